"""How parameters change the wrenches of the tool and the workpiece on the unknowns."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.msa.assembly import System
from strutwork.msa.changes import PlacedChange

Array = NDArray[Any]


def tool_load_rates(system: System, changes: Sequence[PlacedChange]) -> Array | None:
    """How parameters change the wrenches at the tool on the unknowns, (g, p, n, 6).

    They act on a workpiece about a point that stands elsewhere when parts move; None where no
    workpiece moves, for then nothing changes.

    Parameters
    ----------
    system : System
        At p poses.
    changes : sequence of g PlacedChange
        At the same poses.
    """
    if system.placed.structure.workpiece_vertex < 0:
        return None
    result = np.zeros((len(changes), system.poses, system.topology.size, 6))
    for i, change in enumerate(changes):
        if change.systems is not None:
            above, below = change.systems
            result[i] = (above.tool_load() - below.tool_load()) / change.change.width
    return result
