"""How far tolerances, play and drive errors may carry the tool: at worst and in spread.

Where the joints' rows are independent the linkage follows its errors without force, and the rows
alone say how the tool moves; where they are redundant errors are locked in, and the stiffness of
what gives way decides.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import MechanismError, ModelError
from strutwork.kinematics.error_transmission import error_transmission
from strutwork.msa.structure import PlacedStructure
from strutwork.overconstraint.influence import influence
from strutwork.overconstraint.joint_errors import JointError, error_sources
from strutwork.overconstraint.sampling import variances
from strutwork.overconstraint.sources import MisfitSources
from strutwork.overconstraint.tolerance import Tolerance
from strutwork.overconstraint.tool_deviation import farthest

Array = NDArray[Any]


@dataclass(frozen=True)
class Accuracy:
    """Displacement of the tool by errors: mean + gain z, z in the sources' zones.

    Parameters
    ----------
    sources : MisfitSources
        Its `tolerances` are the sources, named.
    transmission : (..., 6, g)
        Displacement and rotation of the tool, global axes, per unit misfit of the sources'
        columns, m and rad.
    gain : (..., 6, k)
        The same per unit parameter of the sources, m and rad.
    mean : (..., 6)
        In the middle of all zones, m and rad.
    elastic : (...) of bool
        The stiffness decides; else the rows alone.
    """

    sources: MisfitSources
    transmission: Array
    gain: Array
    mean: Array
    elastic: NDArray[np.bool_]

    def __repr__(self) -> str:
        return f"<Accuracy: {len(self.names)} sources, batch {self.elastic.shape}, m and rad>"

    @property
    def names(self) -> tuple[str, ...]:
        """Of the sources, (s,)."""
        return tuple(t.name for t in self.sources.tolerances)

    @cached_property
    def contributions(self) -> Array:
        """What each source does at worst in each direction of the tool, (..., 6, s), m and rad."""
        supports = self.sources.supports(self.gain)
        found = np.zeros((*supports.shape[:-1], len(self.names)))
        for block, owner in enumerate(self.sources.owner):
            found[..., owner] += supports[..., block]
        return found

    @property
    def worst(self) -> Array:
        """Largest displacement in each direction, to either side, (..., 6), m and rad: exact."""
        return np.asarray(np.abs(self.mean) + self.contributions.sum(axis=-1))

    @property
    def root_sum_square(self) -> Array:
        """|mean| and the root of the sum of squared contributions, (..., 6), m and rad."""
        return np.asarray(np.abs(self.mean) + np.linalg.norm(self.contributions, axis=-1))

    @cached_property
    def deviation(self) -> Array:
        """Standard deviation in each direction, (..., 6), m and rad.

        By the sources' distributions, none of which is correlated with another.
        """
        return np.asarray(np.sqrt((self.gain**2 @ variances(self.sources)[:, None])[..., 0]))

    def largest(self, tolerance: float = 1e-4) -> tuple[Array, Array]:
        """Worst displacement in any direction of space.

        Parameters
        ----------
        tolerance : float
            Between what is reached and the bound that proves it, as a share of it.

        Returns
        -------
        displacement : (..., 3)
            m; no combination displaces the tool centre point farther, but for the tolerance.
        contributions : (..., s)
            Of each source along it, m.

        Raises
        ------
        NumericalError
            The bound did not come down to the value.
        """
        batch = self.mean.shape[:-1]
        count = int(np.prod(batch, dtype=int))
        gain = self.gain[..., :3, :].reshape(count, 3, self.sources.parameters)
        mean = self.mean[..., :3].reshape(count, 3)
        z, place, _ = farthest(self.sources, gain, mean, tolerance)
        size = np.linalg.norm(place, axis=-1, keepdims=True)
        direction = place / np.where(size > 0, size, 1.0)
        along = np.einsum("pi,pik,pk->pk", direction, gain, z)
        found = np.zeros((count, len(self.names)))
        for block, owner in zip(self.sources.blocks, self.sources.owner, strict=True):
            part = along[:, block.start : block.start + block.shape.dimension]
            found[:, owner] += part.sum(axis=-1)
        return place.reshape(*batch, 3), found.reshape(*batch, len(self.names))


def accuracy(
    placed: PlacedStructure,
    tolerances: Sequence[Tolerance] = (),
    errors: Sequence[JointError] = (),
    method: Literal["rows", "stiffness"] | None = None,
) -> Accuracy:
    """Displacement of the tool by tolerances, drive errors and play.

    Parameters
    ----------
    placed : PlacedStructure
        With a tool; a batch of poses or one.
    tolerances : sequence of Tolerance
    errors : sequence of JointError
    method : "rows" or "stiffness", optional
        Default: by the rows where they are independent, else by the stiffness.

    Returns
    -------
    Accuracy

    Raises
    ------
    ModelError
        No source, no tool, or redundant rows where the rows alone are asked for.
    MechanismError
        The tool can move although the drives are held.
    StrutworkError
        As `influence`: rigid loops that no elastic part closes.
    """
    if placed.structure.linkage.tool is None:
        raise ModelError("tool", "the linkage has none.", "Name a node as the tool.")
    if not tolerances and not errors:
        raise ModelError(
            "accuracy",
            "has no source of error.",
            "Give tolerances, drives with a resolution, a drive error or a play.",
        )
    sources = error_sources(placed, tolerances, errors)
    matrix, elastic = _transmission(placed, sources.columns, method)
    gain = matrix @ sources.map
    mean = (matrix @ sources.mean[..., None])[..., 0]
    return Accuracy(sources, matrix, gain, mean, elastic)


def _transmission(
    placed: PlacedStructure,
    columns: tuple[tuple[str, str], ...],
    method: Literal["rows", "stiffness"] | None,
) -> tuple[Array, NDArray[np.bool_]]:
    """Displacement of the tool per unit misfit, and where the stiffness has decided."""
    batch = placed.batch
    if method == "stiffness":
        return _by_stiffness(placed, columns), np.ones(batch, dtype=bool)
    found = error_transmission(placed.structure.linkage, placed.placement, columns)
    if np.any(found.loose):
        # the message of the saddle-point system names the joints, where it sees the same
        raise MechanismError(
            "tool",
            f"can move although the drives are held{_where(found.loose)}: its position is "
            "indeterminate.",
            "Lock, drive or spring the free directions, or avoid singular poses.",
        )
    if not np.any(found.redundant):
        return found.matrix, found.redundant
    if method == "rows":
        raise ModelError(
            "joints",
            f"are over-constrained{_where(found.redundant)}: errors are locked in as forces.",
            'Use method = "stiffness", with real stiffnesses.',
        )
    # one pose may be redundant where others are not: at a singular one
    matrix = np.array(found.matrix)
    if batch == ():
        return _by_stiffness(placed, columns), np.asarray(found.redundant)
    flat = placed.placement.flat()
    locked = np.ravel(found.redundant)
    part = placed.structure.at(flat[np.flatnonzero(locked)])
    rows = matrix.reshape(len(locked), *matrix.shape[-2:])
    rows[locked] = _by_stiffness(part, columns)
    return rows.reshape(matrix.shape), np.asarray(found.redundant)


def _by_stiffness(placed: PlacedStructure, columns: tuple[tuple[str, str], ...]) -> Array:
    found = influence(placed, columns)
    found.outcome.require_all()
    return found.tool


def _where(bad: NDArray[np.bool_]) -> str:
    if bad.ndim == 0:
        return ""
    return f" at {int(np.count_nonzero(bad))} of {bad.size} poses"
