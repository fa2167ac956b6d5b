"""Units of universal files: those of the file (164) and those that axis labels name."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np

from strutwork.errors import ModelError
from strutwork.fea.uff import Motion
from strutwork.fea.uff_sets import DataSet, Records

#: Powers of m, kg, s; an angle is a number.
Powers = tuple[int, int, int]

FORCE: Powers = (1, 1, -2)
MOMENT: Powers = (2, 1, -2)

#: Length and force in one of SI by the code of the units, where the code settles them.
_CODES = {
    1: (1.0, 1.0),
    2: (3.28084, 0.224809),
    3: (1.0, 0.101972),
    4: (3.28084, 7.23301),
    5: (1e3, 1e3),
    6: (1e2, 1e2),
    7: (39.3701, 0.224809),
    8: (1e3, 0.101972),
    10: (1e3, 1.0),
}

_LBF = 4.4482216152605
#: Names of units, factor to SI and powers. A label is about motion or force: g is gravity.
_NAMES: tuple[tuple[str, float, Powers], ...] = (
    ("m meter metre meters metres", 1.0, (1, 0, 0)),
    ("km", 1e3, (1, 0, 0)),
    ("cm", 1e-2, (1, 0, 0)),
    ("mm", 1e-3, (1, 0, 0)),
    ("um µm μm micron microns", 1e-6, (1, 0, 0)),
    ("nm", 1e-9, (1, 0, 0)),
    ("in inch inches", 0.0254, (1, 0, 0)),
    ("mil mils", 2.54e-5, (1, 0, 0)),
    ("ft foot feet", 0.3048, (1, 0, 0)),
    ("s sec second seconds", 1.0, (0, 0, 1)),
    ("ms", 1e-3, (0, 0, 1)),
    ("min", 60.0, (0, 0, 1)),
    ("Hz", 1.0, (0, 0, -1)),
    ("kHz", 1e3, (0, 0, -1)),
    ("rpm cpm", 1.0 / 60.0, (0, 0, -1)),
    ("ips", 0.0254, (1, 0, -1)),
    ("g gs gn g0 gee", 9.80665, (1, 0, -2)),
    ("mg", 9.80665e-3, (1, 0, -2)),
    ("Gal", 1e-2, (1, 0, -2)),
    ("kg", 1.0, (0, 1, 0)),
    ("N newton newtons", 1.0, FORCE),
    ("mN", 1e-3, FORCE),
    ("cN", 1e-2, FORCE),
    ("daN", 10.0, FORCE),
    ("kN", 1e3, FORCE),
    ("MN", 1e6, FORCE),
    ("lbf lb lbs", _LBF, FORCE),
    ("kip klbf", 1e3 * _LBF, FORCE),
    ("kgf kp", 9.80665, FORCE),
    ("pdl", 0.138254954376, FORCE),
    ("dyn", 1e-5, FORCE),
    ("Nm", 1.0, MOMENT),
    ("Nmm", 1e-3, MOMENT),
    ("kNm", 1e3, MOMENT),
    ("rad radian radians", 1.0, (0, 0, 0)),
    ("mrad", 1e-3, (0, 0, 0)),
    ("urad µrad μrad", 1e-6, (0, 0, 0)),
    ("deg degree degrees °", np.pi / 180.0, (0, 0, 0)),
)
_UNITS = {name: (factor, powers) for names, factor, powers in _NAMES for name in names.split()}

_ENTRY = re.compile(r"([^\W\d_]+0?|°|1)(?:(?:\^|\*\*)\(([+-]?\d)\)|(?:\^|\*\*)?([+-]?\d))?")
_LONGEST = 40

_MOTION_POWERS: Mapping[Motion, int] = {"displacement": 0, "velocity": -1, "acceleration": -2}


@dataclass(frozen=True)
class FileUnits:
    """Units in force for a data set.

    Parameters
    ----------
    length, force : float
        The file's units in one of SI, by data set 164.
    """

    length: float = 1.0
    force: float = 1.0


def file_units(source: DataSet) -> tuple[FileUnits, str]:
    """Read data set 164.

    Parameters
    ----------
    source : DataSet

    Returns
    -------
    units : FileUnits
    note : str
        Empty, or that the code of the units is not that of the factors, which are used.

    Raises
    ------
    ModelError
        A factor that is not positive.
    """
    records = Records(source)
    head = records.next()
    code = head.text[:10].strip()
    values = records.numbers(4, 25) if len(_rest(source)) > 1 else records.numbers(3, 25)
    length, force = values[:2]
    if not all(np.isfinite([length, force])):
        raise ModelError(
            source.part, "contains a number that is not finite (NaN or infinity).", "Correct it."
        )
    if length <= 0 or force <= 0:
        raise ModelError(source.part, "has a unit factor of zero or below.", "Correct it.")
    known = _CODES.get(int(code)) if code.isdecimal() and len(code) < 4 else None
    note = ""
    if known is not None and not np.allclose(known, (length, force), rtol=0.01):
        note = (
            f"units (164): code {code} stands for factors {known[0]:g} and {known[1]:g}, but the "
            f"file gives {length:g} and {force:g}, which are used"
        )
    return FileUnits(length, force), note


def _rest(source: DataSet) -> list[bytes]:
    return [line for line in source.content.splitlines()[1:] if line.strip()]


def named(label: str) -> bool:
    """Whether a label says anything.

    Parameters
    ----------
    label : str
        Unit of an axis.
    """
    return label.strip().casefold() not in ("", "none")


def readings(label: str) -> dict[Powers, set[float]]:
    """What a label may mean: factors to SI by their powers of m, kg and s; empty if unknown.

    Products and quotients with powers, as in `mm/s^2`, `M/SEC2`, `N-m`, `(m/s²)/N`. Capitals
    count where both ways exist (mN, MN) and not elsewhere.

    Parameters
    ----------
    label : str
        Unit of an axis.
    """
    text = label.strip().replace("²", "^2").replace("·", "*").replace("⋅", "*")
    if text[:1] + text[-1:] in ("[]", "()") and not re.search(r"[()\[\]]", text[1:-1]):
        text = text[1:-1]
    if not text or len(text) > _LONGEST:
        return {}
    parts = _factors(text)
    if not parts or len(parts) > 8:
        return {}
    found: dict[Powers, set[float]] = {}
    for chosen in product(*(_candidates(name) for name, _ in parts)):
        factor, powers = 1.0, np.zeros(3, dtype=int)
        for (one, dims), (_, power) in zip(chosen, parts, strict=True):
            factor *= one**power
            powers += power * np.array(dims)
        found.setdefault((int(powers[0]), int(powers[1]), int(powers[2])), set()).add(factor)
    return found


def _candidates(name: str) -> list[tuple[float, Powers]]:
    if name == "1":
        return [(1.0, (0, 0, 0))]
    if name in _UNITS:
        return [_UNITS[name]]
    return [value for key, value in _UNITS.items() if key.casefold() == name.casefold()]


def _factors(text: str) -> list[tuple[str, int]]:
    """Units with their powers; empty where the text is no product or quotient."""
    found: list[tuple[str, int]] = []
    at, sign, signs = 0, 1, [1]
    wants = True
    while at < len(text):
        c = text[at]
        if c == "(":
            signs.append(sign * signs[-1])
            sign = 1
        elif c == ")":
            if len(signs) == 1 or wants:
                return []
            signs.pop()
        elif c in "*./ -/" and not wants:
            # a blank between two units multiplies, beside an operator it is nothing
            sign = -1 if c == "/" else sign if c == " " and text[at - 1] in " */" else 1
            wants = c != " "
        elif c == " ":
            pass
        else:
            entry = _ENTRY.match(text, at)
            if entry is None:
                return []
            found.append((entry[1], sign * signs[-1] * int(entry[2] or entry[3] or 1)))
            at = entry.end()
            sign, wants = 1, False
            continue
        at += 1
    return [] if wants or len(signs) > 1 else found


def motion_of(label: str) -> Motion | None:
    """The motion whose unit a label is, also where it is given per force.

    Parameters
    ----------
    label : str
        Unit of an axis.
    """
    found = readings(label)
    for motion, s in _MOTION_POWERS.items():
        if {(1, 0, s), (0, -1, s + 2)} & set(found):
            return motion
    return None


def response_scale(
    labels: tuple[str, str],
    motion: Motion,
    turning: tuple[bool, bool],
    units: FileUnits,
    part: str,
    given: Mapping[str, str],
) -> float:
    """SI value of one of a function's numbers.

    Parameters
    ----------
    labels : (str, str)
        Units of motion and of force as the function's axes name them; the first may be of
        motion per force. A label goes before the units of the file.
    motion : Motion
    turning : (bool, bool)
        Whether the motion is a rotation and the force a moment.
    units : FileUnits
        For axes without a label.
    part : str
        For messages.
    given : mapping of str to str
        Units that the reader of the file names for labels.

    Raises
    ------
    ModelError
        A label that names no known unit, or a unit of something else.
    """
    seconds = _MOTION_POWERS[motion]
    above: Powers = (0 if turning[0] else 1, 0, seconds)
    below = MOMENT if turning[1] else FORCE
    both: Powers = (above[0] - below[0], above[1] - below[1], above[2] - below[2])
    top, bottom = (given.get(label.strip(), label) for label in labels)
    per = units.force * (units.length if turning[1] else 1.0)
    force = _one(bottom, below, labels[1], part, "force") if named(bottom) else 1.0 / per
    if not named(top):
        return (1.0 if turning[0] else 1.0 / units.length) / force
    found = readings(top)
    if both in found and above not in found:
        if named(bottom) and not np.isclose(force, 1.0, rtol=1e-12):
            raise ModelError(
                part,
                f'has the unit "{labels[0]}" of motion per force and beside it "{labels[1]}" of '
                "force.",
                "Name one of the two: an axis label in the exporting program.",
            )
        return _one(top, both, labels[0], part, motion)
    return _one(top, above, labels[0], part, motion) / force


def frequency_scale(label: str, part: str, given: Mapping[str, str]) -> float:
    """Hz of one of the abscissa's numbers.

    Parameters
    ----------
    label : str
        Unit of the axis.
    part : str
        For messages.
    given : mapping of str to str
        Units that the reader of the file names for labels.

    Raises
    ------
    ModelError
        A label that names no known unit of frequency.
    """
    text = given.get(label.strip(), label)
    if not named(text):
        return 1.0
    scale = _one(text, (0, 0, -1), label, part, "frequency")
    turns = re.search("rad|deg|°", text, re.IGNORECASE)
    return scale / (2.0 * np.pi) if turns else scale


def _one(text: str, powers: Powers, label: str, part: str, what: str) -> float:
    found = readings(text)
    factors = found.get(powers, set())
    if len(factors) == 1:
        return float(next(iter(factors)))
    raise ModelError(
        part,
        f'has the label "{label.strip()[:40]}", '
        + (f"which is not a unit of {what}." if found else f"an unknown unit of {what}."),
        f'State the unit: --unit "{label.strip()[:40]}=mm/s^2" (in Python, units= of '
        "read_universal), or correct the label in the file.",
    )
