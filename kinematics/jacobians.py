"""Velocity Jacobians of a mechanism, from its constraint rows."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.leg_jacobians import legs_compiled
from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.motion_spaces import MotionSpaces, motion_spaces
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.rows import characteristic_lengths, constraint_rows
from strutwork.kinematics.singular_values import singular_values

Array = NDArray[Any]
Mask = NDArray[np.bool_]

#: A matrix whose least singular value is below this share of its largest one is singular: what
#: is left of it is rounding of the coordinates.
SINGULAR = 1e-12

#: Bodies that move faster than this per unit twist of the tool are looked at by rank instead.
FASTEST = 1e6


@dataclass(frozen=True)
class Jacobians:
    """Relations between the twist of the tool and the rates of the drives.

    A tool with less than six freedoms is taken by the motions it has: the rates of a twist are
    those of its part that the mechanism can make, and `condition` is that over those motions.

    Parameters
    ----------
    inverse : (..., a, 6)
        Rate of each driven direction per unit tool twist (translation then rotation): no unit and
        m/rad of a drive that slides, rad/m and no unit of one that turns. At a serial (type 1)
        singularity infinite, without sign, in the directions that are lost. With more drives than
        freedoms the least rates, turning drives at the arm `length`.
    driven : tuple of (joint name, direction)
        Order of the rates, m/s or rad/s.
    length : (...)
        The machine's size, m, by which angles are made comparable where nobody says how.
    motions : (..., 6, 6) or None
        Tool twists that the mechanism can make, as orthonormal columns, the rest zero; None
        for all twists.
    rank : (...) of int or None
        How many columns of `motions` count.
    serial : (...) of bool
        Serial singularity: drives move although the tool stands still, and the tool has lost a
        motion.
    spaces : MotionSpaces or None
        Of the poses of `by_rank`.
    by_rank : (...) of bool or None
        Poses that were treated through the null space of their rows; None for none.
    """

    inverse: Array
    driven: tuple[tuple[str, str], ...]
    length: Array
    serial: Mask
    motions: Array | None = None
    rank: NDArray[np.intp] | None = None
    spaces: MotionSpaces | None = None
    by_rank: Mask | None = None

    def __repr__(self) -> str:
        return f"<Jacobians: {len(self.driven)} drives, batch {self.inverse.shape[:-2]}>"

    @cached_property
    def forward(self) -> Array:
        """Tool twist per unit rate, (..., 6, a); of a redundant drive, rates that it can have.

        Infinite where the tool moves although the drives stand: at a parallel (type 2)
        singularity, or with less drives than freedoms.
        """
        finite = np.where(np.isfinite(self.inverse), self.inverse, 0.0)
        batch, drives = finite.shape[:-2], finite.shape[-2]
        result = np.zeros((*batch, 6, drives))
        ranked = np.zeros(batch, dtype=bool) if self.by_rank is None else self.by_rank
        lost = np.array(self._values(finite, self.length)[1]) & ~ranked
        plain = ~ranked & ~lost
        if drives == 6:
            result[plain] = np.linalg.inv(finite[plain])
        elif plain.any():
            # turning drives at the arm of the machine, as the least rates are
            arm = self.length[plain][..., None] ** self._rotary
            weighted = np.linalg.pinv(arm[..., None] * finite[plain], rcond=SINGULAR)
            result[plain] = weighted * arm[..., None, :]
        if lost.any():
            _, values, right = np.linalg.svd(_scaled(finite[lost], self.driven, self.length[lost]))
            count = values.shape[-1]
            still = np.ones(right.shape[:-1], dtype=bool)
            still[..., :count] = values <= SINGULAR * values[..., :1]
            loose = (np.abs(right) * still[..., None]).max(axis=-2) > 1e-6
            result[lost] = np.where(
                loose[..., None], np.inf, np.linalg.pinv(finite[lost], rcond=SINGULAR)
            )
        if self.spaces is not None:
            result[ranked] = self.spaces.forward
        return result

    @property
    def _rotary(self) -> Array:
        """1 for a drive that turns, else 0, (a,)."""
        return np.array([float(direction.startswith("r")) for _, direction in self.driven])

    @cached_property
    def parallel(self) -> Mask:
        """Parallel singularity: the tool moves although the drives stand still, (...)."""
        loose = np.array(self._values(self.inverse, self.length)[1])
        if self.spaces is not None and self.by_rank is not None:
            loose[self.by_rank] = self.spaces.parallel
        return loose

    @property
    def singular(self) -> Mask:
        """Serial or parallel singularity, (...)."""
        return np.asarray(self.serial | self.parallel)

    def rates(self, twist: ArrayLike) -> Array:
        """Rates of the drives for a twist of the tool, (..., a), m/s or rad/s.

        Parameters
        ----------
        twist : (..., 6)
            m/s and rad/s. Rates are infinite where the twist has a part in a direction that a
            serial singularity has taken.
        """
        t = np.asarray(twist, dtype=float)[..., None, :]
        lost = np.isinf(self.inverse)
        sums = (np.where(lost, 0.0, self.inverse) * t).sum(axis=-1)
        return np.where((lost & (t != 0.0)).any(axis=-1), np.inf, sums)

    def condition(self, length: ArrayLike | None = None) -> Array:
        """Condition number of the inverse Jacobian over the motions of the tool, (...).

        Infinite at every singularity, serial or parallel.

        Parameters
        ----------
        length : (...), optional
            Translations and rotations have different units: how much translation, m, counts
            as much as one radian, of the tool and of a rotary drive alike. Default: the
            machine's own `length`.
        """
        ratio, _ = self._values(self.inverse, self._length(length))
        return self._where_singular(np.where(self.serial, np.inf, ratio), np.inf)

    def margin(self, length: ArrayLike | None = None) -> Array:
        """Distance from the next singularity, (...): 0 at it and 1 at most.

        The least of two ratios: the rates of the drives in that motion of the tool, of size one,
        which moves them least (0 at a parallel singularity), and the motion of the tool by those
        rates, of size one, which move it least (0 at a serial one).

        Parameters
        ----------
        length : (...), optional
            m, as in `condition`.
        """
        first, last = self._extremes(self.inverse, self._length(length))
        still = self.serial | (last <= SINGULAR * first)
        result = np.minimum(np.minimum(last, 1.0 / np.maximum(first, 1.0)), 1.0)
        return self._where_singular(np.where(still, 0.0, result), 0.0)

    def determinant(self) -> Array:
        """Determinant of the inverse Jacobian of a machine with six drives, (...).

        Infinite at a serial (type 1) singularity, zero at a parallel (type 2) one.

        Raises
        ------
        ModelError
            The machine has not six drives.
        """
        if len(self.driven) != 6:
            raise ModelError(
                "Jacobian determinant",
                f"the machine has {len(self.driven)} drives, not six.",
                "Use `condition` instead.",
            )
        finite = np.where(self.serial[..., None, None], np.eye(6), self.inverse)
        return np.where(self.serial, np.inf, np.linalg.det(finite))

    def _length(self, length: ArrayLike | None) -> Array:
        chosen = self.length if length is None else np.asarray(length, dtype=float)
        return np.broadcast_to(chosen, np.shape(self.length))

    def _where_singular(self, values: Array, value: float) -> Array:
        """`value` at the parallel singularities that were found by rank."""
        result = np.array(values)
        if self.spaces is not None and self.by_rank is not None:
            ranked = result[self.by_rank]
            result[self.by_rank] = np.where(self.spaces.parallel, value, ranked)
        return result

    def _values(self, inverse: Array, length: Array) -> tuple[Array, Mask]:
        """Largest over least singular value over the tool's motions, and where that is endless."""
        first, last = self._extremes(inverse, length)
        endless = last <= SINGULAR * first
        return np.where(endless, np.inf, first / np.where(endless, 1.0, last)), endless

    def _extremes(self, inverse: Array, length: Array) -> tuple[Array, Array]:
        """Largest and least singular value over the tool's motions, infinite entries left out."""
        scaled = _scaled(inverse, self.driven, length)
        if self.motions is None or self.rank is None:
            scaled[self.serial] = 0.0
            values = singular_values(scaled)
            few = values.shape[-1] < 6
            return values[..., 0], np.zeros(values.shape[:-1]) if few else values[..., 5]
        basis = np.array(self.motions)
        basis[..., 3:, :] *= length[..., None, None]
        left, _, _ = np.linalg.svd(basis)
        basis = left * (np.arange(6) < self.rank[..., None])[..., None, :]
        safe = np.where(np.isfinite(scaled), scaled, 0.0)
        values = np.linalg.svd(safe @ basis, compute_uv=False)
        padded = np.concatenate([values, np.zeros((*values.shape[:-1], 6))], axis=-1)
        index = np.maximum(self.rank - 1, 0)[..., None]
        return values[..., 0], np.take_along_axis(padded, index, axis=-1)[..., 0]


