"""Where the nodes and joints of a model file stand, as the file states them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from strutwork.kinematics import Placement, axes_frame
from strutwork.machines.model_motion_tables import Coordinate
from strutwork.machines.model_schema import ModelTable


def home_placement(
    tables: ModelTable,
    supports: Sequence[str],
    home: Mapping[Coordinate, float],
    monitors: Sequence[ArrayLike] = (),
) -> Placement:
    """The placement of a model's linkage in the configuration of its file.

    Parameters
    ----------
    tables : ModelTable
    supports : sequence of str
        Supported nodes, in the order of their joints; each ground node stands where its node does.
    home : mapping of (joint, direction) to float
        Joint coordinates, m and rad.
    monitors : sequence of (3,)
        Places of nodes inside solids, m.

    Raises
    ------
    ModelError
        Axes of a joint that give no frame.
    """
    positions = [*tables.nodes.values(), *monitors, *(tables.nodes[n] for n in supports)]
    frames = [
        *(axes_frame(t.axis, t.second_axis, f"joint {t.name}") for t in tables.joints),
        *(np.eye(3) for _ in supports),
    ]
    return Placement(
        np.array(positions, dtype=float).reshape(-1, 3),
        np.array(frames, dtype=float).reshape(-1, 3, 3),
        np.array(list(home.values()), dtype=float),
        tuple(home),
    )
