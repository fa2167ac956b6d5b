"""Pendulums, hanging ropes and lateral buckling: stiffness by forces that keep their direction.

@book{timoshenko1961,
  title     = {Theory of Elastic Stability},
  author    = {Timoshenko, Stephen P. and Gere, James M.},
  edition   = {2},
  publisher = {McGraw-Hill},
  year      = {1961},
  note      = {equations 6-20 and 6-21 (narrow cantilever), 6-8 (pure bending)}
}

@book{southwell1922,
  title = {On the Free Transverse Vibrations of a Uniform Circular Disc Clamped at its Centre},
  author = {Southwell, Richard V. and Lamb, Horace},
  note  = {Proc. R. Soc. A 99: the squares of two systems' frequencies add to a lower bound}
}
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from strutwork.errors import NumericalError
from strutwork.fea import ModalRatio, Port, frequency_response, modes, preloaded
from strutwork.machines.model_file import parse_model, read_model
from strutwork.msa import LoadCase, Material, PointMass, rectangle, rod
from strutwork.msa import Section as MsaSection
from tests.structures import Model, every_direction

CASES = Path(__file__).parents[2] / "cases" / "models"
G = 9.81
GRAVITY = LoadCase("gravity", gravity=(0.0, 0.0, -G))
STEEL = Material.isotropic(200e9, 0.25, density=7850.0)
Y = (0.0, 1.0, 0.0)


def pendulum(kind: str, depth: float, *, at: str = "mass") -> Model:
    """A rigid body on a joint at the origin, its mass at or off a node."""
    model = Model()
    model.ground(o=(0, 0, 0))
    model.joint("pin", kind, ("o", "b"), Y)
    model.nodes(c=(0, 0, -depth), far=(0.3, 0.2, 0.1))
    model.rigid("bob", "b", "c", "far")
    inertia = ((0.03, 0, 0), (0, 0.05, 0), (0, 0, 0.02))
    node = {"mass": "c", "offset": "far", "pin": "b"}[at]
    offset = np.subtract(model.positions["c"], model.positions[node])
    model.masses.append(PointMass(node, 2.0, inertia, tuple(offset.tolist())))
    return model


@pytest.mark.parametrize("at", ["mass", "offset", "pin"])
def test_a_rigid_pendulum_wherever_its_nodes_are(at: str) -> None:
    """ω² = m g d / (I + m d²)."""
    d = 0.3
    found = modes(preloaded(pendulum("revolute", d, at=at).place(), GRAVITY), 1)
    expected = np.sqrt(2.0 * G * d / (0.05 + 2.0 * d**2)) / (2 * np.pi)
    assert found.frequencies == pytest.approx([expected], rel=1e-12)
    assert found.rigid_body_modes == 0
    assert found.energy_parts[-1] == "preload"
    assert found.energy_shares[0, -1] == pytest.approx(1.0, abs=1e-9)


def test_a_pendulum_on_a_ball_swings_both_ways_and_spins_freely() -> None:
    d = 0.3
    found = modes(preloaded(pendulum("spherical", d).place(), GRAVITY), 3)
    swings = np.sqrt(2.0 * G * d / (np.array([0.05, 0.03]) + 2.0 * d**2)) / (2 * np.pi)
    np.testing.assert_allclose(found.frequencies, [0.0, *swings], rtol=1e-12)
    assert found.rigid_body_modes == 1


def test_a_pendulum_loaded_at_a_node_off_its_master() -> None:
    """Two weights of which one is a load: k = m g d + F e."""
    model = pendulum("revolute", 0.3)
    model.nodes(hook=(0, 0.1, -0.5))
    model.groups["bob"] = (*model.groups["bob"], "hook")
    load = (("hook", (0.0, 0.0, -40.0, 0.0, 0.0, 0.0)),)
    found = modes(preloaded(model.place(), replace(GRAVITY, wrenches=load)), 1).frequencies
    k = 2.0 * G * 0.3 + 40.0 * 0.5
    assert found == pytest.approx([np.sqrt(k / (0.05 + 2.0 * 0.09)) / (2 * np.pi)], rel=1e-12)


@pytest.mark.parametrize("kind", ["revolute", "spherical"])
def test_an_inverted_pendulum_falls(kind: str) -> None:
    placed = preloaded(pendulum(kind, -0.3).place(), GRAVITY)
    with pytest.raises(NumericalError, match="collapses under its preload") as caught:
        modes(placed, 1)
    assert "pin in rz" in caught.value.part
    assert '"gravity"' in caught.value.problem


@pytest.mark.parametrize("share", [0.5, 2.0])
def test_an_inverted_pendulum_on_a_spring_stands_while_it_is_stiff_enough(share: float) -> None:
    d, k = 0.3, 2.0 * G * 0.3 / share
    model = pendulum("revolute", -d)
    model.joints = [replace(model.joints[0], stiffness={"rz": k})]
    placed = preloaded(model.place(), GRAVITY)
    if share < 1:
        still = modes(model.place(), 1).frequencies
        assert modes(placed, 1).frequencies == pytest.approx(still * np.sqrt(1 - share), rel=1e-12)
        return
    with pytest.raises(NumericalError, match="buckles") as caught:
        modes(placed, 1)
    assert "critical load is 0.5 of it" in caught.value.problem


@pytest.mark.parametrize("elements", [1, 4, 260])
def test_a_rod_that_swings_on_a_hinge(elements: int) -> None:
    """ω² = 3 g / 2 L of a thin rod; sparse from 200 elements. Thickness takes (d/L)²·3/16."""
    length = 0.8
    model = Model()
    model.ground(o=(0, 0, 0))
    model.joint("pin", "revolute", ("o", "b"), Y)
    model.nodes(c=(0, 0, -length))
    model.beam("rod", "b", "c", rod(0.03), STEEL, elements=elements)
    found = modes(preloaded(model.place(), GRAVITY), 1)
    inertia = length**2 / 3 + 0.03**2 / 16
    expected = np.sqrt(G * length / 2 / inertia) / (2 * np.pi)
    # the rod bends a little as it swings, by m g L²/EI = 3e-4 of its turn
    assert found.frequencies == pytest.approx([expected], rel=5e-6)
    assert ("Lanczos" in found.solver) == (elements == 260)


def test_a_bifilar_pendulum() -> None:
    """A disc on two wires of length l at b from its axis turns with ω² = m g b² / (I l)."""
    b, length, mass, inertia = 0.2, 1.5, 8.0, 0.3
    model = Model()
    wire = MsaSection(1e-6, 1e-16, 1e-16, 2e-16, name="wire")
    light = Material.isotropic(200e9, 0.3, density=1e-3)
    model.nodes(hub=(0, 0, 0))
    for i, x in enumerate((-b, b)):
        model.ground(**{f"top{i}": (x, 0, length)})
        model.nodes(**{f"low{i}": (x, 0, 0)})
        # held against spinning about the wire
        model.joint(f"upper{i}", "universal", (f"top{i}", f"w{i}"), (1, 0, 0), (0, 1, 0))
        model.joint(f"lower{i}", "spherical", (f"v{i}", f"low{i}"))
        model.beam(f"wire{i}", f"w{i}", f"v{i}", wire, light)
    model.rigid("disc", "hub", "low0", "low1")
    model.masses.append(PointMass("hub", mass, ((0.2, 0, 0), (0, 0.2, 0), (0, 0, inertia))))
    found = modes(preloaded(model.place(), GRAVITY), 12).frequencies
    turn = np.sqrt(mass * G * b**2 / (inertia * length)) / (2 * np.pi)
    swing = np.sqrt(G / length) / (2 * np.pi)
    for expected in (turn, swing):
        assert np.abs(found / expected - 1).min() < 1e-6


def test_a_bead_that_slides_on_a_rod() -> None:
    """Sliding by s lowers the rod's end by s θ: the weight couples both, K = [[k a², m g], ·]."""
    a, s, m, inertia, k, soft = 1.0, 0.6, 3.0, 0.4, 5e3, 200.0
    model = Model()
    model.ground(o=(0, 0, 0))
    model.joint("pin", "revolute", ("o", "b"), Y)
    model.nodes(end=(a, 0, 0), seat=(s, 0, 0))
    model.rigid("rod", "b", "end", "seat")
    model.joint("slide", "prismatic", ("seat", "bead"), (1, 0, 0), stiffness={"z": soft})
    model.support("end", stiffness={"z": k})
    model.masses += [
        PointMass("bead", m),
        PointMass("b", 0.0, ((0, 0, 0), (0, inertia, 0), (0, 0, inertia))),
    ]
    found = modes(preloaded(model.place(), GRAVITY), 2).frequencies
    # θ about y lowers the end
    stiffness = np.array([[k * a**2, -m * G], [-m * G, soft]])
    mass = np.diag([inertia + m * s**2, m])
    expected = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real))
    np.testing.assert_allclose(found, expected / (2 * np.pi), rtol=1e-9)
    assert np.abs(expected[0] / np.sqrt(soft / m) - 1) > 1e-4


