"""Every result that the paper prints stands on its page with a status and a test that exists.

@article{kim2001,
  author  = {Kim, Jongwon and Park, Frank C. and Ryu, Sun Joong and others},
  title   = {Design and Analysis of a Redundantly Actuated Parallel Mechanism for Rapid Machining},
  journal = {IEEE Transactions on Robotics and Automation},
  volume  = {17},
  number  = {4},
  year    = {2001}
}
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from strutwork.kinematics import Poses, jacobians, tangent_rotation
from strutwork.kinematics.assembly_modes import assembly_modes
from strutwork.kinematics.mobility import mobility
from strutwork.kinematics.singular_distance import singularity_distance
from strutwork.machines import EclipsePrototype
from strutwork.papers.kim_2001.comparison import (
    HORIZONTAL,
    at_plate,
    barriers,
    ellipsoid,
    position_compliance,
)
from strutwork.papers.kim_2001.drive_rows import condition, drive_gram, least_singular_value
from strutwork.papers.kim_2001.places import (
    ACROSS,
    across,
    joint_compliance,
    joint_ellipsoid,
    link_directions,
    positioning_radius,
    socket_axes,
)
from strutwork.papers.kim_2001.published import MEASURED, TABLE_1, TABLE_2, TABLE_2_JOINT
from strutwork.papers.kim_2001.radii import COLUMNS, LINKS, radius_study_of
from strutwork.papers.kim_2001.statements import statements
from strutwork.papers.statements import Statement

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def said() -> tuple[Statement, ...]:
    return statements()


def test_every_result_is_there(said: tuple[Statement, ...]) -> None:
    # six of the structural magnitudes, five of the joints' beside the first, eight directions
    joint = len(TABLE_2_JOINT.values) - 1
    assert sum(s.place == "Table II" for s in said) == len(TABLE_2.values) + joint + 8
    assert sum(s.place == "Table I" for s in said) == len(TABLE_1.values) == 10
    assert sum("stiffness" in s.what for s in said if "VI" in s.place) >= len(MEASURED.values)
    places = {s.place for s in said}
    assert {f"Fig. {n}" for n in (4, 5, 6, 8, 9, 13, 14, 15)} <= places
    assert {"Figs 11, 12", "eq. 1", "eq. 3", "section V", "section VIII"} <= places


def test_every_test_that_is_named_exists(said: tuple[Statement, ...]) -> None:
    for name in {s.test for s in said}:
        path, _, function = name.partition("::")
        assert re.search(rf"^def {function}\(", (ROOT / path).read_text(), re.MULTILINE), name


def test_what_is_predicted_needs_no_dimension(said: tuple[Statement, ...]) -> None:
    # four dimensions were fitted: only laws that hold for any are predictions
    predicted = {s.what.split(",")[0] for s in said if s.status == "predicted"}
    assert predicted == {
        "kinematic degrees of freedom",
        "height of a ball: P_z = h + L sin φ",
        "degree of the polynomial of the forward kinematics",
        "a ball above the guide's centre: infinite rates of joints",
        "compliance of a determinate machine from the energy of its rods",
    }
    assert all(s.reason for s in said)


def test_six_freedoms() -> None:
    """Section II.A, by rank: at a general pose six, and nothing is constrained twice."""
    machine = EclipsePrototype()
    found = mobility(machine.linkage, machine.place(machine.tilted(0.3, 0.2)))
    assert (found.mobility, found.mobility_locked) == (6, 0)
    assert found.redundant == 0


def test_the_far_side_of_the_guide_is_out_of_reach() -> None:
    """θ + π needs a link of at least R_b + ρ; ρ is R_p with the platform level at the middle."""
    machine = EclipsePrototype()
    assert machine.link_length < machine.base_radius + machine.platform_radius


def test_sixteen_solutions() -> None:
    """Section II.C: the polynomial's degree is the number of solutions at general poses."""
    machine = EclipsePrototype()
    poses = machine.tilted(np.array([0.2, 0.35, 0.8, 1.2]), np.array([0.1, -0.3, 0.4, 0.2]))
    modes = assembly_modes(machine.linkage, machine.place(poses), poses.rotation)
    assert modes.count.tolist() == [16] * 4
    assert (modes.real >= 2).all()
    assert (modes.home >= 0).all()


