"""How much faster than its drives a machine moves its tool, pose by pose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.machines.model import Model
from strutwork.msa import PlacedStructure
from strutwork.outcome import Outcome
from strutwork.studies.answers import Column
from strutwork.studies.margin_bounds import AmplificationBound

Array = NDArray[Any]


@dataclass(frozen=True)
class Amplification:
    """Least and largest translation of the tool for drive rates whose squares add up to one.

    Parameters
    ----------
    bound : AmplificationBound
        Without bounds.
    columns : tuple of Column
    """

    bound: AmplificationBound
    columns: tuple[Column, ...] = (
        Column(
            "least_amplification",
            "1",
            "least velocity of the tool for drive rates of size one",
            worst="least",
        ),
        Column(
            "largest_amplification",
            "1",
            "largest velocity of the tool for drive rates of size one",
            worst="largest",
        ),
    )

    @classmethod
    def of(cls, model: Model) -> Amplification:
        """Of a machine with drives and a tool.

        Parameters
        ----------
        model : Model

        Raises
        ------
        ModelError
            No drive, or no tool that moves.
        """
        return cls(AmplificationBound(model, 0.0, np.inf))

    @property
    def coordinates(self) -> Mapping[str, tuple[Any, ...]]:
        """None."""
        return {}

    def __call__(self, placed: PlacedStructure) -> tuple[dict[str, Array], Outcome]:
        """Of a flat batch; the largest is infinite at singularities.

        Parameters
        ----------
        placed : PlacedStructure
        """
        found = self.bound.of(placed.placement)
        values = {c.name: found[:, i] for i, c in enumerate(self.columns)}
        return values, Outcome.good(placed.batch)
