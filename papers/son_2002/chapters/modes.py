"""Modes of the MIT-SS-1 on its granite: beside the published ones, as shapes, by energy."""

from __future__ import annotations

import numpy as np

from strutwork.fea.solid_fields import SurfaceField
from strutwork.papers.published_rows import PublishedRow, file_name
from strutwork.papers.son_2002.calibrated import Which
from strutwork.papers.son_2002.chapters.energies import MODES_FILE, energy_blocks
from strutwork.papers.son_2002.chapters.plane import axes, plane_file
from strutwork.papers.son_2002.figures.mode_surface import mode_surface, modes_view
from strutwork.papers.son_2002.mode_files import mode_fields, mode_scene
from strutwork.papers.son_2002.modes import (
    BENDING,
    MOUNT_ROWS,
    SCREW,
    STRUTS,
    TILT,
    TWISTING,
    mode_picture,
)
from strutwork.papers.son_2002.published import MODES, MOUNT_MODES
from strutwork.papers.son_2002.whole_study import SETS, WholeStudy
from strutwork.papers.tables import nearly, numbers, rows_file, texts
from strutwork.reports.content import (
    Block,
    Cell,
    Chapter,
    Figure,
    Note,
    Points,
    Row,
    Table,
    Text,
)
from strutwork.reports.data_files import DataFile, csv_file, json_file, netcdf_file
from strutwork.reports.figures.curves import Curve, curves
from strutwork.reports.figures.modes import frequency_dots
from strutwork.reports.figures.theme import PALETTE
from strutwork.reports.numbers import fixed, percent, significant

SHAPES_FILE, POSTURES_FILE = "mode-shapes.vtu", "mode-postures.csv"

#: Modes that the thesis names: each has a moving picture of its own.
PUBLISHED = (TILT, STRUTS, SCREW, BENDING, TWISTING)

#: Differences up to this count as met, %.
MET = 2.0


def modes_chapter(study: WholeStudy) -> Chapter:
    """Frequencies, shapes, energies and postures."""
    blocks: list[Block] = [
        Text(
            "A mode is named after its largest pattern of motion: the eight lowest modes of the "
            "granite alone on its mounts, and the moving structure along x (the housing's tilt "
            "about the tool tip), y (struts) and z (ball screws). The published frequencies are "
            "the thesis's finite element model (section 6.2) and a hammer test without the "
            "spindle (section 9.2.2)."
        ),
        Note(
            "All agreement here is calibration: the thesis prints neither the granite's "
            "thicknesses nor the masses and bearing stiffnesses of its model. The targets of "
            "each number are given below; what the data leave open is under Calibration."
        ),
        _published(study),
        _dots(study),
        Points(_notes(study)),
        Text(
            "Choose a mode, press Play, drag to rotate. The shapes are exaggerated and all move "
            "at the same slow pace; the slider changes the magnification. The machine is at home."
        ),
        _shapes(study),
        *energy_blocks(study),
        *_postures(study),
        Points(_left_open(study)),
    ]
    return Chapter("modes", "Modes", tuple(blocks), tuple(_files(study)))


def _published(study: WholeStudy) -> Table:
    rows: list[list[str | Cell]] = []
    for r in study.rows:
        met = abs(r.difference_percent) <= MET
        rows.append(
            [
                _row_name(r),
                r.quantity,
                str(r.published),
                fixed(r.computed, 1),
                Cell(percent(nearly(r.difference_percent)), "good" if met else "poor"),
                r.status,
            ]
        )
    return Table(
        f"Frequencies of the thesis beside the computed values at home; red: beyond {MET:g} %",
        (
            *texts("mode", "thesis"),
            *numbers("published", "computed", unit="Hz"),
            *numbers("difference"),
            *texts("status"),
        ),
        rows,
        file_name(MODES.key),
    )


def _row_name(row: PublishedRow) -> str:
    return f"{row.row}, on the mounts" if row.row.startswith("rigid") else row.row


