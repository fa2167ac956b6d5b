"""Geometric stiffness obeys the laws of a load that keeps its direction."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.fea import modes, preloaded
from strutwork.fea.geometric import geometric_stiffness
from strutwork.msa import (
    LineLoad,
    LoadCase,
    PlacedStructure,
    PointMass,
    Spring,
    rectangle,
    rigid_map,
    system_of,
)
from tests.structures import Model, turned_case

Array = NDArray[Any]


def floating(seed: int, *, springs: bool = True) -> Model:
    """Beams with offsets, rigid bodies, joints with misfits of axes, springs: nothing held."""
    rng = np.random.default_rng(seed)
    model = Model("a")
    model.nodes(**{n: rng.uniform(-1, 1, 3) for n in "abcdefg"})
    bar = rectangle(0.02, 0.05)
    model.beam("ab", "a", "b", bar, elements=2, offsets=((0.1, 0, 0.05), (0, -0.1, 0.02)))
    model.rigid("block", "b", "c", "d")
    model.beam("de", "d", "e", bar)
    model.joint("hinge", "revolute", ("e", "e2"), rng.normal(size=3))
    model.rigid("crank", "e2", "f")
    model.joint("slide", "cylindrical", ("f", "f2"), rng.normal(size=3), stiffness={"z": 4e6})
    model.beam("fg", "f2", "g", bar, elements=3)
    model.joint(
        "ball",
        "bushing",
        ("g", "g2"),
        rng.normal(size=3),
        stiffness={"x": 3e6, "y": 5e6, "z": 7e6, "rx": 2e4, "ry": 1e4, "rz": 3e4},
    )
    model.beam("ga", "g2", "a", bar)
    if springs:
        model.springs.append(Spring("tie", ("c", "c2"), dict.fromkeys(("x", "y", "z"), 2e6)))
        model.nodes(c2=model.positions["c"])
        model.beam("cc", "c2", "f2", bar)
    model.masses.append(PointMass("c", 3.0, offset=(0.1, 0.2, -0.3)))
    return model


def balanced(model: Model, seed: int) -> tuple[LoadCase, Array]:
    """Forces, gravity and line loads that are balanced at node a, and their S about the origin."""
    rng = np.random.default_rng(seed)
    gravity = rng.normal(size=3) * 9.81
    wrenches = [(n, rng.normal(size=3) * 1e3) for n in ("c", "f", "g", "e")]
    lines = [LineLoad("fg", tuple(rng.normal(size=3) * 500), tuple(rng.normal(size=3) * 500))]
    placed = model.place()
    case = LoadCase(
        "pull",
        tuple((n, (*f.tolist(), 0.0, 0.0, 0.0)) for n, f in wrenches),
        tuple(lines),
        tuple(gravity.tolist()),
    )
    system = system_of(placed)
    moment = np.zeros((3, 3))
    for node, force in wrenches:
        moment += np.outer(force, model.positions[node])
    for mass in model.masses:
        moment += np.outer(mass.mass * gravity, model.positions[mass.node] + mass.offset)
    per_length = system.per_length_loads(case)
    assert per_length is not None
    start, end = (x for x in placed.beam_ends)
    for b in range(len(model.beams)):
        length = np.linalg.norm(end[b] - start[b])
        for x, w in zip(*np.polynomial.legendre.leggauss(4), strict=True):
            share = (x + 1) / 2
            q = (1 - share) * per_length[b, 0] + share * per_length[b, 1]
            at = (1 - share) * start[b] + share * end[b]
            moment += np.outer(q * length * w / 2, at)
    nodal = system.nodal_loads([case])[0, :, :, 0]
    carry = rigid_map(-(system.placed.positions[0] - model.positions["a"]))
    whole = np.einsum("nji,nj->i", np.linalg.inv(carry), nodal)
    back = -whole
    moment += np.outer(back[:3], model.positions["a"])
    wrench = (*back.tolist(),)
    return (
        LoadCase(case.name, (*case.wrenches, ("a", wrench)), case.line_loads, case.gravity),
        moment,
    )


@dataclass(frozen=True)
class Solid:
    """An element of any stiffness that costs nothing in a rigid motion."""

    name: str
    nodes: tuple[str, ...]

    def stiffness(self, at: PlacedStructure) -> Array:
        index = at.structure.mesh_index
        arms = at.positions[..., [index[n] for n in self.nodes], :]
        rigid = rigid_map(arms).reshape(*arms.shape[:-2], -1, 6)
        root = 1e3 * np.random.default_rng(5).normal(size=(rigid.shape[-2],) * 2)
        away = np.eye(rigid.shape[-2]) - rigid @ np.linalg.pinv(rigid)
        return np.asarray(away @ root @ root.T @ away)


@pytest.mark.parametrize("seed", range(6))
def test_a_rigid_turn_costs_what_the_loads_alone_do(seed: int) -> None:
    """−Σ f·½ θ×(θ×r), whatever stands between the loads."""
    model = floating(seed)
    case, moment = balanced(model, seed)
    bare = model.place()
    solid = Solid("lump", ("f2", "g", "c2"))
    structure = replace(bare.structure, elements=(solid,))
    placed = preloaded(structure.at(bare.placement), case)
    assert placed.stiffening is not None
    assert any(name == "element lump" for name, _, _ in placed.stiffening.parts)
    system = system_of(placed)
    positions = system.placed.positions[0]
    reference = positions[system.placed.structure.reference_nodes]
    motion = rigid_map(reference).reshape(-1, 6)
    found = motion.T @ geometric_stiffness(system)[0] @ motion
    expected = np.zeros((6, 6))
    expected[3:, 3:] = np.trace(moment) * np.eye(3) - (moment + moment.T) / 2
    size = np.abs(expected).max()
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-6 * size)
    assert size > 10


@pytest.mark.parametrize("seed", range(3))
def test_preload_does_not_depend_on_the_frame(seed: int) -> None:
    model = floating(seed)
    case, _ = balanced(model, seed)
    # hold it softly, or it would turn into its loads
    for node in "cfg":
        model.springs.append(Spring(f"hold {node}", (node,), dict.fromkeys("xyz", 3e5)))
    turn = Rotation.from_rotvec([1.2, -0.7, 2.1]).as_matrix()
    here = preloaded(model.place(), case)
    there = preloaded(model.turned(turn).place(), turned_case(case, turn))
    found, expected = modes(there, 8).frequencies, modes(here, 8).frequencies
    still = modes(model.place(), 8).frequencies
    np.testing.assert_allclose(found, expected, rtol=1e-8)
    assert np.abs(expected / still - 1).max() > 1e-5
