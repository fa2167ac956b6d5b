"""Rigid-body dynamics: closed forms, Euler-Lagrange by differences, and what must always hold."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError, SingularPoseError, UnreachableError
from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, axes_frame
from strutwork.kinematics.body_masses import BodyMasses
from strutwork.kinematics.body_motion import BodyMotion
from strutwork.kinematics.coordinates import Coordinates, completed
from strutwork.kinematics.drive_forces import inverse_dynamics
from strutwork.kinematics.dynamics import Dynamics
from strutwork.kinematics.motion import Motion
from tests.dynamics import HEAVY, Case, heavy, masses_of, simple
from tests.linkages import chain, gough, open_chain, slider_crank

Array = NDArray[Any]

G = 9.81
DOWN = (0.0, 0.0, -G)

#: Central differences of eighth order: first derivative.
EIGHTH = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280])


def forces_of(dynamics: Dynamics, values: Any, rates: Any, changes: Any) -> Any:
    case = Case(dynamics, np.atleast_1d(values), np.atleast_1d(rates), np.atleast_1d(changes))
    return inverse_dynamics(case.at(case.values), case.rates, case.changes)


def pendulum() -> Dynamics:
    """A point mass of 2 kg on 0.7 m, that hangs from a driven hinge about y."""
    return simple(
        open_chain([[0, 0, 0], [0.7, 0, 0]], [[0, 1.0, 0]] * 2),
        Coordinates((), (("R1", "rz"),)),
        DOWN,
        bar1=(2.0, [0.7, 0, 0], 0.0),
    )


def test_a_pendulum() -> None:
    m, arm, turn, rate, change = 2.0, 0.7, 0.4, 3.0, -5.0
    found = forces_of(pendulum(), turn, rate, change)
    # about y the tip goes down from x: z = −l sin θ
    assert found.drives[0, 0] == pytest.approx(
        m * arm**2 * change - m * G * arm * np.cos(turn), rel=1e-13
    )
    assert found.powers[0, 0] == pytest.approx(found.drives[0, 0] * rate, rel=1e-14)
    outward = np.array([np.cos(turn), 0.0, -np.sin(turn)])
    along = np.array([-np.sin(turn), 0.0, -np.cos(turn)])
    needed = m * (arm * (change * along - rate**2 * outward) - np.array(DOWN))
    # what the hinge's ground does to the bar, in the hinge's axes at this pose
    frame = found.at.placed.placement.frames[0, 0]
    assert found.determined
    assert found.reaction_labels[:3] == ("R1:x", "R1:y", "R1:z")
    np.testing.assert_allclose(found.reactions[0, :3], frame.T @ needed, rtol=1e-12)
    # the point mass is in the plane of the hinge: no moments
    np.testing.assert_allclose(found.reactions[0, 3:], 0.0, atol=1e-12)


def test_a_slider_crank() -> None:
    r, rod, share, turn, rate, change = 0.1, 0.3, 0.4, 0.8, 11.0, 70.0
    crank_inertia, m_rod, i_rod, m_slider = 0.02, 1.5, 0.013, 2.5
    made = slider_crank(0.3, r, rod)
    pin, slider = made[1].positions[2], made[1].positions[5]
    dynamics = simple(
        made,
        Coordinates((), (("crank", "rz"),)),
        (0.0, -G, 0.0),
        crank=(0.0, [0, 0, 0], [0, 0, crank_inertia]),
        rod=(m_rod, pin + share * (slider - pin), [0, 0, i_rod]),
        slider=(m_slider, slider + np.array([0.02, 0.01, 0.0]), 0.3),
    )
    found = forces_of(dynamics, turn - 0.3, rate, change)
    s, c = np.sin(turn), np.cos(turn)
    # angle β of the rod: l sin β = −r sin φ, and its derivatives by φ
    sine = -r / rod * s
    cosine = np.sqrt(1 - sine**2)
    first = -r / rod * c / cosine
    second = (r / rod * s + sine * first**2) / cosine
    pin1, pin2 = r * np.array([-s, c]), -r * np.array([c, s])

    def rod_point(part: float) -> tuple[Array, Array]:
        across, along = np.array([-sine, cosine]), np.array([cosine, sine])
        return (
            pin1 + part * rod * first * across,
            pin2 + part * rod * (second * across - first**2 * along),
        )

    needed = crank_inertia * change + i_rod * first * (first * change + second * rate**2)
    for mass, part in ((m_rod, share), (m_slider, 1.0)):
        c1, c2 = rod_point(part)
        needed += mass * (c1 @ (c1 * change + c2 * rate**2) + G * c1[1])
    assert found.drives[0, 0] == pytest.approx(needed, rel=1e-10)


def test_a_gantry() -> None:
    masses = (5.0, 3.0, 2.0)
    dynamics = simple(
        open_chain(
            [[0, 0, 0], [0.2, 0, 0], [0.2, 0.3, 0], [0.2, 0.3, 0.1]],
            [[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0], [0, 0, 1.0]],
            ["prismatic"] * 3,
        ),
        Coordinates(("x", "y", "z")),
        DOWN,
        bar1=(masses[0], [0.1, 0, 0], 0.1),
        bar2=(masses[1], [0.2, 0.1, 0], 0.2),
        bar3=(masses[2], [0.2, 0.3, 0.1], 0.3),
    )
    change = np.array([1.5, -2.0, 0.7])
    found = forces_of(dynamics, [0.25, 0.2, 0.3], [0.5, 0.6, -0.9], change)
    carried = np.cumsum(masses[::-1])[::-1]
    np.testing.assert_allclose(
        found.drives[0], carried * change + [0, 0, G * masses[2]], rtol=1e-12, atol=1e-12
    )
    np.testing.assert_allclose(found.at.mass[0], np.diag(carried), atol=1e-12)
    np.testing.assert_allclose(found.accelerations_of_drives[0], change, rtol=1e-12)


@pytest.mark.parametrize("name", HEAVY)
def test_velocities_and_accelerations_beside_differences(name: str) -> None:
    case = heavy(name)
    step = 2e-3
    values, rates = case.along(step, 4)
    placed = case.at(values).placed
    twists = placed.twists(rates)
    points = np.einsum("k,kbi->bi", EIGHTH, placed.points) / step
    size = np.abs(twists).max()
    # poses are closed to 1e-11 of the machine's size, over a step of 2 ms
    np.testing.assert_allclose(
        points, twists[4].reshape(-1, 6)[:, :3], rtol=0, atol=1e-8 * max(size, 1.0)
    )
    changed = np.einsum("k,kn->n", EIGHTH, twists) / step
    found = placed.accelerations(rates, np.broadcast_to(case.changes, rates.shape))[4]
    np.testing.assert_allclose(changed, found, rtol=0, atol=1e-8 * np.abs(found).max())
    slope = np.einsum("k,knt->nt", EIGHTH, placed.map) / step
    exact = placed.map_rate(rates)[4]
    np.testing.assert_allclose(slope, exact, rtol=0, atol=1e-8 * max(np.abs(exact).max(), 1.0))


@pytest.mark.parametrize("name", HEAVY)
def test_euler_and_lagrange(name: str) -> None:
    """d/dt ∂T/∂ẋ − ∂T/∂x + ∂U/∂x from energies at neighbouring poses alone."""
    case = heavy(name)
    count = len(case.values)
    # some machines' joints run 8 mm from the axis of their guide: 1/30 of that
    steps = np.where(case.dynamics.coordinates.rotary, 2.5e-3, 2.5e-4)
    offsets = np.arange(-4, 5)
    around = case.values + (
        offsets[None, :, None] * steps[:, None, None] * np.eye(count)[:, None, :]
    )
    at = case.at(around.reshape(-1, count))
    mass = at.mass.reshape(count, 9, count, count)
    slope = np.einsum("k,ikab->iab", EIGHTH, mass) / steps[:, None, None]
    pull = np.einsum("k,ik->i", EIGHTH, at.potential.reshape(count, 9)) / steps
    v = case.rates
    momentum = mass[0, 4] @ case.changes + np.einsum("iab,i,b->a", slope, v, v)
    wanted = momentum - np.einsum("iab,a,b->i", slope, v, v) / 2 + pull
    found = inverse_dynamics(case.at(case.values), v, case.changes).coordinates[0]
    # relative to the largest term: what cancels between inertia and weight is no error
    largest = max(np.abs(momentum).max(), np.abs(pull).max())
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-9 * largest)


@pytest.mark.parametrize("name", HEAVY)
def test_the_equation_of_motion(name: str) -> None:
    case = heavy(name, seed=3)
    at = case.at(case.values)
    mass, coriolis = at.mass[0], at.coriolis(case.rates)[0]
    np.testing.assert_array_equal(mass, mass.T)
    assert np.linalg.eigvalsh(mass).min() > 0
    found = inverse_dynamics(at, case.rates, case.changes)
    whole = mass @ case.changes + coriolis @ case.rates + at.weight[0]
    size = np.abs(whole).max()
    np.testing.assert_allclose(found.coordinates[0], whole, rtol=0, atol=1e-12 * size)
    assert at.kinetic(case.rates)[0] == pytest.approx(case.rates @ mass @ case.rates / 2, rel=1e-12)
    # Ṁ − 2 C is skew: passivity, no force of C does work beyond what changes the mass
    step = 2e-3
    values, _ = case.along(step, 4)
    slope = np.einsum("k,kab->ab", EIGHTH, case.at(values).mass) / step
    odd = slope - 2 * coriolis
    np.testing.assert_allclose(
        odd + odd.T, 0.0, atol=1e-7 * np.abs(coriolis).max() + 1e-9 * np.abs(mass).max()
    )
    # power of the drives is the rate of the energy
    power = found.powers[0].sum()
    assert power == pytest.approx(found.coordinates[0] @ case.rates, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("name", ["mit-ss1", "eclipse-3pprs:calibrated", "prototype-3ppprs"])
def test_in_the_space_of_the_drives(name: str) -> None:
    """M_Q = Jᵀ M J and the same forces, whether tool or drives describe the motion."""
    case = heavy(name)
    at = case.at(case.values)
    found = inverse_dynamics(at, case.rates, case.changes)
    motion = case.dynamics.motion
    drives = Coordinates((), motion.linkage.driven)
    other = Dynamics(motion, case.dynamics.masses, drives, case.dynamics.gravity)
    moved = case.move(case.values[None])
    there = other.at(moved)
    forward = np.linalg.inv(at.drive_map[0])
    scale = np.abs(there.mass[0]).max()
    np.testing.assert_allclose(
        forward.T @ at.mass[0] @ forward, there.mass[0], rtol=0, atol=1e-9 * scale
    )
    again = inverse_dynamics(there, found.rates_of_drives, found.accelerations_of_drives)
    np.testing.assert_allclose(again.coordinates, found.drives, rtol=1e-8, atol=1e-9)
    np.testing.assert_allclose(again.drives, found.drives, rtol=1e-8, atol=1e-9)


def test_reactions_carry_the_weight() -> None:
    """All that the ground's joints bear is weight and inertia of the whole."""
    case = heavy("examples/03_tripod.toml")
    at = case.at(case.values)
    found = inverse_dynamics(at, case.rates, case.changes)
    assert found.determined
    linkage = case.dynamics.motion.linkage
    rows = at.placed.held
    grounded = [
        r
        for r, pair in enumerate(rows.nodes)
        if linkage.body_of_node[pair[0]] < 0 and rows.direction[r] < 3
    ]
    force = sum(found.reactions[0, r] * rows.axes[0, r, :3] for r in grounded)
    accelerations = found.accelerations[0].reshape(-1, 6)[:, :3]
    needed = case.dynamics.masses.mass @ (accelerations - np.asarray(case.dynamics.gravity))
    np.testing.assert_allclose(force, needed, rtol=1e-9)


