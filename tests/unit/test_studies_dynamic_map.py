"""The dynamic map: the same poses as the stiffness map, resumed from disk, nothing silent."""

from __future__ import annotations

import importlib
import json
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from strutwork.errors import ModelError, NumericalError
from strutwork.fea import LossFactor, ModalRatio, Port, minimum_dynamic_stiffness, modes
from strutwork.machines import Proposed3PPRS, Prototype3PPPRS, VibratingLegs, dynamic_machine
from strutwork.msa import Structure
from strutwork.studies import (
    CheckPoints,
    Filters,
    PoseStatus,
    Threads,
    Vibration,
    dynamic_map,
    hemisphere,
    read_netcdf,
    stiffness_map,
    write_netcdf,
)

#: The function has the name of its module.
module = importlib.import_module("strutwork.studies.dynamic_map")

ROLLS = np.arange(6) * np.pi / 9
FILTERS = Filters(joint_kinds=("revolute",))


@pytest.fixture(scope="module")
def machine() -> VibratingLegs:
    return replace(dynamic_machine("glozman-3prrs"), elements=2)


@pytest.fixture(scope="module")
def points(machine: VibratingLegs) -> CheckPoints:
    return hemisphere(machine, lattice=5)


@pytest.fixture(scope="module")
def small(machine: VibratingLegs, points: CheckPoints) -> xr.Dataset:
    return dynamic_map(machine, points, ROLLS, FILTERS, workers=1)


def test_it_takes_the_poses_of_the_stiffness_map(
    machine: VibratingLegs, points: CheckPoints, small: xr.Dataset
) -> None:
    static = stiffness_map(machine, points, ROLLS, FILTERS, workers=1)
    np.testing.assert_array_equal(small["roll"], static["roll"])
    np.testing.assert_array_equal(small["status"], static["status"])
    np.testing.assert_array_equal(small["dropped"], static["dropped"])
    free = static["stiffness_free"].sel(direction=["x", "y", "z"]).to_numpy()
    # statics and modes solve the same system by different methods
    np.testing.assert_allclose(small["static_stiffness"], free, rtol=1e-6)


