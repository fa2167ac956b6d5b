"""Vibration of the machines of Azulay et al. 2014: Table 5, link lengths, sensitivities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from machines import DYNAMIC_SETS, VibratingLegs, dynamic_machine, get
from machines.published_azulay import TABLE_5
from reports.chapters.comparison import SHORT
from reports.chapters.vibration import (
    GRID_TEXT,
    SWING_TEXT,
    minima_table,
    mode_figure,
    modes_table,
    vibration_chapter,
    vibration_files,
)
from reports.content import Block, Cell, Chapter, Column, Figure, Points, Row, Table, Text
from reports.data_files import DataFile, csv_file, json_file
from reports.figures.theme import AXIS_COLOURS, PALETTE
from reports.figures.vibration import responses, sensitivity
from reports.numbers import micro, percent, significant
from reports.vibration_study import AXES, study_machine_vibration
from studies import (
    AzulayDynamics,
    azulay_table_5,
    dynamic_link_lengths,
    file_name,
    mass_sensitivity,
    offset_sensitivity,
    published_dynamic_ranking,
)
from studies.dataset_files import write_long_csv
from studies.published_table import COLUMNS

PROPOSED = "proposed-3pprs"

#: Both sets of Table 5 with frequencies and rankings.
VIBRATION_DATA = "vibration-table-5.json"

INTRODUCTION = (
    "The machine at home, roots clamped on the guide, drives locked, links with their mass and a "
    "rigid heavy platform, as in section 3.3.2 of the paper. Its Table 5 leaves out what decides "
    "it, so two sets of the missing numbers stand side by side. Everything drawn here is of the "
    "calibrated set."
)

ASSUMPTIONS = (
    (
        "Damping: 1 % of critical in every mode, viscous; the paper prints “equivalent damping "
        "ratio of 1 %”. Read as a loss factor it would be half as much."
    ),
    (
        "Roots of the links clamped to the guide, drives rigid: no stiffness of guide, carriage or "
        "drive enters."
    ),
    "Spherical and revolute joints turn freely and are rigid otherwise; the platform is rigid.",
    "Links are beams with shear and rotary inertia, eight elements each, of AISI 1018.",
    *(f"Set “{name}”: {meaning}." for name, meaning in DYNAMIC_SETS.items()),
    "No preload, no gravity, no cutting process: free vibration about the home pose.",
)

_DASHES = ("solid", "dash", "dot", "dashdot")


def machine_vibration(name: str) -> Chapter:
    """The vibration chapter of one machine."""
    study = study_machine_vibration(f"vibration-{name}", get(name).title, dynamic_machine(name))
    dynamics = azulay_table_5()
    table, files = table_5(dynamics, (name,))
    after: list[Block] = [*table, *_frequencies(dynamics, (name,))]
    if name == PROPOSED:
        blocks, some = link_length_blocks()
        after += blocks
        files += some
    blocks, some = sensitivity_blocks((name,))
    return vibration_chapter(
        study, (Text(INTRODUCTION),), (*after, *blocks), (*files, *some), ASSUMPTIONS
    )


def comparison_vibration(names: Sequence[str]) -> Chapter:
    """The vibration chapter of the four machines side by side."""
    dynamics = azulay_table_5()
    studies = {
        n: study_machine_vibration(f"vibration-{n}", get(n).title, dynamic_machine(n))
        for n in names
    }
    table, files = table_5(dynamics, names)
    blocks: list[Block] = [Text(INTRODUCTION), *table, _rankings(dynamics)]
    figures = []
    for i, a in enumerate(AXES):
        curves, marks = {}, []
        for k, (n, study) in enumerate(studies.items()):
            label, response = SHORT[n], study.response
            if response is None:
                continue
            curves[label] = (
                response.frequencies,
                np.abs(response.receptance[:, i, i]),
                PALETTE[k],
                _DASHES[k],
            )
            least = study.least[i]
            marks.append((f"{label}, least along {a}", least.frequency, least.value, PALETTE[k]))
        figures.append(
            Figure(
                f"frf-{a}",
                f"Displacement of the tool along {a} per force along {a} (content of Fig. 10). "
                "Diamonds: exact least dynamic stiffness.",
                responses(curves, marks),
                f"Lines of the receptance along {a} of the four machines.",
                "vibration-frf.csv",
                440,
            )
        )
    blocks += [Row(tuple(figures), 420)]
    blocks += [
        minima_table([(SHORT[n], s) for n, s in studies.items()], "vibration-minima.csv"),
        Text(GRID_TEXT),
        *_frequencies(dynamics, names),
    ]
    blocks += [modes_table(s, f"{s.title}: natural frequencies") for s in studies.values()]
    blocks += [
        Text(SWING_TEXT),
        Row(tuple(mode_figure(s, 470) for s in studies.values()), 380),
    ]
    lengths, some = link_length_blocks()
    sensitive, more = sensitivity_blocks(names)
    blocks += [*lengths, *sensitive, Points(ASSUMPTIONS)]
    minima = csv_file(
        "vibration-minima.csv",
        "exact least dynamic stiffness of the four machines and that of a frequency grid",
        ["machine", "axis", "static_N/m", "least_N/m", "frequency_Hz", "peak_m/N", "grid_N/m"],
        [
            [n, a, o.static, o.value, o.frequency, 1 / o.value, float(g)]
            for n, s in studies.items()
            for a, o, g in zip(AXES, s.least, s.grid, strict=True)
        ],
    )
    magnitudes = csv_file(
        "vibration-frf.csv",
        "receptances of the four machines as drawn; real and imaginary parts in their own files",
        ["machine", "frequency_Hz", *(f"receptance_{a}_m/N" for a in AXES)],
        [
            [n, float(f), *np.abs(np.diagonal(h)).tolist()]
            for n, s in studies.items()
            if s.response is not None
            for f, h in zip(s.response.frequencies, s.response.receptance, strict=True)
        ],
    )
    own = [f for s in studies.values() for f in vibration_files(s)]
    return Chapter(
        "vibration", "Vibration", tuple(blocks), (*files, minima, magnitudes, *own, *some, *more)
    )


def table_5(dynamics: AzulayDynamics, names: Sequence[str]) -> tuple[list[Block], list[DataFile]]:
    """Table 5 beside both sets, and its file."""
    columns = [Column("machine", "", False), Column("quantity", "", False), Column("published")]
    for which in dynamics.rows:
        columns += [
            Column("ours", "", True, which),
            Column("difference", "", True, which),
            Column("status", "", False, which),
        ]
    lines: list[list[str | Cell]] = []
    for rows in zip(*dynamics.rows.values(), strict=True):
        first = rows[0]
        if first.row not in names:
            continue
        line: list[str | Cell] = [first.row, first.quantity, significant(first.published)]
        for row in rows:
            size = abs(row.difference_percent)
            tone = "good" if size < 5 else "fair" if size < 15 else "poor"
            line += [
                significant(row.computed),
                Cell(percent(row.difference_percent), tone),  # type: ignore[arg-type]
                row.status,
            ]
        lines.append(line)
    kept = [row for row in dynamics.table() if row.row.rsplit(",", 1)[0] in names]
    file = csv_file(
        file_name(TABLE_5.key),
        "Table 5 of the paper beside ours, both sets",
        COLUMNS,
        [[row.to_dict()[column] for column in COLUMNS] for row in kept],
    )
    notes: dict[str, list[str]] = {}
    for row in kept:
        # the first remark says what the set is, which the assumptions say too
        for part in row.note.split("; ")[1:]:
            name, chosen = row.row.rsplit(", ", 1)
            about = SHORT[name] if "Kxx = Kyy" in part else f"{SHORT[name]} {row.quantity[:3]}"
            if "no platform mass" in part:
                about = f"set {chosen}"
            elif "Kxx = Kyy" not in part:
                about += f", {chosen}"
            notes.setdefault(part, []).append(about)
    remarks = tuple(f"{'; '.join(dict.fromkeys(about))}: {part}." for part, about in notes.items())
    blocks: list[Block] = [
        Table(f"Table 5 of the paper: {TABLE_5.title}, N/µm", columns, lines, file.name),
        Text(
            "“Calibrated”: what the paper leaves out was fitted to this table. “Not "
            "reproducible”: farther than a factor of two from the print even so, or of the blind "
            "set, whose numbers are no predictions because the paper leaves out what decides them."
        ),
        Points(remarks),
    ]
    whole = json_file(
        VIBRATION_DATA,
        "both sets: frequencies, rankings, minima with a loss factor in place of a ratio",
        dynamics.to_dict(),
    )
    return blocks, [file, whole]


def _frequencies(dynamics: AzulayDynamics, names: Sequence[str]) -> list[Block]:
    """First frequencies with both sets."""
    rows = []
    for name in names:
        for which, study in dynamics.studies.items():
            values = study["natural_frequency"].sel(machine=name).to_numpy()
            rows.append([name, which, *(significant(float(v), 4) for v in values)])
    count = len(rows[0]) - 2
    heads = [Column("machine", "", False), Column("set", "", False)]
    heads += [Column(f"mode {i + 1}", "Hz") for i in range(count)]
    return [Table("Natural frequencies with both sets", heads, rows, VIBRATION_DATA)]


def _rankings(dynamics: AzulayDynamics) -> Table:
    rows: list[list[str | Cell]] = []
    for a in AXES:
        published = published_dynamic_ranking(a)
        rows.append([f"K{a * 2}", "published", _order(published), ""])
        for which in dynamics.studies:
            found = dynamics.ranking(a, which)
            same = Cell("same order", "good") if found == published else Cell("another", "poor")
            rows.append([f"K{a * 2}", which, _order(found), same])
    return Table(
        "Order of the machines by least dynamic stiffness",
        [Column(h, "", False) for h in ("axis", "", "the stiffest first", "")],
        rows,
        VIBRATION_DATA,
    )


def _order(names: Sequence[str]) -> str:
    return " > ".join(SHORT[name] for name in names)


def link_length_blocks() -> tuple[list[Block], list[DataFile]]:
    """The proposed machine with other link lengths (content of Fig. 8)."""
    found = dynamic_link_lengths()
    labels = [f"L = {1e3 * float(v):.0f} mm" for v in found["link_length"]]
    frequencies = found["frequency"].to_numpy()
    figures, rows = [], []
    for a in AXES:
        at = found.sel(axis=a)
        curves = {
            label: (
                frequencies,
                at["receptance_magnitude"].isel(machine=i).to_numpy(),
                PALETTE[i],
                _DASHES[i],
            )
            for i, label in enumerate(labels)
        }
        marks = [
            (
                f"{label}, least along {a}",
                float(at["minimum_frequency"].isel(machine=i)),
                float(at["minimum_dynamic_stiffness"].isel(machine=i)),
                PALETTE[i],
            )
            for i, label in enumerate(labels)
        ]
        figures.append(
            Figure(
                f"lengths-frf-{a}",
                f"Receptance along {a} with three link lengths; diamonds: exact minima.",
                responses(curves, marks),
                f"Lines of the receptance along {a} of the proposed machine, three link lengths.",
                "vibration-link-lengths-frf.csv",
                420,
            )
        )
    for i, label in enumerate(labels):
        one = found.isel(machine=i)
        rows.append(
            [
                label,
                *(significant(float(v), 4) for v in one["natural_frequency"][:3]),
                *(micro(float(v)) for v in one["minimum_dynamic_stiffness"]),
            ]
        )
    columns = [
        Column("link length", "", False),
        *(Column(f"mode {i}", "Hz") for i in (1, 2, 3)),
        *(Column(f"least K{a * 2}", "N/µm") for a in AXES),
    ]
    blocks: list[Block] = [
        Text(
            "Link length of the proposed machine (content of Fig. 8), workpiece in the same place. "
            "Longer links lower the least dynamic stiffness along z, as the paper finds. Along x "
            "and y another thing decides: how high the tool stands beside the height where the "
            "links' directions meet, which changes with the length."
        ),
        Row(tuple(figures), 360),
        Table("Proposed machine by link length", columns, rows, "vibration-link-lengths.csv"),
    ]
    files = [
        _long_file(
            found[["receptance_real", "receptance_imaginary", "receptance_magnitude"]],
            "vibration-link-lengths-frf.csv",
            "receptances of the proposed machine, three link lengths",
        ),
        csv_file(
            "vibration-link-lengths.csv",
            "frequencies and exact minima of the proposed machine, three link lengths",
            [
                "link_length_m",
                *(f"mode_{i}_Hz" for i in (1, 2, 3)),
                *(f"least_{a}_N/m" for a in AXES),
            ],
            [
                [
                    float(found["link_length"][i]),
                    *map(float, found["natural_frequency"][i, :3]),
                    *map(float, found["minimum_dynamic_stiffness"][i]),
                ]
                for i in range(len(labels))
            ],
        ),
    ]
    return blocks, files


def sensitivity_blocks(names: Sequence[str]) -> tuple[list[Block], list[DataFile]]:
    """Least dynamic stiffness by the tool's offset and by the platform's mass."""
    machines = {name: dynamic_machine(name) for name in names}
    first = next(iter(machines.values()))
    offsets, masses = offset_sensitivity(machines), mass_sensitivity(machines)
    kinds = (
        ("offset", offsets, 1e3, "height e of the tool above the joints (mm)", first.tool_offset),
        ("mass", masses, 1.0, "mass of the platform (kg)", first.platform.mass),
    )
    figures = []
    for key, found, scale, title, used in kinds:
        x = scale * found[key].to_numpy()
        for some, label, curves in _curves(found, machines):
            figures.append(
                Figure(
                    f"by-{key}{some}",
                    f"Least dynamic stiffness{label} by the {title.rsplit(' (', 1)[0]}; dotted: "
                    "the calibrated value.",
                    sensitivity(x, curves, title, scale * used),
                    f"Lines of the least dynamic stiffness{label} by the {title}.",
                    f"vibration-by-{key}.csv",
                    400,
                )
            )
    blocks: list[Block] = [
        Text(
            "What decides the minimum and is not printed: how high the tool, the platform's centre "
            "point, stands above the spherical joints, and the platform's mass. The first moves "
            "the minimum along x and y by more than any dimension that the paper compares."
        ),
        Row(tuple(figures), 400 if len(names) == 1 else 340),
    ]
    files = [
        _long_file(
            found[["minimum_dynamic_stiffness", "minimum_frequency", "static_stiffness"]],
            f"vibration-by-{key}.csv",
            f"exact least dynamic stiffness by {key}",
        )
        for key, found, _, _, _ in kinds
    ]
    return blocks, files


def _curves(
    found: xr.Dataset, machines: Mapping[str, VibratingLegs]
) -> list[tuple[str, str, dict[str, tuple[np.ndarray, str, str]]]]:
    """Of one machine all axes in a figure, of several one figure an axis; Kxx is Kyy."""
    values = found["minimum_dynamic_stiffness"]
    if len(machines) == 1:
        one = values.isel(machine=0)
        curves = {
            f"K{a * 2}": (one.sel(axis=a).to_numpy(), AXIS_COLOURS[a], _DASHES[i])
            for i, a in enumerate(AXES)
        }
        return [("", "", curves)]
    return [
        (
            f"-{a}",
            f" along {'x and y' if a == 'x' else a}",
            {
                SHORT[n]: (
                    values.sel(machine=n, axis=a).to_numpy(),
                    PALETTE[i],
                    _DASHES[i],
                )
                for i, n in enumerate(machines)
            },
        )
        for a in ("x", "z")
    ]


def _long_file(dataset: xr.Dataset, name: str, what: str) -> DataFile:
    return DataFile(name, what, lambda path: write_long_csv(path, dataset))
