"""Modes, frequency responses at the tool and the exact least dynamic stiffness."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from strutwork.fea.eigen import Array
from strutwork.fea.least_stiffness import LeastStiffness
from strutwork.fea.uff import UniversalFile, node_positions, response_records
from strutwork.fea.uff_write import write_universal
from strutwork.names import listed
from strutwork.reports.content import (
    Block,
    Cell,
    Chapter,
    Column,
    Figure,
    Note,
    Points,
    Table,
    Text,
)
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.equal_axes import equal_axes
from strutwork.reports.figures.response_parts import response_parts
from strutwork.reports.figures.theme import AXIS_COLOURS
from strutwork.reports.figures.vibration import drawn_amplitude, mode_lines, mode_view
from strutwork.reports.mode_words import moves
from strutwork.reports.numbers import count, micro, percent, significant
from strutwork.reports.part_groups import part_groups, titles
from strutwork.reports.vibration_study import AXES, VibrationStudy
from strutwork.studies.dynamic import GRID_STEP

#: Parts of a mode's strain energy that the table names, and the least share it names, %.
NAMED, LEAST_SHARE = 3, 3.0


def vibration_chapter(
    study: VibrationStudy,
    before: Sequence[Block] = (),
    after: Sequence[Block] = (),
    files: Sequence[DataFile] = (),
    assumptions: Sequence[str] = (),
) -> Chapter:
    """The vibration of one structure, with what a machine of the literature adds."""
    blocks: list[Block] = [*before, modes_table(study)]
    blocks += [
        Note(text) for text in (study.found.rigid_line, study.modes.note, study.validity) if text
    ]
    if len(study.modes.frequencies):
        blocks += [Text(SWING_TEXT), mode_figure(study)]
    if study.response is not None:
        blocks += [
            response_figure(study),
            minima_table([("", study)], f"{study.key}-minima.csv"),
            Text(GRID_TEXT),
            *([Note(study.stop)] if study.stop else []),
        ]
    else:
        blocks.append(Note(f"No frequency response: {_missing(study)}."))
    blocks += after
    if assumptions:
        blocks.append(Points(tuple(assumptions)))
    return Chapter("vibration", "Vibration", tuple(blocks), (*vibration_files(study), *files))


GRID_TEXT = (
    "The minimum of 1/|H| over the band is that of the continuous curve, not of drawn points, "
    f"and is proved where the table says so. A harmonic sweep in steps of {GRID_STEP:g} Hz would "
    "have shown the value in its column: it is never less, and the narrower the resonance, the "
    "larger its error."
)


#: How the moving picture is to be read.
SWING_TEXT = (
    "The shapes are exaggerated: each mode's largest motion is drawn with the length that the "
    "caption states, and every mode moves at the same slow pace. Modes of equal frequency may be "
    "combined at will; the shapes shown are one choice."
)


def modes_table(study: VibrationStudy, caption: str = "") -> Table:
    """Frequencies, damping and what bends."""
    modes, ratios = study.modes, study.elastic.ratios
    rows = []
    for i, frequency in enumerate(modes.frequencies):
        damping = "none given"
        if ratios is not None:
            damping = f"{100 * ratios[i]:.3g} %" if np.isfinite(ratios[i]) else "withheld"
        number = significant(float(frequency), 4)
        rows.append([str(i + 1), number, damping, moves(study, i), bends(study, i)])
    rigid = int(modes.rigid_body_modes)
    text = caption or "Natural frequencies"
    if rigid:
        text += f"; {count(rigid, 'rigid-body mode')} at 0 Hz"
    return Table(
        text,
        (
            Column("mode", "", False),
            Column("frequency", "Hz"),
            Column("equivalent damping ratio"),
            Column("what moves most", "", False),
            Column("what deforms: largest shares of the strain energy", "", False),
        ),
        rows,
        f"{study.key}-modes.csv",
    )


def bends(study: VibrationStudy, mode: int) -> str:
    """The parts that hold most of a mode's strain energy, parts alike together."""
    energies = zip(study.modes.energy_parts, study.modes.energy_shares[mode], strict=True)
    groups = part_groups({name: 100.0 * float(share) for name, share in energies})
    named = [
        f"{title} {group.share:.0f}\N{NO-BREAK SPACE}%"
        for title, group in list(zip(titles(groups), groups, strict=True))[:NAMED]
        if group.share >= LEAST_SHARE
    ]
    return ", ".join(named) or "nothing: it moves as a rigid body"