def test_it_agrees_with_single_poses(
    machine: VibratingLegs, points: CheckPoints, small: xr.Dataset
) -> None:
    good = np.flatnonzero(small["status"].to_numpy() == PoseStatus.GOOD)
    assert 10 < len(good) < len(points)
    for point in good[:: max(1, len(good) // 4)]:
        roll = small["roll"].to_numpy()[point : point + 1]
        poses = points.poses(slice(point, point + 1), roll)
        placed = machine.structure.at(machine.place(poses))
        one = small.sel(point=point)
        # stacks of other sizes round otherwise
        np.testing.assert_allclose(
            one["natural_frequency"], modes(placed, 6).frequencies[0], rtol=1e-7
        )
        ports = [Port("tool", axis) for axis in "xyz"]
        least = minimum_dynamic_stiffness(placed, ports, ModalRatio(0.01), (1.0, 5000.0))
        np.testing.assert_allclose(one["minimum_dynamic_stiffness"], least.value[0], rtol=1e-6)
        np.testing.assert_allclose(one["minimum_frequency"], least.frequency[0], rtol=1e-6)


def test_numbers_are_missing_where_no_candidate_counts(small: xr.Dataset) -> None:
    lost = (small["status"] != PoseStatus.GOOD).to_numpy()
    for name in (
        "roll",
        "natural_frequency",
        "minimum_dynamic_stiffness",
        "minimum_frequency",
        "static_stiffness",
    ):
        missing = np.isnan(small[name].to_numpy()).reshape(len(lost), -1)
        np.testing.assert_array_equal(missing.all(axis=1), lost)
        np.testing.assert_array_equal(missing.any(axis=1), lost)
    assert int((~lost).sum()) == small.attrs["points_kept"]


def test_it_says_what_it_is(small: xr.Dataset, tmp_path: Path) -> None:
    assert small.attrs["machine"] == "glozman-3prrs"
    assert "ζ = 0.01" in small.attrs["damping"]
    assert json.loads(small.attrs["parameters"])["platform"]["mass"] == 0.5
    assert all("units" in v.attrs for name, v in small.data_vars.items() if name != "status")
    back = read_netcdf(write_netcdf(tmp_path / "map.nc", small))
    xr.testing.assert_equal(small, back)


def test_it_goes_on_from_finished_chunks(
    machine: VibratingLegs,
    points: CheckPoints,
    small: xr.Dataset,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "POINTS", 30)
    told: list[tuple[int, int]] = []

    def progress(done: int, whole: int) -> None:
        told.append((done, whole))

    def run() -> xr.Dataset:
        return dynamic_map(
            machine, points, ROLLS, FILTERS, workers=Threads(2), progress=progress, folder=tmp_path
        )

    first = run()
    chunks = sorted(tmp_path.rglob("*.npz"))
    assert len(chunks) == -(-len(points) // 30) == 3
    assert told[-1] == (len(points) * len(ROLLS), len(points) * len(ROLLS))
    chunks[1].unlink()
    worked: list[int] = []
    real = module._vibrate

    def counted(*arguments: Any) -> Any:
        worked.append(1)
        return real(*arguments)

    monkeypatch.setattr(module, "_vibrate", counted)
    again = run()
    assert len(worked) == 1
    xr.testing.assert_identical(first, again)
    np.testing.assert_allclose(
        first["minimum_dynamic_stiffness"], small["minimum_dynamic_stiffness"], rtol=1e-6
    )
    # other damping is another study: nothing of the first is taken
    other = dynamic_map(
        machine, points, ROLLS, FILTERS, Vibration(LossFactor(0.01)), workers=1, folder=tmp_path
    )
    assert len(worked) == 4
    ratio = other["minimum_dynamic_stiffness"] / first["minimum_dynamic_stiffness"]
    # η = 1 % is half the damping of ζ = 1 %; modes close to one another make the rest
    assert float(ratio.median()) == pytest.approx(0.5, rel=0.02)


def test_a_stack_that_fails_is_halved_until_the_pose_stands_alone(
    machine: VibratingLegs, points: CheckPoints, monkeypatch: pytest.MonkeyPatch
) -> None:
    poses = points.poses(slice(0, None), np.zeros(1))
    placement = machine.place(poses)
    placement = placement[placement.reachable][:11]
    real = module._vibrate_stack
    bad = placement.positions[7]

    def fails(which: Any, part: Any, vibration: Any) -> Any:
        if any(np.array_equal(bad, p) for p in part.positions):
            raise NumericalError("stack", "fails.", "Leave the pose out.")
        return real(which, part, vibration)

    monkeypatch.setattr(module, "_vibrate_stack", fails)
    values, status = module._vibrate(machine, placement, Vibration())
    assert np.flatnonzero(status == PoseStatus.UNSOLVED).tolist() == [7]
    missing = np.isnan(values["natural_frequency"]).all(axis=1)
    assert np.flatnonzero(missing).tolist() == [7]


def test_the_prototype_can_be_mapped() -> None:
    machine = Prototype3PPPRS(elements=1)
    found = dynamic_map(machine, hemisphere(machine, lattice=2), ROLLS, FILTERS, workers=1)
    assert found.attrs["machine"] == "prototype-3ppprs"
    assert found.attrs["points_kept"] == found.sizes["point"]


class Massless(Proposed3PPRS):
    """A machine whose links weigh nothing."""

    @cached_property
    def structure(self) -> Structure:
        whole = super().structure
        material = replace(self.material, density=None)
        return replace(whole, beams=tuple(replace(b, material=material) for b in whole.beams))


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"rolls": []}, "rolls"),
        ({"vibration": Vibration(ModalRatio(0.0))}, "damping"),
        ({"machine": Massless()}, "density"),
    ],
)
def test_what_is_wrong_is_told_before_the_work(
    machine: VibratingLegs, wrong: dict[str, Any], words: str
) -> None:
    arguments: dict[str, Any] = {"machine": machine, "workers": 1} | wrong
    with pytest.raises(ModelError, match=words):
        dynamic_map(**arguments)


def test_a_wrong_band_or_count_is_told() -> None:
    with pytest.raises(ModelError, match="frequency band"):
        Vibration(band=(10.0, 5.0))
    with pytest.raises(ModelError, match="modes"):
        Vibration(count=0)