def _dots(study: WholeStudy) -> Figure:
    names = list(dict.fromkeys(r.row for r in study.rows))
    order = sorted(names, key=lambda n: -next(r.published for r in study.rows if r.row == n))
    series: dict[str, list[float | None]] = {}
    for quantity in ("numerical", "measured"):
        found = {r.row: r for r in study.rows if r.quantity == quantity}
        series[f"thesis, {quantity}"] = [found[n].published if n in found else None for n in order]
        series[f"computed beside {quantity}"] = [
            found[n].computed if n in found else None for n in order
        ]
    return Figure(
        "modes-published",
        "Published frequencies (open) and computed (filled).",
        frequency_dots(order, series),
        "Frequencies of each mode, published numerical and measured beside the computed values.",
        file_name(MODES.key),
        460,
    )


def _notes(study: WholeStudy) -> tuple[str, ...]:
    """What the numbers were calibrated on, each said once."""
    found: dict[str, list[str]] = {}
    for r in study.rows:
        found.setdefault(r.note, []).append(f"{_row_name(r)} ({r.quantity})")
    lines = (f"{', '.join(names)}: {note}." for note, names in found.items())
    return tuple(f"{line[0].upper()}{line[1:]}" for line in lines)


def _shapes(study: WholeStudy) -> Figure:
    pictures = {
        label: mode_picture(study.named[which], name)
        for label, (which, name) in _ordered(study).items()
    }
    field: SurfaceField = mode_surface(next(iter(pictures.values())))
    length = field.drawing_scale * float(np.linalg.norm(field.displacement, axis=1).max())
    return Figure(
        "mode-shapes",
        "Mode shapes of the entire machine: the granite's surface and the mechanism's rods "
        "coloured by displacement as a share of the largest, at rest in grey. At the slider's "
        f"middle the largest motion is drawn as {significant(1e3 * length, 2)} mm.",
        modes_view(pictures),
        "Three-dimensional drawing of the mode shapes of granite and mechanism.",
        SHAPES_FILE,
        640,
    )


def _ordered(study: WholeStudy) -> dict[str, tuple[Which, str]]:
    """The drawn modes, the published ones first: the first is what paper and print show."""
    shown = study.shown
    first = sorted(
        (label for label, (_, name) in shown.items() if name in PUBLISHED),
        key=lambda label: PUBLISHED.index(shown[label][1]),
    )
    return {label: shown[label] for label in (*first, *(k for k in shown if k not in first))}


def _postures(study: WholeStudy) -> list[Block]:
    found = study.postures
    along, b = axes(found)
    dashes = ("dash", "solid", "dot")
    figures = []
    for key, words in (("tilt", TILT), ("struts", STRUTS)):
        values = found[key].to_numpy()
        some = [
            Curve(f"x = {fixed(x, 0)} mm", values[i], PALETTE[i], dashes[i])
            for i, x in enumerate(along)
        ]
        figures.append(
            Figure(
                f"posture-{key}",
                f"{words.capitalize()}: frequency against the tilt of the tool.",
                curves(b, some, ("tilt b (deg)", "frequency (Hz)"), from_zero=True),
                f"Lines of the frequency of the {words} over the tilt at three places along x.",
                POSTURES_FILE,
                400,
            )
        )
    home = found["tilt"].sel(x=0.0).to_numpy()
    struts = found["struts"].to_numpy()
    return [
        Row(tuple(figures), 380),
        Text(
            f"At x = 0 the housing's tilt goes from {fixed(float(home[0]), 0)} Hz at "
            f"b = {fixed(float(b[0]), 0)}° to {fixed(float(home[-1]), 0)} Hz at "
            f"b = {fixed(float(b[-1]), 0)}°, where the lines of the struts come near one point; "
            f"the strut assembly's stays between {fixed(float(struts.min()), 1)} and "
            f"{fixed(float(struts.max()), 1)} Hz. The thesis has its first mode nearly independent "
            "of the spindle's orientation: the computed one, a tilt about y, is not."
        ),
    ]


