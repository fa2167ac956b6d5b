"""What a calibration of the geometry takes away, and what it leaves.

The displacements of the tool are linear in the misfits, y = J z + ε at the measured poses, with z
in units of its standard deviation and ε in units of the measuring uncertainty. Of the singular
combinations of J those with a value above one are known better after the measurement than before:
these are estimated by least squares and compensated, the others stay as they were. What is left at
a pose is linear in z and ε again, so that its worst case is exact (Borm and Menq 1991 for
observability and the choice of poses).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Placement, Poses
from strutwork.kinematics.sparse_basis import sparse_basis
from strutwork.kinematics.tool_turns import ToolTurns
from strutwork.machines.model import Model
from strutwork.machines.model_poses import moved
from strutwork.msa import PlacedStructure
from strutwork.names import choices
from strutwork.overconstraint.accuracy import accuracy
from strutwork.overconstraint.sampling import variances
from strutwork.overconstraint.sources import MisfitSources
from strutwork.overconstraint.tolerance import Tolerance
from strutwork.studies.identifiability import Identifiability, identifiability
from strutwork.studies.pose_choice import greedy_exchange

Array = NDArray[Any]

#: A combination of parameters whose standard deviation the measurement does not bring below that of
#: the tolerances is not determined.
INFORMS = 1.0

#: A combination that poses show by less, as a share of the one they show best, is rounding.
SEEN = 1e-9

#: Weights of a combination below this are not named.
SMALL = 1e-3

#: Candidate poses at most.
CANDIDATES = 5000


@dataclass(frozen=True)
class CalibrationPlan:
    """A calibration: which parameters, what is measured, and where.

    Parameters
    ----------
    parameters : tuple of str
        Names or kinds of tolerances; empty for all.
    directions : tuple of str
        Measured displacements of the tool.
    count : int or None
        How many poses are chosen of the candidates.
    at : tuple of mapping of direction to float
        Poses, m and rad, that are measured beside them.
    candidates : mapping of direction to (n,)
        m and rad; empty for the machine's workspace.
    uncertainty, angular_uncertainty : float or None
        Standard deviation of a measured translation and rotation, m and rad.

    Raises
    ------
    ModelError
        No pose, or a measured direction without its uncertainty.
    """

    parameters: tuple[str, ...] = ()
    directions: tuple[str, ...] = DIRECTIONS[:3]
    count: int | None = None
    at: tuple[Mapping[str, float], ...] = ()
    candidates: Mapping[str, Array] | None = None
    uncertainty: float | None = None
    angular_uncertainty: float | None = None

    def __post_init__(self) -> None:
        if self.count is None and not self.at:
            raise ModelError(
                "calibration",
                "has no pose.",
                "Say how many are chosen, as in poses = 12, or list them as at = [{ ... }].",
            )
        for direction in self.directions:
            _ = self.deviation(direction)

    def deviation(self, direction: str) -> float:
        """Standard deviation of a measured direction, m or rad.

        Parameters
        ----------
        direction : str

        Raises
        ------
        ModelError
            It is not stated.
        """
        turns = direction.startswith("r")
        key = "angular_uncertainty" if turns else "uncertainty"
        value = self.angular_uncertainty if turns else self.uncertainty
        if value is None:
            example = "2 urad" if turns else "1 um"
            raise ModelError(
                "calibration",
                f"measures {direction} and does not state {key}.",
                f'Add its standard deviation, as in {key} = "{example}".',
            )
        return value


@dataclass(frozen=True)
class GeometryCalibration:
    """What a calibration determines.

    Parameters
    ----------
    names : tuple of k str
        Of the parameters of all tolerances.
    chosen : (k,) of bool
        Those that are calibrated.
    task : mapping of direction to (p,)
        The measured poses, m and rad.
    picked : int
        How many of them were chosen of the candidates; they come last.
    found : Identifiability
        Of the calibrated parameters, each in units of its standard deviation, by measurements in
        units of their uncertainty.
    keep : (k, k)
        What is left of the parameters, no unit.
    noise : (k, r)
        What the measuring uncertainty adds to them, per unit normal number, no unit.
    """

    names: tuple[str, ...]
    chosen: NDArray[np.bool_]
    task: Mapping[str, Array]
    picked: int
    found: Identifiability
    keep: Array
    noise: Array

    def __repr__(self) -> str:
        return f"<GeometryCalibration: {self.found!r}, {self.poses} poses>"

    @property
    def poses(self) -> int:
        """How many poses are measured."""
        return len(next(iter(self.task.values()), ()))

    @property
    def undetermined(self) -> tuple[dict[str, float], ...]:
        """Combinations that stay as they were, of few parameters each: their weights.

        In units of the parameters' standard deviations, the largest one.
        """
        free = self.found.directions[self.found.rank :]
        if not len(free):
            return ()
        return tuple(
            {n: float(w) for n, w in zip(self.found.names, row, strict=True) if abs(w) > SMALL}
            for row in sparse_basis(free.T).T
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain values, SI."""
        return {
            "parameters": list(self.found.names),
            "determined_combinations": self.found.rank,
            "determined": list(self.found.determined),
            "undetermined_combinations": list(self.undetermined),
            "singular_values": self.found.singular_values.tolist(),
            "poses": [{d: float(v[i]) for d, v in self.task.items()} for i in range(self.poses)],
            "chosen_poses": self.picked,
        }


