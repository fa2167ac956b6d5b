"""Modes of universal files (55, 2414)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.assurance import mac
from strutwork.fea.uff import ModeRecord
from strutwork.fea.uff_geometry import Geometry
from strutwork.fea.uff_sets import DataSet, Records

Array = NDArray[Any]

#: Analyses that are modes: normal, complex of first and of second order.
_NORMAL, _COMPLEX = 2, (3, 7)

_ANALYSES = {
    1: "statics",
    4: "transient",
    5: "frequency response",
    6: "buckling",
    9: "nonlinear statics",
}

#: Results that are motion: displacement, velocity, acceleration; shapes of a mode are alike.
_MOTIONS = (8, 11, 12)

#: Results of which the format says no more than that they are vectors.
_UNSAID = {55: (0, 1), 2414: (0, 95, 96)}

_RESULTS = {
    2: "stress",
    3: "strain",
    4: "element force",
    5: "temperature",
    7: "strain energy",
    9: "reaction force",
    10: "kinetic energy",
    13: "strain energy density",
    32: "constraint force",
}

#: Data characteristics that are vectors, by their numbers a node; 0 is unknown.
_VECTORS = {0: (3, 6), 2: (3, 6), 3: (6, 3)}

_COMPLEX_DATA = (5, 6)


@dataclass(frozen=True)
class _Header:
    analysis: int
    characteristic: int
    result: int
    data: int
    count: int

    def refusal(self, kind: int) -> str:
        """Why these are no modes; empty where they are."""
        if self.analysis != _NORMAL and self.analysis not in _COMPLEX:
            what = _ANALYSES.get(self.analysis, f"analysis type {self.analysis}")
            return f"data set {kind} of {what}"
        if self.result not in _MOTIONS and self.result not in _UNSAID[kind]:
            what = _RESULTS.get(self.result, f"result type {self.result}")
            return f"data set {kind} of {what}"
        if self.characteristic not in _VECTORS:
            return f"data set {kind} of data characteristic {self.characteristic}, no vectors"
        if self.count not in _VECTORS[self.characteristic]:
            return f"data set {kind} with {self.count} values per node"
        return ""


@dataclass(frozen=True)
class RawMode:
    """A mode as it stands in the file.

    Parameters
    ----------
    part : str
        For messages.
    source : (int, int)
        Data set, and the kind of result that it names.
    said : bool
        Whether that kind is a motion.
    frequency : float
        Hz.
    damping_ratio : float or None
        ζ, no unit; None where the file has none.
    nodes : tuple of int
    values : (n, 3) or (n, 6)
        Real or complex, in the file's unit, in the directions of the nodes.
    """

    part: str
    source: tuple[int, int]
    said: bool
    frequency: float
    damping_ratio: float | None
    nodes: tuple[int, ...]
    values: Array


def raw_mode(source: DataSet) -> RawMode | str:
    """Read a mode of 55 or 2414; a text says why the set is left out.

    Parameters
    ----------
    source : DataSet
    """
    records = Records(source)
    if source.kind == 2414:
        records.skip(2)
        location = records.next().whole([10])[0]
        if location != 1:
            return f"data set 2414 of values on elements (location {location})"
    records.skip(5)
    _, analysis, characteristic, result, data, count = records.next().whole([10] * 6, 6)
    header = _Header(analysis, characteristic, result, data, count)
    reason = header.refusal(source.kind)
    if reason:
        return reason
    if source.kind == 2414:
        records.skip(2)
        real = _padded(records.next().numbers([13] * 6)) + _padded(records.next().numbers([13] * 6))
        normal, root = (real[1], real[4], real[5]), complex(real[6], real[7])
    else:
        records.skip(1)
        real = _padded(records.next().numbers([13] * 6))
        normal, root = (real[0], real[2], real[3]), complex(real[0], real[1])
    each = count * (2 if data in _COMPLEX_DATA else 1)
    nodes, rows = [], []
    while records:
        nodes.append(records.next().whole([10])[0])
        rows.append(records.numbers(each, 13))
    if not nodes:
        raise ModelError(
            source.part, "is cut short: it contains no node.", "Export the file again."
        )
    if len(set(nodes)) < len(nodes):
        raise ModelError(source.part, "holds a node twice.", "Export each node once.")
    values = np.array(rows)
    if data in _COMPLEX_DATA:
        pairs, values = values, values[:, 0::2].astype(complex)
        values.imag = pairs[:, 1::2]
    if not (np.all(np.isfinite(values)) and np.all(np.isfinite([*normal, root]))):
        raise ModelError(
            source.part,
            "contains a number that is not finite (NaN or infinity).",
            "Repair the measurement or omit it.",
        )
    if analysis == _NORMAL:
        frequency, viscous, hysteretic = normal
        ratio = viscous or hysteretic / 2.0
    else:
        size = float(np.hypot(root.real, root.imag))
        frequency, ratio = size / (2.0 * np.pi), -root.real / size if size else 0.0
    if frequency < 0 or not np.isfinite(frequency):
        raise ModelError(
            source.part, f"has a mode at {frequency:g} Hz.", "A frequency is zero or positive."
        )
    # the format has no mark for damping that is not known: it is zero
    return RawMode(
        source.part,
        (source.kind, result),
        result in _MOTIONS,
        frequency,
        ratio or None,
        tuple(nodes),
        values,
    )


def _padded(values: list[float]) -> list[float]:
    return (values + [0.0] * 6)[:6]


def global_modes(found: list[RawMode], geometry: Geometry) -> tuple[list[ModeRecord], list[str]]:
    """Modes in global directions, and what is to be said about them.

    A mode that the file holds twice, as displacement and as velocity or in both data sets, is
    taken once.

    Parameters
    ----------
    found : list of RawMode
    geometry : Geometry
    """
    made: list[ModeRecord] = []
    taken: list[RawMode] = []
    notes: list[str] = []
    for one in found:
        if any(_same(one, other) for other in taken):
            notes.append("a mode that occurs twice")
            continue
        shape = np.zeros((len(one.values), 6), dtype=one.values.dtype)
        shape[:, : one.values.shape[1]] = one.values
        turned = 0
        for i, node in enumerate(one.nodes):
            axes = geometry.turned(node, one.part)
            if axes is not None:
                shape[i] = np.concatenate([shape[i, :3] @ axes, shape[i, 3:] @ axes])
                turned += 1
        if not np.all(np.isfinite(shape)):
            raise ModelError(one.part, "contains numbers too large to rotate.", "Scale the shape.")
        if turned:
            notes.append("modes rotated from local axes of nodes into global ones")
        if not one.said:
            notes.append("modes of unknown kind, taken as displacements")
        taken.append(one)
        names = tuple(geometry.name(node) for node in one.nodes)
        made.append(ModeRecord(float(one.frequency), one.damping_ratio, names, shape))
    return made, notes


def _same(one: RawMode, other: RawMode) -> bool:
    if one.source == other.source or one.nodes != other.nodes:
        return False
    if one.values.shape != other.values.shape or not np.isclose(
        one.frequency, other.frequency, rtol=1e-6, atol=0.0
    ):
        return False
    if not (np.any(one.values) and np.any(other.values)):
        return False
    return bool(mac(one.values.ravel(), other.values.ravel())[0, 0] > 1.0 - 1e-8)
