"""Limits of drives from the command line: `[JOINT:DIR:]KIND=VALUE`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from strutwork.errors import ModelError, UnitError
from strutwork.studies.drive_demand import DriveLimit
from strutwork.units import (
    ACCELERATION,
    FORCE,
    MOMENT,
    POWER,
    SPEED,
    TURNING_ACCELERATION,
    TURNING_SPEED,
    quantity,
)

#: What a kind measures of a drive that shifts, and of one that turns.
KINDS = {
    "speed": (SPEED, TURNING_SPEED),
    "acceleration": (ACCELERATION, TURNING_ACCELERATION),
    "force": (FORCE, MOMENT),
    "power": (POWER, POWER),
}

Pair = tuple[str, str]


def drive_limits(texts: Sequence[str], driven: Sequence[Pair]) -> dict[Pair, DriveLimit]:
    """Limits by drive, in SI; later ones count.

    Parameters
    ----------
    texts : sequence of str
        Such as "speed=0.5 m/s", of every drive that the unit fits, or "ram1:z:force=2 kN".
    driven : sequence of (joint, direction)

    Raises
    ------
    ModelError
        A text of another form, an unknown kind or drive, or a limit that is not positive.
    UnitError
        A value whose unit fits none of the drives.
    """
    found = dict.fromkeys(driven, DriveLimit())
    for text in texts:
        part = f'limit "{text}"'
        head, sign, value = text.rpartition("=")
        drive, colon, kind = head.rpartition(":")
        if not sign or kind not in KINDS:
            raise ModelError(
                part,
                "is not understood.",
                f"Write [JOINT:DIR:]KIND=VALUE, KIND one of {', '.join(KINDS)}.",
            )
        joint, _, direction = drive.rpartition(":")
        asked = [pair for pair in driven if not colon or pair == (joint, direction)]
        if not asked:
            raise ModelError(
                part,
                f"names the unknown drive {drive}." if colon else "finds no drive.",
                "Drives: " + ", ".join(f"{j}:{d}" for j, d in driven) + ".",
            )
        limits, wrong = {}, None
        for pair in asked:
            try:
                dimension = KINDS[kind][pair[1].startswith("r")]
                limits[pair] = quantity(_number(value), dimension, part)
            except UnitError as error:
                wrong = error
        if wrong is not None and not limits:
            raise wrong
        for pair, number in limits.items():
            if number <= 0:
                raise ModelError(part, "is not positive.", "Give one above zero.")
            found[pair] = replace(found[pair], **{kind: number})
    return found


def _number(text: str) -> float | str:
    """A bare number is in SI."""
    try:
        return float(text)
    except ValueError:
        return text.strip()
