"""Velocity Jacobians of a mechanism, from its constraint rows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage import Linkage
from kinematics.placement import Placement
from kinematics.rows import constraint_rows
from strutwork.errors import ModelError

Array = NDArray[Any]


@dataclass(frozen=True)
class Jacobians:
    """Relations between the twist of the tool and the rates of the drives.

    Parameters
    ----------
    inverse : (..., a, 6)
        Rate of each driven direction per unit tool twist (translation then rotation).
    forward : (..., 6, a)
        Tool twist per unit rate; the pseudo-inverse of `inverse`.
    driven : tuple of (joint name, direction)
        Order of the rates, m/s or rad/s.
    """

    inverse: Array
    forward: Array
    driven: tuple[tuple[str, str], ...]

    def __repr__(self) -> str:
        return f"<Jacobians: {len(self.driven)} drives, batch {self.inverse.shape[:-2]}>"

    def condition(self, length: float) -> Array:
        """Condition number of the inverse Jacobian with angles multiplied by `length`, (...).

        Translations and rotations have different units: `length`, m, says how much translation
        counts as much as one radian, of the tool and of a rotary drive alike.
        """
        scaled = np.array(self.inverse, dtype=float)
        scaled[..., 3:] /= length
        rotary = [direction.startswith("r") for _, direction in self.driven]
        scaled[..., rotary, :] *= length
        values = np.linalg.svd(scaled, compute_uv=False)
        with np.errstate(divide="ignore"):
            return np.asarray(values[..., 0] / values[..., -1])

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
        return np.asarray(np.linalg.det(self.inverse))


def jacobians(linkage: Linkage, placement: Placement) -> Jacobians:
    """Inverse and forward Jacobian at a batch of poses.

    The rows of the passive joints give the twist of every body as a function of the tool's;
    the rows of the driven directions then read their rates. A machine whose passive rows do
    not fix the other bodies (a strut that spins) or allow less than six tool freedoms is
    treated through the null space of its passive rows.

    Parameters
    ----------
    linkage : Linkage
        With a tool and at least one driven direction.
    placement : Placement

    Returns
    -------
    Jacobians

    Raises
    ------
    ModelError
        No tool, a tool on the ground, or no driven direction.
    """
    if linkage.tool is None:
        raise ModelError("linkage", "has no tool.", "Name the tool centre point's node.")
    tool_body = int(linkage.body_of_node[linkage.node_index[linkage.tool]])
    driven_mask = linkage.driven_mask()
    if tool_body < 0 or not driven_mask.any():
        raise ModelError(
            "linkage",
            "the tool stands on the ground." if tool_body < 0 else "has no driven direction.",
            "Jacobians need a moving tool and at least one driven direction.",
        )
    passive = constraint_rows(
        linkage, placement, linkage.elastic_or_locked() & ~driven_mask
    ).on_bodies()
    driven = constraint_rows(linkage, placement, driven_mask).on_bodies()
    columns = np.arange(6 * tool_body, 6 * tool_body + 6)
    others = np.setdiff1d(np.arange(passive.shape[-1]), columns)
    inverse = _by_elimination(passive, driven, columns, others)
    if inverse is None:
        inverse = _by_null_space(passive, driven, columns)
    return Jacobians(inverse, np.linalg.pinv(inverse, rcond=1e-12), linkage.driven)


def _by_elimination(
    passive: Array, driven: Array, columns: NDArray[np.intp], others: NDArray[np.intp]
) -> Array | None:
    """Solve for the other bodies' twists; None where they are not determined one by one."""
    inner = passive[..., others]
    if inner.shape[-1] != inner.shape[-2]:
        return None
    try:
        carried = -np.linalg.solve(inner, passive[..., columns])
    except np.linalg.LinAlgError:
        return None
    if not np.all(np.isfinite(carried)) or np.abs(carried).max(initial=0.0) > 1e8:
        return None
    return np.asarray(driven[..., columns] + driven[..., others] @ carried)


def _by_null_space(passive: Array, driven: Array, columns: NDArray[np.intp]) -> Array:
    _, values, right = np.linalg.svd(passive)
    count = values.shape[-1]
    keep = np.zeros(right.shape[:-1], dtype=bool)
    keep[..., :count] = values > 1e-10 * values[..., :1]
    # rows of `right` that span the passive rows are blanked instead of cut, so that poses of
    # different rank stay one stack
    null = np.swapaxes(np.where(keep[..., None], 0.0, right), -1, -2)
    tool = null[..., columns, :]
    rates = driven @ null
    return np.asarray(rates @ np.linalg.pinv(tool, rcond=1e-10))
