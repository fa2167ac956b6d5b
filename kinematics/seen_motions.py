"""Motions of tool and drives by elimination: many times faster than a full decomposition."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.joint_motion import JointMotion
from strutwork.kinematics.leg_jacobians import legs_compiled
from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.rows import body_references
from strutwork.kinematics.singular_values import compiled
from strutwork.kinematics.tool_drive_space import (
    Freedoms,
    check_driven,
    drive_matrix,
    passive_matrix,
    tool_drive_space,
)

Array = NDArray[Any]
Mask = NDArray[np.bool_]

#: Motions larger than this for one of unit size are found from a full decomposition instead.
LARGEST = 1e5
#: What motions leave of rows that were not solved for, as a share of the motions.
LEFT = 1e-9
#: Poses that are solved at once: what they take stays near the processor.
PIECE = 128


@dataclass(frozen=True, eq=False)
class SeenMotions:
    """What tool and drives do in the motions that passive joints allow, pose by pose.

    Beside the passive rows that are independent at one pose stand as many rows as there are
    motions: those that tool and drives make at that pose, and those in which neither moves, which
    are held. At other poses the same square system is solved for one unit of each. Where legs hang
    between the ground and the tool's body, that is done leg by leg in compiled code. Poses at which
    this is nearly singular, or at which other rows contradict, are left to `tool_drive_space`.

    Parameters
    ----------
    linkage : Linkage
    home : Placement
        That pose.
    length : float
        L, m.
    known : Freedoms
    rows : (rank,) of int
        Passive rows that are independent.
    others : (k,) of int
        Passive rows that depend on them.
    made : (f, 6 + a)
        Motions of tool and drives at that pose, (v, L ω) and m/s or L rad/s.
    idle : (i, 6 b)
        Motions of bodies in which neither moves there, m/s and rad/s of any size.
    """

    linkage: Linkage
    home: Placement
    length: float
    known: Freedoms
    rows: NDArray[np.intp]
    others: NDArray[np.intp]
    made: Array
    idle: Array

    @classmethod
    def at(cls, linkage: Linkage, placement: Placement) -> SeenMotions:
        """Set up at one pose, at which the machine is not singular.

        Parameters
        ----------
        linkage : Linkage
            With a tool that moves and drives.
        placement : Placement
            One pose, without batch axes.

        Raises
        ------
        ModelError
            As `tool_drive_space`.
        """
        check_driven(linkage)
        one = placement[None]
        space = tool_drive_space(linkage, one)
        passive = passive_matrix(linkage, one, space.length)[0]
        rank = space.known.rank
        order = scipy.linalg.qr(passive.T, mode="r", pivoting=True)[1]
        _, _, right = np.linalg.svd(passive)
        null = right[rank:].T
        seen = _seen(linkage, one, space.length)[0] @ null
        _, _, turned = np.linalg.svd(seen)
        idle = null @ turned[space.known.freedoms :].T
        return cls(
            linkage,
            placement,
            space.length,
            space.known,
            np.sort(order[:rank]),
            np.sort(order[rank:]),
            space.basis[0].T,
            idle.T,
        )

    def __repr__(self) -> str:
        return f"<SeenMotions: {self.known.freedoms} freedoms, L = {1e3 * self.length:.4g} mm>"

    def of(self, placement: Placement) -> tuple[Array, Array]:
        """Independent motions of tool and drives, (p, 6, f) and (p, a, f).

        Parameters
        ----------
        placement : Placement
            (p) poses.
        """
        found, doubtful = (
            self._by_legs(placement) or self._compiled(placement) or self._by_rows(placement)
        )
        if doubtful.any():
            found[doubtful] = tool_drive_space(
                self.linkage, placement[doubtful], self.length, self.known
            ).basis
        return found[:, :6], found[:, 6:]

    def _by_legs(self, placement: Placement) -> tuple[Array, Mask] | None:
        known = self.known
        # with more drives than freedoms legs give the least rates, one motion of many
        if not known.freedoms == known.tool == len(self.linkage.driven) == 6:
            return None
        legs = legs_compiled(self.linkage, placement)
        if legs is None:
            return None
        inverse, _, doubtful = legs
        turning = np.array([d.startswith("r") for _, d in self.linkage.driven])
        inverse[..., 3:] /= self.length
        inverse[:, turning] *= self.length
        doubtful = doubtful | ~(np.abs(inverse).max(axis=(1, 2)) < LARGEST)
        unit = np.broadcast_to(np.eye(6), inverse.shape)
        return np.concatenate([unit, inverse], axis=1), doubtful

    @cached_property
    def _systems(self) -> tuple[Any, Any, tuple[Array, ...]] | None:
        """The linkage as arrays, the same of its drives, and what is solved for; None without."""
        if not compiled() or self.linkage.ties:
            return None
        from strutwork.kinematics.row_kernel import row_system  # noqa: PLC0415 - numba is slow to import

        try:
            system = row_system(JointMotion(self.linkage, self.home), self.length)
        except ModelError:
            # a node that slides in two joints has no finite motion, but has rows
            return None
        joint, direction = (k.astype(np.int64) for k in np.nonzero(self.linkage.driven_mask()))
        idle = np.zeros_like(self.idle)
        columns = (system.column[:, None] + np.arange(6)).ravel()
        idle[:, columns] = self.idle
        rows, others = self.rows.astype(np.int64), self.others.astype(np.int64)
        wanted = (rows, others, np.ascontiguousarray(self.made), idle)
        return system, system._replace(joint=joint, direction=direction), wanted

    def _compiled(self, placement: Placement) -> tuple[Array, Mask] | None:
        if self._systems is None or np.iscomplexobj(placement.positions):
            return None
        from strutwork.kinematics.seen_kernel import solve_seen  # noqa: PLC0415 - as above

        count = placement.batch[0]
        found = np.zeros((count, self.made.shape[1], self.known.freedoms))
        large, left = np.empty(count), np.empty(count)
        solve_seen(
            *self._systems,
            np.ascontiguousarray(placement.positions),
            np.ascontiguousarray(placement.frames),
            np.ascontiguousarray(body_references(self.linkage, placement)),
            (found, large, left),
        )
        return found, ~((large < LARGEST) & (left <= LEFT * large))

    def _by_rows(self, placement: Placement) -> tuple[Array, Mask]:
        count = placement.batch[0]
        found = np.zeros((count, self.made.shape[1], self.known.freedoms))
        doubtful = np.zeros(count, dtype=bool)
        for first in range(0, count, PIECE):
            piece = slice(first, first + PIECE)
            found[piece], doubtful[piece] = self._solved(placement[piece])
        return found, doubtful

    def _solved(self, placement: Placement) -> tuple[Array, Mask]:
        passive = passive_matrix(self.linkage, placement, self.length)
        seen = _seen(self.linkage, placement, self.length)
        count, _, size = passive.shape
        idle = np.broadcast_to(self.idle, (count, *self.idle.shape))
        square = np.concatenate([passive[:, self.rows], self.made @ seen, idle], axis=1)
        right = np.zeros((count, size, self.known.freedoms))
        right[:, self.known.rank + np.arange(self.known.freedoms), :] = np.eye(self.known.freedoms)
        try:
            motions = np.linalg.solve(square, right)
        except np.linalg.LinAlgError:
            return np.zeros((count, *self.made.T.shape)), np.ones(count, dtype=bool)
        large = np.abs(motions).max(axis=(1, 2))
        left = np.abs(passive[:, self.others] @ motions).max(axis=(1, 2), initial=0.0)
        return seen @ motions, ~((large < LARGEST) & (left <= LEFT * large))


def _seen(linkage: Linkage, placement: Placement, length: float) -> Array:
    """What tool and drives do by (v, L ω) of all bodies, (p, 6 + a, 6 b)."""
    drives = drive_matrix(linkage, placement, length)
    tool = np.zeros((len(drives), 6, drives.shape[-1]))
    tool[:, :, 6 * linkage.tool_body : 6 * linkage.tool_body + 6] = np.eye(6)
    return np.concatenate([tool, drives], axis=1)
