"""Static stiffness of servos in the drives of a machine.

The controller of a drive demands the force K_p (e + ∫ e dt / T_n) with e = K_v (r − p) − v
(`strutwork.machines.servos.Servo`). At rest v = 0: without integral action the force is K_v K_p
(r − p), with it the position is held whatever the force. An encoder on the motor holds the motor,
in series with the transmission; one at the joint holds the joint, the transmission included.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import inf, isinf

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Joint
from strutwork.machines.model import Model
from strutwork.machines.servos import Servo
from strutwork.msa.structure import Structure
from strutwork.names import choices
from strutwork.studies.error_inputs import DriveError, ErrorInputs

#: How much stiffer than its transmission a drive is that its servo holds at the joint.
HELD = 1e6


def with_loops(inputs: ErrorInputs, model: Model) -> ErrorInputs:
    """The inputs with the static stiffness of the machine's servos where they give none.

    Parameters
    ----------
    inputs : ErrorInputs
    model : Model
    """
    if not (inputs.servos and model.servos):
        return inputs
    loops = {(s.joint, s.direction): s for s in model.servos}
    drives = [
        with_loop(d, loops[d.joint, d.direction])
        if d.servo and d.servo_stiffness is None and (d.joint, d.direction) in loops
        else d
        for d in inputs.drives
    ]
    named = {(d.joint, d.direction) for d in drives}
    drives += [with_loop(DriveError(*key), s) for key, s in loops.items() if key not in named]
    return replace(inputs, drives=tuple(drives), servos=False)


def with_loop(drive: DriveError, servo: Servo) -> DriveError:
    """A drive with the static stiffness of its servo.

    Parameters
    ----------
    drive : DriveError
    servo : Servo
    """
    at_load = servo.encoder == "load"
    return replace(drive, servo_stiffness=servo.static_stiffness, at_load=at_load)


def servo_notes(inputs: ErrorInputs, structure: Structure) -> list[str]:
    """What integral action does, for the drives that have it.

    Parameters
    ----------
    inputs : ErrorInputs
        As `with_loops` gives them.
    structure : Structure
    """
    stiff: list[str] = []
    held: list[str] = []
    for drive in inputs.drives:
        if drive.servo_stiffness is not None and isinf(drive.servo_stiffness):
            elastic = drive.at_load and isinstance(_own(structure, drive), float)
            (held if elastic else stiff).append(f"{drive.joint}:{drive.direction}")
    notes = []
    if stiff:
        notes.append(
            f"The servos of {', '.join(stiff)} have integral action: their static stiffness is "
            "infinite, and they do not yield to a constant force."
        )
    if held:
        notes.append(
            f"The servos of {', '.join(held)} have integral action and measure the joint: they "
            "take back what their drives yield to a constant force."
        )
    return notes


def series_compliance(drive: DriveError, structure: Structure) -> float:
    """By what the servo lengthens a drive per force, m/N or rad/(N m).

    Negative where it measures the joint and makes the drive stiffer than its transmission.

    Parameters
    ----------
    drive : DriveError
        With a servo stiffness.
    structure : Structure
    """
    own = _own(structure, drive)
    total = 1.0 / (drive.servo_stiffness or inf)
    return total - 1.0 / own if drive.at_load and own is not None else total


def with_servos(
    structure: Structure, drives: Sequence[DriveError], *, vibrating: bool = False
) -> Structure:
    """The structure with the stiffness of servos in its drives.

    Parameters
    ----------
    structure : Structure
    drives : sequence of DriveError
    vibrating : bool
        Whether it is to vibrate: a servo that measures the joint then leaves the drive as it is,
        because it is not as fast as that.

    Raises
    ------
    ModelError
        A drive that the structure has not, or one given twice.
    """
    linkage = structure.linkage
    soft: dict[str, dict[str, float]] = {}
    seen: set[tuple[str, str]] = set()
    for drive in drives:
        key = (drive.joint, drive.direction)
        name = f"{drive.joint}:{drive.direction}"
        if key not in linkage.driven:
            raise ModelError(
                "drives",
                f'names the unknown drive "{name}".',
                choices("Drives", name, [f"{j}:{d}" for j, d in linkage.driven]),
            )
        if key in seen:
            raise ModelError(f"drive {name}", "is given twice.", "Give it once.")
        seen.add(key)
        if drive.servo_stiffness is None:
            continue
        joint = linkage.joints[linkage.joint_index[drive.joint]]
        if joint.matrix is not None and not joint.bearing:
            raise ModelError(
                f"drive {name}",
                "has a full matrix of stiffness, to which no servo is added.",
                "Give the joint stiffness by direction, or leave the servo out: servo = false.",
            )
        k = _total(drive, _own(structure, drive), vibrating)
        if k is not None:
            soft.setdefault(drive.joint, {})[drive.direction] = k
    if not soft:
        return structure
    joints = tuple(_with(j, soft[j.name]) if j.name in soft else j for j in linkage.joints)
    return replace(structure, linkage=replace(linkage, joints=joints))


def _own(structure: Structure, drive: DriveError) -> float | None:
    """Stiffness of the transmission; None where it is rigid."""
    linkage = structure.linkage
    joint = linkage.joints[linkage.joint_index[drive.joint]]
    at = DIRECTIONS.index(drive.direction)
    return float(joint.stiffness_matrix[at, at]) or None


def _total(drive: DriveError, own: float | None, vibrating: bool) -> float | None:
    """Stiffness of a drive with its servo; None where it is that of the drive alone."""
    k = drive.servo_stiffness or inf
    if own is None:
        return None if isinf(k) else k
    if drive.at_load:
        return None if vibrating else min(k, HELD * own)
    return None if isinf(k) else own * k / (own + k)


def _with(joint: Joint, stiffness: dict[str, float]) -> Joint:
    """A joint with another stiffness in driven directions, in which its bearing does not resist."""
    if joint.matrix is None:
        return replace(joint, stiffness={**joint.stiffness, **stiffness})
    matrix = joint.stiffness_matrix.copy()
    for direction, value in stiffness.items():
        at = DIRECTIONS.index(direction)
        matrix[at, at] = value
    return replace(joint, matrix=tuple(tuple(row) for row in matrix.tolist()))
