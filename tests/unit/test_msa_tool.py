"""Stiffness at the tool: both definitions along an axis, ellipsoids, closed forms."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from strutwork.errors import ModelError, SingularPoseError
from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, axes_frame
from strutwork.msa import (
    PlacedStructure,
    Structure,
    System,
    axis_stiffness_blocked,
    axis_stiffness_free,
    compliance_budget,
    prepare_compliance,
    stiffness_ellipsoid,
    system_of,
    tool_compliance,
    tool_stiffness,
)
from strutwork.msa.movable import always_movable, tool_length
from strutwork.msa.tool import COMPILED_FROM
from tests.structure_cases import LIBRARY, stewart
from tests.structures import BAR, STEEL, Model, cantilever

LENGTH = 0.6


def compliance(shear: bool = False) -> np.ndarray:
    return np.asarray(tool_compliance(cantilever(length=LENGTH, shear=shear).place()))


def test_the_two_definitions_along_an_axis_of_a_cantilever() -> None:
    ei = STEEL.youngs_modulus * BAR.second_moment_y
    c = compliance()
    # free to turn at its tip: 3 EI/L³; kept from turning: 12 EI/L³
    assert axis_stiffness_free(c)[2] == pytest.approx(3 * ei / LENGTH**3, rel=1e-10)
    assert axis_stiffness_blocked(c)[2] == pytest.approx(12 * ei / LENGTH**3, rel=1e-9)
    # about y: EI/L free, 4 EI/L with the tip held
    assert axis_stiffness_free(c)[4] == pytest.approx(ei / LENGTH, rel=1e-10)
    assert axis_stiffness_blocked(c)[4] == pytest.approx(4 * ei / LENGTH, rel=1e-9)


def test_blocked_is_never_softer_than_free() -> None:
    for name in ("hexapod", "three-legged frame", "serial arm", "tripod machine"):
        c = tool_compliance(LIBRARY[name]().model.place())
        assert np.all(axis_stiffness_blocked(c) >= axis_stiffness_free(c) * (1 - 1e-12))


def test_stiffness_is_the_inverse_of_the_compliance() -> None:
    c = compliance(shear=True)
    k = tool_stiffness(c)
    weight = np.sqrt(np.diag(c))
    np.testing.assert_allclose((k @ c) * weight / weight[:, None], np.eye(6), atol=1e-12)
    np.testing.assert_array_equal(k, k.T)


def test_ellipsoid_of_a_turned_cantilever() -> None:
    turn = Rotation.from_rotvec([0.5, 0.8, -0.3]).as_matrix()
    c = tool_compliance(cantilever(length=LENGTH, shear=False).turned(turn).place())
    e = STEEL.youngs_modulus
    side, up = (3 * e * i / LENGTH**3 for i in (BAR.second_moment_z, BAR.second_moment_y))
    along = e * BAR.area / LENGTH
    for rotation, factor in (("free", 1.0), ("blocked", 4.0)):
        found = stiffness_ellipsoid(c, rotation)
        np.testing.assert_allclose(found.values, [factor * side, factor * up, along], rtol=1e-8)
        # weakest along local y, then z, then x; the sense of an axis is open
        overlap = np.abs(np.sum(found.directions * turn[:, [1, 2, 0]], axis=0))
        np.testing.assert_allclose(overlap, 1.0, rtol=1e-8)
        assert (found.rotation, "N/m" in repr(found)) == (rotation, True)


def test_ellipsoids_of_a_batch_are_those_of_its_poses() -> None:
    c = tool_compliance(stewart().model.place())
    together = stiffness_ellipsoid(c, "blocked")
    assert together.values.shape == (7, 3)
    assert np.all(np.diff(together.values, axis=-1) >= 0)
    for pose in range(7):
        alone = stiffness_ellipsoid(c[pose], "blocked")
        np.testing.assert_allclose(together.values[pose], alone.values, rtol=1e-12)


def test_the_default_method_changes_with_the_number_of_poses_and_the_numbers_do_not() -> None:
    few, many = stewart(poses=3), stewart(poses=COMPILED_FROM + 3)
    assert few.model.place().batch == (3,)
    placed = many.model.place()
    by_default, on_two = tool_compliance(placed), tool_compliance(placed, workers=2)
    expected = tool_compliance(placed[-3:], "saddle_point")
    np.testing.assert_allclose(by_default[-3:], expected, rtol=1e-9, atol=1e-9 * expected.max())
    np.testing.assert_array_equal(on_two, by_default)


def test_a_part_of_a_study_is_solved_as_the_study_is() -> None:
    placed = stewart(poses=COMPILED_FROM + 3).model.place()
    expected = tool_compliance(placed)
    some = placed[np.arange(100, 105)]
    as_part = tool_compliance(some.among(placed.batch[0]))
    np.testing.assert_array_equal(as_part, expected[100:105])
    # five poses by themselves go to the dense solvers, whose last digits are others
    assert not np.array_equal(tool_compliance(some), as_part)


def test_what_parts_share_is_made_of_many_poses() -> None:
    placed = stewart(poses=COMPILED_FROM).model.place()
    kept = placed.structure.__dict__
    prepare_compliance(placed[:0].among(10_000))
    prepare_compliance(placed[:5].among(COMPILED_FROM - 1))
    assert "_program" not in kept
    prepare_compliance(placed[:5].among(COMPILED_FROM))
    assert kept["_program"] is not None


@pytest.mark.parametrize("asked", [always_movable, tool_length], ids=lambda f: f.__name__)
def test_the_topology_is_asked_at_one_pose(asked: Callable[[System], object]) -> None:
    """The rows of a million poses would take fifteen gigabytes."""
    system = system_of(stewart(poses=3).model.place())
    asked(system)
    assert "row_blocks" not in system.__dict__


def test_a_tool_that_cannot_move_has_no_finite_stiffness() -> None:
    model = cantilever()
    model.tool = "root"
    c = tool_compliance(model.place(), "saddle_point")
    assert np.abs(c).max() < 1e-20
    with pytest.raises(SingularPoseError, match="does not move at all"):
        tool_stiffness(np.zeros((6, 6)))
    lonely = Model("base")
    lonely.ground(base=(0, 0, 0))
    assert not np.any(tool_compliance(lonely.place()))


def test_a_tool_on_a_slide_with_a_soft_drive_is_stiff_elsewhere() -> None:
    model = Model("tool")
    model.ground(base=(0, 0, 0))
    model.joint("slide", "prismatic", ("base", "tool"), driven=("z",), stiffness={"z": 5e6})
    c = tool_compliance(model.place())
    expected = np.zeros((6, 6))
    expected[2, 2] = 2e-7
    np.testing.assert_allclose(c, expected, atol=1e-22)
    with pytest.raises(SingularPoseError):
        tool_stiffness(c)


def test_an_ellipsoid_is_free_or_blocked() -> None:
    with pytest.raises(ModelError, match='rotation is "half"'):
        stiffness_ellipsoid(np.eye(6), "half")


def slide_on_a_spring() -> PlacedStructure:
    """A tool that a prismatic joint lets move along global x alone, on a spring."""
    linkage = Linkage(
        ("A", "B"),
        (Body(GROUND, ("A",)),),
        (Joint("slide", "prismatic", ("A", "B"), stiffness={"z": 1e6}),),
        "B",
    )
    frame = axes_frame([1.0, 0.0, 0.0])
    return Structure(linkage).at(Placement(np.zeros((2, 3)), frame[None], np.zeros(0)))


def test_a_direction_in_which_the_tool_cannot_move_is_infinitely_stiff() -> None:
    placed = slide_on_a_spring()
    compliance = tool_compliance(placed)
    with np.errstate(all="raise"):
        free = axis_stiffness_free(compliance)
        ellipsoid = stiffness_ellipsoid(compliance, "free")
        across = compliance_budget(placed, np.eye(6)[1])
    np.testing.assert_allclose(free[0], 1e6)
    assert np.all(np.isposinf(free[1:]))
    np.testing.assert_allclose(ellipsoid.values[0], 1e6)
    assert np.all(np.isposinf(ellipsoid.values[1:]))
    # the joint takes a force along y alone: nothing stores energy
    np.testing.assert_array_equal(across.shares, 0.0)
