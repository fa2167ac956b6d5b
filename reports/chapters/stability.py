"""How deep it can cut without chatter: at home by speed and feed, and over the workspace."""

from __future__ import annotations

import json
from math import degrees

import numpy as np

from strutwork.reports.content import Block, Chapter, Column, Figure, Note, Row, Table, Text
from strutwork.reports.cut_study import CutStudy
from strutwork.reports.data_files import DataFile, csv_file, netcdf_file
from strutwork.reports.figures.lobes import lobes_diagram, rose
from strutwork.reports.figures.slices import slice_figure
from strutwork.reports.figures.vibration import drawn_amplitude, mode_lines, mode_view
from strutwork.reports.limiting_part import effect_groups, limiting_sentence, raised
from strutwork.reports.mode_words import moves
from strutwork.reports.numbers import share, significant
from strutwork.reports.part_groups import titles
from strutwork.reports.subject import Subject
from strutwork.reports.survey_words import grid_text, largest, least
from strutwork.studies.survey_files import write_survey

KEY = "stability"
TITLE = "How deep can it cut without chatter?"
STEM = "stability-survey"

#: Parts that the table names, and the least effect it names.
NAMED, LEAST_EFFECT = 8, 0.005


def missing(subject: Subject) -> str:
    """Why there is nothing to say; empty where there is."""
    return subject.unstable


def write(subject: Subject) -> Chapter:
    """The cut, its lobes and rose, what limits it, and its map."""
    study = subject.cut
    found = study.lobes
    depth, frequency = found.absolute
    sentence = limiting_sentence(found.effects)
    at_home = (
        f"At home a depth of {significant(1e3 * depth)} mm is stable at every spindle speed, by "
        f"the zero-order method; beyond it the cut chatters at {significant(frequency, 4)} Hz."
    )
    worst = int(np.argmin(found.rose.depth))
    blocks: list[Block] = [
        Text(_process(study)),
        Text(sentence),
        Row((_lobes_figure(study), _rose_figure(study, worst)), 330),
        *([_pockets(study)] if found.pockets else []),
        *([Note(found.note)] if found.note else []),
        _parts(study),
        _mode(study),
    ]
    files: tuple[DataFile, ...] = (*found.files(), _shape_file(study))
    if not subject.unmoved:
        some, more = _map(subject)
        blocks += some
        files = (*files, *more)
    blocks.append(Note(LIMITS))
    return Chapter(KEY, TITLE, tuple(blocks), files, at_home)


LIMITS = (
    "The force is linear in the chip thickness and the teeth are equally spaced; damping by the "
    "flank of the tool is left out. The coefficients of a material hold for the tool and the feed "
    "of their test. The tool and its holder are as stiff as the model states: a slender tool "
    "chatters by its own modes, which are not in it."
)


def _process(study: CutStudy) -> str:
    process, given = study.lobes.process, study.described
    cutter, coefficients = process.cutter, process.coefficients
    helix = f", helix {degrees(cutter.helix):g}°" if cutter.helix else ""
    name = coefficients.name or given.material or "the material"
    source = f" ({coefficients.source})" if coefficients.source else ""
    return (
        f"The cut is {process.way}-milling of {name} with {process.teeth} teeth, diameter "
        f"{1e3 * cutter.diameter:g} mm{helix}, at a radial depth of "
        f"{100 * process.immersion:g} % of the diameter and {1e3 * given.feed_per_tooth:g} mm per "
        f"tooth, at {given.speeds[0]:g} to {given.speeds[1]:g} rpm. Force coefficients: "
        f"{coefficients.tangential / 1e6:g} MPa tangential, {coefficients.radial / 1e6:g} MPa "
        f"radial, {coefficients.axial / 1e6:g} MPa axial{source}. "
        f"Damping: {study.lobes.target.damping}."
        f"{_relative(study.lobes.target.placed.structure.linkage.relative_to)}"
    )


def _relative(to: str) -> str:
    return f" The response of the tool is{to}, on which the opposite force acts." if to else ""


def _lobes_figure(study: CutStudy) -> Figure:
    found = study.lobes
    exact = found.exact is not None
    best = ""
    if found.pockets:
        first = found.pockets[0]
        best = (
            f" The largest removal rate is at {first.speed:.0f} rpm and "
            f"{significant(1e3 * first.depth)} mm."
        )
    what = "below the solid line, in the shaded area," if exact else "below the line"
    return Figure(
        "stability-lobes",
        f"Limiting depth by spindle speed at home; {what} a cut is stable; "
        "up to the dashed line it is at every speed, by the zero-order method. Limiting mode: "
        f"{significant(found.effects.limiting_mode, 4)} Hz.{best}",
        lobes_diagram(found),
        f"Limiting depth of cut over the spindle speed; {significant(1e3 * found.absolute[0])} mm "
        "are stable at every speed.",
        "stability-lobes.csv",
        400,
    )


