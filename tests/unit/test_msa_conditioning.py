"""Sound structures whose stiffnesses differ much are solved, not refused."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement
from strutwork.msa import Beam, Material, PlacedStructure, Structure, rod, tool_compliance

STEEL, DIAMETER = 205e9, 0.02
BENDING = STEEL * np.pi * DIAMETER**4 / 64


def cantilever(lengths: list[float], moduli: list[float]) -> PlacedStructure:
    """Pieces of Euler-Bernoulli beam in a row, clamped at the first node."""
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    nodes = tuple(f"N{i}" for i in range(len(ends)))
    beams = tuple(
        Beam(
            f"piece {i}",
            (nodes[i], nodes[i + 1]),
            Material.isotropic(moduli[i], 0.3),
            rod(DIAMETER),
            shear=False,
        )
        for i in range(len(lengths))
    )
    linkage = Linkage(
        ("ground", *nodes),
        (Body(GROUND, ("ground",)), Body("beam", nodes)),
        (Joint("clamp", "fixed", ("ground", "N0")),),
        tool=nodes[-1],
    )
    positions = np.zeros((len(nodes) + 1, 3))
    positions[1:, 0] = ends
    return Structure(linkage, beams=beams).at(Placement(positions, np.eye(3)[None], np.zeros(0)))


@pytest.mark.parametrize("ratio", [1e3, 1e5, 1e7])
def test_a_beam_much_stiffer_than_its_neighbour(ratio: float) -> None:
    """A soft half carries a nearly rigid one: (L³ − (L/2)³) / 3EI and the stiff half's share."""
    placed = cantilever([0.3, 0.3], [STEEL, ratio * STEEL])
    whole, half = 0.6**3, 0.3**3
    exact = (whole - half + half / ratio) / (3 * BENDING)
    # rounding of the stiff half's terms, which cancel: about 1e-16 times the ratio of stiffness
    assert tool_compliance(placed)[1, 1] == pytest.approx(exact, rel=1e-13 * ratio + 1e-10)


def test_pieces_much_shorter_than_the_beam() -> None:
    """800 mm in 100 pieces: the softest bending is 1e8 times softer than a piece."""
    placed = cantilever([0.008] * 100, [STEEL] * 100)
    # the condition of the problem is some 1e9, so six digits are left for certain
    assert tool_compliance(placed)[1, 1] == pytest.approx(0.8**3 / (3 * BENDING), rel=1e-6)
