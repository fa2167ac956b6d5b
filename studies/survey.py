"""One survey of a machine's workspace for every question."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

import strutwork
from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Moved
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model import Model
from strutwork.machines.model_poses import moved
from strutwork.msa import prepare_compliance
from strutwork.msa.tool import COMPILED_FROM
from strutwork.source_digest import source_digest
from strutwork.studies.answers import Answer, Stiffness
from strutwork.studies.chunks import Arrays
from strutwork.studies.dataset_units import LabelledUnits, motion_units, unit_coordinate
from strutwork.studies.description import plain, versions
from strutwork.studies.evaluation import spread
from strutwork.studies.executor import Executor
from strutwork.studies.filters import PoseStatus
from strutwork.studies.foresee import LONGEST, SMALL, foresee
from strutwork.studies.progress import Progress
from strutwork.studies.run import Chunk, Run, fill
from strutwork.studies.variables import flags, named

Array = NDArray[Any]

#: Poses moved to and asked at once.
CHUNK = 256

#: Poses of a grid on which what the chunks share is made.
SAMPLE = 64

#: Packages whose code decides a survey's numbers.
_CODE = (
    *("kinematics", "meshes", "msa", "fea", "overconstraint", "flexures", "machines", "cutting"),
    "servo",
    "studies",
)


def survey(
    model: Model,
    grid: TaskGrid,
    answers: Sequence[Answer],
    *,
    workers: int | None = None,
    progress: Progress | None = None,
    folder: Path | None = None,
    executor: Executor | None = None,
) -> xr.Dataset:
    """Answers at every pose of a grid that a machine can take.

    Parameters
    ----------
    model : Model
        With a tool; moves from its placement.
    grid : TaskGrid
        What it does not name stays as at home, where it can.
    answers : sequence of Answer
    workers : int, optional
        Threads; default one per processor.
    progress : callable, optional
        Called with how many poses are done, and of how many.
    folder : Path, optional
        Keeps finished chunks there; a later call with the same inputs goes on from them.
    executor : Executor, optional
        In place of threads.

    Returns
    -------
    xarray.Dataset
        Dimensions are the grid's directions and those of the answers; every variable states its
        unit. Numbers of poses that do not count are missing (NaN); `status` is the flag, and
        `reason` the index into `reason_text`, whose first entry is empty.

    Raises
    ------
    ModelError
        A direction in which the tool cannot move, no pose that can be taken, a model that is
        wrong whatever the pose, or a grid that would take too long or too much memory; time has
        no bound where finished chunks are kept, or an executor does the work.
    """
    model.require_tool()
    count = len(grid)
    task = grid.task()
    run = Run(workers, executor, folder, progress, lambda chunk: _spans(task, chunk.items))
    # what the threads share, and what is wrong whatever the pose, comes before the work
    moved(model, {d: values[:1] for d, values in grid.axes.items()})
    _ = model.structure.segments, model.structure.vertex_of_node
    _prepare(model, task, answers, count)
    if count > SMALL:
        foresee(lambda some: _asked(model, some, answers, count), grid, workers).require(
            "workspace",
            "Use fewer points along a direction.",
            LONGEST if run.bounded else None,
        )

    def evaluate(chunk: Chunk) -> Arrays:
        return _asked(model, {d: v[chunk.items] for d, v in task.items()}, answers, count)

    arrays: Arrays = {}
    words = [""]
    for chunk, part in run.chunks(evaluate, count, CHUNK, lambda: survey_key(model, grid, answers)):
        local = ["", *part.pop("reasons").tolist()]
        words += [w for w in local if w not in words]
        number = np.array([words.index(w) for w in local], dtype=np.int16)
        fill(arrays, chunk, part | {"reason": number[part["reason"]]}, count)
    good = arrays["status"] == PoseStatus.GOOD
    if not good.any():
        said = Counter(words[i] for i in arrays["reason"].tolist())
        raise ModelError(
            "workspace",
            f"no pose of the {count} can be taken: {said.most_common(1)[0][0]}.",
            "Move the grid into the machine's reach.",
        )
    return _dataset(model, grid, answers, arrays, words)


def _prepare(
    model: Model, task: Mapping[str, Array], answers: Sequence[Answer], count: int
) -> None:
    """Make what the stiffness of all chunks shares, on poses of the whole grid."""
    if count >= COMPILED_FROM and any(isinstance(answer, Stiffness) for answer in answers):
        some = spread(count, SAMPLE)
        _, placement = moved(model, {d: values[some] for d, values in task.items()})
        good = np.flatnonzero(placement.reachable)
        if good.size:
            prepare_compliance(model.structure.at(placement[good]).among(count))


def _spans(task: Mapping[str, Array], items: slice) -> str:
    """Task coordinates of some poses, as in "x -0.1 to 0.1", m and rad."""
    spans = {d: (float(v[items].min()), float(v[items].max())) for d, v in task.items()}
    return ", ".join(f"{d} {a:.6g} to {b:.6g}" for d, (a, b) in spans.items())


def _asked(model: Model, task: dict[str, Array], answers: Sequence[Answer], count: int) -> Arrays:
    """Status, reasons, joint coordinates and answers of some poses of so many."""
    found, placement = moved(model, task)
    reach = np.asarray(found.reached)
    # the ranges' reasons are the last: what they alone forbid is out of range, not out of reach
    ranged = np.asarray(placement.status) > len(placement.reasons) - len(model.limits)
    status = np.where(
        placement.reachable,
        PoseStatus.GOOD,
        np.where(ranged, PoseStatus.JOINT_RANGE, PoseStatus.UNREACHABLE),
    ).astype(np.int8)
    reason, reasons = np.asarray(placement.status).astype(np.int16), [*placement.reasons]
    good = np.flatnonzero(placement.reachable)
    arrays: Arrays = {
        "joint_coordinate": np.where(reach[:, None], found.placement.values, np.nan),
        "task": _task(model, found),
    }
    if not good.size:
        for answer in answers:
            for column in answer.columns:
                widths = (len(answer.coordinates[d]) for d in column.dims)
                arrays[column.name] = np.full((len(status), *widths), np.nan)
        return arrays | {"status": status, "reason": reason, "reasons": np.array(reasons)}
    placed = model.structure.at(placement[good]).among(count)
    for answer in answers:
        values, outcome = answer(placed)
        for name, some in values.items():
            arrays[name] = np.full((len(status), *some.shape[1:]), np.nan)
            arrays[name][good] = some
        failed = np.flatnonzero(~outcome.solved)
        fresh = failed[status[good[failed]] == PoseStatus.GOOD]
        reason[good[fresh]] = len(reasons) + outcome.status[fresh]
        reasons += outcome.reasons
        status[good[failed]] = PoseStatus.UNSOLVED
    return arrays | {"status": status, "reason": reason, "reasons": np.array(reasons, dtype=str)}


def _task(model: Model, found: Moved) -> Array:
    """Task coordinates of the tool, (p, 6), missing where it was not brought."""
    if found.tool is None:
        raise ModelError("tool", "is not in the model.", "Name its node: [tool] tcp.")
    return np.where(found.reached[:, None], model.motion.task_of(found.tool), np.nan)


def _dataset(
    model: Model, grid: TaskGrid, answers: Sequence[Answer], arrays: Arrays, words: list[str]
) -> xr.Dataset:
    dims = tuple(grid.axes)
    joints = motion_units([d for _, d in model.motion.joints.names])
    variables: dict[str, xr.Variable] = {
        "status": flags("pose", arrays["status"]),
        "reason": named("pose", arrays["reason"], "1", "index into reason_text"),
        "joint_coordinate": named(
            ("pose", "joint"), arrays["joint_coordinate"], joints, "joint coordinates"
        ),
    }
    labels: dict[str, Any] = {
        "joint": [f"{joint}:{d}" for joint, d in model.motion.joints.names],
        "reason_text": words,
        **unit_coordinate("joint_coordinate", "joint", joints),
    }
    for answer in answers:
        for column in answer.columns:
            variables[column.name] = named(
                ("pose", *column.dims), arrays[column.name], column.unit, column.meaning
            )
            if isinstance(column.unit, LabelledUnits):
                labels |= unit_coordinate(column.name, column.dims[-1], column.unit)
        labels |= {k: list(v) for k, v in answer.coordinates.items()}
    folded = {
        name: xr.Variable(
            (*dims, *v.dims[1:]), v.to_numpy().reshape(*grid.shape, *v.shape[1:]), v.attrs
        )
        for name, v in variables.items()
    }
    for name, values in grid.axes.items():
        unit = "rad" if name.startswith("r") else "m"
        labels[name] = named(name, values, unit, f"task coordinate {name} of the tool")
    for k, name in enumerate(DIRECTIONS):
        if name not in dims:
            # what the grid does not name stays where it can: what became of it is of the pose
            unit = "rad" if name.startswith("r") else "m"
            values = arrays["task"][:, k].reshape(grid.shape)
            labels[name] = named(dims, values, unit, f"task coordinate {name} of the tool")
    counts = np.bincount(arrays["reason"], minlength=len(words))
    return xr.Dataset(
        folded,
        coords=labels,
        attrs={
            "title": f"survey of {model.title or 'a model'}",
            "Conventions": "CF-1.11",
            "source": f"strutwork {strutwork.__version__}",
            "poses": len(grid),
            "poses_kept": int(np.count_nonzero(arrays["status"] == PoseStatus.GOOD)),
            "dropped_by_reason": json.dumps(
                {w: int(n) for w, n in zip(words, counts, strict=True) if w and n}
            ),
            "versions": json.dumps(versions()),
        },
    )


def survey_key(model: Model, grid: TaskGrid, answers: Sequence[Answer]) -> str:
    """Hash of everything a survey's numbers depend on, the code included.

    Parameters
    ----------
    model : Model
    grid : TaskGrid
    answers : sequence of Answer
    """
    content: Mapping[str, Any] = {
        "structure": plain(model.structure),
        "placement": plain(
            {
                "positions": model.placement.positions,
                "frames": model.placement.frames,
                "values": model.placement.values,
                "names": [list(n) for n in model.placement.names],
            }
        ),
        "rotation": plain(model.rotation),
        "limits": plain(model.limits),
        "grid": plain(dict(grid.axes)),
        "answers": [[type(a).__name__, plain(a)] for a in answers],
        "versions": versions(),
        "code": source_digest(*(f"strutwork.{name}" for name in _CODE)),
        "chunk": CHUNK,
    }
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
