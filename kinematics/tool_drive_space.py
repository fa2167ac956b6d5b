"""Motions of a mechanism as its tool and drives see them: one space per pose, with one sense."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import qr

from strutwork.errors import ModelError
from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.rows import characteristic_length, constraint_rows

Array = NDArray[Any]

#: Passive rows whose singular values are below this share of the largest hold nothing.
HELD = 1e-8

#: Part that tool and drives have in a motion of unit size before it is one of theirs.
SEEN = 1e-8

#: Poses whose rows are decomposed at once.
PIECE = 512


@dataclass(frozen=True)
class Freedoms:
    """What holds for a mechanism at all poses but singular ones.

    Parameters
    ----------
    rank : int
        Of the passive rows.
    freedoms : int
        Independent motions in which the tool or a drive moves, drives free.
    tool : int
        Independent motions of the tool.
    task : tuple of int
        Directions of the tool that distinguish its motions, as many as `tool`.
    """

    rank: int
    freedoms: int
    tool: int
    task: tuple[int, ...]


@dataclass(frozen=True)
class ToolDriveSpace:
    """Motions that the passive joints allow, reduced to the motions of tool and drives.

    The columns of `basis` are an orthonormal basis of that space: twist of the tool (v, L ω) over
    rates of the drives (m/s, L rad/s). A unit motion in which the drives stand has a drive part
    of zero: the least singular value of `drives` is the sine of the angle between the space and
    the nearest motion of the tool alone, that of `tool` of the nearest motion of drives alone.
    Both are zero exactly at singularities and finite everywhere. A basis has a sense only
    relative to another pose's, see `sense`; signs of minors are compared through it.

    Parameters
    ----------
    basis : (p, 6 + a, f)
        Orthonormal columns.
    passive : (p,)
        Least singular value of the passive rows that counts, each row of unit size, no unit: zero
        where the rows lose rank, at a singularity of the configuration space.
    length : float
        L, m.
    driven : tuple of (joint, direction)
    known : Freedoms
    """

    basis: Array
    passive: Array
    length: float
    driven: tuple[tuple[str, str], ...]
    known: Freedoms

    def __repr__(self) -> str:
        return (
            f"<ToolDriveSpace: {len(self.basis)} poses, {self.known.freedoms} freedoms, "
            f"{len(self.driven)} drives, L = {1e3 * self.length:.4g} mm>"
        )

    def __getitem__(self, index: Any) -> ToolDriveSpace:
        return ToolDriveSpace(
            self.basis[index], self.passive[index], self.length, self.driven, self.known
        )

    @property
    def tool(self) -> Array:
        """What the tool does, (p, 6, f)."""
        return self.basis[:, :6]

    @property
    def drives(self) -> Array:
        """What the drives do, (p, a, f)."""
        return self.basis[:, 6:]

    @cached_property
    def _tool_values(self) -> Array:
        return np.asarray(np.linalg.svd(self.tool, compute_uv=False))

    @cached_property
    def _drive_values(self) -> Array:
        return np.asarray(np.linalg.svd(self.drives, compute_uv=False))

    @property
    def parallel(self) -> Array:
        """Least singular value of the drives' part, (p,): 0 where the tool moves at held drives."""
        return np.asarray(self._drive_values[:, self.known.freedoms - 1])

    @property
    def serial(self) -> Array:
        """Least singular value of the tool's part, (p,): 0 where the tool has lost a motion."""
        return np.asarray(self._tool_values[:, self.known.tool - 1])

    def parallel_distance(self) -> Array:
        """Least singular value of the inverse Jacobian scaled by L, (p,).

        Rates of the drives, m/s or L rad/s, in that unit motion of the tool, (v, L ω), which
        moves them least.
        """
        return np.asarray(self.parallel / self._tool_values[:, 0])

    def serial_distance(self) -> Array:
        """Least singular value of the Jacobian scaled by L, (p,): motion of the tool that moves
        least for unit rates.
        """  # noqa: D205 - one sentence
        known = self.known
        # motions come in pairs: where the tool's part is least, the drives' is largest, but for
        # those of the drives alone, which a machine with more freedoms than its tool has anywhere
        rates = self._drive_values[:, known.freedoms - known.tool]
        return np.asarray(self.serial / rates)

    @property
    def square(self) -> bool:
        """As many drives as freedoms: parallel singularities are where a determinant is zero."""
        return len(self.driven) == self.known.freedoms

    @property
    def square_tool(self) -> bool:
        """As many motions of the tool as freedoms."""
        return self.known.tool == self.known.freedoms

    def drive_minor(self) -> Array:
        """Determinant of the drives' part, (p,), signed by the basis; needs `square`."""
        return np.asarray(np.linalg.det(self.drives))

    def tool_minor(self) -> Array:
        """Determinant of the tool's part in the task's directions, (p,); needs `square_tool`."""
        return np.asarray(np.linalg.det(self.tool[:, list(self.known.task)]))

    def sense(self, other: ToolDriveSpace) -> Array:
        """Determinant of the projection of one basis on another's, (p,).

        Its sign says whether both bases have one sense, its size how near the spaces are: 1 for
        the same space, 0 for spaces of which one holds a motion at right angles to the other.

        Parameters
        ----------
        other : ToolDriveSpace
            Of the same machine, at as many poses or one.
        """
        return np.asarray(np.linalg.det(np.swapaxes(self.basis, -1, -2) @ other.basis))

    def aligned(self, other: ToolDriveSpace) -> ToolDriveSpace:
        """The same spaces in the basis that is nearest to another's: smooth along a way.

        Parameters
        ----------
        other : ToolDriveSpace
            Of the same machine, at as many poses or one.
        """
        u, _, v = np.linalg.svd(np.swapaxes(self.basis, -1, -2) @ other.basis)
        return ToolDriveSpace(
            self.basis @ (u @ v), self.passive, self.length, self.driven, self.known
        )