def test_reactions_of_an_over_constrained_linkage_are_not_determined() -> None:
    case = heavy("examples/04_four_bar.toml")
    found = inverse_dynamics(case.at(case.values), case.rates, case.changes)
    assert not found.determined
    with pytest.raises(ModelError, match="not determined"):
        _ = found.reactions


def doubled(second: float) -> tuple[Linkage, Placement]:
    """A tool on a slide that two drives move: one at a slope, through a pin in a slot."""
    along = [np.cos(second), np.sin(second), 0.0]
    linkage = Linkage(
        ("g1", "g2", "a", "s", "b", "tool"),
        (Body(GROUND, ("g1", "g2")), Body("slide", ("a", "b", "tool")), Body("push", ("s",))),
        (
            Joint("first", "prismatic", ("g1", "a"), driven=("z",)),
            Joint("slope", "prismatic", ("g2", "s"), driven=("z",)),
            Joint("slot", "support", ("b", "s"), locks=("x",)),
        ),
        "tool",
    )
    frames = np.stack([axes_frame([1.0, 0, 0]), axes_frame(along), np.eye(3)])
    return linkage, Placement(np.zeros((6, 3)), frames, np.zeros(0))


def test_redundant_drives_share_with_the_least_norm() -> None:
    slope = 0.5
    dynamics = simple(
        doubled(slope), Coordinates(("x",)), (0.0, 0.0, 0.0), slide=(4.0, [0, 0, 0], 1.0)
    )
    found = forces_of(dynamics, 0.1, 0.2, 3.0)
    # the second moves 1/cos α times as far as the first
    ways = np.array([1.0, 1.0 / np.cos(slope)])
    np.testing.assert_allclose(found.at.drive_map[0, :, 0], ways, rtol=1e-12)
    np.testing.assert_allclose(found.drives[0], 12.0 * ways / (ways @ ways), rtol=1e-12)
    assert not found.determined


