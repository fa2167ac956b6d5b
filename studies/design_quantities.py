"""What a design can be judged by: numbers of a machine by their names."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model import Model
from strutwork.names import choices, matches
from strutwork.studies.answers import Column
from strutwork.studies.chunks import Arrays
from strutwork.studies.dataset_units import LabelledUnits
from strutwork.studies.filters import PoseStatus
from strutwork.studies.pose_sets import PoseSet
from strutwork.studies.travel_answer import COLUMN, TRAVEL
from strutwork.studies.variables import AXES
from strutwork.units import (
    ANGLE,
    FORCE,
    FREQUENCY,
    LENGTH,
    MASS,
    MOMENT,
    NUMBER,
    ROTATIONAL_STIFFNESS,
    STIFFNESS,
    Dimension,
)

Array = NDArray[Any]

Goal = Literal["minimise", "maximise"]

#: Before the name of a quantity whose mean over the poses is meant.
MEAN = "mean"
#: Those that are no answer of the machine; the first also for one direction, as "reach_ry".
REACH, COST = "reach", "cost"

#: Columns that have a value at each pose and a mean that says something.
_OF_POSES = ("stiffness_free", "stiffness_blocked", "condition")


@dataclass(frozen=True)
class Quantity:
    """A number by which machines are judged.

    Parameters
    ----------
    name : str
    question : str
        Of `strutwork.studies.question.QUESTIONS`; empty where it is no answer of the machine.
    column : str
        Of that answer.
    label : str
        Along the column; empty: the worst of all labels.
    dimension : Dimension
    goal : "minimise" or "maximise"
        Unless a file states the other.
    meaning : str
    reduction : "worst", "mean", "poses" for each by itself, or one of `OF_JOINTS`
        Over the poses, of what depends on them.
    """

    name: str
    question: str
    column: str
    label: str
    dimension: Dimension
    goal: Goal
    meaning: str
    reduction: str = "worst"

    @property
    def unit(self) -> str:
        """SI; "1" for none."""
        return self.dimension.unit or "1"

    @property
    def variable(self) -> str:
        """Its name in a dataset: a NetCDF file allows no slash."""
        return re.sub(r"[\s/]", "_", self.name)


def _quantities() -> dict[str, Quantity]:
    found = [
        Quantity(
            f"{prefix}stiffness_{d}",
            "stiffness",
            f"stiffness_{kind}",
            d,
            ROTATIONAL_STIFFNESS if d.startswith("r") else STIFFNESS,
            "maximise",
            f"worst stiffness along {d} with the other directions {kind}"
            if not d.startswith("r")
            else f"worst stiffness about {d[1:]} with the other directions {kind}",
        )
        for prefix, kind in (("", "free"), ("blocked_", "blocked"))
        for d in DIRECTIONS
    ]
    dynamic = "least_dynamic_stiffness"
    words = "least dynamic stiffness in the band"
    found += [
        Quantity(
            "first_frequency",
            "frequency",
            "first_frequency",
            "",
            FREQUENCY,
            "maximise",
            "lowest natural frequency at home",
        ),
        Quantity(
            "lowest_frequency",
            "vibration",
            "natural_frequency",
            "1",
            FREQUENCY,
            "maximise",
            "lowest natural frequency over the poses",
        ),
        Quantity(dynamic, "vibration", dynamic, "", STIFFNESS, "maximise", f"{words}, along x y z"),
        *(
            Quantity(
                f"{dynamic}_{axis}",
                "vibration",
                dynamic,
                axis,
                STIFFNESS,
                "maximise",
                f"{words} along {axis}",
            )
            for axis in AXES
        ),
        Quantity("mass", "mass", "mass", "", MASS, "minimise", "mass of all parts"),
        Quantity(
            "locked_in_force",
            "assembly",
            "worst_case",
            "N",
            FORCE,
            "minimise",
            "largest joint force that the tolerances allow",
        ),
        Quantity(
            "locked_in_moment",
            "assembly",
            "worst_case",
            "N m",
            MOMENT,
            "minimise",
            "largest joint moment that the tolerances allow",
        ),
        Quantity(
            "condition",
            "transmission",
            "condition",
            "",
            NUMBER,
            "minimise",
            "worst condition number of the Jacobian from drives to tool",
        ),
        Quantity(
            "least_amplification",
            "amplification",
            "least_amplification",
            "",
            NUMBER,
            "maximise",
            "least velocity of the tool over the poses, for drive rates of size one",
        ),
        Quantity(
            "largest_amplification",
            "amplification",
            "largest_amplification",
            "",
            NUMBER,
            "minimise",
            "largest velocity of the tool over the poses, for drive rates of size one",
        ),
        Quantity("reach", "", "", "", NUMBER, "maximise", "share of the poses that are reached"),
        *(
            Quantity(
                f"{REACH}_{d}",
                "",
                "",
                d,
                LENGTH if d in AXES else ANGLE,
                "maximise",
                f"range of {d} about home that is reached wherever else the poses are",
                "poses",
            )
            for d in DIRECTIONS
        ),
        Quantity("cost", "", "", "", NUMBER, "minimise", "cost"),
    ]
    means = [
        replace(
            q,
            name=f"{MEAN}_{q.name}",
            meaning=re.sub("^(worst|least|largest|lowest) ", "mean of the poses: ", q.meaning),
            reduction="mean",
        )
        for q in found
        if q.column in _OF_POSES
    ]
    return {q.name: q for q in [*found, *means]}


#: By name.
QUANTITIES: Mapping[str, Quantity] = _quantities()

#: Quantities of joints, before a colon and JOINT:DIRECTION, with what is better of each.
OF_JOINTS: Mapping[str, tuple[Goal, str]] = {
    "travel": ("minimise", "distance between the least and the greatest coordinate over the poses"),
    "least": ("maximise", "least coordinate over the poses"),
    "greatest": ("minimise", "greatest coordinate over the poses"),
}


def quantity_of(name: str, part: str) -> Quantity:
    """A quantity by its name.

    Parameters
    ----------
    name, part : str
        The part is named in an error.

    Raises
    ------
    ModelError
        There is none, or a joint is not named with its direction.
    """
    if name in QUANTITIES:
        return QUANTITIES[name]
    head, _, place = name.partition(":")
    if head in OF_JOINTS:
        joint, _, direction = place.rpartition(":")
        if not joint or not direction:
            raise ModelError(
                part,
                f'names "{name}", which is no direction of a joint.',
                f'Write "{head}:JOINT:z", with a direction x, y, z, rx, ry, rz or bend.',
            )
        goal, words = OF_JOINTS[head]
        kind = LENGTH if direction in AXES else ANGLE
        meaning = f"{words}, {direction} of {joint}"
        return Quantity(name, f"{TRAVEL}:{place}", COLUMN, place, kind, goal, meaning, head)
    known = [*QUANTITIES, *(f"{h}:{place or 'JOINT:z'}" for h in OF_JOINTS)]
    raise ModelError(part, f'names "{name}", which is unknown.', choices("Quantities", name, known))


def taken(quantity: Quantity, column: Column, labels: tuple[Any, ...], found: Array) -> Array:
    """A quantity of n machines from the array of its column, (n,), in its unit, any unit.

    Parameters
    ----------
    quantity : Quantity
    column : Column
    labels : tuple
        Along the column; empty where it has one number a machine.
    found : (n, ...)
        Reduced over the poses, in the unit of the column, any unit.
    """
    if not column.dims:
        return found
    if quantity.reduction in OF_JOINTS:
        # a star may name several joints
        at = [i for i, label in enumerate(labels) if matches(str(label), quantity.label)]
    elif isinstance(column.unit, LabelledUnits):
        # joint quantities of one unit
        at = [i for i, unit in enumerate(column.unit.units) if unit == quantity.label]
    else:
        at = [i for i, label in enumerate(labels) if quantity.label in ("", str(label))]
    if not at:
        return np.full(len(found), np.nan)
    worst = np.max if quantity.goal == "minimise" else np.min
    return np.asarray(worst(found[:, at], axis=1))


def reached_of(quantity: Quantity, found: Arrays, poses: PoseSet | None, model: Model) -> Array:
    """What each of n machines reaches, (n,): the share of the poses, or a range as `range_reached`.

    Parameters
    ----------
    quantity : Quantity
        "reach", or that of one direction.
    found : dict of str to (n, ...)
        From `strutwork.studies.variants.Variants.values`, any unit.
    poses : TaskGrid, TaskList, PoseList or None
        That are asked beside home; None: home alone.
    model : Model
        The machine as stated.
    """
    if quantity.label and isinstance(poses, TaskGrid):
        home = dict(zip(DIRECTIONS, model.motion.task_of(model.motion.home_pose), strict=True))
        return range_reached(found, poses, quantity.label, float(home[quantity.label]))
    if poses is None:
        return np.asarray(found["status"] == 0, dtype=float)
    return np.asarray(found["poses_kept"] / len(poses))


def range_reached(found: Arrays, poses: TaskGrid, direction: str, home: float) -> Array:
    """Range of one direction that each of n machines reaches with every value of the others, (n,).

    It is the distance of the ends of those neighbouring values about home at which all poses of the
    grid are reached, m or rad: where the range ends between two values, the last one counts. Zero
    where the values nearest to home are not all reached.

    Parameters
    ----------
    found : dict of str to (n, ...)
        From `strutwork.studies.variants.Variants.values` with the reduction "poses", any unit.
    poses : TaskGrid
    direction : str
    home : float
        Where the machine as stated is at home, m or rad.
    """
    axes = list(poses.axes)
    values = np.asarray(poses.axes[direction])
    order = np.argsort(values)
    shape = tuple(len(v) for v in poses.axes.values())
    good = (found["pose_status"] == PoseStatus.GOOD).reshape(-1, *shape)
    others = tuple(k + 1 for k, d in enumerate(axes) if d != direction)
    every = good.all(axis=others)[:, order]
    values = values[order]
    middle = int(np.argmin(np.abs(values - home)))
    up = np.cumprod(every[:, middle:], axis=1).sum(axis=1)
    down = np.cumprod(every[:, middle::-1], axis=1).sum(axis=1)
    ends = values[np.minimum(middle + up, len(values)) - 1], values[middle + 1 - down - (down == 0)]
    return np.asarray(np.where(up > 0, ends[0] - ends[1], 0.0))
