"""How it vibrates over the workspace."""

from __future__ import annotations

from typing import Any

import xarray as xr
from numpy.typing import NDArray

from strutwork.reports.content import Block, Chapter, Column, Row, Table, Text
from strutwork.reports.data_files import DataFile, netcdf_file
from strutwork.reports.figures.slices import slice_figure
from strutwork.reports.numbers import significant
from strutwork.reports.subject import Subject
from strutwork.reports.survey_words import grid_text, largest, least
from strutwork.studies.survey_files import write_survey

KEY = "workspace-vibration"
TITLE = "How does it vibrate over the workspace?"
STEM = "vibration-survey"


def missing(subject: Subject) -> str:
    """Why there is nothing to say; empty where there is."""
    if subject.unmoved:
        return subject.unmoved
    if not subject.vibrates:
        return "vibration needs mass and damping: add densities and [damping]"
    return ""


def write(subject: Subject) -> Chapter:
    """The lowest frequency and the least dynamic stiffness, mapped."""
    found = subject.vibration_survey
    low, high = subject.vibration.band
    first = found["natural_frequency"].sel(mode=1).to_numpy()
    figures = [
        slice_figure(
            found, first, ("lowest natural frequency", "Hz"), f"{STEM}-first", f"{STEM}.csv"
        )
    ]
    rows = [_row("lowest natural frequency", "Hz", found, first)]
    for axis in "xyz":
        values = found["least_dynamic_stiffness"].sel(axis=axis).to_numpy() / 1e6
        rows.append(_row(f"least dynamic stiffness along {axis}", "N/µm", found, values))
        name = f"least 1/|H_{axis * 2}|"
        figures.append(slice_figure(found, values, (name, "N/µm"), f"{STEM}-{axis}", f"{STEM}.csv"))
    columns = (
        Column("", "", False),
        Column("unit", "", False),
        Column("least"),
        Column("least at", "", False),
        Column("largest"),
    )
    preload = subject.model.preload
    under = f' It vibrates under its preload "{preload}", with the forces at each pose.'
    blocks: list[Block] = [
        Text(
            f"The survey covers {grid_text(subject.grid)}. The least dynamic stiffness is the "
            f"exact minimum of 1/|H| at the tool{subject.model.relative} from "
            f"{significant(low)} to {significant(high)} Hz, damping {subject.damping}."
            f"{under if preload else ''}"
        ),
        Table("Vibration over the workspace", columns, rows, f"{STEM}.csv"),
        Row(tuple(figures), 330),
    ]
    files = (
        netcdf_file(f"{STEM}.nc", "vibration over the workspace, NetCDF", found),
        DataFile(
            f"{STEM}.csv",
            "vibration over the workspace: one line per pose",
            lambda path: write_survey(path, found),
        ),
    )
    return Chapter(KEY, TITLE, tuple(blocks), files)


def _row(name: str, unit: str, found: xr.Dataset, values: NDArray[Any]) -> list[str]:
    worst, best = least(found, values), largest(found, values)
    return [name, unit, significant(worst.value), worst.where, significant(best.value)]
