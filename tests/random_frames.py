"""Random space frames for property tests and comparisons."""

from __future__ import annotations

import numpy as np

from strutwork.msa import LoadCase, Material, Section, box, rectangle, rod, tube
from tests.structures import Model, vector

MATERIALS = (
    Material.isotropic(205e9, 0.29, density=7870.0, name="steel"),
    Material.isotropic(71e9, 0.33, density=2770.0, name="aluminium"),
)


def random_section(rng: np.random.Generator) -> Section:
    size = rng.uniform(0.06, 0.12)
    kind = rng.integers(5)
    if kind == 0:
        return rod(size)
    if kind == 1:
        return tube(size, rng.uniform(0.5, 0.9) * size)
    if kind == 2:
        return rectangle(size, rng.uniform(0.5, 2.0) * size)
    if kind == 3:
        return box(size, rng.uniform(0.7, 1.5) * size, 0.1 * size)
    area, i = size**2, size**4 / 12
    return Section(area, i, 2 * i, 1.5 * i, shear_areas=(0.7 * area, 0.9 * area))


def random_frame(
    seed: int, nodes: int = 6, joints: bool = False, shear: bool | None = None
) -> Model:
    """A frame of beams that hang together, clamped at its first node.

    Its last node is the tool. With `joints`, some beams end in a joint that moves.
    """
    rng = np.random.default_rng(seed)
    names = [f"n{i}" for i in range(nodes)]
    model = Model(names[-1])
    points = rng.uniform(-0.2, 0.2, (nodes, 3))
    # a grid keeps the nodes apart
    points += 0.8 * np.stack([np.arange(nodes) % 2, np.arange(nodes) // 2, np.arange(nodes) % 3], 1)
    model.nodes(**dict(zip(names, points, strict=True)))
    pairs = [(int(rng.integers(i)), i) for i in range(1, nodes)]
    pairs += [(i, j) for i, j in rng.integers(0, nodes, (3, 2)).tolist() if i < j]
    for k, (i, j) in enumerate(dict.fromkeys(pairs)):
        start = names[i]
        if joints and rng.random() < 0.5:
            start = f"{names[i]}.{k}"
            kind = ("revolute", "universal", "spherical", "prismatic")[rng.integers(4)]
            axis = rng.normal(size=3)
            soft = {d: 10 ** rng.uniform(5, 7) for d in ("rx", "ry", "rz")}
            soft["z"] = 10 ** rng.uniform(7, 9)
            between = (names[i], start)
            model.joint(f"J{k}", kind, between, axis, rng.normal(size=3), stiffness=soft)
        model.beam(
            f"b{k}",
            start,
            names[j],
            random_section(rng),
            MATERIALS[rng.integers(2)],
            orientation=vector(rng.normal(size=3)),
            shear=bool(rng.random() < 0.5) if shear is None else shear,
            elements=int(rng.integers(1, 3)),
        )
    model.support(names[0])
    return model


def random_load(seed: int, model: Model, name: str = "load") -> LoadCase:
    """Forces and moments at every node."""
    rng = np.random.default_rng(seed + 1)
    return LoadCase(
        name,
        tuple(
            (node, tuple((rng.normal(size=6) * np.repeat([100.0, 20.0], 3)).tolist()))
            for node in model.positions
            if not node.endswith("ground")
        ),
    )
