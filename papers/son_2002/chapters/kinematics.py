"""Kinematics of the MIT-SS-1, and its bearing forces over the workspace."""

from __future__ import annotations

from math import degrees

import numpy as np
import xarray as xr

from strutwork.kinematics import drive_values
from strutwork.machines.mit_ss1 import NOMINAL_TILT, NOMINAL_X
from strutwork.papers.published_rows import PublishedRow, file_name
from strutwork.papers.son_2002.assembly_map import FORCES
from strutwork.papers.son_2002.chapters.plane import axes, extremes, plane_file
from strutwork.papers.son_2002.mit_ss1_study import MitSS1Study, degrees_text
from strutwork.papers.son_2002.published import MACHINE, MANIPULABILITY
from strutwork.papers.son_2002.working_modes import free_modes, working_modes
from strutwork.papers.tables import numbers, rows_file, texts
from strutwork.reports.content import (
    Block,
    Cell,
    Chapter,
    Column,
    Figure,
    Row,
    Table,
    Text,
)
from strutwork.reports.data_files import DataFile, netcdf_file
from strutwork.reports.figures.curves import Curve, curves, heat
from strutwork.reports.figures.theme import PALETTE
from strutwork.reports.numbers import fixed, percent, significant


def kinematics_chapter(study: MitSS1Study) -> Chapter:
    """Drives, condition number and singular tilts."""
    machine, found = study.machine, study.kinematics
    x, b = found["x"].to_numpy(), found["b"].to_numpy()
    condition = found["condition"].to_numpy()
    picks = {"largest": np.nanargmax, "smallest": np.nanargmin}
    marks = extremes(*axes(found), condition, picks, "{:.3f}".format)
    drives = found["drive"].to_numpy()
    middle = int(np.abs(x).argmin())
    home = drive_values(machine, machine.place(machine.home()))
    data = "kinematics.csv"
    blocks: list[Block] = [
        Text(
            f"Nominal workspace: x from {significant(1e3 * NOMINAL_X[0], 2)} to "
            f"{significant(1e3 * NOMINAL_X[1], 2)} mm and tilts to ±{degrees(NOMINAL_TILT):g}° at "
            "any height; z is a pure translation. The condition number is that of the tool's "
            "velocity along x, y and z with the tilts held: the struts move x and z, and the "
            "table's carriage moves y one to one."
        ),
        Row(
            (
                Figure(
                    "condition",
                    "Position condition number over the workspace.",
                    heat(
                        1e3 * x,
                        np.degrees(b),
                        condition,
                        ("x (mm)", "tilt b (deg)", "condition number"),
                        marks,
                    ),
                    "Map of the position condition number over x and tilt, largest and smallest "
                    "value marked.",
                    data,
                    420,
                ),
                Figure(
                    "drives",
                    f"Heights of the blocks against the tilt at x = {significant(1e3 * x[middle])} "
                    "mm, tool tip at z = 0.",
                    curves(
                        np.degrees(b),
                        [
                            Curve(f"block {k + 1}", 1e3 * drives[middle, :, k], PALETTE[k])
                            for k in range(3)
                        ],
                        ("tilt b (deg)", "height of the block (mm)"),
                    ),
                    "Lines of the three blocks' heights over the tilt.",
                    data,
                    420,
                ),
            ),
            380,
        ),
        _published_kinematics(study),
        Table(
            "Blocks at x = z = b = 0, and their travel within the nominal workspace",
            (*texts(""), *numbers("at home", "lowest", "highest", unit="mm")),
            [
                [
                    f"block {k + 1}",
                    fixed(1e3 * float(home[k]), 2),
                    fixed(1e3 * float(np.nanmin(drives[..., k])), 1),
                    fixed(1e3 * float(np.nanmax(drives[..., k])), 1),
                ]
                for k in range(3)
            ],
            data,
        ),
        Table(
            "Tilt nearest to upright at which the three strut lines meet in a point and the drives "
            "no longer hold the housing",
            (Column("x", "mm", True), Column("singular tilt b", "deg")),
            [
                [fixed(1e3 * at, 0), degrees_text(tilt).rstrip("°")]
                for at, tilt in study.singular.items()
            ],
            "report.json",
        ),
        _working_modes(study),
        Text(
            "Within the nominal workspace there is none: the determinant of the struts' rows stays "
            f"between {significant(float(found['determinant'].min()))} and "
            f"{significant(float(found['determinant'].max()))} m. b = ±90° is a singularity of the "
            "tool's axis map (eq. 10), not of the struts."
        ),
    ]
    return Chapter("kinematics", "Kinematics", tuple(blocks), tuple(_kinematics_files(study)))


def _modes_over(study: MitSS1Study) -> xr.Dataset:
    """The eight modes on the grid of the chapter's maps."""
    found = study.kinematics
    return working_modes(study.machine, found["x"], found["b"])