def test_a_bead_that_nothing_holds_slides_off() -> None:
    """Neither motion falls by itself; together they do, however stiff the rod's spring is."""
    model = Model()
    model.ground(o=(0, 0, 0))
    model.joint("pin", "revolute", ("o", "b"), Y)
    model.nodes(end=(1, 0, 0), seat=(0.6, 0, 0))
    model.rigid("rod", "b", "end", "seat")
    model.joint("slide", "prismatic", ("seat", "bead"), (1, 0, 0))
    model.support("end", stiffness={"z": 5e3})
    model.masses.append(PointMass("bead", 3.0, ((0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1))))
    with pytest.raises(NumericalError, match="slide in z"):
        modes(preloaded(model.place(), GRAVITY), 1)


@pytest.mark.parametrize("spins", [False, True])
@pytest.mark.parametrize("elements", [10, 260])
def test_dense_and_sparse_name_the_same_critical_load(elements: int, spins: bool) -> None:
    """Euler's π² EI / L² of a strut between hinges, which may let it spin about itself."""
    model = Model()
    model.nodes(a=(0, 0, 0), b=(2.0, 0, 0))
    model.beam("strut", "a", "b", rod(0.02), STEEL, elements=elements, shear=False)
    model.support("a", "x", "y", "z", *([] if spins else ["rx"]))
    model.support("b", "y", "z")
    euler = np.pi**2 * STEEL.youngs_modulus * rod(0.02).second_moment_y / 2.0**2
    case = LoadCase("press", (("b", (-4 * euler, 0, 0, 0, 0, 0)),))
    assert share_of_buckling(model, case) == pytest.approx(0.25, rel=1e-3)


