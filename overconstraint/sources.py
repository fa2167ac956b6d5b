"""From tolerances to the misfits of joints: g = mean + M z."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, GROUND, Linkage, State, axes_frame, cross_matrix
from strutwork.msa.structure import PlacedStructure
from strutwork.names import choices
from strutwork.overconstraint.tolerance import TILTS, Tolerance
from strutwork.overconstraint.unit_sets import Ball, Disc, Interval, PlaneZone, UnitSet

Array = NDArray[Any]

#: A joint this near to its datum is the pivot of a tilt, m: joints' nodes coincide so closely.
PIVOT = 1e-9

#: What turning into a joint's axes leaves in a direction that does not move, as a share.
ROUNDING = 1e-13


class ToleranceWarning(UserWarning):
    """A tolerance has no effect."""


@dataclass(frozen=True)
class Block:
    """Parameters that range over one set.

    Parameters
    ----------
    tolerance : int
        Index of the tolerance that it belongs to.
    shape : UnitSet
    start : int
        Where its parameters begin in z.
    """

    tolerance: int
    shape: UnitSet
    start: int


@dataclass(frozen=True)
class MisfitSources:
    """Misfits of joints that tolerances cause, g = mean + M z.

    Parameters
    ----------
    tolerances : tuple of Tolerance
    blocks : tuple of Block
        z consists of blocks, each in its own unit set.
    columns : tuple of (joint, direction)
        The rows of M.
    map : (..., g, k)
        M, m and rad.
    mean : (..., g)
        Misfits in the middle of all zones, m and rad.
    """

    tolerances: tuple[Tolerance, ...]
    blocks: tuple[Block, ...]
    columns: tuple[tuple[str, str], ...]
    map: Array
    mean: Array

    def __repr__(self) -> str:
        return (
            f"<MisfitSources: {len(self.tolerances)} tolerances, {len(self.columns)} misfits, "
            f"batch {self.mean.shape[:-1]}>"
        )

    @property
    def parameters(self) -> int:
        """Length of z."""
        return int(self.map.shape[-1])

    @cached_property
    def by_shape(self) -> tuple[tuple[UnitSet, NDArray[np.intp], NDArray[np.intp]], ...]:
        """Blocks of equal shape together: the shape, the blocks (b,), their parameters (b, d)."""
        groups: dict[UnitSet, list[int]] = {}
        for i, block in enumerate(self.blocks):
            groups.setdefault(block.shape, []).append(i)
        return tuple(
            (
                shape,
                np.asarray(members),
                np.array([self.blocks[i].start + np.arange(shape.dimension) for i in members]),
            )
            for shape, members in groups.items()
        )

    @cached_property
    def owner(self) -> NDArray[np.intp]:
        """Tolerance of every block, (b,)."""
        return np.array([block.tolerance for block in self.blocks], dtype=np.intp)

    def supports(self, direction: Array) -> Array:
        """What every block does at worst to a quantity cᵀz, (..., b).

        Parameters
        ----------
        direction : (..., k)
            c, any unit.
        """
        result = np.zeros((*direction.shape[:-1], len(self.blocks)))
        for shape, members, index in self.by_shape:
            result[..., members] = shape.support(direction[..., index])
        return result

    def extreme(self, direction: Array) -> Array:
        """The z at which that is reached, (..., k).

        Parameters
        ----------
        direction : (..., k)
            c, as `supports`, any unit.
        """
        result = np.zeros(direction.shape)
        for shape, _, index in self.by_shape:
            result[..., index] = shape.extreme(direction[..., index])
        return result


def misfit_sources(placed: PlacedStructure, tolerances: Sequence[Tolerance]) -> MisfitSources:
    """Misfits that tolerances cause at a batch of poses.

    Parameters
    ----------
    placed : PlacedStructure
    tolerances : sequence of Tolerance

    Returns
    -------
    MisfitSources

    Raises
    ------
    ModelError
        An unknown joint or datum, a datum on neither side of a joint, two tolerances of a name.

    Warns
    -----
    ToleranceWarning
        A tolerance that moves a joint in its free directions alone; names the joint.
    """
    linkage = placed.structure.linkage
    names = [tolerance.name for tolerance in tolerances]
    for name in names:
        if names.count(name) > 1:
            raise ModelError(f"tolerance {name}", "is defined twice.", "Give it another name.")
    states = linkage.states()
    every = 6 * len(linkage.joints)
    batch = placed.batch
    blocks: list[Block] = []
    maps: list[Array] = []
    mean = np.zeros((*batch, every))
    start = 0
    for t, tolerance in enumerate(tolerances):
        seats = _joints(linkage, tolerance)
        for shape, torsors, shared in _zones(placed, tolerance, seats[0]):
            for group in [seats] if shared else [[seat] for seat in seats]:
                column = np.zeros((*batch, every, shape.dimension))
                for joint in group:
                    column[..., 6 * joint : 6 * joint + 6, :] = _at_joint(
                        placed, tolerance, joint, seats[0], torsors
                    )
                column[..., (states == State.FREE).ravel(), :] = 0.0
                blocks.append(Block(t, shape, start))
                maps.append(tolerance.extent * column)
                if tolerance.middle:
                    mean += tolerance.middle * column[..., 0]
                start += shape.dimension
        _warn_idle(
            placed,
            tolerance,
            seats,
            [m for b, m in zip(blocks, maps, strict=True) if b.tolerance == t],
        )
    whole = np.concatenate(maps, axis=-1) if maps else np.zeros((*batch, every, 0))
    used = np.flatnonzero(
        np.any(whole != 0, axis=(*range(len(batch)), -1))
        if whole.size
        else np.zeros(every, dtype=bool)
    )
    columns = tuple((linkage.joints[i // 6].name, DIRECTIONS[i % 6]) for i in used)
    return MisfitSources(
        tuple(tolerances), tuple(blocks), columns, whole[..., used, :], mean[..., used]
    )


def _joints(linkage: Linkage, tolerance: Tolerance) -> list[int]:
    part = f"tolerance {tolerance.name}"
    for joint in tolerance.joints:
        if joint not in linkage.joint_index:
            raise ModelError(
                part,
                f'names the unknown joint "{joint}".',
                choices("Joints", joint, linkage.joint_index),
            )
    if tolerance.datum is not None and tolerance.datum not in linkage.node_index:
        raise ModelError(
            part,
            f'names the unknown datum "{tolerance.datum}".',
            "A datum is a node: " + ", ".join(linkage.nodes[:12]) + ".",
        )
    return [linkage.joint_index[joint] for joint in tolerance.joints]


def _zones(
    placed: PlacedStructure, tolerance: Tolerance, first: int
) -> list[tuple[UnitSet, Array, bool]]:
    """Shapes of the zone with unit torsors (..., 6, d), and whether all joints share them.

    Torsors are of extent one: a cone of one radian, deviations of one metre.
    """
    frame = _feature_frame(placed, tolerance, first)
    e1, e2, axis = (frame[..., :, i] for i in range(3))
    still = np.zeros_like(axis)

    def torsor(moves: Array, turns: Array) -> Array:
        return np.concatenate([moves, turns], axis=-1)[..., None]

    if tolerance.kind in TILTS:
        tilt = np.concatenate([torsor(still, e1), torsor(still, e2)], axis=-1)
        return [(Disc(), tilt, True)]
    if tolerance.kind in {"position", "coaxiality"}:
        if tolerance.length is None:
            moves = np.concatenate([torsor(e1, still), torsor(e2, still)], axis=-1)
            return [(Disc(), moves, True)]
        # each end of the axis in its circle: half of what it moves goes to the middle
        ends = []
        for side in (-1.0, 1.0):
            turn = side / tolerance.length
            # θ × axis = e moves the end on that side
            ends.append(
                np.concatenate([torsor(e1 / 2, turn * e2), torsor(e2 / 2, -turn * e1)], axis=-1)
            )
        return [(Disc(), end, True) for end in ends]
    if tolerance.kind == "point_position":
        unit = np.broadcast_to(np.eye(3), (*axis.shape, 3))
        return [(Ball(), np.concatenate([unit, np.zeros_like(unit)], axis=-2), True)]
    lift = torsor(axis, still)
    if tolerance.kind == "location" and tolerance.length is not None and tolerance.width:
        tilts = [
            torsor(still, 2 / side * np.cross(e, axis))
            for side, e in ((tolerance.length, e1), (tolerance.width, e2))
        ]
        return [(PlaneZone(), np.concatenate([lift, *tilts], axis=-1), True)]
    return [(Interval(), lift, tolerance.kind != "flatness")]


def _feature_frame(placed: PlacedStructure, tolerance: Tolerance, first: int) -> Array:
    """Axes of the feature as columns, the third its axis or normal, (..., 3, 3)."""
    part = f"tolerance {tolerance.name}"
    axis = (
        placed.placement.frames[..., first, :, 2]
        if tolerance.axis is None
        else np.broadcast_to(np.asarray(tolerance.axis, dtype=float), (*placed.batch, 3))
    )
    # directions that the tolerance names go with its feature's body
    datum = tolerance.datum or placed.structure.linkage.joints[first].between[0]
    turn = placed.turn_of(datum)
    if tolerance.axis is None:
        axis = np.einsum("...ji,...j->...i", turn, axis)
    return np.asarray(turn @ axes_frame(axis, tolerance.along, part))


def _at_joint(
    placed: PlacedStructure, tolerance: Tolerance, joint: int, first: int, torsors: Array
) -> Array:
    """Misfit of a joint in joint axes, (..., 6, d), when its feature moves by the torsors."""
    linkage, placement = placed.structure.linkage, placed.placement
    sides = linkage.joints[joint].between
    datum = tolerance.datum or linkage.joints[first].between[0]
    sign = _side(linkage, tolerance, joint, datum)
    index = linkage.node_index
    arm = placement.positions[..., index[sides[0]], :] - placement.positions[..., index[datum], :]
    turns = torsors[..., 3:, :]
    carried = cross_matrix(arm) @ turns
    frame = np.swapaxes(placement.frames[..., joint, :, :], -1, -2)
    size = np.linalg.norm(turns, axis=-2, keepdims=True)
    reach = (
        np.linalg.norm(torsors[..., :3, :], axis=-2, keepdims=True)
        + size
        * np.linalg.norm(placement.positions[..., [index[sides[0]], index[datum]], :], axis=-1).max(
            axis=-1
        )[..., None, None]
    )
    parts = [
        np.where(np.abs(part) > ROUNDING * scale, part, 0.0)
        for part, scale in ((frame @ (torsors[..., :3, :] - carried), reach), (frame @ turns, size))
    ]
    return np.asarray(sign * np.concatenate(parts, axis=-2))


def _side(linkage: Linkage, tolerance: Tolerance, joint: int, datum: str) -> float:
    """+1 where the feature is on the joint's first side, −1 on its second."""
    owner, index = linkage.body_of_node, linkage.node_index
    body = owner[index[datum]]
    first, second = (owner[index[n]] for n in linkage.joints[joint].between)
    if body == first:
        return 1.0
    if body == second:
        return -1.0
    names = [GROUND if b < 0 else linkage.body_names[b] for b in (body, first, second)]
    raise ModelError(
        f"tolerance {tolerance.name}",
        f'its datum "{datum}" is on {names[0]}, but the joint {linkage.joints[joint].name} joins '
        f"{names[1]} and {names[2]}.",
        "Choose a node of one of the joint's bodies as the datum.",
    )


def _warn_idle(
    placed: PlacedStructure, tolerance: Tolerance, seats: list[int], maps: list[Array]
) -> None:
    linkage, index = placed.structure.linkage, placed.structure.linkage.node_index
    idle = [j for j in seats if not any(np.any(m[..., 6 * j : 6 * j + 6, :]) for m in maps)]
    datum = tolerance.datum or linkage.joints[seats[0]].between[0]
    for joint in idle:
        node = index[linkage.joints[joint].between[0]]
        arm = (
            placed.placement.positions[..., node, :]
            - placed.placement.positions[..., index[datum], :]
        )
        if tolerance.kind in TILTS and len(idle) < len(seats) and np.all(np.abs(arm) < PIVOT):
            # the pivot of a tilt that the other joints feel
            continue
        warnings.warn(
            f"tolerance {tolerance.name}: joint {linkage.joints[joint].name} is free where "
            f"this {tolerance.kind} would move it, so it has no effect there.",
            ToleranceWarning,
            stacklevel=3,
        )
