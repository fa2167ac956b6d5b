"""Minimum dynamic stiffness against link length, tool offset and platform mass."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from strutwork.machines import VibratingLegs, dynamic_machine
from strutwork.papers.azulay_2014.chapters.comparison import SHORT
from strutwork.papers.azulay_2014.sensitivity import (
    dynamic_link_lengths,
    mass_sensitivity,
    offset_sensitivity,
)
from strutwork.reports.content import Block, Column, Figure, Row, Table, Text
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.figures.theme import AXIS_COLOURS, PALETTE
from strutwork.reports.figures.vibration import responses, sensitivity
from strutwork.reports.numbers import micro, significant
from strutwork.reports.vibration_study import AXES
from strutwork.studies.dataset_files import write_long_csv

DASHES = ("solid", "dash", "dot", "dashdot")


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
                DASHES[i],
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
            "Link length of the proposed machine (content of Fig. 8), workpiece in the same "
            "place. Longer links lower the least dynamic stiffness along z, as the paper finds. "
            "Along x and y another quantity decides: the height of the tool relative to the "
            "point where the links' directions meet, which changes with the length."
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
            "Two quantities that are not printed decide the minimum: the height of the tool, the "
            "platform's centre point, above the spherical joints, and the platform's mass. The "
            "first moves the minimum along x and y by more than any dimension that the paper "
            "compares."
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
            f"K{a * 2}": (one.sel(axis=a).to_numpy(), AXIS_COLOURS[a], DASHES[i])
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
                    DASHES[i],
                )
                for i, n in enumerate(machines)
            },
        )
        for a in ("x", "z")
    ]


def _long_file(dataset: xr.Dataset, name: str, what: str) -> DataFile:
    return DataFile(name, what, lambda path: write_long_csv(path, dataset))
