"""What weight and a standard circle ask of drives, beside what each is made of."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.kinematics.coordinates import Coordinates
from strutwork.kinematics.dynamics import STANDARD_GRAVITY, Dynamics
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.machines.model_poses import walked
from strutwork.msa.body_mass import body_masses
from strutwork.studies.standard_motion import ACCELERATION, SHARE, standard_motion

EXAMPLES = Path(__file__).parents[2] / "examples" / "machines"


def machine(name: str) -> Model:
    return load(EXAMPLES / f"{name}.toml")


def test_an_upright_slide_bears_what_hangs_on_it() -> None:
    """The gantry: its vertical drive bears the ram, at every pose; the others bear nothing."""
    model = machine("gantry")
    assert model.workspace is not None
    found = standard_motion(model, model.workspace)
    drives = [joint for joint, _ in model.structure.linkage.driven]
    masses = body_masses(model.structure.at(model.placement))
    ram = masses.mass[model.structure.linkage.tool_body]
    up = drives.index("z")
    assert found.standing[:, up] == pytest.approx(ram * -STANDARD_GRAVITY[2], rel=1e-9)
    others = np.delete(found.standing, up, axis=1)
    assert np.abs(others).max() <= 1e-9 * ram
    # straight slides feel what they carry, alone or with the others free to follow
    assert found.labels == ("x", "y", "z")
    np.testing.assert_allclose(found.held, found.free, rtol=1e-9)
    assert found.held[2] == pytest.approx(ram, rel=1e-9)


def test_the_weight_of_a_hexapod_is_borne_by_its_legs() -> None:
    """In a small step down the work of the drives is the change of potential energy."""
    model = machine("6-ups")
    assert model.workspace is not None
    found = standard_motion(model, model.workspace)
    masses = body_masses(model.structure.at(model.placement))
    dynamics = Dynamics(model.motion, masses, Coordinates(DIRECTIONS, ()))
    step = 1e-4
    low, high = (
        {d: v[-1:] + (change if d == "z" else 0.0) for d, v in model.workspace.task().items()}
        for change in (-step, step)
    )
    drives, energies = [], []
    for pose in (low, high):
        there = walked(model, pose)
        drives.append([there.coordinate(*d)[0] for d in model.structure.linkage.driven])
        energies.append(float(dynamics.at(there).potential[0]))
    work = found.standing[-1] @ (np.array(drives[1]) - np.array(drives[0]))
    # central differences over a tenth of a millimetre
    assert work == pytest.approx(energies[1] - energies[0], rel=1e-6)


def test_the_circle_is_as_fast_as_it_says() -> None:
    model = machine("gantry")
    assert model.workspace is not None
    found = standard_motion(model, model.workspace)
    assert found.plane == ("x", "y")
    assert found.radius == pytest.approx(SHARE * 0.4)
    assert found.round is not None
    followed = found.round.followed
    pairs = model.structure.linkage.driven
    x, y = (followed.accelerations[:, pairs.index((j, "z"))] for j in ("x", "y1"))
    largest = float(np.hypot(x, y).max())
    # samples may miss the very peak
    assert 0.99 * ACCELERATION <= largest <= 1.06 * ACCELERATION
    assert followed.imbalance < 1e-9


def test_what_a_force_limit_makes_sure_of() -> None:
    """Straight slides, each along its axis: the weakest decides. Two drives share y."""
    model = machine("gantry")
    assert model.workspace is not None
    limits = {d.joint: d.force for d in model.drives}
    found = standard_motion(model, model.workspace)
    assert None not in limits.values()
    along = [limits["x"], limits["y1"] + limits["y2"], limits["z"]]  # type: ignore[operator]
    assert found.surely == pytest.approx(min(along))  # type: ignore[type-var]
    unknown = replace(model, drives=model.drives[1:])
    assert standard_motion(unknown, model.workspace).surely is None


def test_a_tool_without_mass_is_named() -> None:
    model = load("proposed-3pprs")
    assert model.workspace is not None
    with pytest.raises(ModelError, match="the body of the tool: has no mass"):
        standard_motion(model, model.workspace)
