"""Force limits from the command line: `[JOINT:]KIND=VALUE`."""

from __future__ import annotations

from collections.abc import Sequence

from strutwork.errors import ModelError
from strutwork.names import choices
from strutwork.overconstraint import Limits, Quantity
from strutwork.units import FORCE, MOMENT, quantity

#: Kinds of force by the word of the command line, and what they measure.
WORDS = {
    "radial_force": ("radial force", FORCE),
    "axial_force": ("axial force", FORCE),
    "bending_moment": ("bending moment", MOMENT),
    "torque": ("torque", MOMENT),
}


def parsed_limits(
    known: Limits, texts: Sequence[str], quantities: Sequence[Quantity]
) -> dict[tuple[str | None, str], float]:
    """Limits by joint and kind of force, N and N·m; later ones count.

    Parameters
    ----------
    known : mapping of (joint, kind) to float
        The limits without the command line.
    texts : sequence of str
        Such as "radial_force=2 kN" for every joint that bears one, or
        "block A1:axial_force=500".
    quantities : sequence of Quantity
        What the joints bear.

    Raises
    ------
    ModelError
        A text of another form, an unknown joint or kind, or a limit that is not positive.
    UnitError
        A value of another dimension.
    """
    found: dict[tuple[str | None, str], float] = {
        (joint, kind): value for (joint, kind), value in known.items()
    }
    for text in texts:
        head, sign, value = text.rpartition("=")
        joint, colon, word = head.rpartition(":")
        if not sign or word not in WORDS:
            raise ModelError(
                f'limit "{text}"',
                "is not understood.",
                f"Write [JOINT:]KIND=VALUE, KIND one of {', '.join(WORDS)}.",
            )
        kind, dimension = WORDS[word]
        number = quantity(bare(value), dimension, f'limit "{text}"')
        if number <= 0:
            raise ModelError(f'limit "{text}"', "is not positive.", "Give a force above zero.")
        joints = [
            q.joint
            for q in quantities
            if q.joint is not None and q.kind == kind and (not colon or q.joint == joint)
        ]
        if not joints:
            raise ModelError(
                f'limit "{text}"',
                f"finds no {kind}" + (f" of a joint {joint}." if colon else "."),
                choices("Joints", joint, dict.fromkeys(q.joint for q in quantities if q.joint)),
            )
        found |= {(name, kind): number for name in joints}
    return found


def bare(text: str) -> float | str:
    """A bare number is in SI."""
    try:
        return float(text)
    except ValueError:
        return text