def narrow(elements: int) -> Model:
    model = Model()
    model.nodes(a=(0, 0, 0), b=(2.0, 0, 0))
    strip = rectangle(0.004, 0.1)
    model.beam("strip", "a", "b", strip, STEEL, elements=elements, shear=False)
    return model


def share_of_buckling(model: Model, case: LoadCase) -> float:
    """From the message of a load twice too large."""
    with pytest.raises(NumericalError, match="buckles") as caught:
        modes(preloaded(model.place(), case), 1)
    found = re.search(r"critical load is (\S+) of it", caught.value.problem)
    assert found
    return float(found[1])


def test_a_narrow_cantilever_buckles_sideways() -> None:
    """P = 4.0126 √(EI GJ) / L² at the centroid of the end (Timoshenko and Gere, eq. 6-21)."""
    model = narrow(30)
    model.support("a")
    strip = rectangle(0.004, 0.1)
    critical = 4.0126 * np.sqrt(
        STEEL.youngs_modulus * strip.second_moment_z * STEEL.shear_modulus * strip.torsion_constant
    )
    critical /= 2.0**2
    case = LoadCase("load", (("b", (0.0, 0.0, -2 * critical, 0.0, 0.0, 0.0)),))
    # deep bending stiffens by (Iz/Iy)/2, 1e-3, in theories that count it; here it does not
    assert share_of_buckling(model, case) == pytest.approx(0.5, rel=2e-3)