def _rose_figure(study: CutStudy, worst: int) -> Figure:
    limits = study.lobes.rose
    angle, depth = degrees(float(limits.feeds[worst])), 1e3 * float(limits.depth[worst])
    return Figure(
        "stability-rose",
        "Depth stable at every speed, by the direction of the feed, turned about the tool's axis "
        f"from the feed of the process: least {significant(depth)} mm at {angle:g}°.",
        rose(study.lobes),
        f"Polar plot of the limiting depth over the direction of the feed; least "
        f"{significant(depth)} mm at {angle:g}°.",
        "stability-rose.csv",
        400,
    )


def _pockets(study: CutStudy) -> Table:
    rows = [
        [f"{p.speed:.0f}", significant(1e3 * p.depth), significant(6e7 * p.removal_rate)]
        for p in study.lobes.pockets
    ]
    method = "zero-order limits" if study.lobes.exact is None else "exact limits"
    columns = (
        Column("spindle speed", "rpm"),
        Column("limiting depth", "mm"),
        Column("removal rate", "cm³ per minute"),
    )
    return Table(f"Best speeds at home, {method}", columns, rows, "stability-lobes.csv")


def _parts(study: CutStudy) -> Table:
    groups = effect_groups(study.lobes.effects)
    rows = [
        [title, significant(group.share), share(raised(group.share))]
        for title, group in list(zip(titles(groups), groups, strict=True))[:NAMED]
        if abs(group.share) >= LEAST_EFFECT
    ]
    columns = (
        Column("parts", "", False),
        Column("relative sensitivity"),
        Column("depth gained if 10 % stiffer"),
    )
    return Table(
        "What limits the depth: relative change of the depth that is stable at every speed per "
        "relative change of the parts' stiffness",
        columns,
        rows,
        "stability-depth-effects.csv",
    )


def _mode(study: CutStudy) -> Figure:
    mode = study.mode
    frequency = significant(float(mode.modes.frequencies[0]), 4)
    label = f"{frequency} Hz: {moves(mode, 0)}".removesuffix(": ")
    return Figure(
        "stability-mode",
        f"The mode that limits the depth, {label}; grey at rest, coloured by how far each part "
        f"moves; the largest motion drawn as {significant(1e3 * drawn_amplitude(mode), 2)} mm. "
        "Press the button to move it.",
        mode_view(mode, [f"Limiting mode, {label}"]),
        "Three-dimensional drawing of the mode that limits the depth of cut.",
        "stability-mode-shape.csv",
        460,
    )


def _shape_file(study: CutStudy) -> DataFile:
    points, motion = mode_lines(study.mode)
    shifts = drawn_amplitude(study.mode) * motion[0]
    rows = [[*map(float, p), *map(float, shift)] for p, shift in zip(points, shifts, strict=True)]
    return csv_file(
        "stability-mode-shape.csv",
        "the drawn lines of the limiting mode and their motion; empty rows separate the lines",
        ["x_m", "y_m", "z_m", "motion_x_m", "motion_y_m", "motion_z_m"],
        rows,
    )


def _map(subject: Subject) -> tuple[list[Block], tuple[DataFile, ...]]:
    found = subject.stability_survey
    rows, figures = [], []
    for key, words, factor, unit, drawn in (
        ("limiting_depth", "depth stable at every speed", 1e3, "mm", True),
        ("least_depth", "the same in the worst direction of feed", 1e3, "mm", False),
        ("chatter_frequency", "chatter frequency", 1.0, "Hz", False),
        ("pocket_depth", "depth at the best speed", 1e3, "mm", False),
        ("removal_rate", "removal rate at the best speed", 6e7, "cm³ per minute", True),
    ):
        values = factor * found[key].to_numpy()
        values = np.where(np.isfinite(values), values, np.nan)
        if not np.isfinite(values).any():
            continue
        low, high = least(found, values), largest(found, values)
        rows.append(
            [words, unit, significant(low.value), low.where, significant(high.value), high.where]
        )
        if drawn:
            name = f"{STEM}-{key.replace('_', '-')}"
            figures.append(slice_figure(found, values, (words, unit), name, f"{STEM}.csv"))
    columns = (
        Column("", "", False),
        Column("unit", "", False),
        Column("least"),
        Column("least at", "", False),
        Column("largest"),
        Column("largest at", "", False),
    )
    dropped = json.loads(found.attrs["dropped_by_reason"])
    left = f" {sum(dropped.values())} poses cannot be taken and are blank." if dropped else ""
    blocks: list[Block] = [
        Text(
            f"The survey covers {grid_text(subject.grid)}. Axis and feed turn with the tool; "
            "depths are those of the zero-order method, of at most the cutter's diameter."
            f"{left}"
        ),
        Table("Stability over the workspace", columns, rows, f"{STEM}.csv"),
        Row(tuple(figures), 330),
    ]
    files = (
        netcdf_file(f"{STEM}.nc", "limiting depths over the workspace, NetCDF", found),
        DataFile(
            f"{STEM}.csv",
            "limiting depths over the workspace: one line per pose",
            lambda path: write_survey(path, found),
        ),
    )
    return blocks, files
