"""What a survey asks at every pose: one short class per answer."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.coupled import AnyDamping
from strutwork.fea.ports import tool_ports
from strutwork.fea.preload import preloaded
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.model import Model
from strutwork.msa import (
    LoadCase,
    PlacedStructure,
    axis_stiffness_blocked,
    axis_stiffness_free,
    compliance_and_outcome,
)
from strutwork.outcome import Outcome, solve_poses
from strutwork.overconstraint import (
    Quantity,
    Tolerance,
    joint_quantities,
    tolerance_responses,
    tool_quantities,
    worst_case,
)
from strutwork.studies.dataset_units import LabelledUnits
from strutwork.studies.least_over_poses import least_over_poses
from strutwork.studies.variables import AXES

Array = NDArray[Any]


@dataclass(frozen=True)
class Column:
    """One of an answer's arrays.

    Parameters
    ----------
    name : str
    unit : str or LabelledUnits
        Of all labels, or of each along the last of `dims`.
    meaning : str
    dims : tuple of str
        Beside the poses.
    worst : "least" or "largest" or ""
        Which value over poses is the worst; empty where none is worse than another.
    ends : bool
        Whether the least and the greatest value over the poses and their distance are what counts.
    """

    name: str
    unit: str | LabelledUnits
    meaning: str
    dims: tuple[str, ...] = ()
    worst: str = ""
    ends: bool = False


class Answer(Protocol):
    """A question to a machine that stands at a batch of poses."""

    @property
    def columns(self) -> tuple[Column, ...]:
        """What it answers with."""

    @property
    def coordinates(self) -> Mapping[str, tuple[Any, ...]]:
        """Labels along the dimensions of its arrays."""

    def __call__(self, placed: PlacedStructure) -> tuple[dict[str, Array], Outcome]:
        """Arrays (p, ...) by their names, missing (NaN) where a pose has no answer, and why."""


@dataclass(frozen=True)
class Stiffness:
    """Static stiffness at the tool, in both meanings.

    Parameters
    ----------
    columns : tuple of Column
        The free and the blocked stiffness.
    coordinates : mapping of dimension to labels
        The six directions.
    """

    columns: tuple[Column, ...] = (
        Column(
            "stiffness_free",
            "N/m for x y z; N m/rad for rx ry rz",
            "stiffness with the other directions free to follow, 1/C_ii",
            ("direction",),
            "least",
        ),
        Column(
            "stiffness_blocked",
            "N/m for x y z; N m/rad for rx ry rz",
            "stiffness with the other directions blocked, (C^-1)_ii",
            ("direction",),
            "least",
        ),
    )
    coordinates: Mapping[str, tuple[Any, ...]] = field(
        default_factory=lambda: {"direction": DIRECTIONS}
    )

    def __call__(self, placed: PlacedStructure) -> tuple[dict[str, Array], Outcome]:
        """Of a flat batch."""
        compliance, outcome = compliance_and_outcome(placed)
        good = outcome.solved
        found = {c.name: np.full((len(good), 6), np.nan) for c in self.columns}
        found["stiffness_free"][good] = axis_stiffness_free(compliance[good])
        found["stiffness_blocked"][good] = axis_stiffness_blocked(compliance[good])
        return found, outcome


@dataclass(frozen=True)
class Vibration:
    """Lowest frequencies, and the least dynamic stiffness at the tool in a band.

    Parameters
    ----------
    tool : str
        Node.
    damping : damping of any kind
        Dashpots of joints among it turn with their joints.
    band : (float, float)
        Hz.
    count : int
        Frequencies.
    preload : LoadCase, optional
        Under which it vibrates; its forces are those at each pose.
    """

    tool: str
    damping: AnyDamping
    band: tuple[float, float]
    count: int = 6
    preload: LoadCase | None = None

    @cached_property
    def columns(self) -> tuple[Column, ...]:
        """Frequencies, minima and where they are."""
        return (
            Column("natural_frequency", "Hz", "natural frequency", ("mode",), "least"),
            Column(
                "least_dynamic_stiffness",
                "N/m",
                "least driving-point dynamic stiffness 1/|H_ii| in the band",
                ("axis",),
                "least",
            ),
            Column("least_at", "Hz", "frequency of the least dynamic stiffness", ("axis",)),
        )

    @property
    def coordinates(self) -> Mapping[str, tuple[Any, ...]]:
        """Modes and axes."""
        return {"mode": tuple(range(1, self.count + 1)), "axis": AXES}

    def __call__(self, placed: PlacedStructure) -> tuple[dict[str, Array], Outcome]:
        """Of a flat batch."""
        ports = tool_ports(placed.structure.linkage, self.tool)

        def stack(part: PlacedStructure) -> dict[str, Array]:
            loaded = part if self.preload is None else preloaded(part, self.preload)
            found = least_over_poses(loaded, ports, self.damping, self.band, self.count)
            return dict(
                zip(
                    ("natural_frequency", "least_dynamic_stiffness", "least_at"), found, strict=True
                )
            )

        return _in_stacks(placed, stack, self.columns, self._widths, 16)

    @property
    def _widths(self) -> dict[str, int]:
        return {"mode": self.count, "axis": len(AXES)}


@dataclass(frozen=True)
class Assembly:
    """Worst case of the forces that tolerances lock in, and of the tool's deviation.

    Parameters
    ----------
    tolerances : tuple of Tolerance
    quantities : tuple of Quantity
    """

    tolerances: tuple[Tolerance, ...]
    quantities: tuple[Quantity, ...]

    @classmethod
    def of(cls, model: Model) -> Assembly:
        """What a model's joints carry, and its tool.

        Parameters
        ----------
        model : Model

        Raises
        ------
        ModelError
            The model has no tolerances.
        """
        if not model.tolerances:
            raise ModelError(
                "tolerances", "are none.", "Add [[tolerances]]; see docs/tolerances.md."
            )
        tool = tool_quantities() if model.tool is not None else ()
        return cls(model.tolerances, (*joint_quantities(model.structure.linkage), *tool))

    @property
    def columns(self) -> tuple[Column, ...]:
        """One number per quantity."""
        return (
            Column(
                "worst_case",
                LabelledUnits("N, N m, m or rad", tuple(q.unit for q in self.quantities)),
                "largest size that the tolerances allow",
                ("quantity",),
                "largest",
            ),
        )

    @property
    def coordinates(self) -> Mapping[str, tuple[Any, ...]]:
        """The quantities by their names."""
        return {"quantity": tuple(q.name for q in self.quantities)}

    def __call__(self, placed: PlacedStructure) -> tuple[dict[str, Array], Outcome]:
        """Of a flat batch."""

        def stack(part: PlacedStructure) -> dict[str, Array]:
            responses = tolerance_responses(part, self.tolerances, self.quantities)
            return {"worst_case": worst_case(responses).value}

        return _in_stacks(placed, stack, self.columns, {"quantity": len(self.quantities)}, 64)


def _in_stacks(
    placed: PlacedStructure,
    stack: Callable[[PlacedStructure], dict[str, Array]],
    columns: tuple[Column, ...],
    widths: Mapping[str, int],
    size: int,
) -> tuple[dict[str, Array], Outcome]:
    """Answers of stacks of some poses; one that fails does not take the others with it."""
    poses = placed.batch[0]
    found = {c.name: np.full((poses, *(widths[d] for d in c.dims)), np.nan) for c in columns}

    def some(index: NDArray[np.intp]) -> None:
        # a stack of matrices stays within the cache
        for part in np.array_split(index, max(1, -(-len(index) // size))):
            for name, values in stack(placed[part]).items():
                found[name][part] = values

    return found, solve_poses(some, poses)
