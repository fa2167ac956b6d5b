"""How errors of the joints move the tool, by the constraint rows alone.

With the drives held, every direction of a joint that is not free is a row A of the bodies' small
displacements: A q = g, where g is the displacement of the joint's second side against its first
that wear, play, a drive or a wrong dimension bring. Where the rows are independent, and hold the
tool, q follows whatever is stiff or not: nothing is forced.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.rows import body_references, characteristic_lengths, constraint_rows
from strutwork.names import choices

Array = NDArray[Any]
Mask = NDArray[np.bool_]

#: A row that is independent of those before it by less than this, or a part of the tool's
#: displacement that no row holds beyond it, counts as rounding.
INDEPENDENT = 1e-9

#: Displacements below this share of the largest, turns at the machine's size, are rounding.
ROUNDING = 1e-13

#: Poses whose rows are parted at once.
PIECE = 64


@dataclass(frozen=True)
class ErrorTransmission:
    """Displacement of the tool per unit error of a joint.

    Parameters
    ----------
    columns : tuple of (joint, direction)
        The errors, in joint axes: of the second side against the first.
    matrix : (..., 6, g)
        Displacement of the tool centre point and rotation of the tool, relative to the workpiece
        where the linkage names one, global axes, per unit error, m and rad. NaN where it is not
        determined.
    redundant : (...) of bool
        More rows than can be met: errors are locked in as forces, and what is soft decides.
    loose : (...) of bool
        The tool can move although the drives are held.
    """

    columns: tuple[tuple[str, str], ...]
    matrix: Array
    redundant: Mask
    loose: Mask

    def __repr__(self) -> str:
        return f"<ErrorTransmission: {len(self.columns)} errors, batch {self.redundant.shape}>"

    @property
    def determined(self) -> Mask:
        """True where the rows alone say how the tool moves, (...)."""
        return np.asarray(~self.redundant & ~self.loose)


def error_transmission(
    linkage: Linkage,
    placement: Placement,
    columns: Sequence[tuple[str, str]] | None = None,
) -> ErrorTransmission:
    """Displacement of the tool per unit error of joint directions.

    Parameters
    ----------
    linkage : Linkage
        With a tool.
    placement : Placement
    columns : sequence of (joint, direction), optional
        Directions that are locked, elastic or driven. Default: all of them.

    Returns
    -------
    ErrorTransmission
        Poses out of reach are not determined.

    Raises
    ------
    ModelError
        No moving tool, an unknown joint, or a free direction: its play moves no tool.
    """
    if max(linkage.tool_body, linkage.workpiece_body) < 0:
        raise ModelError("tool", "is on the ground.", "Name a node of a moving body.")
    held = linkage.elastic_or_locked()
    rows = list(zip(*np.nonzero(held), strict=True))
    number = {(linkage.joints[j].name, DIRECTIONS[d]): n for n, (j, d) in enumerate(rows)}
    chosen = tuple(number) if columns is None else tuple(columns)
    for joint, direction in chosen:
        if joint not in linkage.joint_index:
            raise ModelError(
                f"joint {joint}",
                "is not in the linkage.",
                choices("Joints", joint, linkage.joint_index),
            )
        if (joint, direction) not in number:
            raise ModelError(
                f"joint {joint}",
                f"is free in {direction}: an error there does not move the tool.",
                "Name a locked, elastic or driven direction.",
            )
    pick = np.array([number[c] for c in chosen], dtype=np.intp)
    flat = placement.flat()
    count = len(flat.positions)
    matrix = np.full((count, 6, len(pick)), np.nan)
    redundant, loose = np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
    good = np.flatnonzero(flat.reachable)
    for part in np.array_split(good, max(1, -(-len(good) // PIECE))):
        found, redundant[part], loose[part] = _parted(linkage, flat[part])
        matrix[part] = found[..., pick]
    matrix[redundant | loose] = np.nan
    loose[~flat.reachable] = True
    batch = placement.batch
    return ErrorTransmission(
        chosen,
        matrix.reshape(*batch, *matrix.shape[1:]),
        redundant.reshape(batch),
        loose.reshape(batch),
    )


def _parted(linkage: Linkage, placement: Placement) -> tuple[Array, Mask, Mask]:
    """Matrix by all rows (p, 6, r), rows that depend on others, a tool that nothing holds."""
    rows = constraint_rows(linkage, placement)
    a = rows.on_bodies()
    poses, r, n = a.shape
    length = characteristic_lengths(placement)
    # turns of bodies and of joints count at the machine's size
    turning = np.arange(n) % 6 >= 3
    a = np.where(turning, a / length[:, None, None], a)
    twisting = np.asarray(rows.direction) >= 3
    scale = np.where(twisting, length[:, None], 1.0)
    a = a * scale[..., None]
    size = np.linalg.norm(a, axis=-1)
    idle = size <= INDEPENDENT
    if r > n:
        none = np.zeros((poses, 6, r))
        return none, np.ones(poses, dtype=bool), np.zeros(poses, dtype=bool)
    q, upper = np.linalg.qr(np.swapaxes(a, -1, -2))
    pivots = np.abs(np.diagonal(upper, axis1=-2, axis2=-1))
    redundant = np.any((pivots <= INDEPENDENT * np.maximum(size, 1e-300)) | idle, axis=-1)
    moves = _tool_moves(linkage, placement, length)
    ends = moves @ q
    # the tool's displacements that no row sees
    free = moves @ np.swapaxes(moves, -1, -2) - ends @ np.swapaxes(ends, -1, -2)
    loose = np.abs(np.diagonal(free, axis1=-2, axis2=-1)).max(axis=-1) > INDEPENDENT
    safe = np.where(redundant[:, None, None], np.eye(r), upper)
    moved = np.swapaxes(np.linalg.solve(safe, np.swapaxes(ends, -1, -2)), -1, -2)
    # what the solution leaves where nothing moves
    largest = np.abs(moved).max(axis=(-2, -1), keepdims=True, initial=0.0)
    moved = np.where(np.abs(moved) > ROUNDING * largest, moved, 0.0)
    moved = moved * scale[:, None]
    moved[:, 3:] /= length[:, None, None]
    return moved, redundant, loose & ~redundant


def _tool_moves(linkage: Linkage, placement: Placement, length: Array) -> Array:
    """The tool's twist by those of the bodies, turns at the machine's size, (p, 6, 6 b).

    Relative to the point of the workpiece at which it stands, where the linkage names one.
    """
    poses = len(placement.positions)
    result = np.zeros((poses, len(linkage.body_names), 6, 6))
    if linkage.tool_body >= 0:
        result[:, linkage.tool_body] += np.eye(6)
    work = linkage.workpiece_body
    if work >= 0:
        tool = placement.positions[:, linkage.node_index[str(linkage.tool)]]
        arm = (tool - body_references(linkage, placement)[:, work]) / length[:, None]
        carried = np.tile(np.eye(6), (poses, 1, 1))
        carried[:, :3, 3:] = -np.cross(arm[:, None, :], np.eye(3)).swapaxes(-1, -2)
        result[:, work] -= carried
    return np.moveaxis(result, 1, 2).reshape(poses, 6, -1)
