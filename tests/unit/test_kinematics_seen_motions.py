"""Motions of tool and drives by elimination beside those of the full decomposition and formulas."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.kinematics import Placement
from strutwork.kinematics.inscribed_shape import InscribedShape, plane_turn
from strutwork.kinematics.largest_shape import largest_shape
from strutwork.kinematics.margin_grid import margin_grid
from strutwork.kinematics.margins import Margins, of_slacks, placement_slacks
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.seen_motions import SeenMotions
from strutwork.kinematics.tool_drive_space import tool_drive_space
from strutwork.kinematics.transmission import amplifications, velocity_ellipsoids
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.studies.margin_bounds import AmplificationBound
from tests.planar_and_delta import Gliders, biglide, linear_delta
from tests.unit.test_kinematics_largest_shape import delta

Array = NDArray[Any]


def model_of(machine: Gliders) -> Model:
    """A machine in the middle of its guides, as a model of its linkage alone."""
    from tests.unit.test_studies_workspace import model_of as made  # noqa: PLC0415

    return made(machine.linkage, machine.place(np.zeros((1, 3)))[0])


def reached(model: Model, share: float) -> Placement:
    """Poses that drives near home make."""
    linkage = model.structure.linkage
    motion = Motion(linkage, model.placement)
    rng = np.random.default_rng(3)
    joints = {
        pair: motion.home_values[motion.joints.names.index(pair)]
        + share * rng.uniform(-1, 1, 40) * (1.0 if pair[1].startswith("r") else motion.length)
        for pair in linkage.driven
    }
    placement = motion.move(joints=joints).placement
    return placement[placement.reachable]


# legs of six freedoms, legs of less, drives that turn, overconstrained and redundant machines
NAMES = [
    "examples/machines/6-ups.toml",
    "examples/machines/linear-delta.toml",
    "examples/machines/planar-3-rrr.toml",
    "examples/machines/3-rps.toml",
    "prototype-3ppprs",
]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("stacked", [False, True])
def test_spaces_are_those_of_the_full_decomposition(
    name: str, stacked: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    if stacked:
        # as without a compiler
        monkeypatch.setattr(SeenMotions, "_by_legs", lambda *_: None)
        monkeypatch.setattr(SeenMotions, "_compiled", lambda *_: None)
    model = load(name)
    linkage = model.structure.linkage
    placement = reached(model, 0.02)
    assert len(placement.status) >= 5
    motions = SeenMotions.at(linkage, model.placement)
    tool, drives = motions.of(placement)
    exact = tool_drive_space(linkage, placement, motions.length, motions.known)
    basis, _ = np.linalg.qr(np.concatenate([tool, drives], axis=1))
    projections = [b @ np.swapaxes(b, 1, 2) for b in (basis, exact.basis)]
    # rounding over the condition of the rows
    np.testing.assert_allclose(*projections, atol=1e-11)
    ellipsoids = velocity_ellipsoids(exact)
    found = amplifications(tool, drives, ellipsoids.used)
    np.testing.assert_allclose(found[:, 0], ellipsoids.smallest, rtol=1e-9)
    np.testing.assert_allclose(found[:, 1], ellipsoids.largest, rtol=1e-9)


def test_amplifications_of_the_linear_delta() -> None:
    """Rows (a / h, 1) of the inverse Jacobian; rods spin, and that is held."""
    machine = linear_delta(0.8, 0.48)
    bound = AmplificationBound(model_of(machine), 0.0, np.inf)
    assert len(bound._motions.idle) == 3
    places = np.random.default_rng(1).uniform(-0.2, 0.2, (300, 3))
    values = np.linalg.svd(delta(places[:, :2], 0.48), compute_uv=False)
    found = bound.of(machine.place(places))
    np.testing.assert_allclose(found, 1.0 / values[:, [0, 2]], rtol=1e-11)


def test_singular_poses_have_no_end() -> None:
    """Both rods of a biglide in one line: the tool moves across them at held drives."""
    machine = biglide("spherical")
    bound = AmplificationBound(model_of(machine), 0.0, np.inf)
    half = np.sqrt(0.5)
    # the rods lie along (x, y) = (1, -1): det of the inverse Jacobian 1 - tan tan = 0
    found = bound.of(machine.place(np.array([[half, half, 0.0], [0.1, 0.2, 0.0]])))
    assert np.isinf(found[0, 1]) or found[0, 1] > 1e12
    assert found[0, 0] == pytest.approx(1 / 2, rel=1e-9)
    assert found[1, 1] < 2.0


@pytest.mark.parametrize(
    ("angle", "area"), [pytest.param(45.0, 128 / 73, marks=pytest.mark.slow), (0.0, 16 / 13)]
)
def test_squares_of_a_biglide_that_keep_an_amplification(angle: float, area: float) -> None:
    """Exact areas as in `test_kinematics_largest_shape`, now of the linkage itself."""
    machine = biglide()
    bound = AmplificationBound(model_of(machine), 1 / 3, 3.0)

    def kept(points: Array) -> Margins:
        places = np.concatenate([points, np.zeros((len(points), 1))], axis=1)
        placement = machine.place(places)
        slacks = placement_slacks(placement)
        good = np.flatnonzero(placement.reachable)
        for words, slack in bound(placement[good]).items():
            slacks[words] = np.ones(len(points))
            slacks[words][good] = slack
        return of_slacks(slacks)

    axis = np.linspace(-1.1, 1.067, 21)
    grid = margin_grid("xy", [axis] * 2, kept, halvings=2)
    shape = InscribedShape("box", np.ones(2), plane_turn(np.radians(angle)))
    found = largest_shape(grid, kept, shape, centre=np.zeros(2), accuracy=1e-4)
    # the accuracy of the size, twice
    assert found.measure == pytest.approx(area, rel=2e-4)
    assert "velocity amplification" in found.reason
