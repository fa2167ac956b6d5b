"""The frame of the benchmarks: three legs, 84 free degrees of freedom, 20 beams."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement
from strutwork.msa import Beam, Material, Structure, tube

Array = NDArray[Any]

STEEL = Material.isotropic(205e9, 0.29, 7870.0, name="AISI 1018")
SECTION = tube(0.019, 0.014)


def three_legged_frame(shear: bool = False) -> tuple[Structure, Array]:
    """Structure and node positions (n, 3), m, of the reference geometry.

    Every leg has five nodes, of which the lowest is clamped; a ring and a cross-brace join
    the legs, and a spindle beam stands on the platform node.
    """
    places: dict[str, Array] = {"T": np.array([0.0, 0.0, 0.4])}
    beams: list[Beam] = []
    joints: list[Joint] = []

    def beam(first: str, second: str) -> None:
        beams.append(Beam(f"{first}-{second}", (first, second), STEEL, SECTION, shear=shear))

    for leg in range(3):
        turn = 2.0 * np.pi * leg / 3.0
        out = np.array([np.cos(turn), np.sin(turn), 0.0])
        for k, (radius, height) in enumerate(
            ((0.30, 0.0), (0.25, 0.1), (0.20, 0.2), (0.12, 0.3), (0.06, 0.4))
        ):
            places[f"{leg}.{k}"] = radius * out + np.array([0.0, 0.0, height])
        for k in range(4):
            beam(f"{leg}.{k}", f"{leg}.{k + 1}")
        beam(f"{leg}.4", "T")
        places[f"ground {leg}"] = places[f"{leg}.0"]
        joints.append(Joint(f"support {leg}", "fixed", (f"ground {leg}", f"{leg}.0")))
    for leg in range(3):
        beam(f"{leg}.4", f"{(leg + 1) % 3}.4")
    places["S"] = np.array([0.0, 0.0, 0.5])
    beam("T", "S")
    beam("0.3", "1.3")
    nodes = tuple(places)
    linkage = Linkage(
        nodes,
        (
            Body(GROUND, tuple(n for n in nodes if n.startswith("ground"))),
            Body("frame", tuple(n for n in nodes if not n.startswith("ground"))),
        ),
        tuple(joints),
        tool="T",
    )
    return Structure(linkage, beams=tuple(beams)), np.stack([places[n] for n in nodes])


def poses_of(structure: Structure, positions: Array, count: int, seed: int = 0) -> Placement:
    """A batch of new geometries: every node moved at random by about 10 mm."""
    moved = positions + np.random.default_rng(seed).normal(
        scale=0.01, size=(count, *positions.shape)
    )
    index = structure.linkage.node_index
    for leg in range(3):
        moved[:, index[f"ground {leg}"]] = moved[:, index[f"{leg}.0"]]
    frames = np.broadcast_to(np.eye(3), (count, 3, 3, 3))
    return Placement(moved, frames, np.zeros((count, 0)))
