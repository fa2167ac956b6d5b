"""All assembly modes of a platform on three balls: every pose that its held drives allow."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.circle_kernel import ROOTS, circle_ways
from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.mechanism import Poses
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.platform_circles import PlatformCircles, platform_circles

Array = NDArray[Any]

#: A pose is a mode where its turn, and its shift of the platform's size, differ by less: what two
#: tolerant iterations leave, and far less than what parts two modes.
SAME = 1e-6


@dataclass(frozen=True)
class AssemblyModes:
    """Assembly modes of a machine with its drives held, real ones first.

    Parameters
    ----------
    circles : PlatformCircles
    angles : (..., 16, 3) complex
        φ of every way on the three circles, from where the machine stands, rad; not a number
        past the last way. Complex ways come in conjugate pairs and are no poses.
    real : (...) of int
        How many are poses.
    count : (...) of int
        How many there are, 16 in general; fewer where ways coincide. −1 where some may
        be missing.
    home : (...) of int
        Which of the real ones the machine stands in; −1 where that is unknown.
    position, rotation : (..., 16, 3) and (..., 16, 3, 3)
        Of the tool in the real ones, m; not a number past the last of them.
    """

    circles: PlatformCircles
    angles: Array
    real: NDArray[np.intp]
    count: NDArray[np.intp]
    home: NDArray[np.intp]
    position: Array
    rotation: Array

    def __repr__(self) -> str:
        shown = f"{int(self.real)} modes" if self.real.ndim == 0 else f"{self.real.size} poses"
        return f"<AssemblyModes: {shown}, of {ROOTS} ways>"

    @cached_property
    def points(self) -> Array:
        """The balls in the real ways, (..., 16, 3, 3), m; not a number past the last of them."""
        angle = self.angles.real[..., None]
        circles = self.circles
        found = circles.centre[..., None, :, :] + circles.radius[..., None, :, None] * (
            np.cos(angle) * circles.first[..., None, :, :]
            + np.sin(angle) * circles.second[..., None, :, :]
        )
        beyond = np.arange(ROOTS) >= self.real[..., None]
        return np.where(beyond[..., None, None], np.nan, found)

    @property
    def apart(self) -> Array:
        """Largest turn of a leg from where the machine stands to the nearest other mode, (...).

        Rad; infinite where there is no other.
        """
        turns = np.abs(np.angle(np.exp(1j * self.angles.real))).max(axis=-1)
        index = np.arange(ROOTS)
        out = (index >= self.real[..., None]) | (index == self.home[..., None])
        return np.asarray(np.where(out, np.inf, turns).min(axis=-1))

    def poses(self, index: int | tuple[int, ...] = ()) -> Poses:
        """The tool in all modes of one pose of the batch, (m).

        Parameters
        ----------
        index : int or tuple of int
            Of a pose in the batch; () for a single one.
        """
        count = int(self.real[index])
        return Poses(self.position[index][:count], self.rotation[index][:count])

    def which(self, tool: Poses) -> NDArray[np.intp]:
        """Say in which mode the tool stands, for a pose of each of the batch, (...).

        Parameters
        ----------
        tool : Poses
            (...); as forward kinematics gives it at the same drives.

        Returns
        -------
        (...) of int
            Index among the real modes; −1 where the tool stands in none of them, so that its
            drives are not those of the modes, or where it is not a number.
        """
        shift = np.linalg.norm(self.position - tool.position[..., None, :], axis=-1)
        size = self.circles.distances.max(axis=-1)
        turn = np.linalg.norm(self.rotation - tool.rotation[..., None, :, :], axis=(-1, -2))
        apart = shift / size[..., None] + turn
        apart = np.where(np.isfinite(apart), apart, np.inf)
        near = apart.argmin(axis=-1)
        close = np.take_along_axis(apart, near[..., None], axis=-1)[..., 0] < SAME
        return np.asarray(np.where(close, near, -1))


def assembly_modes(
    linkage: Linkage, placement: Placement, rotation: Array | None = None
) -> AssemblyModes:
    """Find every assembly mode at the drives of a batch of poses.

    Parameters
    ----------
    linkage : Linkage
        Its tool's body hangs on three balls that run on circles once the drives stand, see
        `platform_circles`.
    placement : Placement
        Reachable poses, any batch axes.
    rotation : (..., 3, 3), optional
        Rotation matrices of the tool at these poses; default none, the tool as at home.

    Returns
    -------
    AssemblyModes

    Raises
    ------
    ModelError
        The balls run on no circles; says which joint and why.
    UnreachableError
        A pose that cannot be taken.
    """
    placement.require_reachable()
    found = platform_circles(linkage, placement)
    if isinstance(found, str):
        raise ModelError(
            "assembly modes",
            f"cannot be found all at once: {found}.",
            "Search for some from several starts: strutwork.kinematics.branches.",
        )
    batch = placement.batch
    count = int(np.prod(batch, dtype=int))

    rows = (found.centre, found.first, found.second, found.radius, found.distances)
    circles = np.concatenate([r.reshape(count, -1, 3) for r in rows], axis=1)
    ways = np.full((count, ROOTS, 3), np.nan, dtype=complex)
    real, whole = np.zeros(count, dtype=np.intp), np.zeros(count, dtype=np.intp)
    circle_ways(np.ascontiguousarray(circles, dtype=float), ways, real, whole, np.zeros(count))
    angles = (-1j * np.log(ways)).reshape(*batch, ROOTS, 3)
    real = real.reshape(batch)
    known = np.arange(ROOTS) < real[..., None]
    near = np.where(known, np.abs(np.angle(np.exp(1j * angles.real))).max(axis=-1), np.inf)
    partial = AssemblyModes(
        found,
        angles,
        real,
        whole.reshape(batch),
        np.asarray(np.where(near.min(axis=-1) < SAME, near.argmin(axis=-1), -1)),
        np.zeros(0),
        np.zeros(0),
    )
    position, turned = _tool(linkage, placement, rotation, partial)
    return AssemblyModes(found, angles, real, partial.count, partial.home, position, turned)


def _tool(
    linkage: Linkage, placement: Placement, rotation: Array | None, modes: AssemblyModes
) -> tuple[Array, Array]:
    """The tool in every real mode: it keeps its place among the balls."""
    here = _triad(modes.circles.points)
    there = _triad(modes.points)
    turn = there @ np.swapaxes(here, -1, -2)[..., None, :, :]
    tool = placement.positions[..., linkage.node_index[linkage.tool or ""], :]
    arm = tool - modes.circles.points[..., 0, :]
    position = modes.points[..., 0, :] + np.einsum("...mij,...j->...mi", turn, arm)
    given = np.eye(3) if rotation is None else np.asarray(rotation)
    return position, turn @ given[..., None, :, :]


def _triad(points: Array) -> Array:
    """Axes of three points as columns, (..., 3, 3) from rows of points."""
    first = points[..., 1, :] - points[..., 0, :]
    first = first / np.linalg.norm(first, axis=-1, keepdims=True)
    normal = np.cross(first, points[..., 2, :] - points[..., 0, :])
    normal = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    return np.stack([first, np.cross(normal, first), normal], axis=-1)