def test_a_link_in_the_plate() -> None:
    """Fig. 4: such a link is singular at any dimensions; with ours at the second barrier.

    The tilt at which the link of leg 1 lies in the plate is found from geometry alone, the barrier
    from the determinate's sign: 1e-3° is what its line between steps leaves.
    """
    machine = EclipsePrototype()
    low, high = np.radians([50.0, 70.0])

    def out_of_plate(tilt: float) -> float:
        away, _ = link_directions(machine, machine.tilted(tilt))
        # at γ = 0 leg 1 stays in the plane of tilt: in the plate it points at the centre
        assert abs(away[0, 1]) < 1e-12
        return float(away[0, 2])

    sign = np.sign(out_of_plate(low))
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if np.sign(out_of_plate(middle)) == sign else (low, middle)
    assert np.degrees(low) == pytest.approx(barriers()[1], abs=1e-3)
    away, _ = link_directions(machine, machine.tilted(np.radians(barriers()[0])))
    assert np.degrees(np.abs(np.arcsin(away[:, 2]))).min() > 25.0
    # other dimensions: the determinant passes zero where the link lies in the plate
    other = EclipsePrototype(link_length=0.33, platform_radius=0.1)
    tilt = np.radians(np.linspace(5.0, 89.0, 4000))
    poses = other.tilted(tilt)
    determinant = jacobians(other.linkage, other.place(poses)).determinant()
    away, _ = link_directions(other, poses)
    lies = np.flatnonzero(np.diff(np.sign(away[:, 0, 2])))
    crosses = np.flatnonzero(np.diff(np.sign(determinant)))
    assert len(lies) == 1
    assert np.abs(crosses - lies[0]).min() <= 1


def test_where_the_barriers_end() -> None:
    """Fig. 6 draws both over every spindle angle: ours end, the first where the balls do not go."""
    assert len(barriers(28.0)) == 2
    assert len(barriers(30.0)) == 1
    assert len(barriers(112.0)) > 0
    assert len(barriers(114.0)) == 0
    machine = EclipsePrototype()
    tilt = np.radians(np.arange(0.0, 89.0, 1.0))
    for roll in np.radians(np.arange(114.0, 247.0, 3.0)):
        away, _ = link_directions(machine, machine.tilted(tilt, roll))
        for socket in ("home", "midway"):
            cosine = np.sum(away * socket_axes(machine, socket), axis=-1)  # type: ignore[arg-type]
            assert cosine.min() < np.cos(machine.ball_range)


def test_a_ball_above_the_centre() -> None:
    """Fig. 5: θ̇ = v_t/ρ, so that the largest rate per unit motion times ρ tends to 1."""
    machine = EclipsePrototype()
    for distance, within in ((1e-3, 1e-2), (1e-5, 1e-4)):
        # a level platform, the ball of leg 1 so far from the axis
        place = np.array([distance - machine.platform_radius, 0.0, machine.pole_height])
        poses = Poses.of(place, tangent_rotation(np.array([0.0, 0.0, 1.0]), 0.0))
        rows = jacobians(machine.linkage, machine.place(poses)).inverse
        across_ = np.abs(rows[:, 1]).max() * distance
        assert across_ == pytest.approx(1.0, abs=within)


def test_gram_is_that_of_the_drives_rows() -> None:
    """G = J⁻ᵀJ⁻¹: the root of its least eigenvalue is the engine's distance, to rounding."""
    for drives in ("6", "8"):
        machine = EclipsePrototype(drives=drives)  # type: ignore[arg-type]
        tilt, roll = np.array([5.0, 21.5, 56.5, 70.0]), np.array([0.0, 10.0, -20.0, 30.0])
        poses = machine.tilted(np.radians(tilt), np.radians(roll))
        for length in (machine.platform_radius, machine.base_radius):
            values = np.linalg.eigvalsh(drive_gram(machine, tilt, roll, length))
            distance = singularity_distance(machine.linkage, machine.place(poses), length)
            # a root halves the digits: 1e-8
            np.testing.assert_allclose(np.sqrt(values[:, 0]), distance.parallel, rtol=1e-8)


def test_a_least_singular_value_goes_with_its_length() -> None:
    """Ours, a regression: at another length another value at another tilt."""
    base = EclipsePrototype().base_radius
    found = [least_singular_value("8", [0.0]), least_singular_value("8", [0.0], length=base)]
    assert found[0] == pytest.approx((0.2351, 56.5, 0.0), abs=1e-4)
    assert found[1] == pytest.approx((0.2394, 21.5, 0.0), abs=1e-4)


