"""What is lost at a singular pose, and whether the loss is isolated or goes on."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from math import degrees
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.joint import DIRECTIONS, State
from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.mobility import free_motions
from strutwork.kinematics.motion_spaces import null_space
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.rows import constraint_rows
from strutwork.kinematics.second_order import drift
from strutwork.kinematics.tool_drive_space import (
    Freedoms,
    ToolDriveSpace,
    drive_matrix,
    passive_matrix,
)

Array = NDArray[Any]

#: What is left of a singular value at a pose that was refined onto a singularity.
ZERO = 1e-6

#: Part of a unit motion below which a joint or the tool stands still, and second-order part of
#: a held row below which a motion is not stopped by it.
STILL = 1e-5


class Kind(Enum):
    """Kinds of singular poses (Gosselin and Angeles 1990; Park and Kim 1999)."""

    END_EFFECTOR = "end-effector"
    ACTUATOR = "actuator"
    BOTH = "end-effector and actuator"
    CONFIGURATION = "configuration space"
    TURN = "turn of the coordinates"
    LIMIT = "limit of a joint"
    UNKNOWN = "end of reach"

    @property
    def type(self) -> int | None:
        """1 serial, 2 parallel, 3 both; None where it is none of them."""
        return {Kind.END_EFFECTOR: 1, Kind.ACTUATOR: 2, Kind.BOTH: 3}.get(self)

    @property
    def meaning(self) -> str:
        """In words."""
        return _MEANING[self]


_MEANING = {
    Kind.END_EFFECTOR: "drives can move while the tool stands still, having lost a motion (type 1)",
    Kind.ACTUATOR: "the tool can move although the drives are held (type 2)",
    Kind.BOTH: (
        "drives can move while the tool stands still, and the tool while the drives are held "
        "(type 3)"
    ),
    Kind.CONFIGURATION: "the joints alone lose a constraint: the linkage can branch",
    Kind.TURN: "the coordinates reverse, while the tool still moves in others",
    Kind.LIMIT: "a joint is at the end of its range",
    Kind.UNKNOWN: "the path ends without a singularity there",
}


def kinds(space: ToolDriveSpace) -> NDArray[np.object_]:
    """Kind of each pose that was refined onto a singularity, None where there is none, (p,).

    Parameters
    ----------
    space : ToolDriveSpace
        At p poses.
    """
    parallel, serial = space.parallel <= ZERO, space.serial <= ZERO
    found = np.full(len(space.basis), None, dtype=object)
    found[serial] = Kind.END_EFFECTOR
    found[parallel] = Kind.ACTUATOR
    found[serial & parallel] = Kind.BOTH
    # at it the space itself is not determined: what tool and drives do in it says nothing
    found[space.passive <= ZERO] = Kind.CONFIGURATION
    return found


@dataclass(frozen=True)
class Lost:
    """What is lost at one singular pose.

    Parameters
    ----------
    twist : (6,) or None
        Of the tool, m and rad, the larger of |v| and L |ω| one: at an actuator singularity the
        motion that held drives allow; at an end-effector singularity the motion that is lost.
    moving : tuple of (joint, direction)
        Joint directions that move in it: at held drives; or, with the tool at rest, drives too.
    continuous : bool or None
        Of an actuator singularity: whether the motion at held drives goes on to second order
        (degenerate) or is stopped by it (isolated); None where second order does not decide.
    description : str
    """

    twist: Array | None
    moving: tuple[tuple[str, str], ...]
    continuous: bool | None
    description: str


def lost_motion(
    linkage: Linkage, placement: Placement, kind: Kind, length: float, known: Freedoms
) -> Lost | None:
    """Name what is lost at one pose; None for kinds in which nothing is.

    Parameters
    ----------
    linkage : Linkage
    placement : Placement
        One pose, a batch of one.
    kind : Kind
        Of `kinds`.
    length : float
        L, m.
    known : Freedoms
        At poses that are not singular.
    """
    if kind in (Kind.ACTUATOR, Kind.BOTH):
        return _at_held_drives(linkage, placement, length)
    if kind is Kind.END_EFFECTOR:
        return _at_standing_tool(linkage, placement, length, known)
    if kind is Kind.CONFIGURATION:
        return _of_the_joints(linkage, placement, length, known)
    return None


def _at_held_drives(linkage: Linkage, placement: Placement, length: float) -> Lost:
    passive = passive_matrix(linkage, placement, length)[0]
    drives = _unit(drive_matrix(linkage, placement, length)[0])
    tool = _tool_rows(linkage)
    rows = np.concatenate([passive, drives])
    motion = _seen(rows, tool)
    twists = motion.T @ tool.T if motion.size else np.zeros((0, 6))
    continuous = _continuous(linkage, placement, rows, motion, length)
    words = {
        True: "the motion continues with the drives held, to second order (degenerate)",
        False: "isolated: the motion ends at second order",
        None: "second order does not decide whether the motion continues",
    }[continuous]
    twist = _twist(twists[0], length) if len(twists) else None
    moving = _named(linkage, placement, motion, length, drives=False)
    text = "" if twist is None else f"with the drives held the tool {twist_words(twist, length)}; "
    return Lost(twist, moving, continuous, f"{text}{words}")


def _at_standing_tool(
    linkage: Linkage, placement: Placement, length: float, known: Freedoms
) -> Lost:
    passive = passive_matrix(linkage, placement, length)[0]
    tool = _tool_rows(linkage)
    null = _null(passive)
    left, values, _ = np.linalg.svd(tool @ null)
    # among directions that it never has, the one that it has lost is of the task
    lost = left[:, len(values) - int((values <= ZERO).sum()) :] if len(values) else left
    if known.tool < 6:
        inside = np.zeros((6, 6))
        inside[list(known.task), list(known.task)] = 1.0
        u, _, _ = np.linalg.svd(lost @ lost.T @ inside)
        lost = u[:, :1]
    drives = drive_matrix(linkage, placement, length)[0]
    motion = _seen(np.concatenate([passive, tool]), drives)
    moving = _named(linkage, placement, motion, length, drives=True)
    twist = _twist(lost[:, -1], length)
    driven = [pair for pair in moving if pair in linkage.driven]
    text = f"the tool has lost the motion in which it {twist_words(twist, length)}"
    if driven:
        text += "; without it move " + ", ".join(f"{j}:{d}" for j, d in driven)
    return Lost(twist, moving, None, text)


def _of_the_joints(linkage: Linkage, placement: Placement, length: float, known: Freedoms) -> Lost:
    passive = passive_matrix(linkage, placement, length)[0]
    left, values, right = np.linalg.svd(passive)
    at = int((values > ZERO * values[0]).sum())
    motion = right[at : known.rank].T
    moving = _named(linkage, placement, motion, length, drives=True)
    select = linkage.elastic_or_locked() & ~linkage.driven_mask()
    joints = np.nonzero(select)[0]
    force = np.abs(left[:, at : known.rank]).max(axis=1, initial=0.0)
    loaded = dict.fromkeys(
        linkage.joints[j].name for j in joints[force > STILL * force.max(initial=1e-30)]
    )
    return Lost(
        None, moving, None, "joints that lose a constraint: " + ", ".join(loaded or {"none": 0})
    )


def _continuous(
    linkage: Linkage, placement: Placement, rows: Array, motion: Array, length: float
) -> bool | None:
    """Whether motions (n, k) that the rows allow are stopped by them at second order."""
    count = motion.shape[1]
    left, values, _ = np.linalg.svd(rows)
    states = left[:, int((values > ZERO * values[0]).sum()) :]
    driven = linkage.driven_mask()
    parts = [
        constraint_rows(linkage, placement, linkage.elastic_or_locked() & ~driven),
        constraint_rows(linkage, placement, driven),
    ]
    unit = np.tile(np.repeat([1.0, length], 3), len(linkage.body_names))
    norms = np.concatenate([np.linalg.norm(p.on_bodies()[0] / unit, axis=-1) for p in parts])

    def second(motion: Array) -> Array:
        twists = (motion / unit)[None]
        left_open = np.concatenate([drift(p, twists)[0] for p in parts])
        return np.asarray(length * states.T @ (left_open / np.where(norms > 0, norms, 1.0)))

    if count == 1:
        return bool(np.abs(second(motion[:, 0])).max(initial=0.0) < STILL)
    forms = np.zeros((states.shape[1], count, count))
    for i in range(count):
        for j in range(count):
            a, b = motion[:, i], motion[:, j]
            forms[:, i, j] = (second(a + b) - second(a - b)) / 4.0
    if np.abs(forms).max(initial=0.0) < STILL:
        return True
    bends = np.linalg.eigvalsh(forms)
    definite = (bends[:, 0] > STILL) | (bends[:, -1] < -STILL)
    return False if definite.any() else None


def _tool_rows(linkage: Linkage) -> Array:
    body = linkage.tool_body
    rows = np.zeros((6, 6 * len(linkage.body_names)))
    rows[:, 6 * body : 6 * body + 6] = np.eye(6)
    return rows


def _unit(rows: Array) -> Array:
    norm = np.linalg.norm(rows, axis=-1, keepdims=True)
    return np.asarray(rows / np.where(norm == 0.0, 1.0, norm))


def _null(rows: Array) -> Array:
    found = null_space(rows[None], share=ZERO)[0]
    return np.asarray(found[:, np.abs(found).max(axis=0) > 0])


def _seen(rows: Array, seen: Array) -> Array:
    """Motions that rows allow, those first that are seen most and none that is not, (n, k)."""
    null = _null(rows)
    _, values, right = np.linalg.svd(seen @ null, full_matrices=False)
    return np.asarray(null @ right[values > STILL].T)


def _twist(scaled: Array, length: float) -> Array:
    """Twist (v, ω) of one (v, L ω), its larger part one and its largest entry positive."""
    size = max(np.linalg.norm(scaled[:3]), np.linalg.norm(scaled[3:]))
    found = scaled / size
    found = found * np.sign(found[np.abs(found).argmax()])
    found = np.where(np.abs(found) < STILL, 0.0, found)
    return np.concatenate([found[:3], found[3:] / length])


def _named(
    linkage: Linkage, placement: Placement, motion: Array, length: float, *, drives: bool
) -> tuple[tuple[str, str], ...]:
    if not motion.size:
        return ()
    null = np.where(np.abs(motion) < STILL * np.abs(motion).max(), 0.0, motion)
    moves = linkage.states() == State.FREE
    if drives:
        moves |= linkage.driven_mask()
    found = free_motions(linkage, placement[0], null, length, moves)
    return tuple(dict.fromkeys(pair for m in found for pair in m.joints))


def twist_words(twist: Array, length: float) -> str:
    """A small motion in words: `moves along (0, 0, 1) and turns about (1, 0, 0), 3 deg a mm`.

    Parameters
    ----------
    twist : (6,)
        Of the tool, m and rad; parts below `STILL` are left out.
    length : float
        L, m, by which turns are compared with shifts.
    """
    move, turn = np.linalg.norm(twist[:3]), np.linalg.norm(twist[3:])
    parts = []
    if move > STILL:
        parts.append(f"moves along {_direction(twist[:3] / move)}")
    if length * turn > STILL:
        parts.append(f"turns about {_direction(twist[3:] / turn)}")
    text = " and ".join(parts) or "does not move"
    return text + (f", {degrees(1e-3 * turn / move):.3g} deg a mm" if len(parts) == 2 else "")


def _direction(vector: Array) -> str:
    for k, name in enumerate(DIRECTIONS[:3]):
        if abs(vector[k]) > 1.0 - 1e-6:
            return name if vector[k] > 0 else f"-{name}"
    return "(" + ", ".join(f"{round(float(v), 3) + 0.0:.3f}" for v in vector) + ")"
