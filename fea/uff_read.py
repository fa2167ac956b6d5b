"""Reading universal files through pyuff, with every fault named."""

from __future__ import annotations

import contextlib
import io
import re
import stat
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pyuff
from numpy.typing import NDArray

from fea.uff import FrfRecord, ModeRecord, Motion, UniversalFile
from kinematics import DIRECTIONS
from strutwork.errors import ModelError

Array = NDArray[Any]

#: A larger file is refused, bytes.
MAX_BYTES = 200_000_000

#: A line that opens or closes a data set, as pyuff finds it.
_DELIMITER = re.compile(rb"    -1(?=[\r\n]|\Z| {74})")

_MOTION: Mapping[int, Motion] = {8: "displacement", 11: "velocity", 12: "acceleration"}

#: Denominators that are forces: unknown, reaction force, excitation force.
_FORCES = (0, 9, 13)

_TYPES = (55, 58, 164, 2411, 2412, 2414, 2467)

#: Units that axis labels name, in SI; a label goes before the units of the file.
_LABELS: Mapping[str, float] = {
    "m": 1.0,
    "mm": 1e-3,
    "um": 1e-6,
    "µm": 1e-6,
    "in": 0.0254,
    "g": 9.80665,
    "rad": 1.0,
    "deg": np.pi / 180,
    "N": 1.0,
    "kN": 1e3,
    "lbf": 4.4482216152605,
}

_SEE = "Export functions (58) or modes (55, 2414) as a universal file."


def read_universal(path: str | Path) -> UniversalFile:
    """Read frequency response functions, modes and nodes of a universal file.

    Parameters
    ----------
    path : str or Path
        200 MB at most.

    Returns
    -------
    UniversalFile
        In SI units, by data set 164 and by axis labels that name others; negative directions
        are turned into positive ones. Nodes bear the names of groups of one node (2467), else
        their numbers.

    Raises
    ------
    ModelError
        The file cannot be read, is no universal file, is cut short, holds a number that is not
        finite, or neither a function nor a mode.
    """
    path = Path(path)
    data = _content(path)
    marks = [match.start() for match in _DELIMITER.finditer(data)]
    if not marks:
        what = "binary data" if b"\0" in data[:4096] else "text"
        raise ModelError(
            str(path), f"is no universal file: it is {what} without a line of    -1.", _SEE
        )
    if len(marks) % 2:
        kind = data[marks[-1] :].split(b"\n")[1:2]
        kind_of = kind[0].decode("ascii", "replace").strip()[:8] if kind else ""
        raise ModelError(
            str(path),
            f"is cut short: its last data set{f' (type {kind_of})' if kind_of else ''} is not "
            "closed.",
            "Copy or export it again.",
        )
    draft = _Draft(str(path))
    # pyuff prints what it reads of groups
    with contextlib.redirect_stdout(io.StringIO()):
        source = pyuff.UFF(str(path))
        kinds = [int(kind) for kind in source.get_set_types()]
        order = sorted(range(len(kinds)), key=lambda i: kinds[i] not in (164, 2467))
        for i in order:
            if kinds[i] not in _TYPES:
                draft.ignored.append(f"data set {kinds[i]}")
                continue
            draft.part = f"{path}, data set {i + 1} (type {kinds[i]})"
            try:
                draft.add(kinds[i], source.read_sets(i))
            # pyuff raises bare exceptions
            except ModelError:
                raise
            except Exception as error:
                raise ModelError(
                    draft.part,
                    "cannot be read: a line is missing, cut short or no number.",
                    "Export the file again.",
                ) from error
    found = draft.done()
    if not found.functions and not found.modes:
        held = ", ".join(dict.fromkeys(found.ignored)) or "nodes and units"
        raise ModelError(str(path), f"holds no function and no mode, only {held}.", _SEE)
    return found


def _content(path: Path) -> bytes:
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            raise ModelError(str(path), "is not an ordinary file.", "Name a universal file.")
        if status.st_size > MAX_BYTES:
            raise ModelError(
                str(path),
                f"has {status.st_size / 1e6:.0f} MB, more than the {MAX_BYTES / 1e6:.0f} MB that "
                "are read.",
                "Export fewer functions or lines.",
            )
        data = path.read_bytes()
    except FileNotFoundError:
        raise ModelError(str(path), "does not exist.", "Check the path.") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise ModelError(str(path), f"cannot be read ({reason}).", "Check the path.") from None
    if not data.strip():
        raise ModelError(str(path), "is empty.", _SEE)
    return data


