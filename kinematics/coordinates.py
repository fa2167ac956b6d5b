"""Coordinates that describe a motion: directions of the tool and of joints, as many as it has."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.given import given
from strutwork.kinematics.independent import independent_rows
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.rows import constraint_rows

Array = NDArray[Any]

#: Joint, empty for the tool, and direction.
Name = tuple[str, str]


@dataclass(frozen=True)
class Coordinates:
    """Coordinates that move, in their order: those of the tool, then those of joints.

    Parameters
    ----------
    tool : tuple of directions
        x, y, z of the tool centre point and components rx, ry, rz of its rotation vector from
        home.
    joints : tuple of (joint, direction)
    """

    tool: tuple[str, ...] = ()
    joints: tuple[Name, ...] = ()

    def __len__(self) -> int:
        return len(self.tool) + len(self.joints)

    @property
    def names(self) -> tuple[Name, ...]:
        """Joint, empty for the tool, and direction of each."""
        return (*(("", direction) for direction in self.tool), *self.joints)

    @property
    def rotary(self) -> NDArray[np.bool_]:
        """True for a turn, (t,)."""
        return np.array([direction.startswith("r") for _, direction in self.names], dtype=bool)

    @property
    def labels(self) -> tuple[str, ...]:
        """`x`, or `ram1:z` of a joint."""
        return tuple(f"{joint}:{d}" if joint else d for joint, d in self.names)


def completed(
    motion: Motion, asked: Coordinates, task: tuple[str, ...] = ()
) -> tuple[Coordinates, dict[Name, float]]:
    """Coordinates that describe all of a motion, and the values at home of those added.

    Other directions of the tool are held where they can be, then drives that they leave free:
    those of a machine with more drives than its tool has freedoms. Where only joint coordinates
    are asked for, the drives come first.

    Parameters
    ----------
    motion : Motion
    asked : Coordinates
    task : tuple of directions
        Of the tool, held before its others.

    Raises
    ------
    ModelError
        A direction or joint that does not exist or cannot move, or one that follows from the
        others.
    """
    _require_known(motion, asked)
    require_independent(motion, asked)
    home = dict(zip(motion.joints.names, motion.home_values, strict=True))
    drives = [pair for pair in motion.linkage.driven if pair in home]
    tool: list[Name] = []
    if motion.linkage.tool is not None:
        place = dict(zip(DIRECTIONS, motion.task_of(motion.home_pose), strict=True))
        home |= {("", d): value for d, value in place.items()}
        tool = [("", d) for d in dict.fromkeys((*task, *DIRECTIONS))]
    free = freedoms(motion)
    found, added = asked, {}
    for name in (*drives, *tool) if asked.joints and not asked.tool else (*tool, *drives):
        if len(found) == free:
            break
        if name in found.names:
            continue
        more = _with(found, name)
        if not dependent(motion, more):
            found, added[name] = more, float(home[name])
    return found, added


def _with(coordinates: Coordinates, name: Name) -> Coordinates:
    """One more, the tool's in the order of directions."""
    joint, direction = name
    if joint:
        return Coordinates(coordinates.tool, (*coordinates.joints, name))
    tool = {*coordinates.tool, direction}
    return Coordinates(tuple(d for d in DIRECTIONS if d in tool), coordinates.joints)


def freedoms(motion: Motion) -> int:
    """Freedoms of the bodies at home, those of bodies that only spin counted.

    Parameters
    ----------
    motion : Motion
        Counted with its drives free.
    """
    held, _ = home_rows(motion, Coordinates())
    return int(held.shape[1]) - len(independent_rows(held, len(held))[0])


def _require_known(motion: Motion, coordinates: Coordinates) -> None:
    """Refuse names that do not exist, in the words of a motion."""
    start = motion.home_pose if coordinates.tool else None
    zeros: dict[str, ArrayLike] = dict.fromkeys(coordinates.tool, 0.0)
    pairs: dict[Name, ArrayLike] = dict.fromkeys(coordinates.joints, 0.0)
    if zeros or pairs:
        given(motion.joints, start, motion.home_values, None, zeros or None, pairs or None)


def require_independent(motion: Motion, coordinates: Coordinates) -> None:
    """Refuse coordinates of which one follows from the others.

    Parameters
    ----------
    motion : Motion
        At its home.
    coordinates : Coordinates
        Of its tool and joints, in the order in which they may follow from each other.

    Raises
    ------
    ModelError
        Names it.
    """
    bad = dependent(motion, coordinates)
    if not bad:
        return
    joint, direction = coordinates.names[coordinates.labels.index(bad[0])]
    alone = Coordinates((), ((joint, direction),)) if joint else Coordinates((direction,))
    still = bool(dependent(motion, alone))
    raise ModelError(
        "motion",
        f"{bad[0]} cannot move from home: the joints hold it."
        if still
        else f"{bad[0]} follows from the other coordinates that are given at home.",
        "Leave it out." if still else "Omit it: it moves with them.",
    )


def dependent(motion: Motion, coordinates: Coordinates) -> list[str]:
    """Labels of coordinates that follow from those before them at home.

    Parameters
    ----------
    motion : Motion
        At its home.
    coordinates : Coordinates
        Of its tool and joints.
    """
    held, asked = home_rows(motion, coordinates)
    matrix = np.concatenate([held, asked])
    kept, _ = independent_rows(matrix, len(held))
    return [
        label
        for k, label in enumerate(coordinates.labels, start=len(held))
        if k not in set(kept.tolist())
    ]


def home_rows(motion: Motion, coordinates: Coordinates) -> tuple[Array, Array]:
    """Rows of held joint directions (r, 6 b) and of coordinates (t, 6 b) at home.

    About the bodies' references and in one unit: lengths over the machine's size L, on
    (v / L, ω) of the bodies.

    Parameters
    ----------
    motion : Motion
        With b moving bodies; gives rows of 6 b columns.
    coordinates : Coordinates
        One row each, in their order.
    """
    joints, linkage = motion.joints, motion.linkage
    length = motion.length
    bodies = joints.start(1)
    positions, frames, _ = joints.place(bodies)
    placement = Placement(positions, frames, np.zeros((1, 0)))
    unit = np.tile(np.repeat([length, 1.0], 3), len(linkage.body_names))

    def scaled(rows: Array, directions: Array) -> Array:
        over = np.where(directions < 3, 1.0 / length, 1.0)
        return np.asarray(rows * over[:, None] * unit)

    held = constraint_rows(linkage, placement, joints.held)
    first = scaled(held.on_bodies(bodies.position)[0], held.direction)
    asked = np.zeros((len(coordinates), first.shape[1]))
    turned = np.array([DIRECTIONS.index(d) for _, d in coordinates.names], dtype=int)
    for k, (joint, _) in enumerate(coordinates.names):
        if not joint:
            if linkage.tool_body >= 0:
                asked[k, 6 * linkage.tool_body + turned[k]] = 1.0
            continue
        select = np.zeros_like(joints.held)
        select[linkage.joint_index[joint], turned[k]] = True
        own = constraint_rows(linkage, placement, select, coupled=False)
        asked[k] = own.on_bodies(bodies.position)[0, 0]
    return first, scaled(asked, turned)