def tool_drive_space(
    linkage: Linkage,
    placement: Placement,
    length: float | None = None,
    known: Freedoms | None = None,
) -> ToolDriveSpace:
    """Space of motions of tool and drives at a batch of poses.

    Parameters
    ----------
    linkage : Linkage
        With a tool on a moving body and at least one driven direction.
    placement : Placement
        Poses, one batch axis or none.
    length : float, optional
        L, m: how much translation counts as much as one radian. Default: the machine's
        `characteristic_length` here.
    known : Freedoms, optional
        Ranks at poses that are not singular. Default: the largest in the batch.

    Raises
    ------
    ModelError
        No tool, a tool on the ground, no drive, fewer drives than freedoms, a length that is not
        positive.
    """
    check_driven(linkage, length)
    flat = placement.flat() if placement.batch else placement[None]
    if length is None:
        length = characteristic_length(flat)
    pieces = [flat[k : k + PIECE] for k in range(0, max(flat.batch[0], 1), PIECE)]
    parts = [_Rows.of(linkage, piece, length) for piece in pieces]
    if known is None:
        known = _ranks(parts, len(linkage.driven))
    found = [part.space(known) for part in parts]
    return ToolDriveSpace(
        np.concatenate([basis for basis, _ in found]),
        np.concatenate([least for _, least in found]),
        length,
        linkage.driven,
        known,
    )


def passive_matrix(linkage: Linkage, placement: Placement, length: float) -> Array:
    """Rows of the passive joints on (v, L ω) of all bodies, each of unit size, (p, r, 6 b).

    Parameters
    ----------
    linkage : Linkage
        With b moving bodies.
    placement : Placement
        At p poses.
    length : float
        L, m.
    """
    select = linkage.elastic_or_locked() & ~linkage.driven_mask()
    rows = constraint_rows(linkage, placement, select).on_bodies() / _columns(linkage, length)
    norm = np.linalg.norm(rows, axis=-1, keepdims=True)
    return np.asarray(rows / np.where(norm == 0.0, 1.0, norm))


