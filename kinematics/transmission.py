"""Ellipsoids of velocity, force and error at the tool, translation and rotation apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.motion_spaces import null_space
from strutwork.kinematics.singular_values import singular_values
from strutwork.kinematics.tool_drive_space import ToolDriveSpace

Array = NDArray[Any]

#: Which part of the tool's twist or wrench is asked for.
ToolPart = Literal["translation", "rotation", "all"]

#: What the other part does: whatever it must, or nothing.
Others = Literal["free", "blocked"]

#: Sine of the angle to a motion of the tool at held drives, or cosine to one of drives alone,
#: below which it is one.
SINGULAR = 1e-12

#: Motions of tool and drives for rates of one below which drives are inverted as they are.
REGULAR = 1e6

_SLICES = {"translation": slice(0, 3), "rotation": slice(3, 6), "all": slice(0, 6)}


@dataclass(frozen=True)
class Ellipsoids:
    """Effect of drives of unit norm at the tool.

    Parameters
    ----------
    semi_axes : (..., k)
        Largest first, in units of the tool's part for one of the drives'; infinite and zero at
        singularities, zero also in directions that the machine never has.
    directions : (..., k, k)
        Their unit vectors as columns; with "all", of (v, L ω) or (f, m / L).
    used : int
        How many of the axes the machine has at poses that are not singular: the others do not
        count in `smallest` and `isotropy`.
    """

    semi_axes: Array
    directions: Array
    used: int

    def __repr__(self) -> str:
        return f"<Ellipsoids: {self.used} axes, batch {self.semi_axes.shape[:-1]}>"

    @property
    def largest(self) -> Array:
        """Largest semi-axis: the amplification, (...)."""
        return np.asarray(self.semi_axes[..., 0])

    @property
    def smallest(self) -> Array:
        """Smallest semi-axis of those that the machine has, (...)."""
        return np.asarray(self.semi_axes[..., self.used - 1])

    @property
    def isotropy(self) -> Array:
        """Smallest over largest, 1 for a ball and 0 at every singularity, (...)."""
        endless = ~np.isfinite(self.largest) | (self.smallest == 0.0)
        ratio = self.smallest / np.where(endless, 1.0, self.largest)
        return np.where(endless, 0.0, ratio)


def velocity_ellipsoids(
    space: ToolDriveSpace,
    part: ToolPart = "translation",
    others: Others = "free",
    weights: Sequence[float] | None = None,
) -> Ellipsoids:
    """Velocities of the tool for drive rates whose weighted squares add up to one.

    Also error ellipsoids: for small errors of the drives the same holds.

    Parameters
    ----------
    space : ToolDriveSpace
    part : "translation", "rotation" or "all"
        m/s, rad/s, or both as (v, L ω).
    others : "free" or "blocked"
        What the rest of the twist does: whatever comes with the part (the ellipsoid's projection,
        a Schur complement of its matrix), or nothing (its section).
    weights : sequence of float, optional
        Rate of each drive that counts as one, m/s or rad/s. Default: 1 m/s, and 1/L rad/s.

    Returns
    -------
    Ellipsoids

    Raises
    ------
    ModelError
        Weights that are not positive or not one per drive.
    """
    tool, drives = _parts(space, weights)
    return _ellipsoids(space.length, part, others, tool, drives)


def amplifications(tool: Array, drives: Array, used: int) -> Array:
    """Least and largest translation of the tool for drive rates of size one together, (p, 2).

    The semi-axes `smallest` and `largest` of `velocity_ellipsoids`, from any independent motions
    and without the ellipsoids' directions, which takes a fraction of the time.

    Parameters
    ----------
    tool : (p, 6, f)
        (v, L ω), m/s.
    drives : (p, a, f)
        m/s and L rad/s.
    used : int
        As `Ellipsoids.used`.
    """
    found = np.zeros((len(tool), 2))
    square = drives.shape[1] == drives.shape[2]
    try:
        per_rate = np.linalg.inv(drives if square else np.linalg.qr(drives, mode="r"))
    except np.linalg.LinAlgError:
        regular = np.zeros(len(tool), dtype=bool)
    else:
        moved = tool @ per_rate
        # rates are of size one, whatever the columns are
        regular = np.abs(moved).max(axis=(1, 2), initial=0.0) < REGULAR
        wide = moved[:, :3] if moved.shape[2] < 3 else np.swapaxes(moved[:, :3], 1, 2)
        values = singular_values(np.where(regular[:, None, None], wide, 0.0))
        found[:, 0], found[:, 1] = values[:, used - 1], values[:, 0]
    if not regular.all():
        basis, _ = np.linalg.qr(np.concatenate([tool[~regular], drives[~regular]], axis=1))
        axes = _ellipsoids(1.0, "translation", "free", basis[:, :6], basis[:, 6:]).semi_axes
        found[~regular] = np.stack([axes[:, used - 1], axes[:, 0]], axis=-1)
    return found


def force_ellipsoids(
    space: ToolDriveSpace,
    part: ToolPart = "translation",
    others: Others = "free",
    weights: Sequence[float] | None = None,
) -> Ellipsoids:
    """Forces that the tool can carry for drive forces whose weighted squares add up to one.

    By the principle of virtual power they are the reciprocals of the velocity ellipsoids. A
    machine with less freedoms than six bears the rest by its joints: such directions have no
    axis here.

    Parameters
    ----------
    space : ToolDriveSpace
    part : "translation", "rotation" or "all"
        N, N·m, or both as (f, m / L).
    others : "free" or "blocked"
        Where the rest of the tool is free, no such load acts; where it is blocked, whatever load
        comes with the part is borne elsewhere.
    weights : sequence of float, optional
        Force or moment of each drive that counts as one, N or N·m. Default: 1 N, and L N·m.

    Returns
    -------
    Ellipsoids

    Raises
    ------
    ModelError
        As `velocity_ellipsoids`.
    """
    count = len(space.driven)
    rates = None if weights is None else [1.0 / w for w in _checked(weights, count)]
    found = velocity_ellipsoids(space, part, others, rates)
    used = found.semi_axes[..., : found.used]
    with np.errstate(divide="ignore"):
        turned = np.where(np.isinf(used), 0.0, 1.0 / used)[..., ::-1]
    axes = np.concatenate([turned, found.semi_axes[..., found.used :]], axis=-1)
    directions = np.concatenate(
        [found.directions[..., found.used - 1 :: -1], found.directions[..., found.used :]], axis=-1
    )
    return Ellipsoids(axes, directions, found.used)


def _checked(weights: Sequence[float], count: int) -> Array:
    found = np.asarray(weights, dtype=float)
    if found.shape != (count,) or not np.all(np.isfinite(found) & (found > 0.0)):
        raise ModelError(
            "drives", f"have the weights {weights!r}.", f"Give {count} positive numbers."
        )
    return found


def _parts(space: ToolDriveSpace, weights: Sequence[float] | None) -> tuple[Array, Array]:
    """The tool's part of the motions, and the drives' over their weights."""
    if weights is None:
        return space.tool, space.drives
    turning = np.array([direction.startswith("r") for _, direction in space.driven])
    # rates in the space are L times those of drives that turn
    size = _checked(weights, len(space.driven)) * np.where(turning, space.length, 1.0)
    return space.tool, space.drives / size[:, None]


def _ellipsoids(
    length: float, part: ToolPart, others: Others, tool: Array, drives: Array
) -> Ellipsoids:
    if part not in _SLICES or others not in ("free", "blocked"):
        raise ModelError(
            "ellipsoid",
            f"of {part!r} with others {others!r}.",
            'Choose "translation", "rotation" or "all", and "free" or "blocked".',
        )
    own = _SLICES[part]
    unit = 1.0 / length if part == "rotation" else 1.0
    if others == "blocked" and part != "all":
        rest = tool[:, 3:] if part == "translation" else tool[:, :3]
        # motions whose other part is none; columns beyond their number are zero
        still = null_space(rest, np.full(len(rest), SINGULAR))
        tool, drives = tool @ still, drives @ still
    _, values, right = np.linalg.svd(drives)
    count = right.shape[-1]
    values = np.concatenate([values, np.zeros((len(values), count))], axis=1)[:, :count]
    motions = tool[:, own] @ np.swapaxes(right, -1, -2)
    moving = np.linalg.norm(motions, axis=1) > SINGULAR
    scale = np.maximum(values[:, :1], np.finfo(float).tiny)
    loose = values <= SINGULAR * scale
    endless = motions * (loose & moving)[:, None, :]
    made = motions / np.where(loose, np.inf, values)[:, None, :]
    axes, directions = _axes(unit * made, endless)
    return Ellipsoids(axes, directions, _used(axes))


def _axes(made: Array, endless: Array) -> tuple[Array, Array]:
    """Semi-axes of an ellipsoid and the directions in which it has no end, first."""
    left, values, _ = np.linalg.svd(endless)
    size = made.shape[1]
    values = np.concatenate([values, np.zeros((len(values), size))], axis=1)[:, :size]
    free = values > SINGULAR
    first = left * free[:, None, :]
    rest = made - first @ (np.swapaxes(first, -1, -2) @ made)
    u, s, _ = np.linalg.svd(rest)
    s = np.concatenate([s, np.zeros((len(s), size))], axis=1)[:, :size]
    # endless ones take the places of the last axes, which are zero in what is left
    order = np.argsort(
        np.concatenate([np.where(free, -np.inf, np.inf), -s], axis=1), axis=1, kind="stable"
    )[:, :size]
    both = np.concatenate([left, u], axis=2)
    lengths = np.concatenate([np.where(free, np.inf, 0.0), s], axis=1)
    s = np.take_along_axis(lengths, order, axis=1)
    directions = np.take_along_axis(both, order[:, None, :], axis=2)
    tiny = s <= SINGULAR * np.where(np.isfinite(s), s, 0.0).max(axis=1, keepdims=True)
    return np.where(tiny, 0.0, s), directions


def _used(axes: Array) -> int:
    return int((axes > 0.0).sum(axis=1).max(initial=1))
