"""What was measured of a machine at a pose, and what the model gives for it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.model import Model
from strutwork.msa import PlacedStructure
from strutwork.msa.changes import PlacedChange
from strutwork.names import choices, visible

Array = NDArray[Any]


@dataclass(frozen=True)
class Standing:
    """A machine at one pose, and what the unknowns change there.

    Parameters
    ----------
    model : Model
        At home.
    placed : PlacedStructure
        At the pose, one batch axis of one.
    changes : tuple of g PlacedChange
        Empty where no derivative is wanted.
    """

    model: Model
    placed: PlacedStructure
    changes: tuple[PlacedChange, ...] = ()

    @cached_property
    def vibrating(self) -> PlacedStructure:
        """The structure under its preload, where it names one.

        Raises
        ------
        StrutworkError
            The preload cannot be solved.
        """
        if self.model.preload is None:
            return self.placed
        from strutwork.fea.preload import preloaded  # noqa: PLC0415 - few machines have one

        return preloaded(self.placed, self.model.case(self.model.preload))


class Measurement(Protocol):
    """Measured numbers of one kind at one pose."""

    @property
    def name(self) -> str:
        """In the result."""

    @property
    def kind(self) -> str:
        """The table of the file that states it."""

    @property
    def task(self) -> Mapping[str, float]:
        """Pose of the tool, m and rad; empty: home."""

    @property
    def labels(self) -> tuple[str, ...]:
        """What each value is."""

    @property
    def unit(self) -> str:
        """Of the values."""

    @property
    def values(self) -> Array:
        """Measured values, (t,), in `unit`."""

    @property
    def scatter(self) -> Array:
        """Standard deviations of the values, (t,), in `unit`."""

    def computed(self, at: Standing) -> Array:
        """What the model gives, (t,), in the unit of the values.

        Parameters
        ----------
        at : Standing
        """

    def rates(self, at: Standing) -> Array | None:
        """Derivatives for the changes, (g, t), per unit of each parameter; None: none exist.

        Parameters
        ----------
        at : Standing
        """

    def blind(self, path: str) -> bool:
        """Whether the derivatives leave out what a number of this path does.

        Parameters
        ----------
        path : str
        """

    def check(self, at: Standing) -> tuple[str, ...]:
        """Refuse what cannot be computed, and say what is to be known.

        Parameters
        ----------
        at : Standing
        """

    def notes(self, at: Standing) -> tuple[str, ...]:
        """What is to be known of the agreement.

        Parameters
        ----------
        at : Standing
        """


def require_node(part: str, model: Model, node: str) -> str:
    """A node of the machine.

    Parameters
    ----------
    part : str
        For the message.
    model : Model
    node : str

    Raises
    ------
    ModelError
        There is none; the message offers the nearest.
    """
    known = model.structure.mesh_index
    if node not in known:
        raise ModelError(
            part, f'names the unknown node "{visible(node)}".', choices("Nodes", node, model.nodes)
        )
    return node


def at_words(task: Mapping[str, float]) -> str:
    """A pose in words.

    Parameters
    ----------
    task : mapping of direction to float
        m and rad.
    """
    if not task:
        return "home"
    words = [
        f"{d} = {np.degrees(v):.4g}°" if d.startswith("r") else f"{d} = {1e3 * v:.4g} mm"
        for d, v in task.items()
    ]
    return ", ".join(words)


def residuals(measurement: Measurement, computed: Array) -> Array:
    """(computed − measured) / scatter, (t,), no unit.

    Parameters
    ----------
    measurement : Measurement
    computed : (t,)
        In the unit of the measured values.
    """
    return np.asarray((computed - measurement.values) / measurement.scatter)


def checked_scatter(part: str, scatter: Sequence[float], count: int) -> Array:
    """One scatter for each value, (t,), in the unit of the values.

    Parameters
    ----------
    part : str
        For the message.
    scatter : sequence of float
        One for all, or one for each, any unit.
    count : int

    Raises
    ------
    ModelError
        Another number of them.
    """
    if len(scatter) not in (1, count):
        raise ModelError(
            part,
            f"has {count} values and {len(scatter)} scatters.",
            "Give one scatter for all, or one for each value.",
        )
    return np.broadcast_to(np.asarray(scatter, dtype=float), (count,)).copy()
