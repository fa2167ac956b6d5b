"""Mechanisms in 3-D with their misfits and the forces that these lock in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.reports.figures.curves import LIMIT
from strutwork.reports.figures.shapes import across
from strutwork.reports.figures.solid import path, scene, segments
from strutwork.reports.figures.theme import INK, rounded
from strutwork.reports.page import plain

Array = NDArray[Any]

Pairs = Sequence[tuple[Array, Array]]


@dataclass(frozen=True)
class Lines3D:
    """Straight lines of one meaning.

    Parameters
    ----------
    name : str
    pairs : sequence of (start, end)
        m.
    colour : str
    width : float
    dash : str
    """

    name: str
    pairs: Pairs
    colour: str
    width: float = 5.0
    dash: str = "solid"


def misfit_view(
    lines: Sequence[Lines3D], points: Mapping[str, Array], forces: Mapping[str, Array], reach: float
) -> dict[str, Any]:
    """A mechanism at rest and with its misfit exaggerated, with the forces as arrows.

    Parameters
    ----------
    lines : sequence of Lines3D
    points : mapping of joint to (3,)
        Where its force acts as drawn, m.
    forces : mapping of joint to (3,)
        Global axes, N.
    reach : float
        Length of the longest arrow, m.
    """
    traces = [
        segments(
            entry.pairs,
            entry.name,
            entry.colour,
            entry.width,
            line={"color": entry.colour, "width": entry.width, "dash": entry.dash},
        )
        for entry in lines
        if entry.pairs
    ]
    return scene([*traces, *force_arrows(points, forces, reach)])


def force_arrows(
    points: Mapping[str, Array], forces: Mapping[str, Array], reach: float
) -> list[dict[str, Any]]:
    """Forces of joints as arrows, the longest of length `reach` in m, and their places."""
    largest = max((float(np.linalg.norm(f)) for f in forces.values()), default=0.0)
    if largest == 0:
        return []
    arrows = [
        _arrow(points[n], reach * np.asarray(f) / largest)
        for n, f in forces.items()
        if np.linalg.norm(f) > 1e-3 * largest
    ]
    x, y, z = 1e3 * np.array([points[n] for n in forces]).T
    places = {
        "type": "scatter3d",
        "mode": "markers",
        "name": "joint",
        "x": rounded(x),
        "y": rounded(y),
        "z": rounded(z),
        "text": [f"{plain(n)}: {np.linalg.norm(f) / 1e3:.3g} kN" for n, f in forces.items()],
        "hoverinfo": "text",
        "marker": {"size": 4, "color": INK},
    }
    return [path(np.concatenate(arrows), "force on the joint", LIMIT, 6), places]


def _arrow(tail: Array, span: Array) -> Array:
    """An arrow with a head, ended by NaN, (n, 3)."""
    tip, size = tail + span, float(np.linalg.norm(span))
    gap = np.full((1, 3), np.nan)
    parts = [np.stack([tail, tip]), gap]
    for side in across(span):
        back = tip - 0.22 * span
        parts += [np.stack([back + 0.08 * size * side, tip, back - 0.08 * size * side]), gap]
    return np.concatenate(parts)