def _working_modes(study: MitSS1Study) -> Table:
    found = _modes_over(study)
    free = free_modes(found)
    values = found["determinant"].to_numpy()
    rows: list[list[str | Cell]] = [
        [
            str(name),
            percent(100.0 * float(np.isfinite(v).mean())).lstrip("+"),
            significant(float(np.nanmin(v))),
            significant(float(np.nanmax(v))),
            Cell("none", "good") if keeps else Cell("within", "poor"),
        ]
        for name, v, keeps in zip(found["mode"].to_numpy(), values, free, strict=True)
    ]
    return Table(
        "Working modes: each block above (+) or below (−) its joint on the housing; the machine's "
        "own first",
        (
            *texts("blocks"),
            Column("workspace reached", "", True),
            *numbers("least determinant", "largest", unit="m"),
            *texts("actuator singularity"),
        ),
        rows,
        "working-modes.csv",
    )


def condition_rows(kinematics: xr.Dataset) -> tuple[PublishedRow, ...]:
    """Condition numbers of the position beside the printed ones, of `planar_kinematics`."""
    condition = kinematics["condition"]
    ours = {"least": float(condition.min()), "most": float(condition.max())}
    return tuple(
        PublishedRow(
            v.row,
            v.quantity,
            v.unit,
            v.value,
            ours[v.quantity.rsplit(" ", 1)[-1]],
            "predicted",
            "from the dimensions of Appendix B and the workspace of section 6.1; nothing fitted",
        )
        for v in MANIPULABILITY
        if v.row == MACHINE
    )


def _published_kinematics(study: MitSS1Study) -> Table:
    rows: list[list[str | Cell]] = [
        [
            r.quantity,
            f"{r.published:.2f}",
            f"{r.computed:.3f}",
            Cell(percent(r.difference_percent), "good"),
            r.status,
        ]
        for r in condition_rows(study.kinematics)
    ]
    return Table(
        "Manipulability of section 6.4 beside the computed values",
        (*texts("quantity"), *numbers("published", "computed", "difference"), *texts("status")),
        rows,
        file_name(MANIPULABILITY.key),
    )


def _kinematics_files(study: MitSS1Study) -> list[DataFile]:
    found = study.kinematics
    maps = {f"block{k + 1}_m": found["drive"].to_numpy()[..., k] for k in range(3)}
    maps |= {"condition": found["condition"].to_numpy()}
    maps |= {"determinant_m": found["determinant"].to_numpy()}
    modes = _modes_over(study)
    determinants = {
        f"determinant {name} [m]": values
        for name, values in zip(
            modes["mode"].to_numpy(), modes["determinant"].to_numpy(), strict=True
        )
    }
    return [
        plane_file(
            "kinematics.csv", "drives, condition number, determinant over x, b", found, maps
        ),
        netcdf_file("kinematics.nc", "the same as a dataset", found),
        plane_file(
            "working-modes.csv",
            "determinant of every working mode over x, b",
            found,
            determinants,
        ),
        rows_file(
            file_name(MANIPULABILITY.key),
            "manipulability of the thesis beside the computed values",
            condition_rows(study.kinematics),
        ),
    ]


def map_blocks(study: MitSS1Study) -> tuple[list[Block], list[DataFile]]:
    """The largest bearing force over the workspace."""
    found = study.forces
    x, b = axes(found)
    file = "assembly-map.csv"
    figures = []
    for k, kind in enumerate(FORCES):
        values = 1e-3 * found["force"].to_numpy()[:, :, k].max(axis=-1)
        marks = extremes(x, b, values, {"worst": np.nanargmax}, "{:.3g} kN".format)
        figures.append(
            Figure(
                f"assembly-map-{kind.split()[0]}",
                f"Largest {kind} in any bearing, worst case at each pose.",
                heat(x, b, values, ("x (mm)", "tilt b (deg)", f"{kind} (kN)"), marks),
                f"Map of the largest worst-case {kind} over x and tilt, worst pose marked.",
                file,
                400,
            )
        )
    spread = 1e-3 * found["force"].to_numpy().max(axis=-1)
    low, high = np.nanmin(spread[..., 0]), np.nanmax(spread[..., 0])
    text = Text(
        "Over the workspace the largest radial force in any bearing hardly changes, from "
        f"{significant(float(low))} to {significant(float(high))} kN: the struts tilt, but the "
        "pins stay parallel to each other. Height does not matter at all."
    )
    bearings = [str(n) for n in found["bearing"].to_numpy()]
    maps = {
        f"{kind.split()[0]} {n} [N]": found["force"].to_numpy()[:, :, k, m]
        for k, kind in enumerate(FORCES)
        for m, n in enumerate(bearings)
    }
    return [text, Row(tuple(figures), 380)], [
        plane_file(file, "worst-case force of every bearing over x and b", found, maps),
        netcdf_file("assembly-map.nc", "the same as a dataset, with the tool's places", found),
    ]