def calibrated_geometry(
    model: Model, tolerances: tuple[Tolerance, ...], plan: CalibrationPlan
) -> GeometryCalibration:
    """Measure a machine's geometry in thought, and see what is known afterwards.

    Parameters
    ----------
    model : Model
        With a tool; its structure is that of the measurement.
    tolerances : tuple of Tolerance
    plan : CalibrationPlan

    Raises
    ------
    ModelError
        No tolerance, one that is unknown, too few candidates, or a pose that cannot be taken.
    StrutworkError
        As `strutwork.overconstraint.accuracy.accuracy`.
    """
    if not tolerances:
        raise ModelError(
            "calibration", "has no tolerances to calibrate.", "Add [[tolerances]] to either file."
        )
    task, fixed = _poses(model, plan)
    _, sources = _gain(tolerances, model.placed)
    names, chosen = _parameters(sources, plan)
    deviation = np.sqrt(variances(sources))
    pick = [DIRECTIONS.index(d) for d in plan.directions]
    weight = np.array([plan.deviation(d) for d in plan.directions])
    gain, _ = _gain(tolerances, model.structure.at(_placement(model, task)))
    rows = gain[:, pick] * deviation / weight[:, None]
    index = np.arange(fixed)
    if plan.count is not None:
        own = rows[:, :, chosen]
        # combinations that no pose shows would leave only rounding to compare the poses by
        _, size, right = np.linalg.svd(own.reshape(-1, own.shape[-1]), full_matrices=False)
        own = own @ right[size > SEEN * size.max(initial=0.0)].T
        each = np.einsum("pdi,pdj->pij", own, own)
        prior = np.eye(own.shape[-1]) + each[:fixed].sum(axis=0)
        index = np.append(
            index, fixed + np.array(greedy_exchange(prior, each[fixed:], plan.count), dtype=int)
        )
    jacobian = rows[index].reshape(-1, len(names))
    values = np.linalg.svd(jacobian[:, chosen], compute_uv=False)
    labels = tuple(n for n, c in zip(names, chosen, strict=True) if c)
    share = INFORMS / values[0] if values[0] > INFORMS else 1.0
    found = identifiability(jacobian[:, chosen], labels, float(share))
    estimate = np.zeros((len(names), len(jacobian)))
    noise = np.zeros((len(names), found.rank))
    if found.rank:
        left, size, right = np.linalg.svd(jacobian[:, chosen], full_matrices=False)
        inverse = right[: found.rank].T / size[: found.rank]
        estimate[chosen] = inverse @ left[:, : found.rank].T
        noise[chosen] = inverse
    keep = np.eye(len(names)) - estimate @ jacobian
    # back from units of standard deviations
    keep = deviation[:, None] * keep / deviation
    return GeometryCalibration(
        names,
        chosen,
        {d: v[index] for d, v in task.items()},
        0 if plan.count is None else plan.count,
        found,
        keep,
        deviation[:, None] * noise,
    )


