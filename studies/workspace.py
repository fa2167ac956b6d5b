"""Workspace of a machine: how large, of how many pieces, and what bounds it where."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import prod
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS, characteristic_length
from strutwork.kinematics.margin_grid import (
    HALVINGS,
    MarginGrid,
    asked,
    check_axes,
    grid_points,
    margin_grid,
)
from strutwork.kinematics.regions import Regions, regions
from strutwork.studies.dataset_units import unit_attributes
from strutwork.studies.executor import place
from strutwork.studies.foresee import Foreseen
from strutwork.studies.level_set import LevelSet, apart, level_set
from strutwork.studies.progress import Progress
from strutwork.studies.spread_margin import Spread
from strutwork.studies.workspace_margin import MachineMargin

Array = NDArray[Any]

#: Longest work that is begun, s.
LONGEST = 7200.0
#: Poses of a grid: its border is known to a small share of a cell long before.
LARGEST = 10_000_000
#: Poses that are timed beforehand.
TIMED = 64
#: Bytes of a pose in the results, and of one that is followed, a body and a joint.
RESULT, BODY, JOINT = 80.0, 250.0, 250.0
#: Where the border is none of the machine's.
GRID_ENDS = "the grid ends"


@dataclass(frozen=True)
class Nearest:
    """The point of the border that is nearest to home.

    Parameters
    ----------
    place : (d,)
        m and rad.
    distance : float
        m; a turn counts by the arm `Workspace.arm`.
    reason : str
    """

    place: Array
    distance: float
    reason: str


@dataclass(frozen=True)
class Workspace:
    """The workspace of a machine on a grid of task coordinates.

    Parameters
    ----------
    title : str
    grid : MarginGrid
    border : LevelSet
    regions : Regions
    error : float
        Of the measure, in products of m and rad: what lies between the border and that of every
        second point of the grid, for a smooth border some three times what is left.
    home : (d,)
        Home in the grid's directions.
    home_margin : float
        Of home, as of a point of the grid: no unit, at most 1, below zero where it is not good.
    home_reason : str
        What is least at home.
    arm : float
        m; at which turns are compared with lengths.
    spare : (...) or None
        Over the grid, the value of the spare coordinate with the largest margin, m or rad.
    """

    title: str
    grid: MarginGrid
    border: LevelSet
    regions: Regions
    error: float
    home: Array
    home_margin: float
    home_reason: str
    arm: float
    spare: Array | None = None

    def __repr__(self) -> str:
        return (
            f"<Workspace: {self.measure:.4g} ± {self.error:.2g} {self.unit}, "
            f"{len(self.regions.sizes)} components>"
        )

    @property
    def measure(self) -> float:
        """Length, area or volume."""
        return self.border.measure

    @property
    def refused(self) -> dict[str, int]:
        """Points of the grid that are not good, by what they fail most, most first."""
        margins, bad = self.grid.margins, ~self.grid.good
        counts = Counter(margins.reasons[int(k)] for k in margins.reason[bad])
        return dict(counts.most_common())

    @property
    def unit(self) -> str:
        """Unit of the measure, as in m² rad."""
        turns = sum(d.startswith("r") for d in self.grid.directions)
        power = ("", "", "²", "³")
        lengths = len(self.grid.directions) - turns
        words = [f"{u}{power[k]}" for u, k in (("m", lengths), ("rad", turns)) if k]
        return " ".join(words)

    @property
    def home_component(self) -> int:
        """Number of the component that holds home, the largest is 1; 0 where none does."""
        if self.home_margin < 0.0:
            return 0
        return self.regions.of(self._cells(self.home))

    def _cells(self, place: Array) -> Array:
        start = np.array([axis[0] for axis in self.grid.axes])
        return np.asarray((place - start) / self.grid.step)

    @cached_property
    def shares(self) -> dict[str, float]:
        """Share of the border by what it is made of, largest first.

        Lengths and areas are measured as they are; with lengths and turns together in spans of
        the grid.
        """
        if not len(self.border.facets):
            return {}
        kinds = {d.startswith("r") for d in self.grid.directions}
        spans = np.array([np.ptp(axis) for axis in self.grid.axes])
        sizes = self.border.facet_sizes(np.ones(len(spans)) if len(kinds) == 1 else spans)
        reasons = (*self.grid.crossings.reasons, GRID_ENDS)
        on = self.border.crossing[self.border.facets]
        number = np.full(on.shape, len(reasons) - 1)
        number[on >= 0] = self.grid.crossings.reason[on[on >= 0]]
        each = np.repeat(sizes / on.shape[1], on.shape[1])
        total = np.bincount(number.ravel(), each, len(reasons))
        found = {r: float(t / total.sum()) for r, t in zip(reasons, total, strict=True) if t > 0}
        return dict(sorted(found.items(), key=lambda pair: -pair[1]))

    @cached_property
    def nearest(self) -> Nearest | None:
        """The nearest place to home where its component ends; None where the grid ends first."""
        number = self.home_component
        crossings = self.grid.crossings
        high = crossings.low.copy()
        high[np.arange(len(high)), crossings.axis] += 1
        label = self.regions.label
        mine = (label[tuple(crossings.low.T)] == number) | (label[tuple(high.T)] == number)
        if number == 0 or not mine.any():
            return None
        arm = np.array([self.arm if d.startswith("r") else 1.0 for d in self.grid.directions])
        apart = np.linalg.norm((self.grid.border - self.home) * arm, axis=1)
        k = int(np.where(mine, apart, np.inf).argmin())
        reason = crossings.reasons[int(crossings.reason[k])]
        return Nearest(self.grid.border[k], float(apart[k]), reason)

    def to_dataset(self) -> xr.Dataset:
        """Margins, reasons and components over the grid, and the spare coordinate's values."""
        directions = self.grid.directions
        units = {d: "rad" if d.startswith("r") else "m" for d in directions}
        coords = {
            d: (d, axis, {"units": units[d]})
            for d, axis in zip(directions, self.grid.axes, strict=True)
        }
        margins = self.grid.margins
        found: dict[str, Any] = {
            "margin": (directions, margins.value, {"units": "1"}),
            "component": (directions, self.regions.label, {"units": "1"}),
            "reason": (directions, margins.reason, {"units": "1"}),
            "reason_text": (("reason_index",), np.array(margins.reasons, dtype=str)),
        }
        if self.spare is not None:
            found["spare"] = (directions, self.spare, unit_attributes("m or rad"))
        attributes = {
            "title": self.title,
            "measure": self.measure,
            "measure_error": self.error,
            "measure_unit": self.unit,
            "components": len(self.regions.sizes),
            "holes": self.regions.holes,
        }
        return xr.Dataset(found, coords, attributes)