def test_a_narrow_beam_in_pure_bending_buckles_sideways() -> None:
    """M = π √(EI GJ) / L between forks that hold its ends upright (eq. 6-8)."""
    model = narrow(30)
    model.support("a", "x", "y", "z", "rx")
    model.support("b", "y", "z", "rx")
    strip = rectangle(0.004, 0.1)
    critical = (
        np.pi
        / 2.0
        * np.sqrt(
            STEEL.youngs_modulus
            * strip.second_moment_z
            * STEEL.shear_modulus
            * strip.torsion_constant
        )
    )
    m = 2 * critical
    case = LoadCase("load", (("a", (0, 0, 0, 0, m, 0)), ("b", (0, 0, 0, 0, -m, 0))))
    assert share_of_buckling(model, case) == pytest.approx(0.5, rel=2e-3)


def test_hanging_beams_end_to_end_are_one_divided_beam() -> None:
    """A rope of 20 beams hangs between chain and chain with bending (Southwell's bound)."""
    apart = read_model(CASES / "hanging_20beams.toml")
    text = (CASES / "hanging_20beams.toml").read_text()
    one = parse_model(
        text[: text.index("[nodes]")]
        + "[nodes]\nn0 = [0, 0, 0]\nn20 = [0, 0, -10]\n[[beams]]\nname = 'b'\nfrom = 'n0'\n"
        "to = 'n20'\nmaterial = 's'\nsection = 'r'\nshear = false\nelements = 20\n"
        "[[supports]]\nnode = 'n0'\nfixed = 'all'\n"
    )
    found = [modes(preloaded(m.placed, m.cases[0]), 8).frequencies for m in (apart, one)]
    np.testing.assert_allclose(found[0], found[1], rtol=1e-9)
    # J₀(2ω√(L/g)) = 0 of the chain; a cantilever alone
    chain = 2.404825558 / 2 * np.sqrt(G / 10.0) / (2 * np.pi)
    alone = modes(apart.placed, 1).frequencies[0]
    assert found[0][0] > np.hypot(chain, alone)
    assert found[0][0] < 1.03 * chain


def clamped_string(tension: float, bending: float, per_length: float, length: float) -> float:
    """First frequency of a beam in tension with clamped ends, Hz."""

    def determinant(omega: float) -> float:
        half = tension / (2 * bending)
        root = np.sqrt(half**2 + per_length * omega**2 / bending)
        a, b = np.sqrt(root + half), np.sqrt(root - half)
        # symmetric modes: cosh/cos, clamped at half the length
        turn = b * length / 2
        return float(a * np.tanh(a * length / 2) * np.cos(turn) + b * np.sin(turn))

    string = np.pi / length * np.sqrt(tension / per_length)
    return float(brentq(determinant, 1.0001 * string, 1.2 * string)) / (2 * np.pi)


def test_a_pretensioned_wire() -> None:
    """63.7 Hz of the string, and 2 % for its clamped ends; 4.60 Hz without the pull."""
    model = read_model(CASES / "f7_preload_ignored.toml")
    wire = rod(0.001)
    exact = clamped_string(100.0, 210e9 * wire.second_moment_y, 7850.0 * wire.area, 1.0)
    fine = (
        (CASES / "f7_preload_ignored.toml").read_text().replace("elements = 20", "elements = 120")
    )
    found = [
        modes(preloaded(m.placed, m.cases[0]), 2).frequencies for m in (model, parse_model(fine))
    ]
    # the ends bend over a hundredth of the length, less than one of 20 elements
    np.testing.assert_allclose(found[0], exact, rtol=3e-3)
    np.testing.assert_allclose(found[1], exact, rtol=2e-5)
    string = np.sqrt(100.0 / (7850.0 * wire.area)) / 2.0
    assert found[0] == pytest.approx(string, rel=0.03)
    assert modes(model.placed, 1).frequencies[0] == pytest.approx(4.60, abs=0.01)


