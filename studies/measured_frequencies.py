"""Measured natural frequencies: paired with the modes by their shapes, or by order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea import modes
from strutwork.fea.modes import Modes
from strutwork.fea.pairing import ModeSet, pair_modes
from strutwork.fea.sensitivity import frequency_sensitivity
from strutwork.studies.measurement import Standing, at_words

Array = NDArray[Any]

#: Modes beside the measured ones among which a shape is looked for.
MORE = 6

#: A pair whose shapes are less alike is named.
ALIKE = 0.5


@dataclass(frozen=True)
class MeasuredShapes:
    """Shapes by which measured frequencies find their modes.

    Parameters
    ----------
    nodes : tuple of n str
        Of the model.
    shapes : (t, n, 3)
        Translations, any unit; zero in directions that nobody measured.
    """

    nodes: tuple[str, ...]
    shapes: Array


@dataclass(frozen=True)
class MeasuredFrequencies:
    """Natural frequencies at a pose.

    Parameters
    ----------
    name : str
    task : mapping of direction to float
        Pose of the tool, m and rad; empty: home.
    values : (t,)
        Hz, ascending.
    scatter : (t,)
        Standard deviations, Hz.
    numbers : tuple of int
        Which elastic modes they are, from 1; empty where shapes say it.
    shapes : MeasuredShapes or None
    """

    name: str
    task: Mapping[str, float]
    values: Array
    scatter: Array
    numbers: tuple[int, ...] = ()
    shapes: MeasuredShapes | None = None
    kind: str = field(default="frequencies", init=False)
    unit: str = field(default="Hz", init=False)

    @property
    def labels(self) -> tuple[str, ...]:
        """What each value is."""
        if self.shapes is None:
            return tuple(f"mode {n}" for n in self.numbers)
        return tuple(f"measured mode {i + 1}" for i in range(len(self.values)))

    def _modes(self, at: Standing, rigid: int = 6) -> Modes:
        highest = len(self.values) + MORE if self.shapes else max(self.numbers)
        found = modes(at.vibrating, highest + rigid)
        have = int(found.rigid_body_modes.ravel()[0])
        if have > rigid:
            return self._modes(at, have)
        return found

    def _paired(self, found: Modes) -> tuple[NDArray[np.intp], Array]:
        """Index of each value among the computed modes, (t,), and how alike the shapes are."""
        frequencies = found.frequencies[0]
        elastic = np.flatnonzero(np.isfinite(frequencies) & (frequencies > 0))
        need = len(self.values) if self.shapes else max(self.numbers)
        if len(elastic) < need:
            raise ModelError(
                self.name,
                f"asks for {need} elastic modes, but the machine has {len(elastic)} at "
                f"{at_words(self.task)}.",
                "Give fewer frequencies, or divide its beams into more elements.",
            )
        if self.shapes is None:
            return elastic[np.array(self.numbers) - 1], np.ones(need)
        index = found.placed.structure.mesh_index
        at = [index[n] for n in self.shapes.nodes]
        theirs = self.shapes.shapes.reshape(need, -1)
        present = np.any(theirs != 0, axis=0)
        own = found.shapes[0][np.ix_(elastic, np.array(at))][..., :3].reshape(len(elastic), -1)[
            :, present
        ]
        moves = np.linalg.norm(own, axis=1) > 1e-9 * np.abs(own).max(initial=1e-300)
        elastic, own = elastic[moves], own[moves]
        pairs = pair_modes(
            ModeSet(frequencies[elastic], own),
            ModeSet(self.values, theirs[:, present]),
            window=1e6,
            least=0.0,
        ).modes
        if len(pairs) < need:
            raise ModelError(
                self.name,
                f"has {need} shapes, of which {len(pairs)} find a mode of the machine.",
                "Measure other directions, or fewer modes.",
            )
        return elastic[[p.computed for p in pairs]], np.array([p.mac for p in pairs])

    def computed(self, at: Standing) -> Array:
        """Frequencies of the modes that were measured, (t,), Hz.

        Parameters
        ----------
        at : Standing

        Raises
        ------
        ModelError
            Fewer modes than measured ones.
        """
        found = self._modes(at)
        return np.asarray(found.frequencies[0][self._paired(found)[0]])

    def rates(self, at: Standing) -> Array | None:
        """Derivatives, (g, t), Hz per unit of each parameter; None under a preload.

        Parameters
        ----------
        at : Standing
        """
        if at.model.preload is not None:
            return None
        which = self._paired(self._modes(at))[0]
        found = frequency_sensitivity(at.placed, at.changes, int(which.max()) + 1)
        return np.asarray(found.rates[:, 0, which])

    def blind(self, path: str) -> bool:  # noqa: ARG002 - as others take it
        """Whether a number of this path needs differences: none does.

        Parameters
        ----------
        path : str
        """
        return False

    def check(self, at: Standing) -> tuple[str, ...]:
        """How frequencies find their modes.

        Parameters
        ----------
        at : Standing

        Raises
        ------
        ModelError
            Fewer modes than measured ones.
        """
        self.computed(at)
        if self.shapes is None:
            return (f"{self.name}: frequencies are paired with the modes by their order",)
        return (f"{self.name}: frequencies are paired with the modes by their shapes (MAC)",)

    def notes(self, at: Standing) -> tuple[str, ...]:
        """Pairs whose shapes differ.

        Parameters
        ----------
        at : Standing
        """
        mac = self._paired(self._modes(at))[1]
        poor = [i for i, m in enumerate(mac) if m < ALIKE]
        return tuple(
            f"{self.name}: the shape of measured mode {i + 1} ({self.values[i]:.4g} Hz) agrees "
            f"with its computed one by a MAC of {mac[i]:.2f} only"
            for i in poor
        )
