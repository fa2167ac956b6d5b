"""Measured displacements of nodes under a static load."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.msa import LoadCase
from strutwork.msa.sensitivity import StaticQuantity, static_sensitivity
from strutwork.studies.measurement import Standing, require_node

Array = NDArray[Any]


@dataclass(frozen=True)
class MeasuredDeflections:
    """Displacements at a pose, from before to after a load is put on.

    Parameters
    ----------
    name : str
    task : mapping of direction to float
        Pose of the tool, m and rad; empty: home.
    node : str
        Where the load acts.
    load : (6,)
        Force and moment, global axes, N and N·m.
    at : tuple of t (node, direction)
    values : (t,)
        m and rad.
    scatter : (t,)
        Standard deviations, m and rad.
    """

    name: str
    task: Mapping[str, float]
    node: str
    load: tuple[float, ...]
    at: tuple[tuple[str, str], ...]
    values: Array
    scatter: Array
    kind: str = field(default="deflections", init=False)
    unit: str = field(default="m or rad", init=False)

    @property
    def labels(self) -> tuple[str, ...]:
        """What each value is."""
        return tuple(f"{node}:{direction}" for node, direction in self.at)

    def _quantities(self) -> list[StaticQuantity]:
        wrench: Any = tuple(self.load)
        case = LoadCase(self.name, ((self.node, wrench),))
        return [StaticQuantity("displacement", node, d, case) for node, d in self.at]

    def computed(self, at: Standing) -> Array:
        """Displacements, (t,), m and rad.

        Parameters
        ----------
        at : Standing
        """
        return np.asarray(static_sensitivity(at.placed, (), self._quantities()).values[0])

    def rates(self, at: Standing) -> Array | None:
        """Derivatives, (g, t), m and rad per unit of each parameter.

        Parameters
        ----------
        at : Standing
        """
        return np.asarray(static_sensitivity(at.placed, at.changes, self._quantities()).rates[:, 0])

    def blind(self, path: str) -> bool:  # noqa: ARG002 - as others take it
        """Whether a number of this path needs differences: none does.

        Parameters
        ----------
        path : str
        """
        return False

    def check(self, at: Standing) -> tuple[str, ...]:
        """Refuse unknown nodes and no load.

        Parameters
        ----------
        at : Standing

        Raises
        ------
        ModelError
            A node that the machine does not have, no load, no displacement.
        """
        for node in (self.node, *(node for node, _ in self.at)):
            require_node(self.name, at.model, node)
        if not any(self.load):
            raise ModelError(
                self.name, "has no load.", 'Give load = { node = "TCP", z = "500 N" }.'
            )
        if not self.at:
            raise ModelError(
                self.name, "names no displacement.", 'Give displacements.TCP.z = "12 um".'
            )
        return ()

    def notes(self, at: Standing) -> tuple[str, ...]:  # noqa: ARG002 - as others take it
        """Nothing.

        Parameters
        ----------
        at : Standing
        """
        return ()