def drive_matrix(linkage: Linkage, placement: Placement, length: float) -> Array:
    """Rates of the drives, m/s or L rad/s, by (v, L ω) of all bodies, (p, a, 6 b).

    Parameters
    ----------
    linkage : Linkage
        With b moving bodies and a driven directions.
    placement : Placement
        At p poses.
    length : float
        L, m.
    """
    rows = constraint_rows(linkage, placement, linkage.driven_mask())
    size = np.where(rows.direction < 3, 1.0, length)[:, None]
    return np.asarray(size * rows.on_bodies() / _columns(linkage, length))


def _columns(linkage: Linkage, length: float) -> Array:
    return np.tile(np.repeat([1.0, length], 3), len(linkage.body_names))


@dataclass(frozen=True)
class _Rows:
    """Singular values and right vectors of the passive rows, and what tool and drives see."""

    values: Array
    right: Array
    seen: Array

    @classmethod
    def of(cls, linkage: Linkage, placement: Placement, length: float) -> _Rows:
        passive = passive_matrix(linkage, placement, length)
        _, values, right = np.linalg.svd(passive)
        body = linkage.tool_body
        drives = drive_matrix(linkage, placement, length)
        seen = np.concatenate([right[:, :, 6 * body : 6 * body + 6].mT, drives @ right.mT], axis=1)
        return cls(values, right, seen)

    def ranks(self) -> NDArray[np.intp]:
        limit = HELD * self.values[:, :1] if self.values.shape[1] else self.values
        return np.asarray((self.values > limit).sum(axis=-1), dtype=np.intp)

    def bases(self, rank: int) -> tuple[Array, Array]:
        left, values, _ = np.linalg.svd(self.seen[:, :, rank:], full_matrices=False)
        return left, values

    def space(self, known: Freedoms) -> tuple[Array, Array]:
        left, _ = self.bases(known.rank)
        least = self.values[:, known.rank - 1] if known.rank else np.ones(len(left))
        return left[:, :, : known.freedoms], least


def _ranks(parts: list[_Rows], drives: int) -> Freedoms:
    rank = max(int(part.ranks().max(initial=0)) for part in parts)
    full = [part.ranks() == rank for part in parts]
    found = [part.bases(rank) for part in parts]
    seen = [(v > SEEN).sum(axis=-1)[f] for (_, v), f in zip(found, full, strict=True)]
    freedoms = int(np.concatenate(seen).max())
    tools = np.concatenate(
        [left[f, :6, :freedoms] for (left, _), f in zip(found, full, strict=True)]
    )
    values = np.linalg.svd(tools, compute_uv=False)
    tool = int((values > SEEN).sum(axis=-1).max())
    if drives < freedoms:
        raise ModelError(
            "drives",
            f"are {drives}, and the machine has {freedoms} freedoms: it can move with the drives "
            "held everywhere.",
            "Drive as many joint directions as `strutwork check` counts freedoms.",
        )
    # directions of the tool that tell its motions apart best over all poses
    gram = np.einsum("pif,pjf->ij", tools, tools)
    order = qr(gram, pivoting=True, mode="r")[1]
    return Freedoms(rank, freedoms, tool, tuple(sorted(int(k) for k in order[:tool])))


def check_driven(linkage: Linkage, length: ArrayLike | None = None) -> None:
    """Check that a linkage has a tool that can move, drives, and a length that is one.

    Parameters
    ----------
    linkage : Linkage
        With a tool.
    length : (), optional
        L, m.

    Raises
    ------
    ModelError
        It has not.
    """
    body = linkage.tool_body
    if body < 0 or not linkage.driven:
        raise ModelError(
            "linkage",
            "the tool is on the ground." if body < 0 else "has no driven direction.",
            "Singularities need a moving tool and at least one driven direction.",
        )
    if length is not None and not (np.isfinite(length) and float(np.asarray(length)) > 0.0):
        raise ModelError("characteristic length", f"is {length!r}.", "Give a positive length, m.")