def test_too_few_drives() -> None:
    made = chain([[0, 0, 0], [0.7, 0, 0]], [[0, 1.0, 0]] * 2, closed=False)
    dynamics = simple(made, Coordinates((), (("R1", "rz"),)), DOWN, bar1=(2.0, [0.7, 0, 0], 0.0))
    found = forces_of(dynamics, 0.4, 0.0, 0.0)
    with pytest.raises(ModelError, match="are 0 for 1 freedoms"):
        _ = found.drives
    assert found.coordinates[0, 0] == pytest.approx(-2.0 * G * 0.7 * np.cos(0.4), rel=1e-12)


def test_struts_that_spin_freely_do_not() -> None:
    """Between two balls: as with universal joints below, and nothing would turn a round strut."""
    drives = {}
    for lower in ("universal", "spherical"):
        machine = gough(lower)
        home = machine.home()
        motion = Motion(machine.linkage, machine.place(home), home.rotation)
        coordinates, _ = completed(motion, Coordinates())
        parts: dict[str, Any] = {"platform": (6.0, [0, 0, 0.52], [0.1, 0.12, 0.2])}
        placement = motion.home
        for i in range(1, 7):
            foot, head = (
                placement.positions[machine.linkage.node_index[f"{end}{i}"]]
                for end in ("foot", "head")
            )
            along = (head - foot) / np.linalg.norm(head - foot)
            slender = 0.02 * (np.eye(3) - np.outer(along, along)) + 1e-3 * np.outer(along, along)
            parts[f"cylinder{i}"] = (1.2, foot + 0.1 * along, slender)
            parts[f"piston{i}"] = (0.8, head - 0.1 * along, slender)
        dynamics = Dynamics(motion, masses_of(machine.linkage, **parts), coordinates, DOWN)
        spinning = dynamics.bodies.idle
        assert len(spinning) == (6 if lower == "spherical" else 0)
        values = np.array([0.02, -0.03, 0.52, 0.1, -0.05, 0.2])
        found = forces_of(dynamics, values, 0.4 * np.ones(6), -2.0 * np.ones(6))
        drives[lower] = found.drives[0]
        if spinning:
            size = np.abs(found.coordinates).max()
            assert np.abs(found.spins).max() < 1e-12 * size
    # a universal joint turns the strut a little about its line, by its own small inertia
    np.testing.assert_allclose(drives["spherical"], drives["universal"], rtol=5e-3)
    assert np.abs(drives["spherical"] - drives["universal"]).max() > 0


