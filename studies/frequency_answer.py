"""The first natural frequency of a machine at home: one number a machine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.lowest import natural_frequencies
from strutwork.machines.model import Model
from strutwork.msa import PlacedStructure
from strutwork.outcome import Outcome
from strutwork.studies.answers import Column
from strutwork.studies.models_together import first_frequencies
from strutwork.studies.standing import Standing

Array = NDArray[Any]


@dataclass(frozen=True)
class HomeFrequency:
    """Lowest natural frequency at home, under the preload that the machine names.

    A rigid-body mode counts, at 0 Hz: with it the machine is not held.

    Parameters
    ----------
    model : Model
    columns : tuple of Column
    """

    model: Model = field(repr=False)
    columns: tuple[Column, ...] = (
        Column("first_frequency", "Hz", "lowest natural frequency at home", (), "least"),
    )

    @property
    def coordinates(self) -> Mapping[str, tuple[Any, ...]]:
        """None."""
        return {}

    def __call__(self, placed: PlacedStructure) -> tuple[dict[str, Array], Outcome]:
        """Of a flat batch: the same at each pose.

        Parameters
        ----------
        placed : PlacedStructure
            Counts its poses.

        Raises
        ------
        StrutworkError
            The machine has no mass, or does not stand under its preload.
        """
        frequencies, _ = natural_frequencies(self.model.vibrating, 1)
        value = float(frequencies.ravel()[0])
        if not np.isfinite(value):
            raise ModelError("structure", "has no mode.", "Give it mass and elastic parts.")
        poses = placed.batch
        return {"first_frequency": np.full(poses, value)}, Outcome.good(poses)

    @staticmethod
    def of_many(standing: Sequence[tuple[Model, Standing] | None]) -> Array:
        """As `strutwork.studies.models_together.first_frequencies`, (n,), Hz.

        Parameters
        ----------
        standing : sequence of n (Model, Standing) or None
        """
        return first_frequencies(standing)