def _left_open(study: WholeStudy) -> tuple[str, ...]:
    ours = {which: study.named[which].frequencies for which in SETS}
    return (
        (
            "Which tilt: the thesis draws the mode, but the drawing is not available. Eq. 65 "
            "makes it a stiffness along x, so it is interpreted as a tilt about y. A tilt about "
            "x would depend less on the posture, but at 62.4 kN·m/rad it would need the bearings "
            "of a pin 17 mm apart, where a shaft and a strut share 140 to 220 mm."
        ),
        (
            "Measured tilt and strut modes together: one factor on the bearings of the preloading "
            f"side leaves {ours['measured'][TILT]:.1f} for 79.2 Hz and "
            f"{ours['measured'][STRUTS]:.1f} for 154.12 Hz."
        ),
        (
            "Measured tilt and ball screw mode on one machine: drives soft enough for 238.6 Hz "
            f"lower the tilt to {ours['ball screw'][TILT]:.1f} Hz."
        ),
        (
            "The granite's twist splits into two modes with the strut assembly; the one with the "
            f"larger part of it, {100 * study.named['numerical'].shares[TWISTING]:.0f} %, is "
            "shown. With the measured machine's softer bearings that is the upper one, at "
            f"{ours['measured'][TWISTING]:.0f} Hz."
        ),
        f"Rigid-body modes: the thesis shows the shapes only in pictures; {_beside()}.",
    )


def _beside() -> str:
    pairs = (
        " beside the computed ".join(name.removeprefix("rigid body ") for name in pair)
        for pair in MOUNT_ROWS.items()
    )
    return "its " + ", ".join(pairs)


def _files(study: WholeStudy) -> list[DataFile]:
    pictures = {
        label.replace(",", ""): mode_picture(study.named[which], name)
        for label, (which, name) in study.shown.items()
    }
    parts = list(dict.fromkeys(p for n in study.named.values() for p in n.modes.energy_parts))
    rows: list[list[str | float | int | None]] = []
    for which, found in study.named.items():
        names = {i: n for n, i in found.index.items()}
        for i, frequency in enumerate(found.modes.frequencies):
            share = dict(
                zip(found.modes.energy_parts, found.modes.energy_shares[i].tolist(), strict=True)
            )
            name = names.get(i, "")
            held = found.shares[name] if name else None
            rows.append([which, i + 1, float(frequency), name, held, *map(share.get, parts)])
    postures = study.postures
    published = [
        rows_file(
            file_name(table.key),
            f"{table.title} beside the computed values",
            [r for r in study.rows if r.row in {v.row for v in table}],
        )
        for table in (MODES, MOUNT_MODES)
    ]
    scenes = [
        mode_scene(
            f"mode-{name.replace(' ', '-')}.glb",
            f"{name}, moving, for viewers of glTF",
            mode_picture(study.named[which], name),
        )
        for which, name in study.shown.values()
        if name in PUBLISHED
    ]
    return [
        csv_file(
            MODES_FILE,
            "modes of the three sets: frequency, name, shares of strain energy",
            ["machine", "mode", "frequency_Hz", "name", "share_of_pattern",
             *(f"share_{p}" for p in parts)],
            rows,
        ),
        json_file("modes.json", "named modes of the three sets", study.to_dict()["modes"]),
        *published,
        mode_fields(SHAPES_FILE, "shapes of all drawn modes, largest motion one", pictures),
        *scenes,
        plane_file(
            POSTURES_FILE,
            "frequencies of tilt and struts over x and tilt",
            postures,
            {f"{key}_Hz": postures[key].to_numpy() for key in ("tilt", "struts")},
        ),
        netcdf_file("mode-postures.nc", "the same as a dataset", postures),
    ]  # fmt: skip