def test_a_wrench_on_the_tool() -> None:
    """By virtual work: the drives bear it through the Jacobian."""
    case = heavy("mit-ss1")
    at = case.at(case.values)
    still = inverse_dynamics(at, case.rates, case.changes)
    wrench = np.array([100.0, -30.0, 250.0, 4.0, -7.0, 2.0])
    loaded = inverse_dynamics(at, case.rates, case.changes, wrench)
    twist = at.placed.tool_on_bodies[0] @ at.placed.map[0]
    wanted = -np.linalg.solve(at.drive_map[0].T, twist.T @ wrench)
    np.testing.assert_allclose(
        loaded.drives[0] - still.drives[0], wanted, rtol=1e-9, atol=1e-9 * np.abs(wanted).max()
    )
    power = loaded.powers.sum() + loaded.given_power[0]
    assert power == pytest.approx(still.powers.sum(), rel=1e-9)


def test_what_is_refused() -> None:
    linkage, placement = slider_crank(0.3)
    motion = Motion(linkage, placement)
    none = masses_of(linkage)
    with pytest.raises(ModelError, match="crank:rz follows from the other coordinates"):
        BodyMotion(motion, Coordinates(("x",), (("crank", "rz"),)), np.zeros((3, 3)))
    with pytest.raises(ModelError, match="y cannot move from home"):
        Dynamics(motion, none, Coordinates(("x", "y")))
    with pytest.raises(ModelError, match="no coordinate"):
        Dynamics(motion, none, Coordinates())
    bars = open_chain([[0, 0, 0], [0.5, 0, 0], [0.9, 0, 0], [1, 0, 0]], [[0, 0, 1.0]] * 4)
    first = Coordinates((), (("R1", "rz"),))
    with pytest.raises(ModelError, match="bar2, bar3 move although R1:rz stands still"):
        simple(bars, first, DOWN)
    points, axes = [[0, 0, 0], [0.5, 0, 0], [0.9, 0, 0]], [[0, 0, 1.0]] * 3
    with pytest.raises(ModelError, match="bar2 move although R1:rz stands still"):
        simple(open_chain(points, axes), first, DOWN)
    pair = chain(points, axes, driven=0, closed=False)
    swinging = simple(pair, first, DOWN, bar2=(1.0, [0.7, 0, 0], 0.1))
    with pytest.raises(ModelError, match="bar2: rotates freely about a line"):
        forces_of(swinging, 0.1, 0.0, 0.0)
    # a wheel that is balanced about its own hinge is no matter
    wheel = forces_of(simple(pair, first, DOWN, bar2=(2.0, [0.5, 0, 0], 0.1)), 0.1, 3.0, 7.0)
    assert wheel.drives[0, 0] == pytest.approx(2.0 * 0.5**2 * 7.0, rel=1e-12)
    with pytest.raises(ModelError, match="gravity"):
        Dynamics(motion, none, Coordinates(("x",)), (0.0, np.nan, 0.0))
    with pytest.raises(ModelError, match="of 2 bodies; the linkage has 3"):
        Dynamics(
            motion, BodyMasses(*(np.zeros((2, *s)) for s in ((), (3,), (3, 3)))), Coordinates()
        )
    with pytest.raises(ModelError, match="inertia that no body can have"):
        masses_of(linkage, rod=(1.0, [0, 0, 0], [1.0, 1.0, -1.0]))
    with pytest.raises(ModelError, match="negative"):
        masses_of(linkage, rod=(-1.0, [0, 0, 0], 0.0))
    massless = Dynamics(motion, none, Coordinates(("x",)))
    with pytest.raises(NumericalError, match="have no mass"):
        _ = massless.at(motion.move(task={"x": [0.38]})).mass
    with pytest.raises(UnreachableError, match="cannot be reached"):
        massless.at(motion.move(task={"x": [0.5]}))


def test_a_singular_pose_is_refused() -> None:
    """A slider that drives a crank does not hold it where the rod lies along the crank."""
    linkage, placement = slider_crank(0.3)
    joints = tuple(
        Joint(j.name, j.type, j.between, driven=("z",) if j.name == "guide" else ())
        for j in linkage.joints
    )
    driven = Linkage(linkage.nodes, linkage.bodies, joints, "tool")
    motion = Motion(driven, placement)
    dynamics = Dynamics(
        motion,
        masses_of(driven, crank=(1.0, [0, 0, 0], 0.1)),
        Coordinates((), (("crank", "rz"),)),
    )
    at = dynamics.at(motion.move(joints={("crank", "rz"): [-0.3]}))
    assert at.held[0] < 1e-9
    with pytest.raises(SingularPoseError, match="parallel"):
        _ = inverse_dynamics(at, 1.0, 0.0).drives
