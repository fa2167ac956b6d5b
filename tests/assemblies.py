"""Over-constrained assemblies for the tests, and what is checked of their forces."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS
from strutwork.msa import PlacedStructure
from strutwork.overconstraint import Influence, MisfitSources
from tests.structures import BAR, Model

Array = NDArray[Any]

#: Locks that leave a body held by its bushing alone in the directions that they free.
TREE_JOINTS = ("revolute", "prismatic", "spherical", "universal", "cylindrical", "planar")


def elastic(rng: np.random.Generator, locks: str = "xyz") -> dict[str, float]:
    """Random stiffnesses of a joint, N/m and N·m/rad, alike at a length of some 0.3 m."""
    return {
        d: float(rng.uniform(1e6, 9e6) * (0.1 if d.startswith("r") else 1.0))
        for d in (DIRECTIONS if locks == "all" else tuple(locks))
    }


def block_on_joints(
    seed: int, joints: int = 4, locks: str = "xyz", tool: str | None = "tool"
) -> Model:
    """A rigid block on elastic joints J0, J1 and so on with random places, axes and stiffness.

    Every other joint has its first side on the block.
    """
    rng = np.random.default_rng(seed)
    model = Model(tool)
    if tool is not None:
        model.nodes(**{tool: rng.uniform(-0.5, 0.5, 3)})
    for i in range(joints):
        angle = 2 * np.pi * i / joints
        # a circle keeps the joints apart
        place = np.array([np.cos(angle), np.sin(angle), 0.0]) + rng.uniform(-0.3, 0.3, 3)
        model.ground(**{f"g{i}": place})
        model.nodes(**{f"p{i}": place})
        sides = (f"g{i}", f"p{i}") if i % 2 == 0 else (f"p{i}", f"g{i}")
        model.joint(
            f"J{i}",
            "bushing",
            sides,
            rng.normal(size=3),
            rng.normal(size=3),
            stiffness=elastic(rng, locks),
        )
    model.rigid("block", *([] if tool is None else [tool]), *(f"p{i}" for i in range(joints)))
    return model


def random_machine(seed: int, bodies: int = 3) -> Model:
    """Bodies in a tree of locked joints, rigid or beams, each held to ground by a bushing too.

    No rigid loop, no mechanism; every locked direction of a joint stands beside an elastic path.
    """
    rng = np.random.default_rng(seed)
    model = Model("tool")
    model.ground(base=(0.0, 0.0, 0.0))
    ends = ["base"]
    for i in range(bodies):
        start = ends[int(rng.integers(len(ends)))]
        end = "tool" if i == bodies - 1 else f"e{i}"
        far = np.array([0.5 * (i + 1), 0.3 * (i % 2), 0.2 * i]) + rng.uniform(-0.1, 0.1, 3)
        model.nodes(**{end: far})
        kind = TREE_JOINTS[int(rng.integers(len(TREE_JOINTS)))]
        model.joint(f"T{i}", kind, (start, f"s{i}"), rng.normal(size=3), rng.normal(size=3))
        if rng.random() < 0.5:
            model.beam(f"body{i}", f"s{i}", end, BAR)
        else:
            model.rigid(f"body{i}", f"s{i}", end)
        model.ground(**{f"w{i}": far})
        model.joint(
            f"W{i}",
            "bushing",
            (f"w{i}", end),
            rng.normal(size=3),
            rng.normal(size=3),
            stiffness=elastic(rng, "all"),
        )
        ends.append(end)
    return model


def square(found: Influence) -> Array:
    """S itself, (..., g, g): the forces in the directions of the misfits."""
    index = found.linkage.joint_index
    return np.stack(
        [found.forces[..., index[j], DIRECTIONS.index(d), :] for j, d in found.columns], axis=-2
    )


def unbalanced(placed: PlacedStructure, forces: Array) -> Array:
    """Force and moment about the origin that joints leave on every moving body, (b, 6)."""
    linkage, placement = placed.structure.linkage, placed.placement
    total = np.zeros((len(linkage.body_names) + 1, 6))
    for j, joint in enumerate(linkage.joints):
        force, moment = placement.frames[j] @ forces[j, :3], placement.frames[j] @ forces[j, 3:]
        for node, sign in zip(joint.between, (-1.0, 1.0), strict=True):
            i = linkage.node_index[node]
            arm = np.cross(placement.positions[i], force)
            total[linkage.body_of_node[i]] += sign * np.concatenate([force, moment + arm])
    return total[:-1]


def inside(sources: MisfitSources, uniform: Array, edge: bool = False) -> Array:
    """Points of all zones from numbers uniform in [0, 1], (..., k)."""
    z = np.zeros(uniform.shape)
    for shape, _, index in sources.by_shape:
        z[..., index] = (shape.surface if edge else shape.inside)(uniform[..., index])
    return z
