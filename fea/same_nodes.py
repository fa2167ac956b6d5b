"""Which nodes of two universal files are the same."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from strutwork.fea.uff import UniversalFile

Array = NDArray[Any]

#: Nodes of two files nearer than this share of the larger extent are at the same place.
SAME_PLACE = 1e-3

#: A node that bears the same name may have been measured with the tape this far away.
SAME_NAME = 0.05

#: Extents that differ by more than this factor are of two units.
_OTHER_UNIT = 20.0


def same_nodes(
    computed: UniversalFile, measured: UniversalFile
) -> tuple[dict[str, str], tuple[str, ...]]:
    """The computed file's node of each measured one.

    Where both files have places, they decide: the node at the same place, of several there the
    one of the same name; else the one of the same name if no other is nearer. Nodes without a
    place in one of the files are the same by name, and so are all where no place agrees.

    Parameters
    ----------
    computed, measured : UniversalFile

    Returns
    -------
    nodes : dict of str to str
    notes : tuple of str
        What is not as the names say.
    """
    by_name = {name: name for name in measured.nodes if name in set(computed.nodes)}
    if not (computed.positions and measured.positions):
        return by_name, ()
    placed, apart, near = _by_place(computed.positions, measured.positions)
    if not placed:
        if not by_name:
            return {}, (_extents(computed.positions, measured.positions),)
        return by_name, (
            "no node of one file coincides with one of the other, so nodes are matched by their "
            "names: the comparison of shapes is correct only if the axes of both files are "
            "parallel" + _extents(computed.positions, measured.positions),
        )
    rest = {
        name: name
        for name in by_name
        if name not in measured.positions or name not in computed.positions
    }
    notes = []
    renamed = sum(a != b for a, b in placed.items())
    if renamed:
        notes.append(
            f"{renamed} of {len(placed)} nodes are matched by position because their names differ"
        )
    if near:
        notes.append(f"{near} nodes of the same name are not at exactly the same place")
    if apart:
        listed = ", ".join(apart[:5]) + (" …" if len(apart) > 5 else "")
        notes.append(f"{len(apart)} measured nodes are where no computed one is: {listed}")
    taken = set(placed.values())
    return {**{a: b for a, b in rest.items() if b not in taken}, **placed}, tuple(notes)


def _by_place(
    computed: Mapping[str, Array], measured: Mapping[str, Array]
) -> tuple[dict[str, str], list[str], int]:
    names = list(computed)
    places, theirs = np.array([computed[n] for n in names]), np.array(list(measured.values()))
    extent = max(float(np.ptp(p, axis=0).max()) for p in (places, theirs))
    size = max(float(np.abs(p).max()) for p in (places, theirs))
    reach = max(SAME_PLACE * extent, 1e-9 * size, 1e-12)
    tree = cKDTree(places)
    nearest, at = tree.query(theirs)
    found: dict[str, str] = {}
    apart: list[str] = []
    near = 0
    for node, place, distance, index in zip(measured, theirs, nearest, at, strict=True):
        if distance <= reach:
            own = node in computed and np.linalg.norm(computed[node] - place) <= reach
            found[node] = node if own else names[index]
        elif names[index] == node and distance <= SAME_NAME * extent:
            found[node] = node
            near += 1
        else:
            apart.append(node)
    # places that agree with none exactly are another set of axes, near names are chance there
    if near and near == len(found) and near < len(measured):
        return {}, [], 0
    return found, apart, near


def _extents(computed: Mapping[str, Array], measured: Mapping[str, Array]) -> str:
    ours, theirs = (
        float(np.ptp(np.array(list(p.values())), axis=0).max()) for p in (computed, measured)
    )
    text = f" (extents are {ours:.4g} m and {theirs:.4g} m"
    small, large = sorted((ours, theirs))
    return text + (": check the units)" if large > _OTHER_UNIT * small else ")")
