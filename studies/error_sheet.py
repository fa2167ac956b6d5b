"""The error sheet of a pose: displacement of the tool relative to the workpiece, by its causes.

What is known adds as a vector. What is known within bounds only ranges over a convex set, whose
support function says what it does at worst; the sets of independent causes add, and so do their
support functions, which makes the worst case of all exact.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.overconstraint.sampling import draw, variances
from strutwork.overconstraint.sources import Block, MisfitSources
from strutwork.overconstraint.tolerance import Tolerance
from strutwork.overconstraint.tool_deviation import farthest
from strutwork.overconstraint.unit_sets import UnitSet
from strutwork.studies.error_calibration import GeometryCalibration

Array = NDArray[Any]

#: The causes, in the order of the sheet.
CAUSES = (
    "geometry",
    "geometry after calibration",
    "gravity",
    "thermal",
    "cutting",
    "drives",
    "ground",
)

#: Draws of the distribution, and their seed.
SAMPLES, SEED = 2**15, 2002

#: Standard deviations of a random vibration that count as its worst case.
PEAK = 3.0


@dataclass(frozen=True)
class NormalBall:
    """|z| ≤ 1 in any number of dimensions: z is normal, and one is `PEAK` standard deviations.

    Parameters
    ----------
    dimension : int
    """

    dimension: int = 6

    def support(self, direction: Array) -> Array:
        """Largest cᵀz over the set, (...).

        Parameters
        ----------
        direction : (..., d)
            Coefficients c of z in the quantity, any unit.
        """
        return np.asarray(np.linalg.norm(direction, axis=-1))

    def extreme(self, direction: Array) -> Array:
        """A z at which it is reached, (..., d); zero where the direction is zero.

        Parameters
        ----------
        direction : (..., d)
            Coefficients c of z in the quantity, any unit.
        """
        size = np.linalg.norm(direction, axis=-1, keepdims=True)
        return np.asarray(np.divide(direction, size, out=np.zeros_like(direction), where=size > 0))

    def inside(self, uniform: Array) -> Array:
        """Normal points, not cut at the set's surface, (..., d).

        Parameters
        ----------
        uniform : (..., d)
            Numbers in [0, 1), no unit.
        """
        # statistics take longer to load than a small machine
        from scipy.special import ndtri  # noqa: PLC0415

        return np.asarray(ndtri(np.clip(uniform, 1e-16, 1 - 1e-16)) / PEAK)

    def surface(self, uniform: Array) -> Array:
        """As `inside`: a vibration has no bound, (..., d).

        Parameters
        ----------
        uniform : (..., d)
            Numbers in [0, 1), no unit.
        """
        return self.inside(uniform)

    def gauge(self, point: Array) -> Array:
        """Scale of the set at which a point lies on its surface, (...).

        Parameters
        ----------
        point : (..., d)
            z, no unit.
        """
        return np.asarray(np.linalg.norm(point, axis=-1))

    @property
    def surface_variance(self) -> float:
        """Variance of every parameter."""
        return 1.0 / PEAK**2


@dataclass(frozen=True)
class ErrorRow:
    """What one part does to the tool by one cause: mean + gain z, z in the shapes.

    Parameters
    ----------
    cause : str
        One of `CAUSES`.
    part : str
    mean : (6,)
        What is known, m and rad, global axes, as the others.
    gain : (6, k)
        Per parameter of the shapes, one after another, m and rad; k may be zero.
    shapes : tuple of UnitSet
    distribution : "uniform", "surface" or "normal"
        Of z within the shapes; a `NormalBall` has "surface".

    Raises
    ------
    ModelError
        An unknown cause, or a number that is not finite.
    """

    cause: str
    part: str
    mean: Array
    gain: Array
    shapes: tuple[UnitSet, ...] = ()
    distribution: str = "uniform"

    def __post_init__(self) -> None:
        if self.cause not in CAUSES:
            raise ModelError(
                f"error of {self.part}", f'has the unknown cause "{self.cause}".', ", ".join(CAUSES)
            )
        if not (np.all(np.isfinite(self.mean)) and np.all(np.isfinite(self.gain))):
            raise ModelError(
                f"{self.cause} of {self.part}", "is not finite.", "Check the numbers of the model."
            )

    def __repr__(self) -> str:
        return f"<ErrorRow: {self.cause}, {self.part}>"

    @property
    def half_range(self) -> Array:
        """What it may add to either side of its mean, (6,), m and rad."""
        return ErrorSheet((self,)).half_range

    @property
    def worst(self) -> Array:
        """Largest displacement in each direction, to either side, (6,), m and rad."""
        return np.asarray(np.abs(self.mean) + self.half_range)

    @property
    def deviation(self) -> Array:
        """Standard deviation in each direction, (6,), m and rad."""
        return ErrorSheet((self,)).deviation


@dataclass(frozen=True)
class ErrorSheet:
    """Displacement of the tool relative to the workpiece at one pose, by cause and part.

    Parameters
    ----------
    rows : tuple of ErrorRow
    notes : tuple of str
        What limits them.
    drive_forces : tuple of (joint:direction, N or N·m)
        What the drives carry under gravity.
    drift : tuple of (s, (6,))
        Displacement by the temperatures at moments, m and rad.
    calibrated : GeometryCalibration or None
        What the calibration of its geometry determines.
    uncalibrated : tuple of ErrorRow
        What the geometry did before.
    """

    rows: tuple[ErrorRow, ...]
    notes: tuple[str, ...] = ()
    drive_forces: tuple[tuple[str, float], ...] = ()
    drift: tuple[tuple[float, tuple[float, ...]], ...] = ()
    calibrated: GeometryCalibration | None = None
    uncalibrated: tuple[ErrorRow, ...] = ()

    def __repr__(self) -> str:
        return f"<ErrorSheet: {len(self.rows)} rows, m and rad>"

    @property
    def causes(self) -> tuple[str, ...]:
        """Those of its rows, in the order of `CAUSES`."""
        present = {row.cause for row in self.rows}
        return tuple(cause for cause in CAUSES if cause in present)

    def of(self, cause: str) -> ErrorSheet:
        """The rows of one cause.

        Parameters
        ----------
        cause : str
        """
        return ErrorSheet(tuple(row for row in self.rows if row.cause == cause))

    @cached_property
    def sources(self) -> MisfitSources:
        """All parameters as sets with distributions; they are no misfits, and its map is empty."""
        blocks, named, start = [], [], 0
        for r, row in enumerate(self.rows):
            named.append(
                Tolerance(row.part, "length", ("",), size=1.0, distribution=row.distribution)
            )
            for shape in row.shapes:
                blocks.append(Block(r, shape, start))
                start += shape.dimension
        return MisfitSources(tuple(named), tuple(blocks), (), np.zeros((0, start)), np.zeros((0,)))

    @cached_property
    def gain(self) -> Array:
        """Of all rows, (6, k), m and rad."""
        return np.concatenate([np.zeros((6, 0)), *(row.gain for row in self.rows)], axis=1)

    @cached_property
    def mean(self) -> Array:
        """Sum of what is known, (6,), m and rad."""
        return np.asarray(sum((row.mean for row in self.rows), np.zeros(6)))

    @cached_property
    def half_range(self) -> Array:
        """What all may add to either side of the mean, (6,), m and rad: exact."""
        return np.asarray(self.sources.supports(self.gain).sum(axis=-1))

    @property
    def worst(self) -> Array:
        """Largest displacement in each direction, to either side, (6,), m and rad: exact.

        A vibration of the ground counts with `PEAK` standard deviations.
        """
        return np.asarray(np.abs(self.mean) + self.half_range)

    @cached_property
    def deviation(self) -> Array:
        """Standard deviation in each direction, (6,), m and rad; no cause is correlated."""
        if not self.gain.shape[1]:
            return np.zeros(6)
        return np.asarray(np.sqrt(self.gain**2 @ variances(self.sources)))

    def within(self, share: float = 0.95, samples: int = SAMPLES, seed: int = SEED) -> Array:
        """What the displacement stays within with a probability, to either side of zero, (6,).

        Parameters
        ----------
        share : float
            The probability, no unit.
        samples, seed : int
            Random draws of the causes' distributions; m and rad.
        """
        if not self.gain.shape[1]:
            return np.abs(self.mean)
        uniform = np.random.default_rng(seed).random((samples, self.gain.shape[1]))
        moved = self.mean + draw(self.sources, uniform) @ self.gain.T
        return np.asarray(np.quantile(np.abs(moved), share, axis=0))

    def largest(self, tolerance: float = 1e-4) -> Array:
        """Worst displacement of the tool centre point in any direction of space, (3,), m.

        Parameters
        ----------
        tolerance : float
            Between what is reached and the bound that proves it, as a share of it.

        Raises
        ------
        NumericalError
            The bound did not come down to the value.
        """
        if not self.gain.shape[1]:
            return self.mean[:3].copy()
        _, place, _ = farthest(self.sources, self.gain[None, :3], self.mean[None, :3], tolerance)
        return np.asarray(place[0])

    def to_dict(self) -> dict[str, Any]:
        """Rows, totals by cause and the total, lists, SI."""
        return {
            "rows": [
                {"cause": r.cause, "part": r.part} | _numbers(ErrorSheet((r,))) for r in self.rows
            ],
            "causes": {cause: _numbers(self.of(cause)) for cause in self.causes},
            "total": _numbers(self) | {"largest": self.largest().tolist()},
            "drive_forces": dict(self.drive_forces),
            "drift": [{"time": t, "displacement": list(u)} for t, u in self.drift],
            "notes": list(self.notes),
            **self._calibration(),
        }

    def _calibration(self) -> dict[str, Any]:
        if self.calibrated is None:
            return {}
        before = _numbers(ErrorSheet(self.uncalibrated))
        return {"calibration": self.calibrated.to_dict() | {"geometry_before": before}}


def _numbers(sheet: ErrorSheet) -> dict[str, list[float]]:
    return {
        "mean": sheet.mean.tolist(),
        "half_range": sheet.half_range.tolist(),
        "worst_case": sheet.worst.tolist(),
        "standard_deviation": sheet.deviation.tolist(),
        "within_95_percent": sheet.within().tolist(),
    }


def displacement_total(rows: Sequence[ErrorRow]) -> Array:
    """Sum of the known displacements of rows, (6,), m and rad.

    Parameters
    ----------
    rows : sequence of ErrorRow
    """
    return ErrorSheet(tuple(rows)).mean
