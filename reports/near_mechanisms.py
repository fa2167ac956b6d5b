"""Motions that only the last digits of a model's coordinates hold, in words and numbers."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

from strutwork.kinematics import NearMechanism
from strutwork.machines.model import Model, ModelWarning


def near_mechanisms(model: Model, found: Sequence[NearMechanism]) -> list[dict[str, Any]]:
    """As plain numbers: how little holds each motion, and the motion of every node."""
    index = model.structure.linkage.node_index
    return [
        {
            "description": near.description,
            "share": near.share,
            "motion": {n: near.motion.nodes[index[n]].tolist() for n in model.nodes},
        }
        for near in found
    ]


def warn_of_near(found: Sequence[NearMechanism]) -> None:
    """Name every motion in a warning of its own."""
    for near in found:
        warnings.warn(
            f"joints: {near.description} Give the coordinates and axes with all their digits, or "
            "free one of the joint directions that close the loop.",
            ModelWarning,
            stacklevel=3,
        )
