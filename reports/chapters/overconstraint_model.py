"""The tolerance chapter of a model file: what its [[tolerances]] lock into its joints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from strutwork.machines.extent import model_size
from strutwork.machines.model import Model
from strutwork.msa import LoadCase
from strutwork.overconstraint import Allocation, allocate
from strutwork.reports.chapters.overconstraint import (
    governing,
    headline,
    label,
    loaded,
    shown,
    study_file,
    tolerance_table,
    tool_blocks,
)
from strutwork.reports.chapters.overconstraint_allocation import allocation_blocks
from strutwork.reports.chapters.overconstraint_forces import (
    cause_blocks,
    force_blocks,
    spread_blocks,
)
from strutwork.reports.content import Block, Chapter, Figure, Text
from strutwork.reports.data_files import DataFile, json_file
from strutwork.reports.figures.assembly_scene import ARROW, SHOWN, assembled
from strutwork.reports.figures.misfits import force_arrows
from strutwork.reports.figures.model import deformed_shape, deformed_view
from strutwork.reports.numbers import times
from strutwork.studies.tolerance_result import ToleranceStudy
from strutwork.studies.tolerance_study import tolerance_study

KEY = "tolerances"


@dataclass(frozen=True)
class ModelTolerances:
    """What the tolerances of a model file do.

    Parameters
    ----------
    study : ToleranceStudy
    allocations : dict of words to Allocation
        Empty where the file names no limits, or where nothing is loaded.
    """

    study: ToleranceStudy
    allocations: dict[str, Allocation]

    def to_dict(self) -> dict[str, Any]:
        """Plain values, SI."""
        return {
            **self.study.to_dict(),
            "allocations": {words: a.to_dict() for words, a in self.allocations.items()},
        }


def study_model_tolerances(model: Model) -> ModelTolerances:
    """Study the tolerances of a model.

    Raises
    ------
    StrutworkError
        As `strutwork.studies.tolerance_study` and `strutwork.overconstraint.allocate`.
    """
    study = tolerance_study(model.placed, model.tolerances, model.force_limits, title=model.title)
    allocations = {}
    if np.any(study.utilisation > 0):
        allocations["all by one factor"] = allocate(study.responses, model.force_limits)
        costs = model.tolerance_costs
        allocations["cheapest"] = allocate(study.responses, model.force_limits, "cost", costs=costs)
    return ModelTolerances(study, allocations)


def tolerance_chapter(model: Model, found: ModelTolerances) -> Chapter:
    """Forces, distribution, causes, limits and the tool's displacement."""
    study = found.study
    blocks: list[Block] = [
        Text(
            "Manufacturing errors within these tolerances lock forces into the structure when it "
            "is assembled, without any load. The worst case is exact; no assembly within the "
            "tolerances exceeds it."
        ),
        headline(study),
        tolerance_table(study.tolerances, "Tolerances"),
    ]
    files: list[DataFile] = [study_file(study, KEY)]
    parts: list[tuple[list[Block], list[DataFile]]] = []
    if loaded(study):
        parts = [
            _misfit(model, study),
            force_blocks(study, KEY),
            spread_blocks(study, KEY),
            cause_blocks(study, KEY),
        ]
    parts.append((tool_blocks(study, f"{KEY}") if loaded(study) else [], []))
    if found.allocations:
        limits = "every joint within its limit"
        parts.append(allocation_blocks(study.tolerances, found.allocations, KEY, limits))
    for some, more in parts:
        blocks += some
        files += more
    return Chapter("tolerances", "Assembly forces", tuple(blocks), tuple(files))


def _misfit(model: Model, study: ToleranceStudy) -> tuple[list[Block], list[DataFile]]:
    top = governing(study)
    if top is None:
        return [], []
    misfits = {
        (joint, d): value for joint, some in study.misfits(top).items() for d, value in some.items()
    }
    shape = assembled(model.placed, misfits)
    case = LoadCase("worst case", gaps=misfits)
    most = max(float(np.linalg.norm(u)) for u in shape.moved.values())
    factor = SHOWN * model_size(model) / max(most, 1e-300)
    points, moved = deformed_shape(model, shape.solution, 0, factor)
    view = deformed_view(model, points, moved, case, "displacement (µm)")
    joints = {j.name: j for j in model.structure.linkage.joints}
    at = {
        name: shape.at[joints[name].between[1]] + factor * shape.moved[joints[name].between[1]]
        for name in model.joints
    }
    forces = {name: shape.forces[name] for name in model.joints}
    view["data"] += force_arrows(at, forces, ARROW * model_size(model))
    file = f"{KEY}-misfit.json"
    figure = Figure(
        f"{KEY}-misfit",
        f"The structure assembled with the misfits at which the {label(study.quantities[top])} is "
        f"largest, {shown(float(study.largest[top]), 'N')} kN; displacements are drawn "
        f"{times(factor)} times their true size, and arrows are the forces on the second side of "
        "each joint.",
        view,
        "Three-dimensional drawing of the structure, strained by the worst misfits, with the joint "
        "forces as arrows.",
        file,
        560,
    )
    what = "the drawn worst case: misfits, displacements, forces"
    return [figure], [json_file(file, what, shape.to_dict())]
