"""The result of a study as a dataset: named axes, units, and what it was made of."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

import strutwork
from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.studies.chunks import Arrays
from strutwork.studies.dataset_units import LabelledUnits, unit_coordinate
from strutwork.studies.description import versions
from strutwork.studies.filters import PoseStatus
from strutwork.studies.parameter import Varied
from strutwork.studies.pose_sets import PoseList
from strutwork.studies.study_machines import Kept
from strutwork.studies.variables import named

if TYPE_CHECKING:
    from strutwork.studies.study import Study

Array = NDArray[Any]

#: Dimension of the machines of a sample that is no grid.
SAMPLE = "sample"

#: Coordinates of what is said of all machines together.
ANALYSIS = ("answer", "answer_unit", "parameter", "other_parameter", "bound", "quantile")

#: Variables of every study.
_OF_MACHINES = ("status", "reason", "reason_text", "poses_kept", "pose_status")

#: What became of a machine, by its code.
STATUS = ("solved", "cannot_be", "no_pose")

_WORDS = {
    "worst": "the worst over the poses",
    "best": "the best over the poses",
    "mean": "mean over the poses that count",
    "home": "at home",
    "least": "the least over the poses",
    "greatest": "the greatest over the poses",
    "travel": "from the least to the greatest over the poses",
}


def study_dataset(study: Study, arrays: Arrays, words: list[str]) -> xr.Dataset:
    """The dataset of a study.

    Parameters
    ----------
    study : Study
    arrays : dict of name to (n, ...)
        For each machine, any unit.
    words : list of str
        Reasons, the first of them empty.
    """
    gridded = study.drawn.kind == "grid"
    dims = tuple(p.name for p in study.varied) if gridded else (SAMPLE,)
    shape = study.drawn.shape
    made: dict[str, xr.Variable] = {}

    def put(
        name: str, inner: tuple[str, ...], unit: str | LabelledUnits, meaning: str, **more: Any
    ) -> None:
        array = arrays[name]
        made[name] = named(
            (*dims, *inner), array.reshape(*shape, *array.shape[1:]), unit, meaning, **more
        )

    put(
        "status",
        (),
        "1",
        "what became of the machine",
        flag_values=np.arange(len(STATUS), dtype=np.int8),
        flag_meanings=" ".join(STATUS),
    )
    put("reason", (), "1", "index into reason_text")
    put("poses_kept", (), "1", "poses of the workspace that count")
    labels: dict[str, Any] = {"reason_text": words}
    model = study.machine.origin.model
    for question in study.questions:
        labels |= {k: list(v) for k, v in question.of(model).coordinates.items()}
    for kept in study.machines.kept:
        column = kept.column
        inner = ("pose", *column.dims) if kept.reduction == "poses" else column.dims
        put(kept.name, inner, column.unit, _meaning(kept))
        if isinstance(column.unit, LabelledUnits):
            labels |= unit_coordinate(kept.name, column.dims[-1], column.unit)
        if f"{kept.name}_pose" in arrays:
            put(f"{kept.name}_pose", column.dims, "1", "number of that pose, -1 where none counts")
    if "pose_status" in arrays:
        flag = {
            "flag_values": np.array([int(s) for s in PoseStatus], dtype=np.int8),
            "flag_meanings": " ".join(s.word for s in PoseStatus),
        }
        put("pose_status", ("pose",), "1", "what became of the pose", **flag)
    labels |= _poses(study, made) | _parameters(study, dims)
    return xr.Dataset(made, coords=labels, attrs=_attributes(study))


def _meaning(kept: Kept) -> str:
    more = _WORDS.get(kept.reduction, "")
    return f"{kept.column.meaning}; {more}" if more else kept.column.meaning


def _poses(study: Study, made: dict[str, xr.Variable]) -> dict[str, xr.Variable]:
    """Where the poses stand, of those that variables name by number."""
    workspace = study.workspace
    if workspace is None or isinstance(workspace, PoseList):
        return {}
    if not any("pose" in v.dims or name.endswith("_pose") for name, v in made.items()):
        return {}
    task = workspace.task()
    found = {}
    for direction, values in task.items():
        unit = "rad" if direction in DIRECTIONS[3:] else "m"
        words = f"task coordinate {direction} of the tool"
        found[f"pose_{direction}"] = named("pose", values, unit, words)
    return found


def _parameters(study: Study, dims: tuple[str, ...]) -> dict[str, xr.Variable]:
    found = {}
    for i, p in enumerate(study.varied):
        values = p.grid if p.name in dims else study.drawn.values[:, i]
        found[p.name] = named(
            p.name if p.name in dims else SAMPLE,
            np.asarray(values),
            p.unit or "1",
            p.meaning,
            paths=", ".join(n.path for n in p.numbers),
            stated=_stated(p),
        )
    return found


def require_own_names(study: Study) -> None:
    """Refuse a parameter with the name of something else in the dataset.

    Parameters
    ----------
    study : Study

    Raises
    ------
    ModelError
        There is one.
    """
    model = study.machine.origin.model
    taken = {*_OF_MACHINES, *ANALYSIS, SAMPLE, "pose"}
    taken |= {f"pose_{d}" for d in DIRECTIONS}
    for question in study.questions:
        taken |= {str(name) for name in question.of(model).coordinates}
    for kept in study.machines.kept:
        taken |= {kept.name, f"{kept.name}_pose", *kept.column.dims}
        if isinstance(kept.column.unit, LabelledUnits):
            taken |= set(unit_coordinate(kept.name, kept.column.dims[-1], kept.column.unit))
    for p in study.varied:
        if p.name in taken:
            raise ModelError(
                f"parameter {p.name}",
                "has the name of something else in the result.",
                "Give it another name.",
            )


def _stated(p: Varied) -> float:
    """The value of the machine as it is described: a factor of one where it is relative."""
    return 1.0 if p.relative else float(p.numbers[0].value)


def _attributes(study: Study) -> dict[str, Any]:
    return {
        "title": f"study of {study.machine.title}",
        "Conventions": "CF-1.11",
        "source": f"strutwork {strutwork.__version__}",
        "machines": len(study),
        "settings": json.dumps(study.settings, ensure_ascii=False),
        "inputs_sha256": study.inputs,
        "code_sha256": study.code,
        "study_key": study.key,
        "versions": json.dumps(versions()),
    }
