"""Numbers of many machines at once, where these differ in the numbers of their parts alone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import StrutworkError
from strutwork.fea.lowest import natural_frequencies
from strutwork.fea.preload import preloaded
from strutwork.kinematics import Placement
from strutwork.machines.model import Model
from strutwork.msa import LoadCase
from strutwork.msa.mass import total_mass
from strutwork.msa.stacked import PlacedStack, can_stack, stacked
from strutwork.msa.variant_of import origin_of
from strutwork.outcome import solve_poses
from strutwork.studies.standing import Standing

Array = NDArray[Any]

#: A machine and where it stands.
Stands = tuple[Model, Standing]

#: Machines from which a stack is quicker than one after the other.
STACKED_FROM = 2


def first_frequencies(standing: Sequence[Stands | None]) -> Array:
    """Lowest natural frequency of each machine at home under its preload, (n,), Hz.

    Missing (NaN) where a machine has to be asked alone: it is None, stands otherwise than the
    others, has another load case, or cannot be.

    Parameters
    ----------
    standing : sequence of n (Model, Standing) or None
    """

    def values(stack: PlacedStack, case: LoadCase | None) -> Array:
        vibrating = stack if case is None else preloaded(stack, case)
        return natural_frequencies(vibrating, 1)[0][:, 0]

    def where(one: Stands) -> tuple[Placement, LoadCase | None]:
        model = one[0]
        return model.placement, None if model.preload is None else model.case(model.preload)

    return _together(standing, where, values)


def masses(standing: Sequence[Stands | None]) -> Array:
    """Mass of all parts of each machine at home, (n,), kg.

    Missing (NaN) as `first_frequencies`.

    Parameters
    ----------
    standing : sequence of n (Model, Standing) or None
    """
    return _together(
        standing, lambda one: (one[0].placement, None), lambda stack, _: total_mass(stack)
    )


def _together(
    standing: Sequence[Stands | None],
    where: Callable[[Stands], tuple[Placement, LoadCase | None]],
    values: Callable[[PlacedStack, LoadCase | None], Array],
) -> Array:
    """What `values` finds of stacks of machines that share topology, placement and load case."""
    found = np.full(len(standing), np.nan)
    groups: dict[tuple[int, int, int], tuple[list[int], Placement, LoadCase | None]] = {}
    for i, one in enumerate(standing):
        if one is not None and one[1].good.size and can_stack(one[0].structure):
            placement, case = where(one)
            # what a change leaves alone is the same object in all models
            key = (id(origin_of(one[0].structure)), id(placement), id(case))
            groups.setdefault(key, ([], placement, case))[0].append(i)
    for group, placement, case in groups.values():
        if len(group) < STACKED_FROM:
            continue
        structures = [one[0].structure for one in (standing[i] for i in group) if one is not None]
        _fill(found, np.array(group), stacked(structures, placement), case, values)
    found[~np.isfinite(found)] = np.nan
    return found


def _fill(
    found: Array,
    place: NDArray[np.intp],
    stack: PlacedStack,
    case: LoadCase | None,
    values: Callable[[PlacedStack, LoadCase | None], Array],
) -> None:
    """Put the values of a stack in their places; those that cannot be stay missing."""

    def some(part: NDArray[np.intp]) -> None:
        found[place[part]] = values(stack[part], case)

    try:
        solve_poses(some, len(place))
    except (StrutworkError, np.linalg.LinAlgError):
        # each says by itself what is wrong with it
        found[place] = np.nan
