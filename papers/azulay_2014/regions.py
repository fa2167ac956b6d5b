"""What the singular ring and a machine's own joint ranges leave of its check points."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

import numpy as np
import xarray as xr

from strutwork.machines import ThreeLegs
from strutwork.papers.azulay_2014.barrier import Ring, pole_side, ring
from strutwork.papers.azulay_2014.filters import AS_IN_AZULAY
from strutwork.studies.filters import Filters, PoseStatus
from strutwork.studies.progress import Progress, silent
from strutwork.studies.statistics import Summary, summary
from strutwork.studies.stiffness_map import stiffness_map

Side = Literal["all", "pole", "beyond"]

#: The regions in the words of the report. What the ring parts no motion with six drives joins.
SIDES: Mapping[Side, str] = MappingProxyType(
    {"all": "all points", "pole": "the pole's side of the ring", "beyond": "beyond the ring"}
)

#: Which joint ranges are kept: those that the paper's means agree with, or every one.
RANGES: Mapping[bool, str] = MappingProxyType(
    {False: "revolute joints only", True: "the machine's own, all"}
)

OWN_RANGES = Filters(condition_limit=AS_IN_AZULAY.condition_limit, length=AS_IN_AZULAY.length)


@dataclass(frozen=True)
class Barred:
    """A machine's map by region, without and with its own joint ranges.

    Parameters
    ----------
    ring : Ring
    own : Dataset
        The stiffness map with every joint range kept.
    parts : mapping of (own ranges, side) to Summary or None
        None where no point is left.
    points : int
    """

    ring: Ring
    own: xr.Dataset
    parts: Mapping[tuple[bool, Side], Summary | None]
    points: int

    def __repr__(self) -> str:
        return f"<Barred: {self.kept(False)} and {self.kept(True)} of {self.points} points>"

    def kept(self, own: bool, side: Side = "all") -> int:
        """How many points are left."""
        found = self.parts[own, side]
        return 0 if found is None else found.points_kept

    def mean(self, axis: str, own: bool, side: Side = "all") -> float:
        """Mean blocked stiffness along an axis, N/m; not a number where no point is left."""
        found = self.parts[own, side]
        return np.nan if found is None else found.axis(axis).statistics.mean


def barred(machine: ThreeLegs, dataset: xr.Dataset, progress: Progress = silent) -> Barred:
    """Split a machine's stiffness map by the singular ring, and do so with its own joint ranges.

    Parameters
    ----------
    machine : ThreeLegs
    dataset : Dataset
        Its map with the ranges of revolute joints only.
    progress : callable, optional
        Told how far the map with all ranges is.

    Returns
    -------
    Barred
    """
    own = stiffness_map(machine, filters=OWN_RANGES, progress=progress)
    parts: dict[tuple[bool, Side], Summary | None] = {}
    for ranges, found in ((False, dataset), (True, own)):
        inside = pole_side(machine, found)
        parts[ranges, "all"] = _summary(found)
        parts[ranges, "pole"] = _summary(found.isel(point=np.flatnonzero(inside)))
        parts[ranges, "beyond"] = _summary(found.isel(point=np.flatnonzero(~inside)))
    return Barred(ring(machine), own, MappingProxyType(parts), dataset.sizes["point"])


def _summary(dataset: xr.Dataset) -> Summary | None:
    good = np.any(dataset["status"].to_numpy() == PoseStatus.GOOD)
    return summary(dataset) if good else None
