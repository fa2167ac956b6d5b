"""The proposed machine of Azulay et al. 2014 with links of three lengths (Table 2)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import xarray as xr

from strutwork.errors import ModelError
from strutwork.machines import Proposed3PPRS, ThreeLegs
from strutwork.papers.azulay_2014.filters import AS_IN_AZULAY
from strutwork.studies.filters import Filters
from strutwork.studies.progress import Progress, share
from strutwork.studies.stiffness_map import stiffness_map

#: m (Table 2).
LINK_LENGTHS = (0.196, 0.216, 0.236)


def link_lengths(
    machine: ThreeLegs | None = None,
    lengths: Sequence[float] = LINK_LENGTHS,
    filters: Filters = AS_IN_AZULAY,
    *,
    workers: int | None = None,
    progress: Progress | None = None,
) -> Mapping[float, xr.Dataset]:
    """Stiffness maps of the machine with other link lengths, the workpiece in the same place.

    Only the links change: the pole of the hemisphere, the guide and the platform stay, so the
    sliders go where longer or shorter links let them.

    Parameters
    ----------
    machine : ThreeLegs, optional
        Everything but the link length; default the proposed machine, true spherical joints.
        Its `apparent()` for the model that the paper's numbers suggest.
    lengths : sequence of float
        m.
    filters : Filters
        With the prismatic joints' ranges kept, 196 mm loses most of its points: its sliders
        would stand inside the guide's radius.
    workers, progress
        As `strutwork.studies.stiffness_map`.

    Returns
    -------
    mapping of length to Dataset

    Raises
    ------
    ModelError
        No lengths, one with which the machine cannot stand at home, or a machine without a
        link length.
    """
    if not lengths:
        raise ModelError("link lengths", "are none.", "Give at least one, m.")
    base = machine or Proposed3PPRS()
    if not hasattr(base, "link_length"):
        raise ModelError(
            f"machine {type(base).__name__}", "has no link length.", "Choose another machine."
        )
    maps = {}
    for number, length in enumerate(lengths):
        change: dict[str, Any] = {"link_length": length}
        maps[length] = stiffness_map(
            replace(base, **change),
            filters=filters,
            workers=workers,
            progress=share(progress, number, len(lengths)),
        )
    return maps
