"""Stiffness of a machine over a user's own poses."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import Poses
from strutwork.machines import Machine
from strutwork.studies.chunks import Arrays
from strutwork.studies.description import attributes, study_key
from strutwork.studies.evaluation import Evaluator, keep_said, said, spread
from strutwork.studies.executor import Executor
from strutwork.studies.filters import Filters, PoseStatus
from strutwork.studies.progress import Progress
from strutwork.studies.run import Chunk, Run, fill
from strutwork.studies.variables import AXES, named, stiffness_variables

Array = NDArray[Any]

#: Poses evaluated at once: some tens of megabytes a worker.
CHUNK = 8192


def sweep(
    machine: Machine,
    positions: ArrayLike,
    rotations: ArrayLike | None = None,
    filters: Filters | None = None,
    *,
    workers: int | None = None,
    progress: Progress | None = None,
    folder: Path | None = None,
    executor: Executor | None = None,
) -> xr.Dataset:
    """Stiffness at every position with every rotation.

    Parameters
    ----------
    machine : Machine
    positions : (n, 3)
        m.
    rotations : (q, 3, 3), optional
        Rotation matrices; default the machine's own at home.
    filters : Filters, optional
        Default: all joint ranges, condition number below 100.
    workers, progress, folder, executor
        As `strutwork.studies.stiffness_map`.

    Returns
    -------
    xarray.Dataset
        n·q poses along `pose`, rotation fastest. `good` is the mask, `status` the flag, and
        `reason` the index into `reason_text`, whose first entry is empty; the numbers of poses
        that do not count are missing (NaN).

    Raises
    ------
    ModelError
        No poses, or arrays of another shape.
    """
    filters = filters or Filters()
    position = np.atleast_2d(np.asarray(positions, dtype=float))
    home = np.asarray(machine.home().rotation, dtype=float).reshape(1, 3, 3)
    rotation = home if rotations is None else np.asarray(rotations, dtype=float)
    rotation = rotation[None] if rotation.ndim == 2 else rotation
    if position.shape[1:] != (3,) or rotation.shape[1:] != (3, 3) or not position.size:
        raise ModelError(
            "sweep",
            f"positions have the shape {position.shape}, rotations {rotation.shape}.",
            "Give at least one position (n, 3), and rotations (q, 3, 3).",
        )
    turns = len(rotation)
    total = len(position) * turns
    some = spread(total)
    evaluator = Evaluator(machine, filters, total).prepared(
        Poses(position[some // turns], rotation[some % turns])
    )

    def evaluate(chunk: Chunk) -> Arrays:
        item = np.arange(chunk.start, chunk.stop)
        found = evaluator(Poses(position[item // turns], rotation[item % turns]))
        return {
            "status": found.status,
            "reason": found.reason,
            "condition_number": found.condition,
            "compliance": found.compliance,
            "reasons": np.array(found.reasons),
            **said(found),
        }

    run = Run(workers, executor, folder, progress)
    arrays: Arrays = {}
    words = [""]
    examples: dict[str, str] = {}
    for chunk, part in run.chunks(
        evaluate,
        total,
        CHUNK,
        lambda: study_key(
            "sweep", machine, {"filters": filters, "chunk": CHUNK}, position, rotation
        ),
    ):
        # a machine may name its reasons in another order elsewhere
        local = ["", *part.pop("reasons").tolist()]
        keep_said(examples, part)
        words += [w for w in local if w not in words]
        number = np.array([words.index(w) for w in local], dtype=np.int16)
        fill(arrays, chunk, part | {"reason": number[part["reason"]]}, total)
    status = arrays["status"]
    item = np.arange(total)
    good = status == PoseStatus.GOOD
    variables = {
        "position": named(("pose", "axis"), position[item // turns], "m", "tool position"),
        "rotation": named(
            ("pose", "axis", "tool_axis"),
            rotation[item % turns],
            "1",
            "axes of the tool as columns",
        ),
        **stiffness_variables("pose", arrays["compliance"], status),
        "good": named("pose", good, "1", "the pose counts"),
        "reason": named("pose", arrays["reason"], "1", "index into reason_text"),
        "reason_text": xr.Variable(
            "reason_index", words, {"long_name": "why a pose does not count"}
        ),
        "condition_number": named(
            "pose", arrays["condition_number"], "1", "condition number of the inverse Jacobian"
        ),
    }
    counts = np.bincount(arrays["reason"], minlength=len(words))
    kept = "all" if filters.joint_kinds is None else filters.joint_kinds
    details = {
        "poses": total,
        "poses_kept": int(np.count_nonzero(good)),
        "dropped_by_reason": json.dumps(
            {w: int(n) for w, n in zip(words, counts, strict=True) if w and n}
        ),
        "first_of_reason": json.dumps(examples),
        "joint_ranges_kept": json.dumps(kept),
        "condition_limit": filters.condition_limit or "none",
        "condition_length": evaluator.length,
    }
    return xr.Dataset(
        variables,
        coords={"axis": list(AXES), "tool_axis": list(AXES)},
        attrs=attributes("stiffness sweep", machine) | details,
    ).assign_coords(pose=item)