def jacobians(
    linkage: Linkage, placement: Placement, method: Literal["legs", "rows"] | None = None
) -> Jacobians:
    """Inverse and forward Jacobian at a batch of poses.

    The rows of the passive joints give the twist of every body as a function of the tool's;
    the rows of the driven directions then read their rates. Where legs hang between the ground
    and the tool's body, each a chain that lets the tool move in six ways, that is done leg by
    leg in compiled code. A machine whose passive rows do not fix the other bodies (a strut that
    spins) or allow less than six tool freedoms, and a pose near a serial singularity, is
    treated through the null space of its passive rows.

    Parameters
    ----------
    linkage : Linkage
        With a tool and at least one driven direction.
    placement : Placement
    method : "legs" or "rows", optional
        Leg by leg, or by all rows of the linkage. Default: by legs where it has such.

    Returns
    -------
    Jacobians

    Raises
    ------
    ModelError
        No tool, a tool on the ground, no driven direction, or legs asked for that are none.
    """
    tool_body = linkage.tool_body
    driven_mask = linkage.driven_mask()
    if tool_body < 0 or not driven_mask.any():
        raise ModelError(
            "linkage",
            "the tool is on the ground." if tool_body < 0 else "has no driven direction.",
            "Jacobians need a moving tool and at least one driven direction.",
        )
    batch = placement.batch
    flat = placement[None] if batch == () else placement
    if len(flat.batch) > 1:
        count = int(np.prod(batch, dtype=int))
        flat = Placement(
            placement.positions.reshape(count, *placement.positions.shape[-2:]),
            placement.frames.reshape(count, *placement.frames.shape[-3:]),
            np.zeros((count, 0)),
        )
    found = None if method == "rows" else legs_compiled(linkage, flat)
    if found is None and method == "legs":
        raise ModelError(
            "linkage",
            "does not split into legs that each let the tool move in six directions.",
            'Choose method = "rows".',
        )
    if found is None:
        length = characteristic_lengths(flat)
        inverse, doubtful = _by_elimination(linkage, flat, driven_mask, tool_body)
    else:
        inverse, length, doubtful = found
    result = _with_doubtful(linkage, flat, inverse, length, doubtful)
    return _shaped(result, batch)


