"""Solids between two interfaces, statically reduced, for temperatures."""

from __future__ import annotations

import numpy as np

from strutwork.fea.interface import Interface
from strutwork.fea.reduce_solid import tied
from strutwork.fea.solid import Solid
from strutwork.fea.superelement import Superelement
from strutwork.fea.tied_solid import StaticSolver
from strutwork.msa import Material

ENDS = (Interface("A", "-x"), Interface("B", "+x"))


def material(poisson: float = 0.3) -> Material:
    return Material(200e9, 200e9 / (2 + 2 * poisson), 7800, name="steel")


def reduced(solid: Solid, interfaces: tuple[Interface, ...] = ENDS) -> Superelement:
    """Statically alone: a strip without coupling has shapes that monitors do not tell apart."""
    whole = tied(solid, interfaces)
    shapes = StaticSolver(whole).constraint_modes()
    return Superelement(
        solid.name,
        tuple(i.name for i in interfaces),
        np.array([p.position for p in whole.patches]),
        shapes.T @ (whole.stiffness @ shapes),
        np.zeros((12, 12)),
        whole.recovery @ shapes,
        np.zeros(0),
        "",
    )


def free_end(element: Superelement, load: np.ndarray) -> np.ndarray:
    """Motion of the second node, the first one held."""
    stiffness = element.local_stiffness[6:, 6:]
    return np.asarray(np.linalg.solve(stiffness, load[6:])[:6])
