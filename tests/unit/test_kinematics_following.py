"""Inverse dynamics along trajectories: energy, singularities, jumps, speed limits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError, SingularPoseError, UnreachableError
from strutwork.kinematics import Joint, Linkage
from strutwork.kinematics.coordinates import Coordinates, completed
from strutwork.kinematics.dynamics import Dynamics
from strutwork.kinematics.following import fastest, follow, within_speeds
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.path_checks import Way, check_way
from strutwork.kinematics.time_laws import circle, point_to_point, trapezoid
from strutwork.kinematics.trajectory import Trajectory, sampled
from strutwork.machines import Proposed3PPRS
from tests.dynamics import HEAVY, heavy, home_values, masses_of, simple
from tests.linkages import chain, gough, open_chain, slider_crank
from tests.unit.test_kinematics_dynamics import G, pendulum

Array = NDArray[Any]


@pytest.mark.parametrize("name", HEAVY)
def test_work_of_the_drives_is_the_change_of_energy(name: str) -> None:
    """Along a path that ends elsewhere and in motion."""
    case = heavy(name)
    coordinates = case.dynamics.coordinates
    home = home_values(case.dynamics.motion, coordinates)
    times = np.linspace(0.0, 0.6, 25)[:, None]
    random = np.random.default_rng(5)
    phase = random.uniform(0, 6, len(coordinates))
    scale = np.where(coordinates.rotary, 0.04, 0.004)
    values = home + scale * (np.sin(4 * times + phase) - np.sin(phase))
    found = follow(case.dynamics, sampled(coordinates, times[:, 0], values))
    assert len(found.times) == 24 * 5 + 1
    # polynomials of degree 9 on intervals of 25 ms; 1e-9 of the work that goes in and out
    assert found.imbalance < 1e-9
    moved = np.abs(found.kinetic).max()
    assert moved > 0
    assert abs(found.kinetic[-1] - found.kinetic[0]) > 1e-3 * moved
    np.testing.assert_allclose(found.powers, found.forces * found.speeds, rtol=1e-12)
    # speeds are the slopes of the coordinates
    inner = found.weights @ found.speeds
    np.testing.assert_allclose(inner, found.drives[-1] - found.drives[0], atol=1e-9)
    np.testing.assert_allclose(
        found.weights @ found.accelerations, found.speeds[-1] - found.speeds[0], atol=1e-7
    )


def test_a_wrench_is_part_of_the_balance() -> None:
    case = heavy("mit-ss1")
    home = home_values(case.dynamics.motion, case.dynamics.coordinates)
    path = point_to_point(case.dynamics.coordinates, home, home + np.array([0.02, 0.01, 0.05]), 0.4)
    found = follow(case.dynamics, path, wrench=[300.0, 0, -200.0, 0, 15.0, 0])
    assert found.imbalance < 1e-9
    assert abs(found.work - found.energy_change) > 1.0


def test_the_rms_force_of_a_turning_pendulum() -> None:
    """At constant speed round and round: m g l cos θ, whose mean square is half."""
    dynamics = pendulum()
    turn = 2 * np.pi / 1.5
    times = np.linspace(0, 3.0, 121)
    values = turn * times[:, None]
    path = sampled(
        dynamics.coordinates, times, values, np.full_like(values, turn), np.zeros_like(values)
    )
    found = follow(dynamics, path, reactions=True)
    assert found.rms_forces[0] == pytest.approx(2.0 * G * 0.7 / np.sqrt(2), rel=1e-9)
    assert found.drives[-1, 0] == pytest.approx(4 * np.pi, rel=1e-12)
    assert found.reactions is not None
    assert found.reactions.shape == (601, 5)


def driven_by_slider() -> Dynamics:
    """A slider-crank whose slider is driven, in the coordinate of its crank."""
    linkage, placement = slider_crank(0.8)
    joints = tuple(
        Joint(j.name, j.type, j.between, driven=("z",) if j.name == "guide" else ())
        for j in linkage.joints
    )
    driven = Linkage(linkage.nodes, linkage.bodies, joints, "tool")
    masses = masses_of(driven, crank=(1.0, [0, 0, 0], 0.1), slider=(2.0, [0, 0, 0], 0.1))
    crank = Coordinates((), (("crank", "rz"),))
    return Dynamics(Motion(driven, placement), masses, crank, (0, -G, 0))


def test_a_parallel_singularity_between_samples() -> None:
    dynamics = driven_by_slider()
    # the crank stretches along the rod at −0.8 rad from home: a quarter of the quintic's time on
    path = point_to_point(dynamics.coordinates, [0.0], [-1.1], 2.0)
    with pytest.raises(SingularPoseError, match=r"parallel \(type 2\)") as caught:
        follow(dynamics, path)
    when = float(caught.value.part.split("=")[1].split()[0])
    assert path.at([when])[0][0, 0] == pytest.approx(-0.8, abs=1e-5)


def test_a_parallel_singularity_that_is_touched() -> None:
    """There and back: the drives' sense never changes, yet between samples they hold nothing."""
    dynamics = driven_by_slider()
    times = np.linspace(-1.0, 1.001, 38)
    turn = (-0.8 + 0.7 * times**2)[:, None]
    path = sampled(dynamics.coordinates, times, turn)
    assert np.abs(path.quadrature[0]).min() > 1e-3
    with pytest.raises(
        SingularPoseError, match=r"t = \S*e-\S* s, .*: passes through a singularity, para"
    ):
        follow(dynamics, path)
    # two degrees before it the way is free
    close = sampled(dynamics.coordinates, times, turn + 0.035)
    assert follow(dynamics, close).held.min() < 0.1