def _with_doubtful(
    linkage: Linkage, placement: Placement, inverse: Array, length: Array, doubtful: Mask
) -> Jacobians:
    """Poses that were not eliminated, through the null space of their rows."""
    serial = np.zeros(len(inverse), dtype=bool)
    if not doubtful.any():
        return Jacobians(inverse, linkage.driven, length, serial)
    spaces = motion_spaces(linkage, placement[doubtful], length[doubtful])
    inverse[doubtful] = spaces.inverse
    serial[doubtful] = spaces.serial
    motions = np.zeros((len(inverse), 6, 6))
    motions[:] = np.eye(6)
    motions[doubtful] = spaces.motions
    rank = np.full(len(inverse), 6)
    rank[doubtful] = spaces.rank
    if np.all(rank == 6):
        return Jacobians(inverse, linkage.driven, length, serial, spaces=spaces, by_rank=doubtful)
    return Jacobians(inverse, linkage.driven, length, serial, motions, rank, spaces, doubtful)


def _shaped(found: Jacobians, batch: tuple[int, ...]) -> Jacobians:
    """The same with its batch axes."""
    if len(batch) == 1:
        return found

    def shaped(array: Array | None) -> Any:
        return None if array is None else array.reshape((*batch, *array.shape[1:]))

    return Jacobians(
        shaped(found.inverse),
        found.driven,
        shaped(found.length),
        shaped(found.serial),
        shaped(found.motions),
        shaped(found.rank),
        found.spaces,
        shaped(found.by_rank),
    )


def _scaled(inverse: Array, driven: tuple[tuple[str, str], ...], length: Array) -> Array:
    """The inverse Jacobian with angles of tool and drives multiplied by a length."""
    rotary = np.array([direction.startswith("r") for _, direction in driven])
    scaled = np.array(inverse, dtype=float)
    scaled[..., 3:] /= length[..., None, None]
    scaled[..., rotary, :] *= length[..., None, None]
    return scaled


def _by_elimination(
    linkage: Linkage, placement: Placement, driven_mask: Mask, tool_body: int
) -> tuple[Array, Mask]:
    """Solve for the other bodies' twists, and where they are not determined one by one."""
    passive = constraint_rows(
        linkage, placement, linkage.elastic_or_locked() & ~driven_mask
    ).on_bodies()
    driven = constraint_rows(linkage, placement, driven_mask).on_bodies()
    columns = np.arange(6 * tool_body, 6 * tool_body + 6)
    others = np.setdiff1d(np.arange(passive.shape[-1]), columns)
    inner = passive[..., others]
    none = np.zeros((*driven.shape[:-1], 6))
    everywhere = np.ones(len(none), dtype=bool)
    if inner.shape[-1] != inner.shape[-2]:
        return none, everywhere
    try:
        carried = -np.linalg.solve(inner, passive[..., columns])
    except np.linalg.LinAlgError:
        return none, everywhere
    fastest = np.abs(carried).max(axis=(-2, -1), initial=0.0)
    doubtful = ~(fastest < FASTEST)
    rates = driven[..., columns] + driven[..., others] @ carried
    return np.where(doubtful[..., None, None], 0.0, rates), doubtful
