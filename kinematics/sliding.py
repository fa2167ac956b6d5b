"""Joints that slide, and the nodes that slide with them along the bodies they belong to."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.linkage import Linkage


def sliding_joints(linkage: Linkage) -> NDArray[np.bool_]:
    """Joints with a free translation: their first node follows the second, (j,).

    Parameters
    ----------
    linkage : Linkage
        With j joints.
    """
    return np.asarray(~linkage.still_mask()[:, :3].all(axis=1))


def fixed_nodes(linkage: Linkage) -> NDArray[np.bool_]:
    """Nodes that stay where they are on their bodies, (n,).

    Parameters
    ----------
    linkage : Linkage
        With n nodes.
    """
    fixed = np.ones(len(linkage.nodes), dtype=bool)
    for j in np.flatnonzero(sliding_joints(linkage)):
        fixed[linkage.node_index[linkage.joints[j].between[0]]] = False
    return fixed
