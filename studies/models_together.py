"""Numbers of many machines at once, where these differ in the numbers of their parts alone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import StrutworkError
from strutwork.fea.lowest import natural_frequencies
from strutwork.fea.preload import preloaded
from strutwork.machines.model import Model
from strutwork.msa import LoadCase, PlacedStructure
from strutwork.msa.mass import total_mass
from strutwork.msa.stacked import PlacedStack, can_stack, stacked
from strutwork.msa.variant_of import origin_of
from strutwork.outcome import solve_poses

Array = NDArray[Any]

#: Machines from which a stack is quicker than one after the other.
STACKED_FROM = 2


def first_frequencies(models: Sequence[Model | None]) -> Array:
    """Lowest natural frequency of each machine at home under its preload, (n,), Hz.

    Missing (NaN) where a machine has to be asked alone: it is None, stands otherwise than the
    others, has another load case, or cannot be.

    Parameters
    ----------
    models : sequence of n Model or None
    """

    def values(stack: PlacedStructure, case: LoadCase | None) -> Array:
        vibrating = stack if case is None else preloaded(stack, case)
        return natural_frequencies(vibrating, 1)[0][:, 0]

    return _together(models, _preload, values)


def masses(models: Sequence[Model | None]) -> Array:
    """Mass of all parts of each machine, (n,), kg; missing (NaN) as `first_frequencies`.

    Parameters
    ----------
    models : sequence of n Model or None
    """
    return _together(models, lambda _: None, lambda stack, _: total_mass(stack))


def _preload(model: Model) -> LoadCase | None:
    return None if model.preload is None else model.case(model.preload)


def _together(
    models: Sequence[Model | None],
    case_of: Callable[[Model], LoadCase | None],
    values: Callable[[PlacedStack, LoadCase | None], Array],
) -> Array:
    """What `values` finds of stacks of machines that share topology, placement and load case."""
    found = np.full(len(models), np.nan)
    groups: dict[tuple[int, int, int], list[int]] = {}
    cases: dict[int, LoadCase | None] = {}
    for i, model in enumerate(models):
        if model is not None and can_stack(model.structure):
            case = case_of(model)
            # cases that a change leaves alone are the same objects in all models
            cases[i] = case
            key = (id(origin_of(model.structure)), id(model.placement), id(case))
            groups.setdefault(key, []).append(i)
    for group in groups.values():
        members = [m for m in (models[i] for i in group) if m is not None]
        if len(members) < STACKED_FROM:
            continue
        stack = stacked([m.structure for m in members], members[0].placement)
        place, case = np.array(group), cases[group[0]]

        def some(
            part: NDArray[np.intp],
            place: NDArray[np.intp] = place,
            case: LoadCase | None = case,
            stack: PlacedStack = stack,
        ) -> None:
            found[place[part]] = values(stack[part], case)

        try:
            solve_poses(some, len(group))
        except (StrutworkError, np.linalg.LinAlgError):
            # each says by itself what is wrong with it
            found[place] = np.nan
    found[~np.isfinite(found)] = np.nan
    return found
