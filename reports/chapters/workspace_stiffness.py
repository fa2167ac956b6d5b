"""How stiff it is over the workspace."""

from __future__ import annotations

import json

import numpy as np

from strutwork.kinematics import DIRECTIONS
from strutwork.machines.model_poses import at_pose
from strutwork.msa import compliance_budget
from strutwork.reports.chapters.first_changes import first_changes
from strutwork.reports.content import Block, Chapter, Column, Note, Row, Table, Text
from strutwork.reports.data_files import DataFile, netcdf_file
from strutwork.reports.figures.slices import slice_figure
from strutwork.reports.model_solution import ModelSolution
from strutwork.reports.numbers import share, significant
from strutwork.reports.subject import Subject
from strutwork.reports.survey_words import grid_text, largest, least
from strutwork.studies.survey_files import write_survey

KEY = "workspace-stiffness"
TITLE = "How stiff is it over the workspace?"
STEM = "stiffness-survey"

#: Parts named of what gives way.
NAMED = 3


def missing(subject: Subject) -> str:
    """Why there is nothing to say; empty where there is."""
    return subject.unmoved


def write(subject: Subject) -> Chapter:
    """Maps, extremes, what gives way where it is worst, and what was dropped."""
    found = subject.stiffness_survey
    free = found["stiffness_free"]
    rows, figures = [], []
    for axis in DIRECTIONS:
        factor, unit = (1e-6, "N/µm") if axis in "xyz" else (1e-3, "kN·m/rad")
        values = factor * free.sel(direction=axis).to_numpy()
        if not np.isfinite(values).any():
            rows.append([f"1/C, {axis}", unit, *["infinite"] * 3, "", ""])
            continue
        values = np.where(np.isfinite(values), values, np.nan)
        low, high = least(found, values), largest(found, values)
        rows.append(
            [
                f"1/C_{axis * 2}" if axis in "xyz" else f"1/C_{axis},{axis}",
                unit,
                _home(subject.solution, axis, factor),
                significant(low.value),
                significant(high.value),
                low.where,
                gives_way(subject, low.task, axis),
            ]
        )
        if axis in "xyz":
            name = f"1/C_{axis * 2}"
            figures.append(
                slice_figure(found, values, (name, unit), f"{STEM}-{axis}", f"{STEM}.csv")
            )
    columns = (
        Column("stiffness", "", False),
        Column("unit", "", False),
        Column("home"),
        Column("least"),
        Column("largest"),
        Column("least at", "", False),
        Column("what deforms most there, share of the deflection", "", False),
    )
    blocks: list[Block] = [
        Text(
            f"The survey covers {grid_text(subject.grid)}, with the other directions free to "
            "follow and the drives held. At each pose the joints place the machine, and every "
            "part follows its body."
        ),
        Table(
            f"Static stiffness of the tool{subject.model.relative} over the workspace",
            columns,
            rows,
            f"{STEM}.csv",
        ),
        Row(tuple(figures), 330),
    ]
    dropped = json.loads(found.attrs["dropped_by_reason"])
    if dropped:
        total = int(found.attrs["poses"])
        lost = [[reason, str(n), share(n / total)] for reason, n in dropped.items()]
        heads = (Column("poses excluded", "", False), Column("poses"), Column("share"))
        blocks.append(Table("Poses that the machine cannot reach", heads, lost, f"{STEM}.csv"))
        blocks.append(Note("Such poses are blank in the maps and excluded from the extremes."))
    more, own = first_changes(subject)
    blocks.extend(more)
    files = (
        *own,
        netcdf_file(f"{STEM}.nc", "stiffness over the workspace, NetCDF", found),
        DataFile(
            f"{STEM}.csv",
            "stiffness over the workspace: one line per pose",
            lambda path: write_survey(path, found),
        ),
    )
    return Chapter(KEY, TITLE, tuple(blocks), files)


def gives_way(subject: Subject, task: dict[str, float], axis: str) -> str:
    """Parts with the largest shares in the deflection along an axis at a pose."""
    placed = at_pose(subject.model, task).placed
    budget = compliance_budget(placed, np.eye(6)[DIRECTIONS.index(axis)])
    shares = budget.shares.reshape(-1)
    first = np.argsort(-shares, kind="stable")[:NAMED]
    return ", ".join(f"{budget.parts[i]} {share(float(shares[i]))}" for i in first)


def _home(solution: ModelSolution | None, axis: str, factor: float) -> str:
    if solution is None or solution.compliance is None:
        return "none"
    i = DIRECTIONS.index(axis)
    value = float(solution.compliance[i, i])
    return significant(factor / value) if value > 0 else "infinite"
