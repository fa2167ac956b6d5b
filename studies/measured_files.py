"""Measurements of universal files: their points are brought to the nodes of a model."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.ports import Port
from strutwork.fea.same_nodes import same_nodes
from strutwork.fea.uff import FrfRecord, ModeRecord, UniversalFile, node_positions
from strutwork.fea.uff_read import read_universal
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.model import Model
from strutwork.machines.model_poses import moved
from strutwork.names import choices, listed, visible
from strutwork.studies.calibration_schema import FrequenciesTable, FrfTable
from strutwork.studies.measured_frequencies import MeasuredShapes
from strutwork.studies.measured_frf import MeasuredFrf
from strutwork.studies.measurement import require_node

Array = NDArray[Any]

#: Frequencies of two functions that differ by less, as a share, are the same line.
SAME_LINE = 1e-6


def frequencies_of_file(
    table: FrequenciesTable, name: str, model: Model, task: Mapping[str, float], folder: Path
) -> tuple[Array, MeasuredShapes]:
    """Measured frequencies (t,), Hz, and the shapes that belong to them.

    Parameters
    ----------
    table : FrequenciesTable
        Its `modes` choose among the modes of the file, by their order from 1.
    name : str
        For messages.
    model : Model
    task : mapping of direction to float
        Pose of the tool, m and rad.
    folder : Path
        Where the name of the file begins.

    Raises
    ------
    ModelError
        No such file, mode or node, or no mode in it.
    """
    content = read_universal(folder / str(table.file))
    records: list[ModeRecord] = sorted(content.modes, key=lambda m: m.frequency)
    if not records:
        raise ModelError(
            name, f"names {table.file}, which contains no mode.", "Export modes (55 or 2414)."
        )
    if table.modes is not None:
        beyond = [n for n in table.modes if n > len(records)]
        if beyond or not table.modes:
            raise ModelError(
                name,
                f"asks for mode {beyond[0] if beyond else 0} of {len(records)}.",
                "Name modes of the file, from 1.",
            )
        records = [records[n - 1] for n in sorted(set(table.modes))]
    mapped, _ = _nodes(content, table.points, name, model, task)
    common = [p for p in records[0].nodes if p in mapped and all(p in m.nodes for m in records)]
    if not common:
        raise _unmapped(name, records[0].nodes, model)
    shapes = []
    for record in records:
        at = [record.nodes.index(p) for p in common]
        shape = record.shape[at, :3]
        if not np.any(shape):
            raise ModelError(
                name,
                f"has a mode at {record.frequency:g} Hz that moves no point that is in the model.",
                "Map more points to nodes: points = { POINT = NODE }.",
            )
        shapes.append(shape)
    values = np.array([r.frequency for r in records])
    if np.any(values <= 0):
        raise ModelError(name, "contains a mode at 0 Hz.", "Choose others with modes = [...].")
    return values, MeasuredShapes(tuple(mapped[p] for p in common), np.array(shapes))


def frf_of_file(
    table: FrfTable, name: str, task: Mapping[str, float], model: Model, folder: Path
) -> MeasuredFrf:
    """Measured responses within their band, between nodes of the model.

    Parameters
    ----------
    table : FrfTable
    name : str
        For messages.
    task : mapping of direction to float
        Pose of the tool, m and rad.
    model : Model
    folder : Path
        Where the name of the file begins.

    Raises
    ------
    ModelError
        No such file or node, no function between nodes of the model, no line in the band, lines
        without response, functions on other lines than the first.
    """
    low, high = table.band
    if not low < high:
        raise ModelError(name, f"has a band from {low:g} to {high:g} Hz.", "Give the lower first.")
    content = read_universal(folder / table.file, table.units)
    if not content.functions:
        raise ModelError(
            name, f"names {table.file}, which contains no function.", "Export functions (58)."
        )
    mapped, ports = _nodes(content, table.points, name, model, task)
    used: list[tuple[FrfRecord, Port, Port]] = []
    left = []
    for record in content.functions:
        ends = [ports.get(end) or _port(mapped, end) for end in (record.output, record.input)]
        if ends[0] is None or ends[1] is None:
            left.append(record.name)
        else:
            used.append((record, ends[0], ends[1]))
    if not used:
        ends_of = [node for f in content.functions for node, _ in (f.output, f.input)]
        raise _unmapped(name, tuple(dict.fromkeys(ends_of)), model)
    lines = _lines(used[0][0], low, high, table.lines, name)
    values = [_logarithms(record, lines, low, high, name) for record, _, _ in used]
    said = [f"{name}: {f}" for f in (*content.notes,)]
    if left:
        said.append(
            f"{name}: {len(left)} functions are between points that the model does not have and "
            f"are left out: {listed(left[:3])}"
        )
    said.append(f"{name}: {len(lines)} lines of {len(used)} functions are compared")
    flat = np.concatenate(values)
    return MeasuredFrf(
        name,
        task,
        tuple((o, i) for _, o, i in used),
        lines,
        flat,
        np.full(len(flat), float(table.scatter)),
        table.modal_ratio,
        tuple(said),
    )


def _nodes(
    content: UniversalFile,
    points: Mapping[str, str],
    name: str,
    model: Model,
    task: Mapping[str, float],
) -> tuple[dict[str, str], dict[tuple[str, str], Port]]:
    """Node of each measured point, and ports of points of which single directions are mapped."""
    names = model.structure.mesh_nodes
    placement = model.placement
    if task:
        batch = moved(model, {d: np.array([v]) for d, v in task.items()})[1].require_reachable()
        placed = model.structure.at(batch)
        places = placed.positions[0]
    else:
        places = model.structure.at(placement).positions
    # by name or place as correlate does; only then what the file says by hand
    own = UniversalFile(positions=node_positions(names, places))
    found = same_nodes(own, content)[0]
    ports: dict[tuple[str, str], Port] = {}
    for point, node in points.items():
        at, direction = _split(point)
        if at not in content.nodes:
            raise ModelError(
                f"{name}.points",
                f'names the unknown measured point "{visible(at)}".',
                choices("Points", at, content.nodes),
            )
        target, way = _split(node)
        require_node(f"{name}.points", model, target)
        if bool(direction) != bool(way):
            raise ModelError(
                f"{name}.points",
                f'maps "{visible(point)}" to "{visible(node)}".',
                'Map a point to a node, or a direction to a direction: "12:x" = "TCP:z".',
            )
        if direction:
            ports[at, direction] = Port(target, way)
        else:
            found[at] = target
    return found, ports


def _split(text: str) -> tuple[str, str]:
    """A point and its direction; the sign of a direction does not change a magnitude."""
    point, _, direction = text.rpartition(":")
    plain = direction.lstrip("+-")
    return (point, plain) if point and plain in DIRECTIONS else (text, "")


def _port(mapped: Mapping[str, str], end: tuple[str, str]) -> Port | None:
    node, direction = end
    return Port(mapped[node], direction) if node in mapped else None


def _unmapped(name: str, points: tuple[str, ...], model: Model) -> ModelError:
    some = listed([f'"{visible(p)}"' for p in points[:4]])
    return ModelError(
        name,
        f"has no point that is a node of the model by its name or place; points: {some}.",
        'Map them: points = { "POINT" = "NODE" }. '
        + choices("Nodes", points[0] if points else "", model.nodes),
    )


def _lines(record: FrfRecord, low: float, high: float, most: int, name: str) -> Array:
    """Measured lines in the band, not more than asked for, evenly chosen."""
    inside = record.frequencies[(record.frequencies >= low) & (record.frequencies <= high)]
    inside = inside[inside > 0]
    if len(inside) < 2:
        first, last = record.frequencies[0], record.frequencies[-1]
        raise ModelError(
            name,
            f"has {len(inside)} measured lines in the band {low:g} to {high:g} Hz; function "
            f"{record.name} goes from {first:g} to {last:g} Hz.",
            "Give a band within the measured one.",
        )
    if len(inside) <= most:
        return np.asarray(inside)
    return np.asarray(inside[np.unique(np.linspace(0, len(inside) - 1, most).round().astype(int))])


def _logarithms(record: FrfRecord, lines: Array, low: float, high: float, name: str) -> Array:
    """ln|H| of the receptance on the lines, (f,), H in m/N and the like."""
    at = np.searchsorted(record.frequencies, lines * (1 - SAME_LINE))
    at = np.minimum(at, len(record.frequencies) - 1)
    if not np.allclose(record.frequencies[at], lines, rtol=SAME_LINE, atol=0.0):
        raise ModelError(
            name,
            f"contains function {record.name}, whose lines between {low:g} and {high:g} Hz are "
            "not those of the first function.",
            "Put functions with other lines in a table [[frf]] of their own.",
        )
    inside = FrfRecord(
        record.output, record.input, record.frequencies[at], record.values[at], record.motion
    )
    size = np.abs(inside.as_motion("displacement"))
    if np.any(size == 0):
        raise ModelError(
            name,
            f"contains function {record.name}, which is zero at "
            f"{float(lines[int(np.argmin(size))]):g} Hz.",
            "Choose a band in which it was measured.",
        )
    return np.log(size)
