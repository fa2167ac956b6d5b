"""Singularities and redundancy of Jacobians: infinite where it is, never hidden by a least norm."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from strutwork.kinematics import Joint, Linkage, Placement, Poses, jacobians
from tests.linkages import gough, open_chain, slider_crank

FRAMES = [None, Rotation.from_rotvec([0.3, 0.5, -0.8]).as_matrix()]


@pytest.mark.parametrize("rotation", FRAMES, ids=["plain", "turned"])
@pytest.mark.parametrize("turn", [0.0, np.pi])
def test_a_slider_crank_at_dead_centre(turn: float, rotation: np.ndarray | None) -> None:
    """The slider stands while the crank turns: any speed of it needs an infinite rate."""
    found = jacobians(*slider_crank(turn, rotation=rotation))
    along = np.eye(3) if rotation is None else rotation
    rates = found.inverse[0, :3]
    assert np.isinf(rates[np.abs(along[:, 0]) > 0.1]).all()
    # the slider cannot turn, there or anywhere
    np.testing.assert_array_equal(found.inverse[0, 3:], 0.0)
    np.testing.assert_allclose(found.forward, 0.0, atol=1e-14)
    assert found.serial
    assert not found.parallel
    assert found.condition() == np.inf
    assert found.condition(0.2) == np.inf
    assert found.margin() == 0.0
    assert np.isinf(found.rates([*along[:, 0], 0, 0, 0])).all()


@pytest.mark.parametrize("turn", [1e-6, 1e-3, 0.7, np.pi / 2, np.pi - 1e-6, 4.0])
def test_a_slider_crank_beside_dead_centre(turn: float) -> None:
    """dx/dφ = −r sin φ (1 + r cos φ / √(l² − r² sin² φ)), r = 0.1 m, l = 0.3 m."""
    found = jacobians(*slider_crank(turn))
    rate = -0.1 * np.sin(turn) * (1 + 0.1 * np.cos(turn) / np.sqrt(0.09 - 0.01 * np.sin(turn) ** 2))
    np.testing.assert_allclose(found.forward[0, 0], rate, rtol=1e-7)
    np.testing.assert_allclose(found.inverse[0, 0], 1 / rate, rtol=1e-7)
    assert not found.singular
    assert found.condition() == pytest.approx(1.0)
    assert 0 < found.margin() <= 1
    # what the slider cannot do needs no rate: its part of a twist is left out
    np.testing.assert_allclose(found.inverse[0, 1:] * rate, 0.0, atol=1e-9)


def test_the_margin_goes_to_zero_at_dead_centre() -> None:
    margins = [float(jacobians(*slider_crank(t)).margin()) for t in (1e-1, 1e-3, 1e-5, 1e-7, 0.0)]
    assert np.all(np.diff(margins) < 0)
    assert margins[-1] == 0.0


def test_a_crank_driven_by_its_slider_is_at_a_parallel_singularity_at_dead_centre() -> None:
    """The same linkage with the slider driven and the tool on the crank."""

    def turned_round(turn: float) -> tuple[Linkage, Placement]:
        linkage, placement = slider_crank(turn)
        joints = [replace(j, driven=()) for j in linkage.joints]
        joints[3] = replace(joints[3], driven=("z",))
        return Linkage(linkage.nodes, linkage.bodies, tuple(joints), "c1"), placement

    found = jacobians(*turned_round(0.0))
    assert (bool(found.parallel), bool(found.serial)) == (True, False)
    assert found.condition() == np.inf
    assert found.margin() == 0.0
    # the pin moves along y and turns about z, the slider standing
    assert np.isinf(found.forward[:, 0]).tolist() == [False, True, False, False, False, True]
    np.testing.assert_allclose(found.inverse, 0.0, atol=1e-12)
    assert not jacobians(*turned_round(0.5)).singular


SIX = [[0, 0, 1], [0, 1, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0]]


def arm(wrist: float, forearm: float = 0.4) -> tuple[Linkage, Placement]:
    """Six revolutes with a wrist; singular where its first and last axis fall into one line."""
    points = [[0, 0, 0], [0, 0, 0.3], [0.3, 0, 0.5], [0.3 + forearm, 0, 0.5]]
    centre = points[-1]
    axes = [list(a) for a in SIX]
    axes[5] = [np.cos(wrist), 0.0, -np.sin(wrist)]
    tool = (np.array(centre) + 0.1 * np.array(axes[5])).tolist()
    return open_chain([*points, centre, centre, tool], [*axes, [0, 0, 1]])


def test_a_wrist_singularity_of_an_arm() -> None:
    regular, singular = (jacobians(*arm(w)) for w in (0.6, 0.0))
    np.testing.assert_allclose(regular.inverse @ regular.forward, np.eye(6), atol=1e-12)
    assert not regular.singular
    assert bool(singular.serial)
    assert singular.condition() == np.inf
    assert singular.determinant() == np.inf
    # drives 4 and 6 turn against each other; the others are told
    infinite = np.isinf(singular.inverse).any(axis=-1)
    assert infinite.tolist() == [False, False, False, True, False, True]
    assert np.isfinite(singular.forward).all()
    assert np.linalg.matrix_rank(singular.forward) == 5


def test_one_singular_pose_does_not_touch_its_neighbours() -> None:
    linkage, singular = arm(0.0)
    places = [arm(0.6)[1], singular, arm(0.7)[1]]
    batch = Placement(
        np.stack([p.positions for p in places]),
        np.stack([p.frames for p in places]),
        np.zeros((3, 0)),
    )
    for method in ("legs", "rows"):
        found = jacobians(linkage, batch, method)  # type: ignore[arg-type]
        assert found.serial.tolist() == [False, True, False]
        assert found.by_rank is not None
        for i, place in enumerate(places):
            alone = jacobians(linkage, place, method)  # type: ignore[arg-type]
            np.testing.assert_allclose(found.inverse[i], alone.inverse, rtol=1e-9, atol=1e-9)
            np.testing.assert_allclose(found.forward[i], alone.forward, rtol=1e-9, atol=1e-9)
            assert found.condition()[i] == pytest.approx(float(alone.condition()))


def test_a_redundant_arm_is_not_singular_and_takes_the_least_rates() -> None:
    """Four parallel revolutes move a tool in a plane: three freedoms, four drives."""
    points = [[0, 0, 0], [0.3, 0.1, 0], [0.5, 0.4, 0], [0.3, 0.7, 0], [0.6, 0.8, 0]]
    found = jacobians(*open_chain(points, [[0, 0, 1]] * 5))
    plane = [0, 1, 5]
    assert not found.singular
    assert np.isfinite(found.condition(0.3))
    np.testing.assert_allclose(found.inverse[:, [2, 3, 4]], 0.0, atol=1e-12)
    exact = np.linalg.pinv(found.forward[plane])
    np.testing.assert_allclose(found.inverse[:, plane], exact, atol=1e-12)


def test_two_slides_on_one_line_are_redundant_and_not_singular() -> None:
    found = jacobians(
        *open_chain([[0, 0, 0], [0.2, 0, 0], [0.5, 0, 0]], [[1, 0, 0]] * 3, ["prismatic"] * 2)
    )
    assert not found.singular
    np.testing.assert_allclose(found.inverse[:, 0], [0.5, 0.5], atol=1e-14)
    assert found.condition() == pytest.approx(1.0)


def test_the_twists_of_a_stretched_arm_are_still_two() -> None:
    """Seen as a position it is singular; its twists, with the turn, stay independent."""
    found = jacobians(*open_chain([[0, 0, 0], [0.3, 0, 0], [0.5, 0, 0]], [[0, 0, 1]] * 3))
    np.testing.assert_allclose(found.forward[[1, 5]], [[0.5, 0.2], [1.0, 1.0]], atol=1e-13)
    assert not found.singular
    np.testing.assert_allclose(found.inverse @ found.forward, np.eye(2), atol=1e-12)


def test_less_drives_than_freedoms_leave_the_tool_loose() -> None:
    machine = gough()
    linkage = machine.linkage
    joints = tuple(replace(j, driven=()) if j.name == "P1" else j for j in linkage.joints)
    loose = Linkage(linkage.nodes, linkage.bodies, joints, linkage.tool)
    found = jacobians(loose, machine.place(machine.home()))
    assert bool(found.parallel)
    assert found.condition(0.2) == np.inf
    assert np.isinf(found.forward).any()


@pytest.mark.parametrize("lower", ["universal", "spherical"])
def test_a_parallel_singularity_is_endless_and_not_rounding(lower: str) -> None:
    """Fichter 1986: turned by 90 degrees about its normal a Gough platform is singular."""
    machine = gough(lower)
    quarter = Rotation.from_rotvec([[0, 0, np.pi / 2], [0, 0, 1.2]]).as_matrix()
    placement = machine.place(Poses.of([0.0, 0, 0.5], quarter))
    for method in (None, "rows"):
        found = jacobians(machine.linkage, placement, method)  # type: ignore[arg-type]
        assert found.parallel.tolist() == [True, False]
        assert found.condition(0.2)[0] == np.inf
        assert 1 < found.condition(0.2)[1] < 1e3
        assert np.isfinite(found.inverse).all()
        assert np.isinf(found.forward[0]).any()
        assert np.isfinite(found.forward[1]).all()
        assert found.margin(0.2)[0] == 0.0


def test_idle_motions_are_no_singularity() -> None:
    """A rod between two balls spins; nothing that counts moves with it."""
    machine = gough("spherical")
    found = jacobians(machine.linkage, machine.place(machine.home()), "rows")
    assert not found.singular
    assert Joint("J", "spherical", ("a", "b")).driven == ()
