"""Coordinates that describe a motion: directions of the tool and of joints, as many as it has."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
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


def completed(motion: Motion, asked: Coordinates) -> tuple[Coordinates, dict[Name, float]]:
    """Coordinates that describe all of a motion, and the values at home of those added.

    Other directions of the tool are held where they can be, then drives: those of a machine that
    has more drives than its tool has freedoms.

    Raises
    ------
    ModelError
        A direction or joint that does not exist or cannot move, or one that follows from the
        others.
    """
    tool = dict(motion.rest(asked.tool, asked.joints)) if motion.linkage.tool is not None else {}
    directions = tuple(d for d in DIRECTIONS if d in asked.tool or d in tool)
    found = Coordinates(directions, asked.joints)
    require_independent(motion, found)
    home = dict(zip(motion.joints.names, motion.home_values, strict=True))
    added: dict[Name, float] = {("", d): value for d, value in tool.items()}
    for pair in motion.linkage.driven:
        if pair in found.joints or pair not in home:
            continue
        more = Coordinates(directions, (*found.joints, pair))
        if not dependent(motion, more):
            found, added[pair] = more, float(home[pair])
    return found, added


def require_independent(motion: Motion, coordinates: Coordinates) -> None:
    """Refuse coordinates of which one follows from the others.

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
        "Leave it out." if still else "Leave it out: it moves with them.",
    )


def dependent(motion: Motion, coordinates: Coordinates) -> list[str]:
    """Labels of coordinates that follow from those before them at home."""
    held, given = home_rows(motion, coordinates)
    matrix = np.concatenate([held, given])
    kept, _ = independent_rows(matrix, len(held))
    return [
        label
        for k, label in enumerate(coordinates.labels, start=len(held))
        if k not in set(kept.tolist())
    ]


def home_rows(motion: Motion, coordinates: Coordinates) -> tuple[Array, Array]:
    """Rows of held joint directions and of coordinates at home, about the bodies' references.

    In one unit: lengths over the machine's size L, on (v / L, ω) of the bodies.
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
    given = np.zeros((len(coordinates), first.shape[1]))
    turned = np.array([DIRECTIONS.index(d) for _, d in coordinates.names], dtype=int)
    for k, (joint, _) in enumerate(coordinates.names):
        if not joint:
            if linkage.tool_body >= 0:
                given[k, 6 * linkage.tool_body + turned[k]] = 1.0
            continue
        select = np.zeros_like(joints.held)
        select[linkage.joint_index[joint], turned[k]] = True
        given[k] = constraint_rows(linkage, placement, select).on_bodies(bodies.position)[0, 0]
    return first, scaled(given, turned)