def mode_figure(study: VibrationStudy, height: int = 560) -> Figure:
    """Mode shapes, swinging at a button."""
    labels = [
        f"Mode {i + 1}, {significant(float(f), 4)} Hz: {moves(study, i)}".removesuffix(": ")
        for i, f in enumerate(study.modes.frequencies)
    ]
    return Figure(
        f"modes-{study.key}",
        f"{study.title}: mode shapes, grey at rest, coloured by how far each "
        "part moves; the largest motion drawn as "
        f"{significant(1e3 * drawn_amplitude(study), 2)} mm. Choose a mode and press the button.",
        mode_view(study, labels),
        f"Three-dimensional drawing of the mode shapes of {study.title}.",
        f"{study.key}-mode-shapes.csv",
        height,
    )


def response_figure(study: VibrationStudy) -> Figure:
    """Driving-point receptances at the tool along x, y and z; equal ones are one curve."""
    response = study.response
    assert response is not None  # noqa: S101 - callers have looked
    dashes = {"x": "solid", "y": "dash", "z": "solid"}
    own = {a: response.receptance[:, i, i] for i, a in enumerate(AXES)}
    together = equal_axes(list(own.values()), AXES)
    least = dict(zip(AXES, study.least, strict=True))
    curves = {
        f"along {listed(some)}": (
            response.frequencies,
            own[some[0]],
            AXIS_COLOURS[some[0]],
            dashes[some[0]],
        )
        for some in together
    }
    marks = [
        (
            f"least along {listed(some)}",
            least[some[0]].frequency,
            least[some[0]].value,
            AXIS_COLOURS[some[0]],
        )
        for some in together
    ]
    peaks = "; ".join(
        f"along {listed(some)} {micro(least[some[0]].value)} N/µm at "
        f"{significant(least[some[0]].frequency, 4)} Hz"
        for some in together
    )
    same = "".join(
        f" {listed(some)} have the same response and share a curve."
        for some in together
        if len(some) > 1
    )
    return Figure(
        f"frf-{study.key}",
        f"Displacement of the tool{study.relative} per force in the same direction: magnitude, "
        "phase and real part. "
        f"Diamonds mark the least dynamic stiffness, the highest peak of the magnitude: {peaks}."
        f"{same}",
        response_parts(curves, marks),
        f"Magnitude, phase and real part of the receptance at the tool{study.relative} of "
        f"{study.title} along x, y and z; least dynamic stiffness {peaks}.",
        f"{study.key}-frf.csv",
        720,
    )


def minima_table(studies: Sequence[tuple[str, VibrationStudy]], data: str) -> Table:
    """Exact minima beside the static stiffness and a grid's minimum."""
    columns = [
        Column("axis", "", False),
        Column("static", "N/µm"),
        Column("least, exact", "N/µm"),
        Column("at", "Hz"),
        Column("peak", "µm/N"),
        Column(f"on a {GRID_STEP:g} Hz grid", "N/µm"),
        Column("grid too high by"),
        Column("proof", "", False),
    ]
    if len(studies) > 1:
        columns.insert(0, Column("", "", False))
    rows: list[list[str | Cell]] = []
    for name, study in studies:
        for axis, one, grid in zip(_axes(study), *_firsts(study), strict=True):
            excess = 100.0 * (float(grid) / one.value - 1.0)
            line: list[str | Cell] = [
                axis,
                "none" if one.static is None else micro(one.static),
                micro(one.value),
                significant(one.frequency, 5) + _end(one.frequency, study.band),
                significant(1e6 / one.value),
                micro(float(grid)) if np.isfinite(grid) else "no line",
                Cell(percent(excess), "poor" if excess > 5 else "plain")
                if np.isfinite(grid)
                else "no line",
                "finished" if one.certified else Cell("not finished", "poor"),
            ]
            rows.append([name, *line] if len(studies) > 1 else line)
    low, high = studies[0][1].band
    return Table(
        f"Least dynamic stiffness 1/|H| at the tool{studies[0][1].relative} from "
        f"{significant(low)} to "
        f"{significant(high)} Hz, other directions free",
        columns,
        rows,
        data,
    )


