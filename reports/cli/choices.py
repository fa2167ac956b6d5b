"""Words that options take."""

from __future__ import annotations

from enum import StrEnum


class Objective(StrEnum):
    """What an allocation of tolerances aims at."""

    UNIFORM = "uniform"
    COST = "cost"


class Ranges(StrEnum):
    """Joints whose ranges a pose must keep."""

    ALL = "all"
    REVOLUTE = "revolute"
    NONE = "none"
