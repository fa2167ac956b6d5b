"""A machine at other poses than home: one, or a batch of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import degrees

import numpy as np
from numpy.typing import ArrayLike

from strutwork.errors import UnreachableError
from strutwork.kinematics import DIRECTIONS, Placement, Poses
from strutwork.kinematics.motion import Moved
from strutwork.kinematics.turns import rotation_matrix
from strutwork.machines.limits import check_limits
from strutwork.machines.model import Model

#: A joint coordinate by its joint and direction.
Coordinate = tuple[str, str]

#: Joint coordinates that differ by less, m and rad, are the same.
SAME = 1e-7


def targets(
    model: Model,
    task: Mapping[str, ArrayLike],
    joints: Mapping[Coordinate, ArrayLike],
) -> dict[str, ArrayLike]:
    """Task coordinates, (...) each, with those at home that are not named and can be held.

    Parameters
    ----------
    model : Model
    task : mapping of direction to (...)
        Of the tool, m and rad.
    joints : mapping of (joint, direction) to (...)
        Joint coordinates, m and rad.

    Raises
    ------
    ModelError
        A direction in which the tool cannot move.
    """
    if not task and (joints or model.tool is None):
        return {}
    return {**task, **model.motion.rest(tuple(task), tuple(joints))}


def walked(
    model: Model,
    task: Mapping[str, ArrayLike] | None = None,
    joints: Mapping[Coordinate, ArrayLike] | None = None,
    of_many: int = 0,
) -> Moved:
    """Move a machine from home by its joints alone; what is not named stays, where it can.

    Parameters
    ----------
    model : Model
    task : mapping of direction to (...)
        Of the tool, m and rad.
    joints : mapping of (joint, direction) to (...)
        Joint coordinates, m and rad.
    of_many : int
        As `Motion.move`.

    Raises
    ------
    ModelError
        As `Motion.move`.
    """
    wanted, coordinates = targets(model, task or {}, joints or {}), dict(joints or {})
    if not wanted and not coordinates:
        coordinates = dict.fromkeys(model.motion.joints.names[:1], 0.0)
    return brought(model, wanted, coordinates, of_many=of_many)


def brought(
    model: Model,
    wanted: Mapping[str, ArrayLike],
    coordinates: Mapping[Coordinate, ArrayLike],
    beside: Moved | None = None,
    of_many: int = 0,
) -> Moved:
    """Move a machine from home by its joints alone, with what is to be held named.

    Parameters
    ----------
    model : Model
    wanted : mapping of direction to (...)
        Of the tool, m and rad; other directions are left to the joints.
    coordinates : mapping of (joint, direction) to (...)
        Joint coordinates, m and rad.
    beside : Moved, optional
        Where a machine that hardly differs was brought.
    of_many : int
        As `Motion.move`.

    Raises
    ------
    ModelError
        As `Motion.move`.
    """
    whole = len(wanted) == len(DIRECTIONS) and not coordinates
    if whole and all(np.isfinite(v).all() for v in wanted.values()):
        # the same way, and a pose of the tool may go leg by leg in compiled code; what is not
        # finite is named by its direction below
        return model.motion.move(tool=_poses(model, wanted), of_many=of_many)
    return model.motion.move(
        task=dict(wanted) or None,
        joints=dict(coordinates) or None,
        beside=beside,
        of_many=of_many,
    )


def moved(
    model: Model,
    task: Mapping[str, ArrayLike] | None = None,
    joints: Mapping[Coordinate, ArrayLike] | None = None,
    of_many: int = 0,
) -> tuple[Moved, Placement]:
    """Move a machine from home to a batch of targets.

    Parameters
    ----------
    model : Model
    task : mapping of direction to (...)
        Of the tool, m and rad; what is not named stays, where it can.
    joints : mapping of (joint, direction) to (...)
        Joint coordinates, m and rad.
    of_many : int
        As `Motion.move`.

    Returns
    -------
    moved : Moved
        Of the generic motion, whose coordinates and reasons it has.
    placement : Placement
        By the machine's own formulas where it has some; poses outside joint ranges are marked.

    Raises
    ------
    ModelError
        As `Motion.move`.
    """
    found = walked(model, task, joints, of_many)
    placement = found.placement
    if model.closed_form is not None and found.tool is not None:
        own = model.closed_form(found.tool)
        # what the way there does not reach, no formula makes reachable on this branch
        reasons = (*own.reasons, *placement.reasons)
        late = np.asarray(placement.status) + len(own.reasons)
        status = np.where(placement.reachable, np.asarray(own.status), late).astype(np.int16)
        placement = replace(own, status=status, reasons=reasons)
        placement = _of_the_asked(placement, joints or {})
    return found, check_limits(model.limits, placement)


def _of_the_asked(placement: Placement, joints: Mapping[Coordinate, ArrayLike]) -> Placement:
    """Poses marked at which the machine's own formulas take a joint elsewhere than asked.

    With redundant drives a pose of the tool leaves some open, and the formulas choose.
    """
    for (joint, direction), asked in joints.items():
        if (joint, direction) not in placement.names:
            continue
        value = placement.values[..., placement.names.index((joint, direction))]
        why = (
            f"the machine's own formulas choose {joint}:{direction} by themselves: give only a "
            "pose of the tool"
        )
        reasons = (*placement.reasons, why)
        other = (np.abs(value - np.asarray(asked)) > SAME) & placement.reachable
        status = np.where(other, np.int16(len(reasons)), np.asarray(placement.status))
        placement = replace(placement, status=status, reasons=reasons)
    return placement


def _poses(model: Model, task: Mapping[str, ArrayLike]) -> Poses:
    values = np.broadcast_arrays(*(np.asarray(task[d], dtype=float) for d in DIRECTIONS))
    six = np.stack(values, axis=-1)
    return Poses(six[..., :3], rotation_matrix(six[..., 3:]) @ model.rotation)


def at_pose(
    model: Model,
    task: Mapping[str, float] | None = None,
    joints: Mapping[Coordinate, float] | None = None,
) -> Model:
    """The same machine standing elsewhere.

    Parameters
    ----------
    model : Model
    task : mapping of direction to float
        Of the tool, m and rad; what is not named stays, where it can.
    joints : mapping of (joint, direction) to float
        Joint coordinates, m and rad.

    Raises
    ------
    ModelError
        As `Motion.move`.
    UnreachableError
        The pose is out of reach or outside a joint's range; the message offers the nearest pose
        on the way that is not.
    """
    if not task and not joints:
        return model
    found, placement = moved(model, task, joints)
    reason = placement.reason(())
    if reason:
        offer = _offer(model, found, task or {}, joints or {})
        raise UnreachableError("pose", f"cannot be taken: {reason}.", offer)
    where = pose_words({**(task or {})}, {**(joints or {})})
    rotation = model.rotation if found.tool is None else found.tool.rotation
    return replace(
        model,
        title=f"{model.title or 'Model'}, at {where}",
        placement=placement,
        rotation=rotation,
    )


def pose_words(task: Mapping[str, float], joints: Mapping[Coordinate, float]) -> str:
    """A pose in words: `x = 20 mm, ram1:z = 310 mm`.

    Parameters
    ----------
    task : mapping of direction to float
        m and rad.
    joints : mapping of (joint, direction) to float
        Joint coordinates, m and rad.
    """
    words = []
    for name, value in [*task.items(), *((f"{j}:{d}", v) for (j, d), v in joints.items())]:
        turns = name.rpartition(":")[2].startswith("r")
        shown = degrees(value) if turns else 1e3 * value
        words.append(f"{name} = {shown:.6g} {'deg' if turns else 'mm'}")
    return ", ".join(words)


def _offer(
    model: Model, found: Moved, task: Mapping[str, float], joints: Mapping[Coordinate, float]
) -> str:
    """Remedy: how far the machine gets on the way, within its ranges."""
    start: dict[Coordinate, float] = {}
    if task:
        home = model.motion.task_of(model.motion.home_pose)
        start |= {("", d): float(home[DIRECTIONS.index(d)]) for d in task}
    values = dict(zip(model.motion.joints.names, model.motion.home_values, strict=True))
    start |= {name: float(values[name]) for name in joints}
    end = {**{("", d): v for d, v in task.items()}, **joints}
    # the ranges may end before the reach does: the last share that keeps them, to 0.1 %
    last = float(found.share[()])
    shares = np.linspace(0.0, last, 1001) if model.limits else np.array([0.0, last])
    way = {name: value + shares * (end[name] - value) for name, value in start.items()}
    _, placed = moved(
        model,
        {d: v for (owner, d), v in way.items() if not owner},
        {name: v for name, v in way.items() if name[0]},
    )
    out = np.flatnonzero(~placed.reachable)
    first = int(out[0]) if out.size else len(shares)
    if first == 0:
        return "Home itself is outside: correct its limits."
    near = {name: float(v[first - 1]) for name, v in way.items()}
    words = pose_words(
        {d: v for (owner, d), v in near.items() if not owner},
        {name: v for name, v in near.items() if name[0]},
    )
    return f"On the path from home it reaches {words}."
