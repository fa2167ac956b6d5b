"""Rods that spin are one line, counts are of elastic modes, bands cover what gives way."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from strutwork.fea import ModalRatio, Port, modal_model
from strutwork.fea.modal import STATIC_SHARE
from strutwork.machines.model_file import read_model
from strutwork.msa import PlacedStructure, PointMass, rod
from strutwork.reports.covering_band import covering_band
from strutwork.reports.vibration import Target, TargetModes, target_modes
from tests.structures import Model
from tests.vibration import heavy

ROOT = Path(__file__).parents[2]
CARRIAGE = ((1e-2, 0.0, 0.0), (0.0, 1e-2, 0.0), (0.0, 0.0, 1e-2))


def linear_delta() -> PlacedStructure:
    """Three rigid carriages on vertical drives, each with two rods on balls to the platform."""
    model = Model("tool")
    model.nodes(tool=(0, 0, 0))
    balls = []
    for leg in range(3):
        angle = 2 * np.pi * leg / 3
        out = np.array([np.cos(angle), np.sin(angle), 0])
        side = np.array([-np.sin(angle), np.cos(angle), 0])
        model.ground(**{f"rail{leg}": 0.3 * out + [0, 0, 0.4]})
        held = [f"slide{leg}"]
        model.joint(
            f"drive{leg}", "prismatic", (f"rail{leg}", f"slide{leg}"), (0, 0, 1),
            driven=("z",), stiffness={"z": 5e7},
        )  # fmt: skip
        for half, sign in enumerate((-1.0, 1.0)):
            key = f"{leg}{half}"
            model.nodes(
                **{f"up{key}": 0.3 * out + 0.05 * sign * side + [0, 0, 0.4],
                   f"low{key}": 0.06 * out + 0.05 * sign * side}
            )  # fmt: skip
            model.joint(f"upper{key}", "spherical", (f"up{key}", f"head{key}"))
            model.joint(f"lower{key}", "spherical", (f"low{key}", f"foot{key}"))
            model.beam(f"rod{key}", f"head{key}", f"foot{key}", rod(0.012))
            held.append(f"up{key}")
            balls.append(f"low{key}")
        model.rigid(f"carriage{leg}", *held)
        model.masses.append(PointMass(f"slide{leg}", 1.0, CARRIAGE))
    model.rigid("platform", "tool", *balls)
    model.masses.append(PointMass("tool", 2.0, ((1e-2, 0, 0), (0, 1e-2, 0), (0, 0, 2e-2))))
    return model.place()


def from_file(name: str) -> Callable[[], PlacedStructure]:
    return lambda: read_model(str(ROOT / "examples" / f"{name}.toml")).placed


MACHINES: dict[str, tuple[Callable[[], PlacedStructure], int]] = {
    "tripod": (from_file("03_tripod"), 0),
    "column on mounts, a model file": (from_file("08_column_on_mounts"), 0),
    "linear Delta": (linear_delta, 6),
    "UPS hexapod": (lambda: heavy("hexapod, spinning struts").place()[0], 6),
    "hexapod": (lambda: heavy("hexapod").place()[0], 0),
}


def found(placed: PlacedStructure, count: int) -> TargetModes:
    nodes = placed.structure.linkage.nodes
    return target_modes(Target("machine", "m", placed, nodes, ModalRatio(0.01)), count)


@pytest.mark.parametrize("name", MACHINES)
def test_idle_spins_are_named_and_elastic_modes_are_counted(name: str) -> None:
    make, spins = MACHINES[name]
    placed = make()
    for count in (1, 5):
        some = found(placed, count)
        assert len(some.elastic.modes.frequencies) == count
        assert np.all(some.elastic.modes.frequencies > 1.0)
        assert int(some.modes.rigid_body_modes) == len(some.idle) == spins
    assert all(motion.spins for motion in some.idle)
    line = some.rigid_line
    assert "\n" not in line
    if not spins:
        assert line == ""
        return
    assert line.startswith(f"{spins} rigid-body modes at 0 Hz. {spins} idle motions")
    for motion in some.idle:
        assert " and ".join(motion.parts) in line


@pytest.mark.parametrize("name", MACHINES)
def test_the_automatic_band_covers_each_outputs_static_compliance(name: str) -> None:
    placed = MACHINES[name][0]()
    tool = placed.structure.linkage.tool
    assert tool is not None
    ports = [Port(tool, axis) for axis in ("x", "y", "z")]
    band, stop = covering_band(placed, ports)
    assert band is not None
    model = modal_model(placed, ports, ModalRatio(0.01))
    massive = model.square[0] > 0
    natural = 1 / np.sqrt(model.square[0][massive]) / (2 * np.pi)
    part = (model.residues[0] ** 2)[:, massive]
    inside = part[:, (natural > band[0]) & (natural < band[1])].sum(axis=1) / part.sum(axis=1)
    short = [str(port) for port, share in zip(ports, inside, strict=True) if share < STATIC_SHARE]
    # either all is covered, or the line names exactly what is not
    assert all(port in stop for port in short)
    assert bool(short) == bool(stop)
    assert STATIC_SHARE == 0.99
    assert band[0] < natural.min() < band[1]
