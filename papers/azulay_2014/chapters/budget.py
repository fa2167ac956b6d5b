"""Compliance budget with both joint models."""

from __future__ import annotations

from strutwork.papers.azulay_2014.machine_study import MODEL_NAMES, MachineStudy
from strutwork.reports.chapters.budget import PART_COLOURS, budget_file, by_kind
from strutwork.reports.content import Block, Chapter, Figure, Row, Text
from strutwork.reports.figures.charts import stacked_shares


def budget_chapter(study: MachineStudy) -> Chapter:
    """Stacked bars for each joint model; the three legs' equal parts are added up."""
    figures = []
    for model, label in MODEL_NAMES.items():
        categories, shares = by_kind(study.budgets[model])
        figures.append(
            Figure(
                f"budget-{model}",
                f"{label[0].upper()}{label[1:]}: share of each kind of part, all three legs, in "
                "the deflection along the force.",
                stacked_shares(categories, shares, "share of the deflection", PART_COLOURS),
                "Stacked bars of the shares of links and drives in the tool's deflection along x, "
                f"y and z at the best, median and worst pose, {label}.",
                f"budget-{model}.csv",
                height=480,
            )
        )
    blocks: list[Block] = [
        Text(
            "The chart shows which parts deform under a force at the tool: each part's share of "
            "the strain energy is its share in the deflection along the force. The poses are "
            "those with the largest, the median and the smallest stiffness along that axis; the "
            "tool's other directions are free to follow the force."
        ),
        Row(tuple(figures), 420),
    ]
    files = tuple(
        budget_file(study.budgets[m], f"budget-{m}.csv", n) for m, n in MODEL_NAMES.items()
    )
    return Chapter("budget", "Compliance budget", tuple(blocks), files)
