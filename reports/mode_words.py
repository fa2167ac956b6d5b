"""A mode of vibration in words: which body moves most, and which way."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.names import listed
from strutwork.reports.alike import label, pattern, word
from strutwork.reports.vibration_study import VibrationStudy

Array = NDArray[Any]

#: A body alike that moves at least this share of the largest moves with it.
WITH_IT = 0.6

#: A direction with this share of the largest component takes part.
PART = 0.35

#: Below this share of its largest motion a body's middle stands: it turns.
STANDS = 0.5


def moves(study: VibrationStudy, mode: int) -> str:
    """What moves most in a mode: `platform along x`, `rams turn about z`."""
    bodies = _bodies(study)
    if not bodies:
        return ""
    shape = np.asarray(study.modes.shapes[mode])
    most = {
        name: float(np.linalg.norm(shape[rows, :3], axis=1).max()) for name, rows in bodies.items()
    }
    first = max(most, key=lambda name: most[name])
    if most[first] <= 0.0:
        return ""
    tool = _tool_body(study)
    # where the tool goes along, its body is what a reader looks for
    if tool in most and most[tool] >= WITH_IT * most[first]:
        first = tool
    alike = [
        name
        for name in bodies
        if pattern(name) == pattern(first) and most[name] >= WITH_IT * most[first]
    ]
    ways = {_way(shape[bodies[name]], most[name]) for name in alike}
    way = ways.pop() if len(ways) == 1 else "in different directions"
    return f"{word(alike) or label(alike)} {way}".rstrip()


def _way(motion: Array, most: float) -> str:
    """Direction in which a body with these motions of its nodes, (n, 6), moves or turns."""
    middle = motion[:, :3].mean(axis=0)
    if np.linalg.norm(middle) >= STANDS * most:
        return f"along {_axes(middle)}"
    turn = motion[:, 3:].mean(axis=0)
    return f"about {_axes(turn)}" if np.linalg.norm(turn) > 0.0 else ""


def _tool_body(study: VibrationStudy) -> str:
    linkage = study.placed.structure.linkage
    if linkage.tool is None or linkage.tool_body < 0:
        return ""
    return linkage.body_names[linkage.tool_body]


def _axes(vector: Array) -> str:
    size = np.abs(vector)
    return listed([a for a, s in zip("xyz", size, strict=True) if s >= PART * size.max()])


def _bodies(study: VibrationStudy) -> dict[str, list[int]]:
    """Mesh nodes of every moving body; those inside a divided beam are of its body."""
    structure = study.placed.structure
    linkage, index = structure.linkage, structure.mesh_index
    names = linkage.body_names
    owner = dict(zip(linkage.nodes, linkage.body_of_node.tolist(), strict=True))
    inside = {
        f"{beam.name}/{k}": owner[beam.nodes[0]]
        for beam in structure.beams
        for k in range(1, beam.elements)
    }
    found: dict[str, list[int]] = {}
    for node, body in (owner | inside).items():
        if body >= 0:
            found.setdefault(names[body], []).append(index[node])
    return found
