"""Stress and stroke of flexures under the load cases of a model."""

from __future__ import annotations

from strutwork.reports.content import Column, Table, Text
from strutwork.reports.flexure_use import flexure_uses
from strutwork.reports.model_solution import ModelSolution
from strutwork.reports.numbers import significant

#: Rows that a reader is shown; the file has all.
SHOWN = 40


def flexure_tables(solution: ModelSolution) -> list[Table | Text]:
    """The most stressed flexures of all load cases; empty without flexures."""
    model, statics = solution.model, solution.statics
    uses = [
        (joint, case, use)
        for number, case in enumerate(statics.cases)
        for joint, use in flexure_uses(model, statics, number).items()
    ]
    if not uses:
        return []
    uses.sort(key=lambda entry: -entry[2].stress)
    rows = []
    for joint, case, use in uses[:SHOWN]:
        stroke = use.flexure.stroke
        rows.append(
            [
                joint,
                case,
                significant(1e-6 * use.stress),
                "–" if use.share is None else significant(100.0 * use.share),
                significant(1e3 * float(use.motion[5]), 4),
                "–" if stroke is None else significant(1e3 * float(stroke[5]), 4),
                significant(1e6 * float(use.motion[1]), 4),
                significant(100.0 * use.compression),
            ]
        )
    heads = (
        Column("joint", "", False),
        Column("load case", "", False),
        Column("stress", "MPa"),
        Column("of allowable", "%"),
        Column("rotation about z", "mrad"),
        Column("stroke about z", "mrad"),
        Column("motion along y", "µm"),
        Column("of buckling force", "%"),
    )
    table = Table("Flexures: largest equivalent stress and motion", heads, rows, "solution.json")
    if len(uses) <= SHOWN:
        return [table]
    return [table, Text(f"The {SHOWN} most stressed of {len(uses)}; solution.json contains all.")]