@dataclass
class _Draft:
    """A universal file while it is read."""

    part: str
    length: float = 1.0
    force: float = 1.0
    names: dict[int, str] = field(default_factory=dict)
    functions: list[FrfRecord] = field(default_factory=list)
    modes: list[ModeRecord] = field(default_factory=list)
    positions: dict[str, Array] = field(default_factory=dict)
    lines: list[tuple[str, str]] = field(default_factory=list)
    ignored: list[str] = field(default_factory=list)

    def done(self) -> UniversalFile:
        return UniversalFile(
            tuple(self.functions),
            tuple(self.modes),
            self.positions,
            tuple(self.lines),
            tuple(self.ignored),
        )

    def add(self, kind: int, one: dict[Any, Any]) -> None:
        reader = {
            55: self._shape_55,
            58: self._function,
            164: self._units,
            2411: self._nodes,
            2412: self._elements,
            2414: self._shape_2414,
            2467: self._groups,
        }
        reader[kind](one)

    def _name(self, number: int) -> str:
        return self.names.get(number, str(number))

    def _finite(self, *arrays: Any) -> None:
        for array in arrays:
            if not np.all(np.isfinite(array)):
                raise ModelError(
                    self.part,
                    "holds a number that is not finite (NaN or infinity).",
                    "Repair the measurement or leave it out.",
                )

    def _units(self, one: dict[Any, Any]) -> None:
        self._finite(one["length"], one["force"])
        if one["length"] <= 0 or one["force"] <= 0:
            raise ModelError(self.part, "has a unit factor of zero or below.", "Correct it.")
        # the format gives the number of the file's units in one of SI
        self.length, self.force = one["length"], one["force"]

    def _groups(self, one: dict[Any, Any]) -> None:
        for group in one["groups"]:
            if len(group["entity_tag"]) == 1 and group["entity_type_code"][0] == 7:
                self.names[int(group["entity_tag"][0])] = group["group_name"]
        if len(set(self.names.values())) < len(self.names):
            # groups that do not name nodes one by one are no names
            self.names.clear()

    def _nodes(self, one: dict[Any, Any]) -> None:
        columns = [one[key] for key in ("node_nums", "x", "y", "z")]
        if len({len(column) for column in columns}) != 1:
            raise ModelError(self.part, "is cut short.", "Export the file again.")
        self._finite(*columns)
        for number, *place in zip(*columns, strict=True):
            self.positions[self._name(int(number))] = np.array(place) / self.length

    def _elements(self, one: dict[Any, Any]) -> None:
        for kind, elements in one.items():
            if not isinstance(kind, int):
                continue
            for element in elements:
                nodes = [self._name(n) for n in element["nodes_nums"]]
                self.lines += list(pairwise(nodes))
                if len(nodes) > 2:
                    self.lines.append((nodes[-1], nodes[0]))

    def _function(self, one: dict[Any, Any]) -> None:
        if one["func_type"] != 4:
            self.ignored.append(f"function of type {one['func_type']}")
            return
        above, below = one["ordinate_spec_data_type"], one["orddenom_spec_data_type"]
        directions = [int(one[key]) for key in ("rsp_dir", "ref_dir")]
        if below not in _FORCES or 0 in directions or above == 13:
            self.ignored.append("function that is no motion per force in a direction")
            return
        if above not in _MOTION:
            raise ModelError(
                self.part,
                f"does not tell displacement, velocity or acceleration (type {above}).",
                "Set the ordinate's specific data type to 8, 11 or 12.",
            )
        values, lines = np.asarray(one["data"], dtype=complex), np.asarray(one["x"], dtype=float)
        if not len(values) == len(lines) == one["num_pts"]:
            raise ModelError(
                self.part,
                f"is cut short: it says {one['num_pts']} lines and has {len(values)}.",
                "Export the file again.",
            )
        self._finite(values, lines)
        output, given = (DIRECTIONS[abs(d) - 1] for d in directions)
        scale = float(np.sign(directions[0]) * np.sign(directions[1]))
        scale *= _label(one["ordinate_axis_units_lab"], None if output[0] == "r" else self.length)
        per = self.force * (self.length if given[0] == "r" else 1.0)
        scale /= _label(one["orddenom_axis_units_lab"], per)
        self.functions.append(
            FrfRecord(
                (self._name(one["rsp_node"]), output),
                (self._name(one["ref_node"]), given),
                lines,
                values * scale,
                _MOTION[above],
            )
        )

    def _shape_55(self, one: dict[Any, Any]) -> None:
        kind = one["analysis_type"]
        if kind not in (2, 3, 7):
            self.ignored.append(f"data set 55 of analysis type {kind}")
            return
        count = one["n_data_per_node"]
        if count not in (3, 6):
            self.ignored.append(f"data set 55 with {count} values a node")
            return
        values = np.stack([one[f"r{k + 1}"] for k in range(count)], axis=1)
        if kind == 2:
            ratio = one["modal_damp_vis"] or one["modal_damp_his"] / 2.0
            self._add_mode(one["freq"], ratio, one["node_nums"], values)
        else:
            root = complex(one["eig"])
            self._finite(root)
            size = abs(root)
            ratio = -root.real / size if size else 0.0
            self._add_mode(size / (2.0 * np.pi), ratio, one["node_nums"], values)

    def _shape_2414(self, one: dict[Any, Any]) -> None:
        kind = (one["analysis_type"], one["dataset_location"])
        if kind != (2, 1):
            self.ignored.append(f"data set 2414 of analysis type {kind[0]}")
            return
        values = np.array(one["data_at_node"], dtype=float)
        if one["data_type"] in (5, 6):
            values = values[:, 0::2] + 1j * values[:, 1::2]
        if values.ndim != 2 or values.shape[1] not in (3, 6):
            self.ignored.append("data set 2414 without 3 or 6 values a node")
            return
        ratio = one["record12_field5"] or one["record12_field6"] / 2.0
        self._add_mode(one["record12_field2"], ratio, one["node_nums"], values)

    def _add_mode(self, frequency: float, ratio: float, numbers: Array, values: Array) -> None:
        if len(numbers) != len(values) or not len(numbers):
            raise ModelError(self.part, "is cut short.", "Export the file again.")
        self._finite(frequency, ratio, values)
        shape = np.zeros((len(values), 6), dtype=values.dtype)
        shape[:, : values.shape[1]] = values
        nodes = tuple(self._name(int(n)) for n in numbers)
        # the format has no mark for damping that is not known: it is zero
        self.modes.append(ModeRecord(float(frequency), ratio or None, nodes, shape))


def _label(text: str, factor: float | None) -> float:
    """SI value of the unit that a label names, else of the file's unit, `factor` in one of SI."""
    top = text.partition("/")[0].replace("·", "*").replace("-", "*")
    units = [_LABELS.get(unit.strip()) for unit in top.split("*")]
    if None not in units:
        return float(np.prod([unit for unit in units if unit is not None]))
    return 1.0 if factor is None else 1.0 / factor