def test_a_wire_whose_ends_turn_is_the_string_of_the_public_report() -> None:
    """63.7 Hz: √(T/μ)/2l, stiffened by π² EI/(T l²); the file itself clamps its ends, 65.03 Hz."""
    text = (CASES / "f7_preload_ignored.toml").read_text(encoding="utf-8")
    hinged = text.replace('fixed = ["y", "z", "rx", "ry", "rz"]', 'fixed = ["y", "z", "rx"]')
    hinged = hinged.replace('node = "A"\nfixed = "all"', 'node = "A"\nfixed = ["x", "y", "z"]')
    assert hinged.count('"rx"') == 1
    model = parse_model(hinged)
    wire = rod(0.001)
    per_length, bending = 7850.0 * wire.area, 210e9 * wire.second_moment_y
    string = np.sqrt(100.0 / per_length) / 2.0
    assert string == pytest.approx(63.7, abs=0.05)
    found = modes(preloaded(model.placed, model.cases[0]), 2).frequencies
    # sine waves are all but exact for cubic elements of a twentieth of the half wave
    exact = string * np.sqrt(1 + np.pi**2 * bending / 100.0)
    np.testing.assert_allclose(found[:2], exact, rtol=1e-5)
    wire_file = clamped_string(100.0, bending, per_length, 1.0)
    assert wire_file == pytest.approx(65.03, abs=5e-3)


def test_a_frequency_response_has_the_preloads_resonance_and_compliance() -> None:
    """At rest a pendulum yields by 1/(m g d) per unit moment; without its weight it floats."""
    d = 0.3
    placed = preloaded(pendulum("revolute", d).place(), GRAVITY)
    port = Port("c", "x")
    lines = np.linspace(0.0, 3.0, 3001)
    found = frequency_response(placed, [port], [port], lines, ModalRatio(0.01))
    assert found.static_compliance[0, 0] == pytest.approx(d**2 / (2.0 * G * d), rel=1e-12)
    peak = lines[np.abs(found.receptance[:, 0, 0]).argmax()]
    assert peak == pytest.approx(float(modes(placed, 1).frequencies[0]), abs=2e-3)


def test_poses_have_each_their_own_preload() -> None:
    model = pendulum("revolute", 0.3)
    depths = np.array([0.2, 0.3, 0.5])
    model.positions["c"] = np.stack([0 * depths, 0 * depths, -depths], axis=-1)
    model.masses = [PointMass("c", 2.0, ((0.03, 0, 0), (0, 0.05, 0), (0, 0, 0.02)))]
    found = modes(preloaded(model.place(), GRAVITY), 1).frequencies[:, 0]
    expected = np.sqrt(2.0 * G * depths / (0.05 + 2.0 * depths**2)) / (2 * np.pi)
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_a_stretched_bushing_does_not_care_where_the_body_is_counted_from() -> None:
    """A body between two stretched mounts: transverse 2 N/l, whichever node leads."""
    results: list[Any] = []
    for tool in ("middle", "left"):
        model = Model(tool)
        model.nodes(left=(-0.2, 0, 0), middle=(0, 0.05, 0.1), right=(0.2, 0, 0))
        model.rigid("body", "left", "middle", "right")
        model.masses.append(PointMass("middle", 1.0, ((0.01, 0, 0), (0, 0.01, 0), (0, 0, 0.01))))
        for node in ("left", "right"):
            model.support(node, stiffness=every_direction(1e4))
        pull = (("left", (-500.0, 0, 0, 0, 0, 0)), ("right", (500.0, 0, 0, 0, 0, 0)))
        results.append(modes(preloaded(model.place(), LoadCase("pull", pull)), 6).frequencies)
    np.testing.assert_allclose(results[0], results[1], rtol=1e-10)