def test_a_singularity_of_the_catalogue() -> None:
    """The ring of tilts on which the drives do not hold the platform (s = 0)."""
    machine = Proposed3PPRS()
    home = machine.home()
    motion = Motion(machine.linkage, machine.place(home), home.rotation)
    coordinates, _ = completed(motion, Coordinates())
    masses = masses_of(machine.linkage, platform=(1.0, home.position, 0.01))
    dynamics = Dynamics(motion, masses, coordinates)
    # along x the way of a tool that tilts about y on a ball of 4 mm
    tilt = np.linspace(0, 0.8, 81)
    values = np.zeros((81, 6))
    values[:, 0], values[:, 2] = 4e-3 * np.sin(tilt), home.position[2]
    values[:, 4] = tilt
    path = sampled(coordinates, np.linspace(0, 1, 81), values)
    with pytest.raises(SingularPoseError, match="parallel") as caught:
        follow(dynamics, path)
    when = float(caught.value.part.split("=")[1].split()[0])
    x = path.at([when])[0][0]
    shift = np.hypot(x[0], x[1])
    # 2.14 to 2.42 mm over all rolls (Azulay et al. 2014, Fig. 4: about 2)
    assert 2.1e-3 < shift < 2.5e-3


def test_a_path_out_of_reach() -> None:
    dynamics = pendulum()
    linkage, placement = slider_crank(0.8)
    masses = masses_of(linkage, slider=(1.0, [0, 0, 0], 0.0))
    tool = Dynamics(Motion(linkage, placement), masses, Coordinates(("x",)))
    start = float(placement.positions[linkage.node_index["tool"], 0])
    with pytest.raises(UnreachableError, match=r"at t = .* s, .*: cannot be reached: out of reach"):
        follow(tool, point_to_point(tool.coordinates, [start], [0.45], 1.0))
    with pytest.raises(ModelError, match="gives R2:rz; the dynamics are those of R1:rz"):
        follow(dynamics, point_to_point(Coordinates((), (("R2", "rz"),)), [0.0], [1.0], 1.0))


def test_a_linkage_without_drives() -> None:
    made = chain([[0, 0, 0], [0.7, 0, 0]], [[0, 1.0, 0]] * 2, closed=False)
    dynamics = simple(
        made, Coordinates((), (("R1", "rz"),)), (0, 0, 0), bar1=(2.0, [0.7, 0, 0], 0.0)
    )
    with pytest.raises(ModelError, match="has no driven direction"):
        follow(dynamics, point_to_point(dynamics.coordinates, [0.0], [1.0], 1.0))


def test_a_jump_is_refused() -> None:
    dynamics = pendulum()
    path = point_to_point(dynamics.coordinates, [0.0], [1.0], 1.0)
    points = np.zeros((3, 1, 3))
    points[2] = 0.3
    still = np.zeros((3, 1, 3))
    sign = np.ones(3)
    way = Way(np.array([0.0, 0.1, 0.2]), sign, sign, points, still)
    with pytest.raises(NumericalError, match=r"between t = 0.1 s and 0.2 s: jumps: bar1"):
        check_way(dynamics, path, way)
    moving = Way(way.times, sign, sign, points, points / 0.1)
    check_way(dynamics, path, moving)


def test_the_fastest_within_speed_limits() -> None:
    machine = gough()
    home = machine.home()
    motion = Motion(machine.linkage, machine.place(home), home.rotation)
    coordinates, _ = completed(motion, Coordinates())
    masses = masses_of(machine.linkage, platform=(5.0, home.position, 0.1))
    dynamics = Dynamics(motion, masses, coordinates)
    start = home_values(motion, coordinates)
    end = start + np.array([0.05, -0.02, 0.04, 0.1, 0.05, -0.1])
    limits = np.array([0.2, 0.3, 0.2, np.inf, 0.25, 0.3])

    def make(duration: float) -> Trajectory:
        return point_to_point(coordinates, start, end, duration, trapezoid())

    path = within_speeds(dynamics, make, limits)
    found = follow(dynamics, path)
    share = np.abs(found.speeds).max(axis=0) / limits
    assert share.max() == pytest.approx(1.0, rel=1e-9)
    assert fastest(found, limits) == pytest.approx(1.0, rel=1e-9)
    # round a circle the drives come back to where they were
    around = circle(coordinates, start, 0.03, 1.0)
    home_again = follow(dynamics, around)
    np.testing.assert_allclose(home_again.drives[-1], home_again.drives[0], atol=1e-9)
    assert abs(home_again.work) < 1e-9 * np.abs(home_again.powers).max()
    with pytest.raises(ModelError, match="bound no drive"):
        within_speeds(dynamics, make, np.full(6, np.inf))
    with pytest.raises(ModelError, match="not one positive number per drive"):
        fastest(found, [1.0, 2.0])


def test_many_poses_are_foreseen(monkeypatch: pytest.MonkeyPatch) -> None:
    from strutwork.kinematics import following  # noqa: PLC0415

    monkeypatch.setattr(following, "HOURS", 1e-9)
    monkeypatch.setattr(following, "PIECE", 4)
    dynamics = pendulum()
    with pytest.raises(ModelError, match=r"has 501 poses; they would take about .* hours and"):
        follow(dynamics, point_to_point(dynamics.coordinates, [0.0], [1.0], 1.0))


def test_progress_is_told() -> None:
    made = open_chain([[0, 0, 0], [0.7, 0, 0]], [[0, 1.0, 0]] * 2)
    dynamics = simple(
        made, Coordinates((), (("R1", "rz"),)), (0, 0, 0), bar1=(2.0, [0.7, 0, 0], 0.0)
    )
    told: list[tuple[int, int]] = []
    path = point_to_point(dynamics.coordinates, [0.0], [1.0], 1.0)
    follow(dynamics, path, progress=lambda done, total: told.append((done, total)))
    assert told == [(256, 501), (501, 501)]
