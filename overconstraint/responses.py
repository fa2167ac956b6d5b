"""What a designer asks about an assembly: forces of joints and places of the tool, linear in z."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Linkage, State
from strutwork.msa.structure import PlacedStructure
from strutwork.overconstraint.influence import Influence, influence
from strutwork.overconstraint.joint_forces import JOINT_FORCES
from strutwork.overconstraint.rounding import product_without_rounding, row_scale
from strutwork.overconstraint.sources import MisfitSources, misfit_sources
from strutwork.overconstraint.tolerance import Tolerance

Array = NDArray[Any]


@dataclass(frozen=True)
class Quantity:
    """Magnitude of one or two components of a joint force or of the tool displacement.

    Parameters
    ----------
    joint : str or None
        None for the tool.
    kind : str
        "radial force" (across the joint's z axis), "axial force", "bending moment", "torque";
        "displacement" or "rotation" for the tool.
    directions : tuple of directions
        One or two: joint axes for a joint, global axes for the tool.
    unit : str
        N, N*m, m or rad.
    """

    joint: str | None
    kind: str
    directions: tuple[str, ...]
    unit: str

    @property
    def name(self) -> str:
        """Joint and kind in words."""
        where = " and ".join(self.directions)
        return f"tool {self.kind} in {where}" if self.joint is None else f"{self.joint} {self.kind}"


@dataclass(frozen=True)
class Responses:
    """Quantities as linear functions of the zones' parameters: |mean + gain z|.

    Parameters
    ----------
    quantities : tuple of Quantity
    gain : (..., q, 2, k)
        In the quantity's unit, N, N·m, m or rad; the second row is zero for a quantity of one
        component.
    mean : (..., q, 2)
        In the middle of all zones, in the same unit.
    sources : MisfitSources
    influence : Influence
    """

    quantities: tuple[Quantity, ...]
    gain: Array
    mean: Array
    sources: MisfitSources
    influence: Influence

    def __repr__(self) -> str:
        return (
            f"<Responses: {len(self.quantities)} quantities, {self.gain.shape[-1]} parameters, "
            f"batch {self.gain.shape[:-3]}>"
        )

    def index(self, joint: str | None, kind: str) -> int:
        """Index of the first quantity of a joint (None: the tool) and kind.

        Parameters
        ----------
        joint : str or None
            None for the tool.
        kind : str
            As `Quantity.kind`.

        Raises
        ------
        ModelError
            There is none.
        """
        for i, quantity in enumerate(self.quantities):
            if (quantity.joint, quantity.kind) == (joint, kind):
                return i
        raise ModelError(
            f"joint {joint}" if joint else "tool",
            f'has no "{kind}".',
            "Quantities: " + ", ".join(q.name for q in self.quantities[:12]) + ".",
        )


def joint_quantities(linkage: Linkage) -> tuple[Quantity, ...]:
    """Forces and moments that the joints can carry, supports excepted.

    Parameters
    ----------
    linkage : Linkage
    """
    found = []
    for joint, states in zip(linkage.joints, linkage.states(), strict=True):
        if joint.type == "support":
            continue
        carried = {d for d, s in zip(DIRECTIONS, states, strict=True) if s != State.FREE}
        for kind, directions, unit in JOINT_FORCES:
            here = tuple(d for d in directions if d in carried)
            if here:
                found.append(Quantity(joint.name, kind, here, unit))
    return tuple(found)


def tool_quantities() -> tuple[Quantity, ...]:
    """The tool's displacements and rotations, one by one, in global axes."""
    return tuple(
        Quantity(None, "rotation" if d.startswith("r") else "displacement", (d,), unit)
        for d, unit in zip(DIRECTIONS, ("m",) * 3 + ("rad",) * 3, strict=True)
    )


def responses(
    found: Influence, sources: MisfitSources, quantities: Sequence[Quantity] | None = None
) -> Responses:
    """Quantities as functions of the zones' parameters.

    Parameters
    ----------
    found : Influence
        With a column for every misfit of the sources.
    sources : MisfitSources
    quantities : sequence of Quantity, optional
        Default: everything the joints carry, then the tool's displacements where there is one.

    Raises
    ------
    ModelError
        A misfit without a column, or a quantity of an unknown joint.
    """
    missing = [c for c in sources.columns if c not in found.columns]
    if missing:
        raise ModelError(
            f"joint {missing[0][0]}",
            f"its misfit in {missing[0][1]} has no column in the influence.",
            "Compute the influence with columns=sources.columns.",
        )
    linkage = found.linkage
    if quantities is None:
        quantities = joint_quantities(linkage)
        if linkage.tool is not None:
            quantities += tool_quantities()
    pick = [found.columns.index(c) for c in sources.columns]
    forces, tool = found.forces[..., pick], found.tool[..., pick]
    batch = tool.shape[:-2]
    rows = np.zeros((*batch, len(quantities), 2, len(pick)))
    scale = np.zeros_like(rows)
    # a joint's force is made from what its misfits do to all joints
    every = np.abs(forces).max(axis=-3, initial=0.0)
    for q, quantity in enumerate(quantities):
        if quantity.joint is None:
            table, made_from = tool, row_scale(tool)
        elif quantity.joint in linkage.joint_index:
            table = forces[..., linkage.joint_index[quantity.joint], :, :]
            made_from = row_scale(every)
        else:
            raise ModelError(f"joint {quantity.joint}", "is not in the linkage.", "Name a joint.")
        for i, direction in enumerate(quantity.directions):
            rows[..., q, i, :] = table[..., DIRECTIONS.index(direction), :]
            scale[..., q, i, :] = made_from[..., DIRECTIONS.index(direction), :]
    gain = product_without_rounding(rows, sources.map[..., None, :, :], scale)
    mean = product_without_rounding(rows, sources.mean[..., None, :, None], scale)[..., 0]
    return Responses(tuple(quantities), gain, mean, sources, found)


def tolerance_responses(
    placed: PlacedStructure,
    tolerances: Sequence[Tolerance],
    quantities: Sequence[Quantity] | None = None,
) -> Responses:
    """Responses of a structure to its tolerances.

    Parameters
    ----------
    placed : PlacedStructure
    tolerances : sequence of Tolerance
    quantities : sequence of Quantity, optional

    Returns
    -------
    Responses

    Raises
    ------
    StrutworkError
        As `misfit_sources` and `influence`.

    Warns
    -----
    PoseWarning
        Some poses of the batch have no answer and are NaN: how many, and why.
    """
    sources = misfit_sources(placed, tolerances)
    found = influence(placed, sources.columns)
    found.outcome.warn("tolerance responses")
    return responses(found, sources, quantities)
