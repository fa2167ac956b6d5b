"""Constraint rows: the one object from which everything about a machine follows.

Every direction of a joint that is not free is one row: it relates the twists of the two nodes
the joint joins. Mobility, Jacobians, the saddle-point system of the matrix structural analysis
and its multipliers, all read the rows made here.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.frames import cross
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.placement import COINCIDENCE, Placement

Array = NDArray[Any]

#: Nodes this many times further away than the median node are marks, not parts of the machine.
FAR = 1e3


@dataclass(frozen=True)
class ConstraintRows:
    """Rows e·(q₂ − q₁), one for each selected joint direction.

    Parameters
    ----------
    linkage : Linkage
    placement : Placement
    joint : (r,)
        Index of the joint that owns each row.
    direction : (r,)
        Index into `DIRECTIONS`.
    axes : (..., r, 6)
        The direction e in global axes, translation then rotation: (a, 0) or (0, a), a a unit
        vector.
    tied : Tied or None
        What the rows of coordinates that follow others have beside that.
    """

    linkage: Linkage
    placement: Placement
    joint: NDArray[np.intp]
    direction: NDArray[np.intp]
    axes: Array
    tied: Tied | None = None

    def __repr__(self) -> str:
        return f"<ConstraintRows: {len(self.joint)} rows, batch {self.placement.batch}>"

    def __len__(self) -> int:
        return len(self.joint)

    def __getitem__(self, index: Any) -> ConstraintRows:
        """The same rows at the poses selected by `index` on the batch axes."""
        tied = self.tied and replace(self.tied, others=self.tied.others[index])
        return replace(self, placement=self.placement[index], axes=self.axes[index], tied=tied)

    @property
    def labels(self) -> tuple[str, ...]:
        """Name of each row, `joint:direction`."""
        return tuple(
            f"{self.linkage.joints[j].name}:{DIRECTIONS[d]}"
            for j, d in zip(self.joint, self.direction, strict=True)
        )

    @cached_property
    def nodes(self) -> NDArray[np.intp]:
        """Indices of the first and second node of each row, (r, 2)."""
        index = self.linkage.node_index
        pairs = [[index[n] for n in self.linkage.joints[j].between] for j in self.joint]
        return np.asarray(pairs, dtype=np.intp).reshape(-1, 2)

    def on_bodies(self, references: Array | None = None) -> Array:
        """Rows on the twists of the moving bodies, each about its reference point.

        Parameters
        ----------
        references : (..., b, 3), optional
            m. Default: `body_references`.

        Returns
        -------
        rows : (..., r, 6 b)
        """
        linkage, positions = self.linkage, self.placement.positions
        if references is None:
            references = body_references(linkage, self.placement)
        bodies = len(linkage.body_names)
        shape = self.axes.shape[:-1]
        rows = np.zeros((*shape, bodies, 6), dtype=self.axes.dtype)
        owner = linkage.body_of_node[self.nodes]
        # within one body there is nothing to hold: only the rounding of coordinates would be left
        apart = owner[:, 0] != owner[:, 1]
        for side, sign in enumerate((-1.0, 1.0)):
            r = np.flatnonzero(apart & (owner[:, side] >= 0))
            body = owner[r, side]
            e = sign * self.axes[..., r, :]
            arm = positions[..., self.nodes[r, side], :] - references[..., body, :]
            rows[..., r, body, :3] = e[..., :3]
            rows[..., r, body, 3:] = cross(arm, e[..., :3]) + e[..., 3:]
        flat = rows.reshape(*shape, 6 * bodies)
        if self.tied is not None:
            others = self.tied.others.on_bodies(references)
            flat[..., self.tied.rows, :] -= self.tied.ratio[:, None] * others
        return flat


@dataclass(frozen=True)
class Tied:
    """Rows that also hold another coordinate: e·(q₂ − q₁) − ratio times the other's row.

    Parameters
    ----------
    rows : (t,)
        Which rows.
    ratio : (t,)
        In m and rad.
    others : ConstraintRows
        The plain rows of the coordinates that they follow, (t).
    """

    rows: NDArray[np.intp]
    ratio: Array
    others: ConstraintRows


def constraint_rows(
    linkage: Linkage,
    placement: Placement,
    select: NDArray[np.bool_] | None = None,
    *,
    coupled: bool = True,
) -> ConstraintRows:
    """Rows of the selected joint directions at a batch of poses.

    Parameters
    ----------
    linkage : Linkage
    placement : Placement
    select : (j, 6) of bool, optional
        Which joint directions make a row. Default: all that are not free in statics.
    coupled : bool
        Whether the row of a coordinate that follows another holds it to that one; otherwise it
        is the coordinate's own, as for its rate.

    Returns
    -------
    ConstraintRows
    """
    if select is None:
        select = linkage.elastic_or_locked()
    joint, direction = np.nonzero(select)
    frames = placement.frames
    tied = [tie for tie in linkage.ties if select[tie.joint, tie.direction]] if coupled else []
    rows = ConstraintRows(
        linkage, placement, joint, direction, _directions(frames, joint, direction)
    )
    if not tied:
        return rows
    number = np.cumsum(select.ravel()) - 1
    other = np.array([[tie.other_joint, tie.other_direction] for tie in tied], dtype=np.intp).T
    return replace(
        rows,
        tied=Tied(
            np.array([number[6 * tie.joint + tie.direction] for tie in tied], dtype=np.intp),
            np.array([tie.ratio for tie in tied]),
            ConstraintRows(
                linkage, placement, other[0], other[1], _directions(frames, other[0], other[1])
            ),
        ),
    )


def _directions(frames: Array, joint: NDArray[np.intp], direction: NDArray[np.intp]) -> Array:
    """Joint directions in global axes, (..., r, 6)."""
    axes = np.zeros((*frames.shape[:-3], len(joint), 6), dtype=frames.dtype)
    for r, (j, d) in enumerate(zip(joint, direction, strict=True)):
        axes[..., r, 3 * (d // 3) : 3 * (d // 3) + 3] = frames[..., j, :, d % 3]
    return axes


def row_selection(
    shape: tuple[int, ...], joint: NDArray[np.intp], direction: NDArray[np.intp]
) -> tuple[NDArray[np.bool_], NDArray[np.intp]]:
    """Joint directions as a mask (j, 6), and where each of them stands among its rows, (m,).

    Parameters
    ----------
    shape : (int, int)
        Of the mask: number of joints, and 6.
    joint : (m,) of int
        Number of the joint of each direction.
    direction : (m,) of int
        Index into `DIRECTIONS`.
    """
    select = np.zeros(shape, dtype=bool)
    select[joint, direction] = True
    rank = np.cumsum(select.ravel()) - 1
    return select, np.asarray(rank[6 * joint + direction], dtype=np.intp)


def body_references(linkage: Linkage, placement: Placement) -> Array:
    """Reference point of every moving body: the tool on its body, else the body's first node.

    Parameters
    ----------
    linkage : Linkage
        With b moving bodies.
    placement : Placement
        (...); any batch axes.

    Returns
    -------
    points : (..., b, 3)
    """
    owner = linkage.body_of_node
    first = [int(np.flatnonzero(owner == b)[0]) for b in range(len(linkage.body_names))]
    if linkage.tool is not None:
        tool = linkage.node_index[linkage.tool]
        if owner[tool] >= 0:
            first[owner[tool]] = tool
    return placement.positions[..., first, :]


def characteristic_length(placement: Placement) -> float:
    """Length that makes rotations comparable with translations, m.

    The largest distance of a node from the centre of all nodes, which no turn of the machine
    changes; the median over the reachable poses.

    Parameters
    ----------
    placement : Placement
        (...); any batch axes.
    """
    sizes = characteristic_lengths(placement)[placement.reachable]
    return float(_median(sizes)) if sizes.size else 1.0


def characteristic_lengths(placement: Placement) -> Array:
    """`characteristic_length` of every pose by itself, (...), m: no pose sees its neighbours.

    Parameters
    ----------
    placement : Placement
        (...); any batch axes.
    """
    points = placement.positions.real
    reach = _reach(points)
    far = _marks(points)
    if np.any(far):
        inner = far.any(axis=-1)
        # a mark far from the machine is no part of it: its place counts as the machine's centre
        kept = np.where(far, 0.0, 1.0)[inner]
        centre = (points[inner] * kept[..., None]).sum(axis=-2) / kept.sum(axis=-1)[..., None]
        placed = np.where(far[inner][..., None], centre[..., None, :], points[inner])
        reach[inner] = _reach(placed)
    # where all stand at one place, rounding is no length: turns and moves do not mix
    return np.asarray(np.where(reach > COINCIDENCE, reach, 1.0))


def _reach(points: Array) -> Array:
    apart = np.linalg.norm(points - points.mean(axis=-2, keepdims=True), axis=-1)
    return np.asarray(apart.max(axis=-1, initial=0.0))


def _marks(points: Array) -> NDArray[np.bool_]:
    """Nodes further than `FAR` times the usual distance between nodes, (..., n)."""
    best: Array = np.full(points.shape[:-2], np.inf)
    far = np.zeros(points.shape[:-1], dtype=bool)
    count = points.shape[-2]
    # from three nodes, of which one at least is no mark
    for i in sorted({0, count // 2, count - 1}) if count else ():
        apart = np.linalg.norm(points - points[..., i : i + 1, :], axis=-1)
        # two nodes of a joint are one place, whatever rounding has left between them
        usual = _median(np.where(apart > COINCIDENCE, apart, 0.0))
        better = (usual > 0) & (usual < best)
        best = np.where(better, usual, best)
        far = np.where(better[..., None], apart > FAR * usual[..., None], far)
    return far


def _median(values: Array) -> Array:
    """Median along the last axis, none of them NaN: NumPy's own reads `numpy.ma` to look for it."""
    count = values.shape[-1]
    low, high = (count - 1) // 2, count // 2
    parted = np.partition(values, (low, high), axis=-1)
    return np.asarray(0.5 * (parted[..., low] + parted[..., high]))
