"""Functions of universal files (58, 58b)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.uff import FrfRecord, Motion
from strutwork.fea.uff_columns import Columns, number
from strutwork.fea.uff_geometry import Geometry
from strutwork.fea.uff_sets import DataSet, head_and_body, numbers_of
from strutwork.fea.uff_units import FileUnits, frequency_scale, motion_of, named, response_scale
from strutwork.kinematics import DIRECTIONS

Array = NDArray[Any]

_RESPONSE = 4

#: Names of function types, for what is left out.
_KINDS = {
    1: "time response",
    2: "auto spectrum",
    3: "cross spectrum",
    5: "transmissibility",
    6: "coherence",
    7: "auto correlation",
    8: "cross correlation",
    9: "power spectral density",
    12: "spectrum",
    18: "mode indicator function",
    26: "multiple coherence",
    27: "order function",
}

_MOTION: Mapping[int, Motion] = {8: "displacement", 11: "velocity", 12: "acceleration"}

#: Ordinates that are settled by their label: unknown and general.
_UNSAID = (0, 1)

#: Denominators that are forces: unknown, reaction force, excitation force.
_FORCES = (0, 9, 13)

#: Abscissae that may be a frequency: unknown, general, frequency.
_FREQUENCIES = (0, 1, 18)

#: Columns of a line of text by ordinate type and even spacing.
_LAYOUT = {
    (2, True): [13] * 6,
    (2, False): [13] * 6,
    (5, True): [13] * 6,
    (5, False): [13] * 6,
    (4, True): [20] * 4,
    (6, True): [20] * 4,
    (4, False): [13, 20, 13, 20],
    (6, False): [13, 20, 20],
}

#: Byte orders and the one format of floating-point numbers that is read.
_ORDERS = {1: "<", 2: ">"}
_IEEE = 2


@dataclass(frozen=True)
class End:
    """One end of a function: where and which way.

    Parameters
    ----------
    entity : str
        Component that the node's number belongs to; empty for none.
    node : int
    direction : int
        1 to 6, negative against the axis; 0 for a scalar.
    """

    entity: str
    node: int
    direction: int


@dataclass(frozen=True)
class RawFunction:
    """A response as it stands in the file, in SI units.

    Parameters
    ----------
    part : str
        For messages.
    output, given : End
        Where the motion and the force are.
    frequencies : (f,)
        Hz.
    values : (f,)
        Complex motion per force: m/N, m/(N·s), m/(N·s²) and the like of rotations.
    motion : "displacement", "velocity" or "acceleration"
    """

    part: str
    output: End
    given: End
    frequencies: Array
    values: Array
    motion: Motion


def raw_function(source: DataSet, units: FileUnits, given: Mapping[str, str]) -> RawFunction | str:
    """Read a function; a text says why it is left out.

    Parameters
    ----------
    source : DataSet
    units : FileUnits
    given : mapping of str to str
        Units of labels that the reader of the file names.
    """
    head, body = head_and_body(source, 11)
    record = head[5].text
    kind = _field(head[5], 0, 5)
    if kind != _RESPONSE:
        return f"{_KINDS.get(kind, 'function')} (function of type {kind})"
    load_case = _field(head[5], 20, 30)
    output = End(record[31:41].strip(), _field(head[5], 41, 51), _field(head[5], 51, 55))
    load = End(record[56:66].strip(), _field(head[5], 66, 76), _field(head[5], 76, 80))
    abscissa, above, below = (_field(line, 0, 10) for line in head[7:10])
    labels = tuple(line.text[46:67].strip() for line in head[7:10])
    if abscissa not in _FREQUENCIES:
        return f"response over something other than frequency (type {abscissa})"
    if load_case != 0:
        return f"response to several forces (load case {load_case})"
    if below not in _FORCES or 0 in (output.direction, load.direction) or above == 13:
        return "function that is not a motion per force in a direction"
    if not all(abs(end.direction) <= 6 for end in (output, load)):
        raise ModelError(source.part, "has a direction beyond 6.", "Directions are 1 to 6.")
    motion = _MOTION.get(above)
    if above in _UNSAID and named(labels[1]):
        motion = motion_of(given.get(labels[1], labels[1]))
    if motion is None:
        return (
            f"function that does not state displacement, velocity or acceleration (type {above}, "
            f'unit "{labels[1]}")'
        )
    turning = (abs(output.direction) > 3, abs(load.direction) > 3)
    scale = response_scale((labels[1], labels[2]), motion, turning, units, source.part, given)
    per_line = frequency_scale(labels[0], source.part, given)
    lines, values = _numbers(source, head[6], body)
    with np.errstate(all="ignore"):
        lines, values = lines * per_line, values * scale
    if not (np.all(np.isfinite(lines)) and np.all(np.isfinite(values))):
        raise ModelError(
            source.part,
            "contains a number that is not finite (NaN or infinity).",
            "Repair the measurement or omit it.",
        )
    return RawFunction(source.part, _plain(output), _plain(load), lines, values, motion)


def _plain(end: End) -> End:
    unused = end.entity.upper() in ("NONE", "")
    return End("" if unused else end.entity, end.node, end.direction)


def _field(line: Columns, start: int, end: int) -> int:
    text = line.text[start:end].strip()
    value = number(text, line.part, line.line) if text else 0.0
    if not abs(value) < 1e12 or value != int(value):
        raise ModelError(
            line.part,
            f'cannot be read: "{text}" in line {line.line} is not a whole number.',
            "Export the file again.",
        )
    return int(value)


def _numbers(source: DataSet, form: Columns, body: bytes) -> tuple[Array, Array]:
    """Abscissa and ordinates as they stand in the set."""
    kind, count, spacing = form.whole([10, 10, 10], 3)
    start, step = ([*form.numbers([10, 10, 10, 13, 13, 13])[3:5], 0.0, 0.0])[:2]
    even = spacing == 1
    if (kind, even) not in _LAYOUT or spacing not in (0, 1) or count < 0:
        raise ModelError(
            source.part,
            f"has the ordinate type {kind}, spacing {spacing} and {count} lines in line "
            f"{form.line}.",
            "Ordinate types are 2, 4, 5 and 6, spacing 0 or 1.",
        )
    values = 2 if kind in (5, 6) else 1
    each = values + (not even)
    if source.binary:
        found = _binary(source, body, kind, count, even)
    else:
        found = numbers_of(body, source, _LAYOUT[kind, even], count * each)
    if len(found) != count * each:
        raise ModelError(
            source.part,
            f"is cut short: it states {count} lines and has {len(found) // each}.",
            "Export the file again.",
        )
    rows = found.reshape(count, each)
    with np.errstate(all="ignore"):
        lines = start + step * np.arange(count) if even else rows[:, 0]
    if not even:
        rows = rows[:, 1:]
    # no arithmetic: infinite parts are reported by the caller
    response = rows[:, 0].astype(complex)
    if values == 2:
        response.imag = rows[:, 1]
    return lines, response


def _binary(source: DataSet, body: bytes, kind: int, count: int, even: bool) -> Array:
    order, form = (Columns(source.part, source.fields, source.line - 1).whole([6, 6], 2))[:2]
    if order not in _ORDERS or form != _IEEE:
        raise ModelError(
            source.part,
            f"contains binary numbers of byte order {order} and format {form}.",
            "Export them as IEEE 754 (format 2), or as text (58).",
        )
    way = _ORDERS[order]
    real = np.dtype(f"{way}f8" if kind in (4, 6) else f"{way}f4")
    values = 2 if kind in (5, 6) else 1
    narrow = np.dtype([("x", f"{way}f4"), ("y", real, (values,))])
    if not even and kind in (4, 6) and len(body) == count * narrow.itemsize:
        # the format has abscissae of single precision, most programs write all numbers alike
        rows = np.frombuffer(body, dtype=narrow)
        return _doubles(np.column_stack([rows["x"], rows["y"]])).ravel()
    size = count * (values + (not even)) * real.itemsize
    return _doubles(
        np.frombuffer(body[:size], dtype=real, count=min(size, len(body)) // real.itemsize)
    )


def _doubles(numbers: Array) -> Array:
    # a signalling NaN of single precision raises here; what is not finite is refused by its reader
    with np.errstate(invalid="ignore"):
        return np.asarray(numbers, dtype=float)


def named_functions(
    found: list[RawFunction], geometry: Geometry
) -> tuple[list[FrfRecord], list[str]]:
    """Records whose names differ, in global directions, and why others are left out.

    A node number that occurs in several components bears their names; functions between the
    same ends are numbered.

    Parameters
    ----------
    found : list of RawFunction
    geometry : Geometry
    """
    entities: dict[int, set[str]] = {}
    for one in found:
        for end in (one.output, one.given):
            entities.setdefault(end.node, set()).add(end.entity)
    made: list[FrfRecord] = []
    left: list[str] = []
    for one in found:
        ends = []
        sign = 1.0
        for end in (one.output, one.given):
            index, way = _global_direction(end, geometry, one.part)
            if index is None:
                left.append("response in a local direction that is along no global axis")
                break
            sign *= way
            name = geometry.name(end.node)
            if end.entity and len(entities[end.node]) > 1:
                name = f"{end.entity}/{name}"
            ends.append((name, DIRECTIONS[index]))
        if len(ends) == 2:
            try:
                made.append(
                    FrfRecord(ends[0], ends[1], one.frequencies, sign * one.values, one.motion)
                )
            except ModelError as error:
                raise ModelError(f"{one.part}, {error.part}", error.problem, error.remedy) from None
    return _numbered(made), left


def _global_direction(end: End, geometry: Geometry, part: str) -> tuple[int | None, float]:
    """Index of the global direction and the sign along it."""
    index, sign = abs(end.direction) - 1, float(np.sign(end.direction))
    axes = geometry.turned(end.node, part)
    if axes is None:
        return index, sign
    along = axes[index % 3]
    nearest = int(np.abs(along).argmax())
    if abs(along[nearest]) < 1.0 - 1e-6:
        return None, 0.0
    return nearest + 3 * (index // 3), sign * float(np.sign(along[nearest]))


def _numbered(functions: list[FrfRecord]) -> list[FrfRecord]:
    total: dict[str, int] = {}
    for f in functions:
        total[f.name] = total.get(f.name, 0) + 1
    seen: dict[str, int] = {}
    made = []
    for f in functions:
        seen[f.name] = seen.get(f.name, 0) + 1
        run = f"#{seen[f.name]}" if total[f.name] > 1 else ""
        made.append(FrfRecord(f.output, f.input, f.frequencies, f.values, f.motion, run))
    return made
