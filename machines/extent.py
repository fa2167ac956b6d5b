"""How large a machine is: the length with which turns are compared with displacements."""

from __future__ import annotations

import numpy as np

from strutwork.machines.model import Model


def model_size(model: Model) -> float:
    """Diagonal of the box about all nodes, m; one for a single point.

    Parameters
    ----------
    model : Model
    """
    at = model.placement.positions
    return float(np.linalg.norm(at.max(axis=0) - at.min(axis=0))) or 1.0