def workspace(
    margin: MachineMargin,
    axes: Mapping[str, Array],
    *,
    halvings: int = HALVINGS,
    progress: Progress | None = None,
) -> Workspace:
    """The workspace of a machine over a grid of one to three task coordinates.

    Parameters
    ----------
    margin : MachineMargin
        Of the directions of the grid, in its order.
    axes : mapping of direction to (n,)
        Evenly spaced, m and rad, an odd number along each.
    halvings : int
        Of each edge that crosses the border.
    progress : callable, optional
        Called with how many poses are done, and of how many.

    Raises
    ------
    ModelError
        As `margin_grid`, or the grid would take too much time or memory; says how much.
    """
    directions, values = tuple(axes), tuple(np.asarray(v, dtype=float) for v in axes.values())
    check_axes(directions, values)
    foresee(margin, values)
    margin.told = progress if margin.follows else None
    # poses that are followed from one another are no chunks
    somewhere = not margin.follows and (place().executor or place().folder) is not None
    grid = margin_grid(
        directions,
        values,
        Spread(margin, progress) if somewhere else margin,
        halvings=halvings,
        at_once=margin.follows or somewhere,
        told=progress,
    )
    # what is asked of it later is no part of this grid
    margin.told = None
    border, coarse = level_set(grid), grid.coarse()
    home = margin.home[[DIRECTIONS.index(d) for d in directions]]
    there = margin(home[None])
    spare = None
    if margin.spare is not None:
        points = grid_points(values)
        spare = np.concatenate([margin.chosen(p) for p in np.array_split(points, _parts(points))])
        spare = np.where(grid.good, spare.reshape(grid.good.shape), np.nan)
    return Workspace(
        margin.model.title,
        grid,
        border,
        regions(grid.good),
        apart(border, level_set(coarse), coarse.step),
        home,
        float(there.value[0]),
        there.reasons[int(there.reason[0])],
        characteristic_length(margin.model.placement),
        spare,
    )


def foresee(margin: MachineMargin, axes: tuple[Array, ...]) -> Foreseen:
    """Time and memory that a grid will take.

    Parameters
    ----------
    margin : MachineMargin
    axes : tuple of (n,)
        Of the grid, m and rad.

    Raises
    ------
    ModelError
        Longer than `LONGEST`, or more memory than its share of what there is; says how much of
        both.
    """
    count = prod(len(axis) for axis in axes)
    linkage = margin.model.structure.linkage
    memory = RESULT * count
    if margin.follows:
        memory += count * (BODY * len(linkage.body_names) + JOINT * len(linkage.joints))
    found = Foreseen(count, _time(margin, axes) * count, memory)
    found.require(
        "workspace",
        "Use fewer points along a direction, or fewer tilts, rolls or spare values.",
        LONGEST,
        LARGEST,
    )
    return found


def _time(margin: MachineMargin, axes: tuple[Array, ...]) -> float:
    """Time of a pose, s: of some of the grid, after one that compiles and prepares."""
    points = np.stack([np.linspace(a[0], a[-1], TIMED) for a in axes], axis=-1)
    if margin.follows:
        # near home, as each is from the one before
        home = margin.home[[DIRECTIONS.index(d) for d in margin.directions]]
        points = home + np.linspace(-0.5, 0.5, TIMED)[:, None] * margin.step
    margin(points[:1])
    begun = time.perf_counter()
    asked(margin, points)
    # small batches cost more a pose than large ones
    return (time.perf_counter() - begun) / TIMED / (1.0 if margin.follows else 10.0)


def _parts(points: Array) -> int:
    return max(1, len(points) // 4096)