def _alike(study: VibrationStudy) -> list[tuple[str, ...]]:
    """Axes with the same minimum together."""
    answers = [
        np.array([one.value, float(np.nan_to_num(grid)), one.static or 0.0])
        for one, grid in zip(study.least, study.grid, strict=True)
    ]
    return equal_axes(answers, AXES)


def _axes(study: VibrationStudy) -> list[str]:
    return [listed(some) for some in _alike(study)]


def _firsts(study: VibrationStudy) -> tuple[list[LeastStiffness], list[float]]:
    which = [AXES.index(some[0]) for some in _alike(study)]
    return [study.least[k] for k in which], [float(study.grid[k]) for k in which]


def _end(frequency: float, band: tuple[float, float]) -> str:
    """A word where no peak but the end of the band is the least."""
    return ", end of band" if min(abs(frequency - b) for b in band) <= 1e-9 * band[1] else ""


def vibration_files(study: VibrationStudy) -> tuple[DataFile, ...]:
    """Every plotted and tabulated number, and the responses as a universal file."""
    modes, key, what = study.modes, study.key, study.title
    ratios = study.elastic.ratios
    files = [
        csv_file(
            f"{key}-modes.csv",
            f"{what}: frequencies, damping ratios, shares of the strain energy",
            ["mode", "frequency_Hz", "damping_ratio", *(f"share_{p}" for p in modes.energy_parts)],
            [
                [i + 1, float(f), _number(ratios, i), *shares.tolist()]
                for i, (f, shares) in enumerate(
                    zip(modes.frequencies, modes.energy_shares, strict=True)
                )
            ],
        ),
    ]
    if len(modes.frequencies):
        files.append(_shape_file(study))
    return (*files, *response_files(study))


def _number(ratios: Array | None, mode: int) -> float | None:
    return None if ratios is None or not np.isfinite(ratios[mode]) else float(ratios[mode])


def response_files(study: VibrationStudy) -> tuple[DataFile, ...]:
    """The responses at the tool and their minima; none where there is no response."""
    key, what, response = study.key, study.title, study.response
    if response is None:
        return ()
    diagonal = np.einsum("fii->fi", response.receptance)
    heads = [f"{part}_{a}_m/N" for a in AXES for part in ("real", "imaginary")]
    columns = [c for i in range(3) for c in (diagonal[:, i].real, diagonal[:, i].imag)]
    everywhere = node_positions(study.placed.structure.mesh_nodes, study.placed.positions)
    port = response.outputs[0]
    universal: tuple[DataFile, ...] = ()
    # a universal file has no place for the node of the workpiece
    if port.against is None:
        content = UniversalFile(
            response_records(response), positions={port.node: everywhere[port.node]}
        )

        def write(path: Path) -> object:
            return write_universal(path, content)

        universal = (
            DataFile(
                f"{key}-frf.uff", f"{what}: the same, all nine, as a universal file (58)", write
            ),
        )
    return (
        csv_file(
            f"{key}-frf.csv",
            f"{what}: receptances at the tool{study.relative}",
            ["frequency_Hz", *heads],
            np.column_stack([response.frequencies, *columns]).tolist(),
        ),
        *universal,
        csv_file(
            f"{key}-minima.csv",
            f"{what}: exact least dynamic stiffness and that of a frequency grid",
            ["axis", "static_N/m", "least_N/m", "frequency_Hz", "peak_m/N", "grid_N/m", "proof"],
            [
                [a, o.static, o.value, o.frequency, 1 / o.value, float(g), o.certified]
                for a, o, g in zip(AXES, study.least, study.grid, strict=True)
            ],
        ),
    )


def _shape_file(study: VibrationStudy) -> DataFile:
    points, motion = mode_lines(study)
    drawn = drawn_amplitude(study) * motion
    rows: list[list[Any]] = [
        [m + 1, *map(float, point), *map(float, shift)]
        for m, shifts in enumerate(drawn)
        for point, shift in zip(points, shifts, strict=True)
    ]
    return csv_file(
        f"{study.key}-mode-shapes.csv",
        (
            f"{study.title}: the drawn lines and their exaggerated motion; empty rows separate "
            "the lines"
        ),
        ["mode", "x_m", "y_m", "z_m", "motion_x_m", "motion_y_m", "motion_z_m"],
        rows,
    )


def _missing(study: VibrationStudy) -> str:
    if study.placed.structure.linkage.tool is None:
        return "the model has no tool"
    if study.found.target.damping is None:
        return "the model file gives no damping"
    return "no mode has a frequency"
