"""Bounds that a pose must keep beside reach: on velocity amplification and on stiffness."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import Placement
from strutwork.kinematics.seen_motions import SeenMotions
from strutwork.kinematics.tool_drive_space import tool_drive_space
from strutwork.kinematics.transmission import amplifications, velocity_ellipsoids
from strutwork.machines.model import Model
from strutwork.msa import compliance_and_outcome

Array = NDArray[Any]

#: What ends a workspace by a bound, in words.
FASTEST, SLOWEST = "largest velocity amplification", "least velocity amplification"
SOFTEST = "stiffness in the softest direction"


class Bound(Protocol):
    """What else makes a pose good."""

    def __call__(self, placement: Placement) -> Mapping[str, Array]:
        """Slacks of poses that are all reached, (p,), by their names; zero at the bound."""


@dataclass(frozen=True)
class AmplificationBound:
    """Translation of the tool for drive rates whose squares sum up to one, between two bounds.

    Drives that turn count by the characteristic length L of home: 1/L rad/s is one.

    Parameters
    ----------
    model : Model
    low, high : float
        Least and largest semi-axis of the ellipsoid of velocities, m/s for 1 m/s; 0 and infinity
        ask nothing.

    Raises
    ------
    ModelError
        Bounds that are none, a machine without tool or drives, or a home that exceeds them.
    """

    model: Model
    low: float
    high: float

    def __post_init__(self) -> None:
        if not 0.0 <= self.low < self.high:
            raise ModelError(
                "velocity amplification",
                f"is bounded by {self.low:g} and {self.high:g}.",
                "Give the lower bound first, not negative.",
            )
        _check_home(self, self.model)

    @cached_property
    def _motions(self) -> SeenMotions:
        return SeenMotions.at(self.model.structure.linkage, self.model.placement)

    @cached_property
    def _used(self) -> int:
        home = tool_drive_space(self.model.structure.linkage, self.model.placement)
        return velocity_ellipsoids(home).used

    @property
    def length(self) -> float:
        """L, m."""
        return self._motions.length

    def of(self, placement: Placement) -> Array:
        """Least and largest amplification of poses, (p, 2), m/s for 1 m/s.

        Parameters
        ----------
        placement : Placement
            At p poses that are all reached.
        """
        return amplifications(*self._motions.of(placement), self._used)

    def __call__(self, placement: Placement) -> dict[str, Array]:
        """Slacks as shares of the bounds."""
        least, largest = self.of(placement).T
        slacks = {}
        if np.isfinite(self.high):
            # of a singular pose, where it has no end, -1
            slacks[f"{FASTEST}, {self.high:.4g}"] = self.high / largest - 1.0
        if self.low > 0.0:
            slacks[f"{SLOWEST}, {self.low:.4g}"] = least / self.low - 1.0
        return slacks


@dataclass(frozen=True)
class StiffnessBound:
    """Least static stiffness against forces at the tool, in whichever direction it is softest.

    Parameters
    ----------
    model : Model
    least : float
        N/m; the other directions of the tool are free to follow.

    Raises
    ------
    ModelError
        A bound that is not positive, a structure that carries no load, or a home that is softer.
    """

    model: Model
    least: float

    def __post_init__(self) -> None:
        if not 0.0 < self.least < np.inf:
            raise ModelError(
                "stiffness", f"is bounded by {self.least:g} N/m.", "Give a positive number."
            )
        _check_home(self, self.model)

    def of(self, placement: Placement) -> Array:
        """Stiffness in the softest direction, (p,), N/m; 0 where the pose is a mechanism.

        Parameters
        ----------
        placement : Placement
            At p poses that are all reached.
        """
        compliance, outcome = compliance_and_outcome(self.model.structure.at(placement))
        found = np.zeros(len(compliance))
        good = outcome.solved
        found[good] = 1.0 / np.linalg.eigvalsh(compliance[good, :3, :3])[:, -1]
        return found

    def __call__(self, placement: Placement) -> dict[str, Array]:
        """Slack as a share of the bound."""
        words = f"{SOFTEST}, {1e-6 * self.least:.4g} N/um"
        return {words: self.of(placement) / self.least - 1.0}


def _check_home(bound: Bound, model: Model) -> None:
    model.require_tool()
    for words, slack in bound(model.placement[None]).items():
        if slack[0] < 0.0:
            raise ModelError(
                "workspace",
                f"has the bound {words}, which home does not meet.",
                "Require less, or choose another home.",
            )