def turned(model: Model, placed: PlacedStructure) -> PlacedStructure:
    """The structure at its pose with the rotations of its bodies, which misfits go with.

    Parameters
    ----------
    model : Model
        Where it stands.
    placed : PlacedStructure
        At one pose.

    Raises
    ------
    ModelError
        The pose cannot be followed from where the model stands.
    """
    placement = placed.placement
    same = np.array_equal(placement.positions, model.placement.positions)
    if placement.turns is not None or same:
        return placed
    linkage = model.structure.linkage
    tool = linkage.node_index[model.require_tool()]
    rotation = ToolTurns.of(linkage, model.placement).at(placement[None])[0] @ model.rotation
    found = model.motion.move(tool=Poses(placement.positions[None, tool], rotation[None]))
    turns = found.placement.require_reachable().turns
    return placed if turns is None else placed.structure.at(replace(placement, turns=turns[0]))


def _gain(
    tolerances: tuple[Tolerance, ...], placed: PlacedStructure
) -> tuple[Array, MisfitSources]:
    """Displacement of the tool per parameter of the tolerances, (..., 6, k)."""
    found = accuracy(placed, tolerances)
    return found.gain, found.sources


def _placement(model: Model, task: Mapping[str, Array]) -> Placement:
    """Where the machine stands at the poses, with the rotations of its bodies."""
    placement = _brought(model, task)
    bad = np.flatnonzero(~placement.reachable)
    if bad.size:
        at = ", ".join(f"{d} = {v[bad[0]]:.6g}" for d, v in task.items())
        raise ModelError(
            "calibration",
            f"measures at {at}, which the machine cannot take: {placement.reason((int(bad[0]),))}.",
            "Choose poses within the workspace.",
        )
    return placement


def _brought(model: Model, task: Mapping[str, Array]) -> Placement:
    """Where the joints bring the machine, which turns its bodies; the limits are its own."""
    found, own = moved(model, task)
    return replace(found.placement, status=own.status, reasons=own.reasons)


def _poses(model: Model, plan: CalibrationPlan) -> tuple[dict[str, Array], int]:
    """Poses that are given, then candidates that can be taken, and how many are given."""
    grid: Mapping[str, Array] = {}
    if plan.count is not None:
        if plan.candidates:
            grid = plan.candidates
        elif model.workspace is not None:
            grid = model.workspace.task()
        else:
            raise ModelError(
                "calibration",
                "has no candidate poses: neither file states any.",
                "Add [calibration.candidates] with spans, or [workspace] to the model file.",
            )
    total = len(next(iter(grid.values()), ()))
    if total > CANDIDATES:
        raise ModelError(
            "calibration.candidates", f"are {total:,} poses.", f"Give {CANDIDATES:,} at most."
        )
    motion = model.motion
    home = dict(zip(DIRECTIONS, motion.task_of(motion.home_pose).reshape(6), strict=True))
    used = [d for d in DIRECTIONS if d in grid or any(d in one for one in plan.at)]
    used = used or [*(model.task or DIRECTIONS)[:1]]
    given = {d: np.array([one.get(d, home[d]) for one in plan.at], dtype=float) for d in used}
    free = {d: np.asarray(grid[d]) if d in grid else np.full(total, home[d]) for d in used}
    if total:
        good = _brought(model, free).reachable
        count = plan.count or 0
        if good.sum() < count:
            raise ModelError(
                "calibration.candidates",
                f"are {total}, of which {good.sum()} can be taken: too few to choose {count}.",
                "Give more points, or move the grid.",
            )
        free = {d: v[good] for d, v in free.items()}
    return {d: np.concatenate([given[d], free[d]]) for d in used}, len(plan.at)


def _parameters(
    sources: MisfitSources, plan: CalibrationPlan
) -> tuple[tuple[str, ...], NDArray[np.bool_]]:
    """Names of the tolerances' parameters, and which of them are calibrated."""
    known = {t.name for t in sources.tolerances} | {t.kind for t in sources.tolerances}
    for name in plan.parameters:
        if name not in known:
            raise ModelError(
                "calibration.parameters",
                f'names the unknown tolerance "{name}".',
                choices("Tolerances and kinds", name, sorted(known)),
            )
    names: list[str] = []
    chosen: list[bool] = []
    for t, tolerance in enumerate(sources.tolerances):
        size = sum(b.shape.dimension for b in sources.blocks if b.tolerance == t)
        names += [tolerance.name if size == 1 else f"{tolerance.name} {i + 1}" for i in range(size)]
        taken = not plan.parameters or bool({tolerance.name, tolerance.kind} & {*plan.parameters})
        chosen += [taken] * size
    return tuple(names), np.array(chosen, dtype=bool)
