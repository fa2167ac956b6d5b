"""Compliance budgets at the best, median and worst pose of a map."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import Poses, tangent_rotation
from strutwork.machines import Machine
from strutwork.msa import compliance_budget
from strutwork.studies.description import attributes
from strutwork.studies.filters import PoseStatus
from strutwork.studies.statistics import Meaning
from strutwork.studies.variables import AXES, named

Array = NDArray[Any]

RANKS = ("best", "median", "worst")


def budget_map(machine: Machine, dataset: xr.Dataset, meaning: Meaning = "blocked") -> xr.Dataset:
    """Share of every part in the tool's deflection under unit forces along x, y and z.

    Parameters
    ----------
    machine : Machine
        The one the map was made of.
    dataset : xarray.Dataset
        From `stiffness_map`.
    meaning : "blocked" or "free"
        Which stiffness ranks the poses. The budget itself is that of the deflection with
        the other directions free to follow: it says which part gives way under a force.

    Returns
    -------
    xarray.Dataset
        Dimensions force (x, y, z), rank (best, median, worst) and part; shares add to one over
        the parts. For each force the poses are ranked by the stiffness along it.

    Raises
    ------
    ModelError
        No point of the map counts, or the map is of another machine.
    """
    made_of = json.loads(dataset.attrs.get("parameters", "{}"))
    own = attributes("compliance budget", machine)
    if made_of != json.loads(own["parameters"]) or "roll" not in dataset:
        raise ModelError(
            "compliance budget",
            "the dataset is not a stiffness map of this machine.",
            "Give the machine the map was made of.",
        )
    kept = np.flatnonzero(dataset["status"].to_numpy() == PoseStatus.GOOD)
    if not kept.size:
        raise ModelError("compliance budget", "no point of the map is valid.", "Widen the filters.")
    stiffness = dataset[f"stiffness_{meaning}"].to_numpy()[kept, :3]
    order = np.argsort(-stiffness, axis=0, kind="stable")
    # the median pose is one of the poses: of an even number the stiffer of the middle two
    rows = [0, (len(kept) - 1) // 2, len(kept) - 1]
    index = kept[order[rows]].T
    rotation = tangent_rotation(
        dataset["normal"].to_numpy()[index], dataset["roll"].to_numpy()[index]
    )
    position = dataset["position"].to_numpy()[index]
    placed = machine.structure.at(machine.place(Poses(position, rotation)))
    found = [compliance_budget(placed[k], np.eye(6)[k]) for k in range(3)]
    share = np.stack([budget.shares for budget in found])
    return xr.Dataset(
        {
            "share": named(
                ("force", "rank", "part"), share, "1", "share in the deflection of the tool"
            ),
            "deflection": named(
                ("force", "rank"),
                np.stack([budget.deflection for budget in found]),
                "m/N",
                "deflection along the force per unit of it, other directions free to follow",
            ),
            "stiffness": named(
                ("force", "rank"),
                dataset[f"stiffness_{meaning}"].to_numpy()[index, np.arange(3)[:, None]],
                "N/m",
                f"stiffness that ranks the poses ({meaning})",
            ),
            "point": named(("force", "rank"), index, "1", "index of the point in the map"),
            "position": named(("force", "rank", "axis"), position, "m", "tool position"),
            "roll": named(
                ("force", "rank"), dataset["roll"].to_numpy()[index], "rad", "roll about the normal"
            ),
        },
        coords={
            "force": list(AXES),
            "rank": list(RANKS),
            "part": list(found[0].parts),
            "axis": list(AXES),
        },
        attrs=own,
    )
