"""Machines by the same questions, in the same task: what sets them side by side."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.errors import ModelError, StrutworkError
from strutwork.fea import modes
from strutwork.kinematics import DIRECTIONS, mobility
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.kinematics.tool_drive_space import tool_drive_space
from strutwork.machines.model import Model
from strutwork.msa import compliance_and_outcome
from strutwork.studies.answers import Answer, Stiffness
from strutwork.studies.progress import Progress
from strutwork.studies.survey import survey
from strutwork.studies.transmission_answer import Transmission

Array = NDArray[Any]

#: To either side of home, m, and points along each direction, of the task of all machines.
HALF, POINTS = 0.01, 5

#: The task in words.
TASK = (
    f"a cube of {2e3 * HALF:g} mm about home, {POINTS} points along each of the machine's "
    "translations, with the tool oriented as at home where the machine can do so"
)

AXES = DIRECTIONS[:3]

#: Singular value of a unit motion's share along axes above which the tool moves along them.
MOVES = 1e-6


@dataclass(frozen=True)
class MachineAnswers:
    """One machine's answers to the questions that all are asked.

    Parameters
    ----------
    mobility, drives, redundant : int
        Freedoms with the drives free, driven directions, and constraints that are redundant with
        the drives held.
    home, worst : (3,)
        Stiffness along x, y, z at home and the least in the task, the other directions free, N/m;
        infinite along a direction that gives way nowhere, NaN where it is not known.
    worst_at : tuple of dict of direction to float
        Where the least of each is, m.
    condition : (2,)
        Least and largest condition number of the Jacobian in the task, no unit.
    length : float
        m, that counts as one radian in it; NaN where it is not known.
    reached, poses : int
        Poses of the task.
    frequency : float
        First natural frequency at home that strains something, Hz; NaN where it is not known.
    missing : dict of str to str
        Why an answer is missing, by the name of its field.
    """

    mobility: int
    drives: int
    redundant: int
    home: Array
    worst: Array
    worst_at: tuple[dict[str, float], ...]
    condition: Array
    length: float
    reached: int
    poses: int
    frequency: float
    missing: dict[str, str] = field(default_factory=dict)

    def __repr__(self) -> str:
        return (
            f"<MachineAnswers: mobility {self.mobility}, {self.drives} drives, "
            f"{self.reached} of {self.poses} poses reached>"
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers in SI; None where one is missing."""
        content = {
            "mobility": self.mobility,
            "drives": self.drives,
            "redundant_constraints": self.redundant,
            "stiffness_at_home": self.home.tolist(),
            "least_stiffness": self.worst.tolist(),
            "least_stiffness_at": list(self.worst_at),
            "condition": self.condition.tolist(),
            "characteristic_length": self.length,
            "poses_reached": self.reached,
            "poses": self.poses,
            "first_frequency": self.frequency,
            "missing": self.missing,
        }
        plain = json.loads(json.dumps(content), parse_constant=lambda _: None)
        assert isinstance(plain, dict)  # noqa: S101 - of a dict
        return plain


def common_task(model: Model) -> TaskGrid:
    """The task that all machines are asked in.

    Parameters
    ----------
    model : Model
        With a tool and drives.

    Raises
    ------
    ModelError
        No drive, or a tool that moves along no axis at home.
    """
    space = tool_drive_space(model.structure.linkage, model.placement)
    moves: list[int] = []
    for row in range(3):
        if model.task and DIRECTIONS[row] not in model.task:
            continue
        several = [*moves, row]
        if np.linalg.matrix_rank(space.tool[0, several], tol=MOVES) == len(several):
            moves = several
    if not moves:
        raise ModelError("tool", "moves along no axis at home.", "Give it a workspace of its own.")
    home = model.motion.task_of(model.motion.home_pose)
    steps = np.linspace(-HALF, HALF, POINTS)
    return TaskGrid({DIRECTIONS[k]: home[k] + steps for k in moves})


def machine_answers(
    model: Model, heavy: Model | None = None, progress: Progress | None = None
) -> MachineAnswers:
    """Ask a machine what all are asked.

    Parameters
    ----------
    model : Model
        With a tool.
    heavy : Model, optional
        The same machine as it vibrates, where that is another model.
    progress : callable, optional
        Called with how many poses are done, and of how many.

    Returns
    -------
    MachineAnswers
        An answer that a machine cannot give is missing, and `missing` says why.
    """
    missing: dict[str, str] = {}
    found = mobility(model.structure.linkage, model.placement)
    task: xr.Dataset | None = None
    condition, length = np.full(2, np.nan), np.nan
    transmission: Transmission | None = None
    try:
        transmission = Transmission.of(model)
        length = transmission.length
    except StrutworkError as error:
        missing["condition"] = str(error)
    answers: list[Answer] = [Stiffness()]
    if transmission is not None:
        answers.append(transmission)
    try:
        task = survey(model, common_task(model), answers, progress=progress)
    except StrutworkError as error:
        missing["worst"] = str(error)
        missing.setdefault("condition", str(error))
    worst = np.full(3, np.nan)
    places: tuple[dict[str, float], ...] = ({}, {}, {})
    if task is not None:
        worst, places = _least(task)
        if transmission is not None:
            values = task["condition"].to_numpy()
            condition = np.array([np.nanmin(values), np.nanmax(values)])
    return MachineAnswers(
        found.mobility,
        len(model.structure.linkage.driven),
        found.redundant,
        _at_home(model, missing),
        worst,
        places,
        condition,
        float(length),
        0 if task is None else int(task.attrs["poses_kept"]),
        0 if task is None else int(task.attrs["poses"]),
        _frequency(model if heavy is None else heavy, missing),
        missing,
    )


def _at_home(model: Model, missing: dict[str, str]) -> Array:
    try:
        compliance, outcome = compliance_and_outcome(model.placed)
        outcome.require_all()
    except StrutworkError as error:
        missing["home"] = str(error)
        return np.full(3, np.nan)
    with np.errstate(divide="ignore"):
        return np.asarray(1.0 / np.diagonal(compliance)[:3])


def _frequency(model: Model, missing: dict[str, str]) -> float:
    try:
        found = modes(model.vibrating, 1)
        free = int(found.rigid_body_modes)
        if free:
            found = modes(model.vibrating, free + 1)
    except StrutworkError as error:
        missing["frequency"] = str(error)
        return float("nan")
    strained = found.frequencies.ravel()[free:]
    if not len(strained):
        missing["frequency"] = "Nothing in it is strained: every mode is one of a rigid body."
        return float("nan")
    return float(strained[0])


def _least(task: xr.Dataset) -> tuple[Array, tuple[dict[str, float], ...]]:
    """Least stiffness along each axis, and where."""
    values = task["stiffness_free"].sel(direction=list(AXES))
    dims = [str(d) for d in values.dims if d != "direction"]
    flat = values.transpose("direction", *dims).to_numpy().reshape(3, -1)
    worst, places = np.full(3, np.nan), []
    shape = tuple(task.sizes[d] for d in dims)
    for k, row in enumerate(flat):
        known = np.where(np.isnan(row), np.inf, row)
        at = np.unravel_index(int(np.argmin(known)), shape)
        worst[k] = float(row[int(np.argmin(known))])
        places.append({d: float(task[d][i]) for d, i in zip(dims, at, strict=True)})
    return worst, tuple(places)
