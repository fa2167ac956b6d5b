"""Where in the workspace manufacturing errors lock in most."""

from __future__ import annotations

import numpy as np

from strutwork.reports.content import Block, Chapter, Column, Row, Table, Text
from strutwork.reports.data_files import DataFile, netcdf_file
from strutwork.reports.figures.slices import slice_figure
from strutwork.reports.numbers import significant
from strutwork.reports.subject import Subject
from strutwork.reports.survey_words import grid_text, largest
from strutwork.studies.survey_files import write_survey

KEY = "workspace-assembly"
TITLE = "Where do manufacturing errors lock in the largest forces?"
STEM = "assembly-survey"

#: Quantities that the table shows and that are drawn.
SHOWN, DRAWN = 12, 2

#: Share of the largest of its unit below which a quantity is rounding.
NOTHING = 1e-9


def missing(subject: Subject) -> str:
    """Why there is nothing to say; empty where there is."""
    if subject.unmoved:
        return subject.unmoved
    if not subject.model.tolerances:
        return "no tolerances are given: add [[tolerances]]"
    return ""


def write(subject: Subject) -> Chapter:
    """Largest worst case of every quantity over the workspace."""
    found = subject.assembly_survey
    names = [str(q) for q in found["quantity"].to_numpy()]
    values = found["worst_case"].to_numpy()
    most = np.nanmax(values.reshape(-1, len(names)), axis=0)
    forces = [i for i, n in enumerate(names) if n.endswith("force")]
    moments = [i for i, n in enumerate(names) if n.endswith(("moment", "torque"))]
    tool = [i for i, n in enumerate(names) if n.startswith("tool ")]
    blocks: list[Block] = [
        Text(
            "The tables show the exact worst case that the tolerances allow at each of "
            f"{grid_text(subject.grid)}, without any load."
        )
    ]
    figures = []
    for title, some, factor, unit in (
        ("Forces", forces, 1.0, "N"),
        ("Moments", moments, 1.0, "N·m"),
        ("Displacement of the tool", [i for i in tool if "displacement" in names[i]], 1e6, "µm"),
        ("Rotation of the tool", [i for i in tool if "rotation" in names[i]], 1e6, "µrad"),
    ):
        top = max((float(most[i]) for i in some), default=0.0)
        kept = [i for i in sorted(some, key=lambda i: -most[i]) if most[i] > NOTHING * top]
        if not kept:
            if some:
                blocks.append(Text(f"{title}: none anywhere in the workspace."))
            continue
        rows = []
        for i in kept[:SHOWN]:
            worst = largest(found, factor * values[..., i])
            least = float(np.nanmin(factor * values[..., i]))
            rows.append([names[i], significant(worst.value), worst.where, significant(least)])
        columns = (
            Column("", "", False),
            Column("worst", unit),
            Column("at", "", False),
            Column("least over all poses", unit),
        )
        blocks.append(
            Table(f"{title}, worst case over the workspace", columns, rows, f"{STEM}.csv")
        )
        if title not in ("Forces", "Displacement of the tool"):
            continue
        figures += [
            slice_figure(
                found,
                factor * values[..., i],
                (names[i], unit),
                f"{STEM}-{i}",
                f"{STEM}.csv",
                worst_is_least=False,
            )
            for i in kept[:DRAWN]
        ]
    if figures:
        blocks.append(Row(tuple(figures), 330))
    files = (
        netcdf_file(f"{STEM}.nc", "assembly forces over the workspace, NetCDF", found),
        DataFile(
            f"{STEM}.csv",
            "assembly forces over the workspace: one line per pose",
            lambda path: write_survey(path, found),
        ),
    )
    return Chapter(KEY, TITLE, tuple(blocks), files)