def test_condition_map_shows_the_barriers() -> None:
    """Fig. 6: along spindle angle 0 the two largest conditions stand at the singular tilts."""
    tilts = np.arange(10.0, 80.0, 0.5)
    six, eight = (condition(d, tilts, [0.0], 0.275)[:, 0] for d in ("6", "8"))  # type: ignore[arg-type]
    peaks = tilts[1:-1][(six[1:-1] > six[:-2]) & (six[1:-1] > six[2:]) & (six[1:-1] > 1e6)]
    np.testing.assert_allclose(peaks, barriers(), atol=0.26)
    assert eight.max() < 1e5


def test_positioning_workspace() -> None:
    """Our digits; what holds at any socket: nothing at 90° if counted from the links at home."""
    machine = EclipsePrototype()
    home, lying = (
        link_directions(machine, machine.tilted(np.radians(t)))[0] for t in (0.0, HORIZONTAL)
    )
    turn = np.degrees(np.arccos(np.sum(home * lying, axis=-1)))
    assert turn == pytest.approx([87.4, 40.9, 40.9], abs=0.05)
    assert positioning_radius(90.0, "home") < 0
    np.testing.assert_allclose(
        np.sum(socket_axes(machine, "midway") * home, axis=-1), np.cos(np.radians(turn / 2))
    )
    # steps of 2.5 mm
    assert positioning_radius(0.0, "midway") == pytest.approx(0.0775, abs=1e-3)
    assert positioning_radius(90.0, "midway") == pytest.approx(0.1125, abs=1e-3)


def test_norms_over_a_plane() -> None:
    """Fig. 13: the middle is Table II's, and both halves mirror each other, to rounding."""
    found = across(0.0)
    middle = len(ACROSS) // 2
    assert found.structural[middle, middle] == pytest.approx(ellipsoid(at_plate(), 0.0).norm)
    assert found.joint[middle, middle] == 1.0
    for values in (found.structural, found.joint):
        np.testing.assert_allclose(values, values[:, ::-1], rtol=1e-6)
        assert np.isfinite(values).all()
    assert found.structural.max() > 10 * found.structural.min()


@pytest.mark.parametrize("tilt", [0.0, HORIZONTAL])
def test_radii_add_up(tilt: float) -> None:
    """Figs 14 and 15: six drives leave forces to statics, so that rods add; 1e-9 is rounding."""
    study = radius_study_of(tilt)
    machine = at_plate()
    built = np.linalg.norm(position_compliance(machine, tilt))
    for i, k in ((0, 0), (0, -1), (-1, 0), (-1, -1)):
        direct = replace(machine, link_radius=LINKS[i], column_radius=COLUMNS[k])
        size = np.linalg.norm(position_compliance(direct, tilt)) / built
        assert study.both[i, k] == pytest.approx(size, rel=1e-9)
    assert (np.diff(study.single, axis=1) < 0).all()
    assert (np.diff(study.both, axis=0) < 0).all()
    assert (np.diff(study.both, axis=1) < 0).all()
    # legs 2 and 3 mirror each other
    np.testing.assert_allclose(study.single[1], study.single[2], rtol=1e-6)


def test_joint_ellipsoids() -> None:
    """The drives' compliance is not the document's: no axis but the unit comes within a fifth."""
    assert joint_ellipsoid(0.0)[0] == 1.0
    ours = np.concatenate([joint_ellipsoid(0.0), joint_ellipsoid(HORIZONTAL)])
    printed = np.array([v.value for v in TABLE_2_JOINT])
    printed = printed / printed[0]
    assert (np.abs(ours[1:] / printed[1:] - 1.0) > 0.2).all()
    # against a frame whose drives yield and whose rods do not
    machine = EclipsePrototype(
        tool_below=0.0,
        pole_height=0.0,
        link_radius=1.0,
        column_radius=1.0,
        guide_stiffness=1e3,
        drive_stiffness=1e3,
    )
    wanted = position_compliance(machine, 0.0)
    np.testing.assert_allclose(1e-3 * joint_compliance(0.0), wanted, atol=1e-4 * wanted.max())
