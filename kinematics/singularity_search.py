"""Singular poses on the edges of a net of poses: found by sign and by least values, refined."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import elementwise

from strutwork.kinematics.lost_motion import ZERO
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.pose_family import Looked, PoseFamily
from strutwork.kinematics.tool_drive_space import ToolDriveSpace, passive_matrix

Array = NDArray[Any]
Mask = NDArray[np.bool_]
Indices = NDArray[np.intp]

#: What is looked at: the drives' part of the motions, the tool's, and the passive rows.
Part = Literal["drives", "tool", "passive"]

#: Where a zero lies on its edge, as a share of it.
SHARE = 1e-11
#: Steps of Gauss and Newton, and their difference, as a share of the net's spacing.
STEPS, DIFFERENCE = 60, 1e-4
#: A step below this share of the spacing changes nothing.
ARRIVED = 1e-13
#: A zero further than this many spacings is none of this pose's.
FARTHEST = 3.0
#: Each step leaves at most this share of the value; a zero that is only touched, a quarter.
SHRINKS = 0.8


@dataclass(frozen=True)
class Refined:
    """Poses on singularities.

    Parameters
    ----------
    parameters : (m, k)
        m or rad.
    placement : Placement
    space : ToolDriveSpace
    index : (m,)
        The edge or candidate that each comes from.
    """

    parameters: Array
    placement: Placement
    space: ToolDriveSpace
    index: Indices

    def __getitem__(self, index: Any) -> Refined:
        return Refined(
            self.parameters[index], self.placement[index], self.space[index], self.index[index]
        )


def minor(space: ToolDriveSpace, part: Part) -> Array:
    """Signed minor of the tool's or the drives' part, (p,).

    Parameters
    ----------
    space : ToolDriveSpace
        At p poses.
    part : Part
        "drives" or "tool".
    """
    return space.drive_minor() if part == "drives" else space.tool_minor()


def has_minor(space: ToolDriveSpace, part: Part) -> bool:
    """Whether singular poses of a part are where one determinant changes its sign.

    Parameters
    ----------
    space : ToolDriveSpace
        Of the machine, at any poses.
    part : Part
        "drives", "tool" or "passive".
    """
    return {"drives": space.square, "tool": space.square_tool, "passive": False}[part]


def least(space: ToolDriveSpace, part: Part) -> Array:
    """The singular value that is zero at singular poses, (p,).

    Parameters
    ----------
    space : ToolDriveSpace
        At p poses.
    part : Part
        "drives", "tool" or "passive".
    """
    return {"drives": space.parallel, "tool": space.serial, "passive": space.passive}[part]


def edge_senses(looked: Looked, edges: Indices) -> Array:
    """`sense` of the spaces at both ends of edges, (e,).

    Parameters
    ----------
    looked : Looked
        p poses of a net.
    edges : (e, 2) of int
        Pairs of poses that are both reached.
    """
    a, b = looked.index[edges].T
    return looked.space[a].sense(looked.space[b])


def sign_changes(looked: Looked, edges: Indices, part: Part) -> Mask:
    """Edges, both ends of which are reached, on which a minor changes its sign, (e,).

    Parameters
    ----------
    looked : Looked
        p poses of a net.
    edges : (e, 2) of int
        Pairs of poses.
    part : Part
        Whose minor; "passive" has none, and no changes.
    """
    if not has_minor(looked.space, part) or not len(edges):
        return np.zeros(len(edges), dtype=bool)
    values = minor(looked.space, part)[looked.index[edges]]
    return np.asarray(values[:, 0] * values[:, 1] * edge_senses(looked, edges) < 0.0)


def refine_zeros(family: PoseFamily, start: Array, end: Array, part: Part) -> Refined:
    """Zeros of a minor on edges on which it changes its sign (Chandrupatla's method).

    Parameters
    ----------
    family : PoseFamily
        Whose ranks are known.
    start, end : (e, k)
        Parameters of both ends of the edges, m and rad.
    part : Part
        "drives" or "tool".

    Returns
    -------
    Refined
        Edges on which the sign changes without a zero, since their ends are too far apart, and
        edges on which poses out of reach lie are left out.
    """
    first = family.look(start)
    kept = np.flatnonzero(first.reach)
    start, end, space = start[kept], end[kept], first.space

    def value(share: Array, which: Array) -> Array:
        i = np.asarray(which, dtype=np.intp).ravel()
        x = np.asarray(share, dtype=float).ravel()[:, None]
        looked = family.look(start[i] + x * (end[i] - start[i]))
        reached = i[looked.reach]
        signed = minor(looked.space, part) * np.sign(looked.space.sense(space[reached]))
        return looked.spread(signed).reshape(np.shape(share))

    which = np.arange(len(start))
    found = elementwise.find_root(
        value,
        (np.zeros(len(start)), np.ones(len(start))),
        args=(which,),
        tolerances={"xatol": SHARE, "xrtol": 0.0, "fatol": 0.0, "frtol": 0.0},
        maxiter=200,
    )
    share = np.where(np.isfinite(found.x), found.x, 0.0)[:, None]
    return _judged(family, start + share * (end - start), kept, part, found.success)


def refine_least(family: PoseFamily, start: Array, spacing: Array, part: Part) -> Refined:
    """Zeros of the least singular value near poses at which it is small (Gauss and Newton).

    With left vectors U and right ones V of the values that vanish at the singularity, those of
    Uᵀ M V, which vary smoothly, are brought to zero.

    Parameters
    ----------
    family : PoseFamily
    start : (m, k)
        Parameters, m and rad.
    spacing : (k,)
        Of the net, m and rad; a pose that goes further than one and a half of it is given up.
    part : Part
    """
    at = start.copy()
    going = np.arange(len(start))
    before = np.full(len(start), np.inf)
    for _ in range(STEPS):
        if not going.size:
            break
        change, value = _newton(family, at[going], spacing, part)
        # a least value that stays above zero shrinks no more
        alive = (value < SHRINKS * before[going]) | (value <= ZERO)
        before[going] = value
        going, change = going[alive], change[alive]
        trial = at[going] + change
        near = np.all(np.abs(trial - start[going]) <= 1.5 * spacing, axis=1)
        at[going[near]] = trial[near]
        ended = np.all(np.abs(change) <= ARRIVED * spacing, axis=1)
        going = going[near & ~ended]
    return _judged(family, at, np.arange(len(start)), part, np.ones(len(start), dtype=bool))


def _newton(family: PoseFamily, at: Array, spacing: Array, part: Part) -> tuple[Array, Array]:
    """One step from each of m poses, (m, k), and their least values, infinite out of reach."""
    here = family.look(at)
    matrix = _matrix(family, here.placement, here.space, part)
    left, values, right = np.linalg.svd(matrix)
    known = here.space.known
    rank = {"drives": known.freedoms, "tool": known.tool, "passive": known.rank}[part]
    u, v = left[:, :, rank - 1 :], np.swapaxes(right[:, rank - 1 :], -1, -2)
    alive = here.reach.copy()
    slopes = []
    for k in range(at.shape[1]):
        sides = []
        for sign in (1.0, -1.0):
            moved = at.copy()
            moved[:, k] += sign * DIFFERENCE * spacing[k]
            there = family.look(moved)
            alive &= there.reach
            full = np.zeros((len(at), *matrix.shape[1:]))
            both = here.reach & there.reach
            space = there.space[there.index[both]].aligned(here.space[here.index[both]])
            placed = there.placement[there.index[both]]
            full[both] = _matrix(family, placed, space, part)
            sides.append(full[here.reach])
        slopes.append((sides[0] - sides[1]) / (2.0 * DIFFERENCE))
    across, entries = np.swapaxes(u, -1, -2), u.shape[2] * v.shape[2]
    h = (across @ matrix @ v).reshape(len(matrix), entries)
    jacobian = np.stack([(across @ s @ v).reshape(len(matrix), entries) for s in slopes], axis=-1)
    step = -np.einsum("mkh,mh->mk", np.linalg.pinv(jacobian, rcond=1e-6), h)
    size = np.abs(step).max(axis=1, initial=0.0)
    change = np.zeros_like(at)
    change[here.reach] = step / np.maximum(1.0, size / 0.5)[:, None] * spacing
    alive[here.reach] &= (size <= FARTHEST) | (values[:, rank - 1] <= ZERO)
    value = here.spread(values[:, rank - 1])
    return change, np.where(alive, value, np.inf)


def _matrix(family: PoseFamily, placement: Placement, space: ToolDriveSpace, part: Part) -> Array:
    if part == "passive":
        return passive_matrix(family.linkage, placement, family.length)
    return space.drives if part == "drives" else space.tool


def _judged(family: PoseFamily, at: Array, index: Indices, part: Part, arrived: Mask) -> Refined:
    """Those poses at which the value is zero."""
    looked = family.look(at)
    zero = least(looked.space, part) <= ZERO
    # where the joints themselves are singular, the space and with it the minor may jump
    zero |= looked.space.passive <= ZERO
    kept = np.zeros(len(at), dtype=bool)
    kept[looked.reach] = zero
    kept &= arrived
    i = looked.index[kept]
    return Refined(at[kept], looked.placement[i], looked.space[i], index[kept])
