"""First frequencies and least dynamic stiffness of a machine over check points."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import MechanismError, ModelError, NumericalError
from strutwork.fea import Damping
from strutwork.fea.dynamic_stiffness import check_band, minimum_of
from strutwork.fea.validity import warn_beyond
from strutwork.kinematics import Placement
from strutwork.machines import Machine, roll_angles
from strutwork.studies.check_points import CheckPoints, hemisphere
from strutwork.studies.chunks import Arrays
from strutwork.studies.description import attributes, plain, study_key
from strutwork.studies.dynamic import BAND, MODES, ONE_PERCENT, modal_data, tool_ports
from strutwork.studies.evaluation import SAMPLE, Evaluator, spread
from strutwork.studies.executor import Executor
from strutwork.studies.filters import REASONS, Filters, PoseStatus
from strutwork.studies.progress import Progress
from strutwork.studies.run import Chunk, Run, fill
from strutwork.studies.stiffness_map import stiffest_roll
from strutwork.studies.variables import AXES, flags, named

Array = NDArray[Any]

#: Check points of a chunk: every roll is a static solution, one of them an eigensolution.
POINTS = 64

#: Poses whose eigenproblems are solved at once: a stack of matrices stays within the cache.
PIECE = 16

#: The variables along mode and axis, with their units.
_VARIABLES = {
    "natural_frequency": ("mode", "Hz", "natural frequency"),
    "minimum_dynamic_stiffness": (
        "axis",
        "N/m",
        "least driving-point dynamic stiffness 1/|H_ii| in the band",
    ),
    "minimum_frequency": ("axis", "Hz", "frequency of the least dynamic stiffness"),
    "static_stiffness": ("axis", "N/m", "static stiffness with the other directions free"),
}


@dataclass(frozen=True)
class Vibration:
    """Options for the vibration of a machine.

    Parameters
    ----------
    damping : Damping
    band : (float, float)
        Hz; where the least dynamic stiffness is looked for.
    count : int
        Modes to list.

    Raises
    ------
    ModelError
        A wrong band, or no modes.
    """

    damping: Damping = ONE_PERCENT
    band: tuple[float, float] = BAND
    count: int = MODES

    def __post_init__(self) -> None:
        check_band(*self.band)
        if self.count < 1:
            raise ModelError("modes", f"{self.count} asked for.", "Request at least one.")


def dynamic_map(
    machine: Machine,
    points: CheckPoints | None = None,
    rolls: ArrayLike | None = None,
    filters: Filters | None = None,
    vibration: Vibration | None = None,
    *,
    workers: int | Executor | None = None,
    progress: Progress | None = None,
    folder: Path | None = None,
) -> xr.Dataset:
    """Modes and least dynamic stiffness over check points.

    The roll γ at each point is that of the stiffness map: of the candidates that count, the one
    with the largest blocked Kxx. Only there the eigenproblem is solved.

    Parameters
    ----------
    machine : Machine
        Its structure needs mass.
    points : CheckPoints, optional
        Default: `hemisphere(machine)`.
    rolls : (r,), optional
        rad. Default: 24 over a third of a turn, `strutwork.machines.roll_angles()`.
    filters : Filters, optional
        Default: all joint ranges, condition number below 100.
    vibration : Vibration, optional
        Damping, band and number of modes.
    workers : int or Executor, optional
        Threads, or what computes in place of threads; default one thread per processor.
    progress : callable, optional
        Called with how many candidates are done, and of how many.
    folder : Path, optional
        Keeps finished chunks there; a later call with the same inputs goes on from them.

    Returns
    -------
    xarray.Dataset
        Dimensions point, mode, axis, reason; every variable states its unit. Where no candidate
        is left the numbers are missing (NaN) and `status` says why.

    Raises
    ------
    ModelError
        No rolls, no mass, no damping, a wrong band, or a machine whose model is wrong.

    Warns
    -----
    ValidityWarning
        The band goes beyond what a superelement holds to.
    """
    vibration = vibration or Vibration()
    filters = filters or Filters()
    points = points or hemisphere(machine)
    turns = np.atleast_1d(np.asarray(roll_angles() if rolls is None else rolls, dtype=float))
    if turns.ndim != 1 or not turns.size or not np.all(np.isfinite(turns)):
        raise ModelError("rolls", "are none, or not finite.", "Give a list of angles, rad.")
    some = points.poses(spread(len(points), max(1, SAMPLE // len(turns))), turns)
    evaluator = Evaluator(machine, filters, len(points) * len(turns)).prepared(some)
    # what is wrong whatever the pose is told before the work begins
    home = machine.place(machine.home())
    _vibrate_stack(machine, home, vibration)
    warn_beyond(machine.structure.at(home), vibration.band[1])

    def evaluate(chunk: Chunk) -> Arrays:
        poses = points.poses(chunk.items, turns)
        found = evaluator(poses)
        best, status = stiffest_roll(found, len(turns))
        good = np.flatnonzero(status == PoseStatus.GOOD)
        chosen = machine.place(poses[good * len(turns) + best[good]])
        parts, solved = _vibrate(machine, chosen, vibration)
        status[good] = solved
        result: Arrays = {"status": status}
        for name, values in parts.items():
            result[name] = np.full((len(status), values.shape[1]), np.nan)
            result[name][good] = values
        result["roll"] = np.where(status == PoseStatus.GOOD, turns[best], np.nan)
        dropped = found.status.reshape(-1, len(turns))
        result["dropped"] = np.stack([(dropped == code).sum(axis=1) for code in REASONS], -1)
        return result

    settings = {
        "filters": filters,
        "vibration": vibration,
        "damping": str(vibration.damping),
        "chunk": POINTS,
    }
    arrays: Arrays = {}
    threads, executor = (workers, None) if isinstance(workers, int | None) else (None, workers)
    run = Run(threads, executor, folder, progress)
    for chunk, part in run.chunks(
        evaluate,
        len(points),
        POINTS,
        lambda: study_key("dynamic map", machine, settings, points.position, points.normal, turns),
        len(turns),
    ):
        fill(arrays, chunk, part, len(points))
    details = {
        "roll_criterion": "largest blocked Kxx, (C^-1)_xx, of the valid candidates",
        "candidates": len(points) * len(turns),
        "points_kept": int(np.count_nonzero(arrays["status"] == PoseStatus.GOOD)),
        "damping": str(vibration.damping),
        "band": f"{vibration.band[0]:g} to {vibration.band[1]:g} Hz",
        "rolls": json.dumps(plain(turns)),
        "condition_limit": filters.condition_limit or "none",
        "condition_length": evaluator.length,
    }
    return _dataset(machine, points, arrays, details)


def _vibrate(
    machine: Machine, placement: Placement, vibration: Vibration
) -> tuple[Arrays, NDArray[np.int8]]:
    """Frequencies and minima of reachable poses, in stacks; stacks that fail are halved."""
    poses = placement.batch[0]
    status = np.zeros(poses, dtype=np.int8)
    result: Arrays = {
        name: np.full((poses, vibration.count if dim == "mode" else len(AXES)), np.nan)
        for name, (dim, _, _) in _VARIABLES.items()
    }
    pending = list(np.array_split(np.arange(poses), max(1, -(-poses // PIECE))))
    while pending:
        part = pending.pop()
        if not part.size:
            continue
        try:
            values = _vibrate_stack(machine, placement[part], vibration)
        except (MechanismError, NumericalError) as error:
            if part.size == 1:
                mechanism = isinstance(error, MechanismError)
                status[part] = PoseStatus.MECHANISM if mechanism else PoseStatus.UNSOLVED
            else:
                pending += np.array_split(part, 2)
            continue
        for name, found in values.items():
            result[name][part] = found
    return result, status


def _vibrate_stack(machine: Machine, placement: Placement, vibration: Vibration) -> Arrays:
    placed = machine.structure.at(placement)
    frequencies, model = modal_data(placed, tool_ports(machine), vibration.damping, vibration.count)
    found = minimum_of(model, vibration.band)
    return {
        "natural_frequency": frequencies,
        "minimum_dynamic_stiffness": found.value,
        "minimum_frequency": found.frequency,
        "static_stiffness": found.static,
    }


def _dataset(
    machine: Machine, points: CheckPoints, arrays: Arrays, details: dict[str, Any]
) -> xr.Dataset:
    variables = {
        "position": named(("point", "axis"), points.position, "m", "tool position"),
        "normal": named(("point", "axis"), points.normal, "1", "direction of the tool's z axis"),
        "roll": named("point", arrays["roll"], "rad", "roll about the normal (Euler angle γ)"),
        "status": flags("point", arrays["status"]),
        "dropped": named(
            ("point", "reason"), arrays["dropped"], "1", "candidates dropped, by reason"
        ),
    }
    for name, (dim, unit, long_name) in _VARIABLES.items():
        variables[name] = named(("point", dim), arrays[name], unit, long_name)
    modes = arrays["natural_frequency"].shape[1]
    return xr.Dataset(
        variables,
        coords={
            "point": np.arange(len(points)),
            "axis": list(AXES),
            "mode": np.arange(1, modes + 1),
            "reason": [code.word for code in REASONS],
        },
        attrs=attributes("dynamic map", machine) | details,
    )
