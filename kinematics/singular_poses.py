"""Singular poses of a net: which poses are candidates, of which kind they are, what is lost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.lost_motion import Kind, Lost, kinds, lost_motion
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.pose_family import Looked, PoseFamily
from strutwork.kinematics.reach_end import ReachEnds
from strutwork.kinematics.singularity_search import (
    Part,
    Refined,
    least,
    refine_zeros,
    sign_changes,
)
from strutwork.kinematics.tool_drive_space import Freedoms, tool_drive_space

Array = NDArray[Any]

#: Share of the way from a pose to the end of reach that is left out before the end.
BEFORE = 1e-4

PARTS: tuple[Part, ...] = ("drives", "tool", "passive")


@dataclass(frozen=True)
class Singularity:
    """One singular pose, or an end of reach.

    Parameters
    ----------
    parameters : mapping of name to float
        m and rad.
    kind : Kind
    lost : Lost or None
        What is lost there; None where nothing is.
    reason : str
        At an end of reach, why poses beyond are not reached; else empty.
    placement : Placement
        A batch of one.
    """

    parameters: Mapping[str, float]
    kind: Kind
    lost: Lost | None
    reason: str
    placement: Placement

    def __repr__(self) -> str:
        where = ", ".join(f"{k} = {v:.6g}" for k, v in self.parameters.items())
        return f"<Singularity: {self.kind.value} at {where}>"


def classify(
    linkage: Linkage,
    placement: Placement,
    known: Freedoms,
    length: float | None = None,
) -> tuple[list[Kind | None], list[Lost | None]]:
    """Kinds of poses that are singular to rounding, and what is lost there.

    Parameters
    ----------
    linkage : Linkage
    placement : Placement
        One batch axis.
    known : Freedoms
        Ranks at poses that are not singular, as `tool_drive_space(...).known` of such.
    length : float, optional
        m.

    Returns
    -------
    kinds : list of Kind or None
        None for a pose that is not singular.
    lost : list of Lost or None
    """
    space = tool_drive_space(linkage, placement, length, known)
    found = list(kinds(space))
    lost = [
        None
        if kind is None
        else lost_motion(linkage, placement[i : i + 1], kind, space.length, known)
        for i, kind in enumerate(found)
    ]
    return found, lost


def local_minima(
    looked: Looked, edges: NDArray[np.intp], changed: NDArray[np.intp], part: Part
) -> NDArray[np.intp]:
    """Poses whose least singular value is below that of all neighbours they have, (m,).

    Those beside a change of sign are left out, since that has been followed already, and those
    beside the end of reach, towards which values fall.

    Parameters
    ----------
    looked : Looked
        p poses of a net.
    edges : (e, 2) of int
        Pairs of neighbours.
    changed : (c, 2) of int
        Edges on which a minor changes its sign.
    part : Part
        Whose singular values.
    """
    if part == "passive" and looked.space.known.rank == 0:
        return np.zeros(0, dtype=np.intp)
    values = looked.spread(least(looked.space, part))
    lower = looked.reach.copy()
    inner = edges[looked.reach[edges].all(axis=1)]
    for here, there in (inner.T, inner.T[::-1]):
        # of two neighbours with one value the first stays
        above = np.where(here < there, values[here] > values[there], values[here] >= values[there])
        lower[here[above]] = False
    lower[changed.ravel()] = False
    lower[edges[~looked.reach[edges].all(axis=1)].ravel()] = False
    return np.flatnonzero(lower)


def singular_poses(family: PoseFamily, refined: Refined) -> list[Singularity]:
    """What refined poses are, and what is lost there.

    Parameters
    ----------
    family : PoseFamily
        Whose ranks are known.
    refined : Refined
        Its poses on singularities; those that are none are left out.
    """
    found = kinds(refined.space)
    result = []
    for i, kind in enumerate(found):
        if kind is not None:
            placement = refined.placement[i : i + 1]
            result.append(singular_pose(family, refined.parameters[i], kind, placement))
    return result


def ordered_ends(looked: Looked, edges: NDArray[np.intp]) -> tuple[Array, Array, tuple[str, ...]]:
    """Of edges with one end in reach: parameters there and beyond, (e, k), and why that is not.

    Parameters
    ----------
    looked : Looked
        p poses of a net.
    edges : (e, 2) of int
        One end of each in reach.
    """
    inside = np.where(looked.reach[edges[:, 0]], edges[:, 0], edges[:, 1])
    outside = edges.sum(axis=1) - inside
    reasons = tuple(looked.reasons[k] for k in looked.reason[outside])
    return looked.parameters[inside], looked.parameters[outside], reasons


def end_kinds(family: PoseFamily, ends: ReachEnds) -> list[Kind]:
    """Kinds of ends of reach, (e,).

    Parameters
    ----------
    family : PoseFamily
        Whose ranks are known.
    ends : ReachEnds
        e of them.
    """
    space = tool_drive_space(family.linkage, ends.placement, family.length, family.known)
    found = list(kinds(space))
    section = family.section
    if section is not None and not ends.turned.all():
        # what the motion reaches and the family refuses is outside a range
        free = section.place(ends.beyond).reachable
    else:
        free = np.zeros(len(found), dtype=bool)
    result = []
    for kind, turned, limited in zip(found, ends.turned, free, strict=True):
        other = Kind.TURN if turned else Kind.LIMIT if limited else Kind.UNKNOWN
        result.append(other if kind is None or (limited and not turned) else kind)
    return result


def ends_of_reach(family: PoseFamily, ends: ReachEnds) -> list[Singularity]:
    """Ends of reach, as singularities.

    Parameters
    ----------
    family : PoseFamily
        Whose ranks are known.
    ends : ReachEnds
        e of them.
    """
    return [
        singular_pose(family, ends.parameters[i], kind, ends.placement[i : i + 1], ends.reasons[i])
        for i, kind in enumerate(end_kinds(family, ends))
    ]


def before_the_end(family: PoseFamily, inside: Array, end: Array) -> list[Singularity]:
    """Singular poses between the last pose that was looked at and the end of reach, (e, k) each.

    Parameters
    ----------
    family : PoseFamily
        Whose ranks are known.
    inside, end : (e, k)
        Parameters of both, m and rad.
    """
    count = len(inside)
    # at the end itself the motion cannot be taken any more
    last = inside + (1.0 - BEFORE) * (end - inside)
    looked = family.look(np.concatenate([inside, last]))
    edges = np.stack([np.arange(count), np.arange(count) + count], axis=1)
    edges = edges[looked.reach[edges].all(axis=1)]
    found: list[Singularity] = []
    for part in PARTS:
        chosen = edges[sign_changes(looked, edges, part)]
        if len(chosen):
            a, b = looked.parameters[chosen].swapaxes(0, 1)
            found += singular_poses(family, refine_zeros(family, a, b, part))
    return found


def singular_pose(
    family: PoseFamily, parameters: Array, kind: Kind, placement: Placement, reason: str = ""
) -> Singularity:
    """One singular pose, with what is lost there.

    Parameters
    ----------
    family : PoseFamily
        Whose ranks are known, else nothing is named as lost.
    parameters : (k,)
        Of the pose, m and rad.
    kind : Kind
        What it is.
    placement : Placement
    reason : str
        Of an end of reach.
    """
    known = family.known
    lost = (
        None
        if known is None
        else lost_motion(family.linkage, placement, kind, family.length, known)
    )
    named = dict(zip(family.names, map(float, parameters), strict=True))
    return Singularity(named, kind, lost, reason, placement)
