"""Vibration over poses, with preload and dashpots, is that of each pose by itself."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from strutwork.fea import Port, modes
from strutwork.fea.least_stiffness import least_dynamic_stiffness
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model
from strutwork.machines.model_poses import at_pose
from strutwork.reports.cli.survey import _vibration
from strutwork.studies.model_damping import model_damping
from strutwork.studies.survey import survey
from tests.cli.conftest import Program, strutwork
from tests.model_files import put, toml

__all__ = ["strutwork"]

HEXAPOD = Path(__file__).parents[2] / "examples" / "machines" / "6-ups.toml"
AT = {"x": 0.03, "rx": 0.05}


def hexapod(dashpots: bool) -> Model:
    """The hexapod of the examples under its preload; with dashpots in its drives or without."""
    return parse_model(text(dashpots))


def text(dashpots: bool) -> str:
    content = tomllib.loads(HEXAPOD.read_text(encoding="utf-8"))
    if dashpots:
        for k, joint in enumerate(content["joints"]):
            if joint["name"].startswith("drive"):
                put(f"joints.{k}.damping", {"z": "4e3 N*s/m"})(content)
    return toml(content)


@pytest.mark.parametrize("dashpots", [False, True], ids=["plain", "dashpots"])
def test_a_map_is_each_pose_by_itself(dashpots: bool) -> None:
    """To 1e-9: the same matrices; poses of a stack are solved by other orders of the same sums."""
    model = hexapod(dashpots)
    answer = _vibration(model)
    assert answer.preload is not None
    grid = TaskGrid({d: np.array([v]) for d, v in AT.items()})
    found = survey(model, grid, [answer]).squeeze()
    there = at_pose(model, AT)
    alone = modes(there.vibrating, 40)
    frequencies = alone.frequencies[int(alone.rigid_body_modes) :][: answer.count]
    assert found["natural_frequency"].to_numpy() == pytest.approx(frequencies, rel=1e-9)
    damping = model_damping(there)
    assert damping is not None
    for k, axis in enumerate("xyz"):
        port = Port(answer.tool, axis)
        least = least_dynamic_stiffness(there.vibrating, port, port, damping, answer.band)
        value = float(found["least_dynamic_stiffness"][k])
        # a minimum is known to 1e-6 of its value on its curve, its place to the root of that
        assert value == pytest.approx(least.value, rel=1e-9)
        assert float(found["least_at"][k]) == pytest.approx(least.frequency, rel=1e-5)


def test_preload_and_dashpots_change_the_map() -> None:
    """Neither is left out: without them the numbers are others by more than any rounding."""
    grid = TaskGrid({d: np.array([v]) for d, v in AT.items()})
    model, damped = hexapod(dashpots=False), hexapod(dashpots=True)
    answer = _vibration(model)
    with_, without, dashed = (
        survey(m, grid, [a]).squeeze()
        for m, a in (
            (model, answer),
            (model, replace(answer, preload=None)),
            (damped, replace(_vibration(damped), band=answer.band)),
        )
    )
    first = [float(f["natural_frequency"][0]) for f in (with_, without, dashed)]
    assert abs(first[1] / first[0] - 1.0) > 1e-5
    assert first[2] == pytest.approx(first[0], rel=1e-9)
    least = [f["least_dynamic_stiffness"].to_numpy() for f in (with_, dashed)]
    assert np.all(least[1] > 1.001 * least[0])


def test_the_commands_agree(strutwork: Program, tmp_path: Path) -> None:
    """`map` at one pose, `modes --pose` and `frf --pose` over the same band."""
    file = tmp_path / "hexapod.toml"
    file.write_text(text(dashpots=True), encoding="utf-8")
    mapped = strutwork("map", file, "--vibration", "--over", "x=30mm", "--json").result
    one = strutwork("modes", file, "-n", "1", "--pose", "x=30mm", "--json").result
    first = mapped["extremes"]["natural_frequency_1"]["least"]["value"]
    assert first == pytest.approx(one["frequencies"][one["rigid_body_modes"]], rel=1e-9)
    band = _vibration(hexapod(dashpots=True)).band
    least = strutwork(
        *("frf", file, "--input", "TCP:z", "--pose", "x=30mm", "--json"),
        *("--from", repr(band[0]), "--to", repr(band[1])),
    ).result["minimum_dynamic_stiffness"]
    value = mapped["extremes"]["least_dynamic_stiffness_z"]["least"]["value"]
    assert value == pytest.approx(least["value"], rel=1e-9)
