"""Whether a load that is no preload would change the frequencies that are shown."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import StrutworkError
from strutwork.fea import Modes, preloaded
from strutwork.machines.model import ModelWarning
from strutwork.msa import LoadCase

Array = NDArray[Any]

#: A load case is named when it would change a frequency by more than this share.
NOTABLE = 0.01

#: Modes looked at where none are asked for.
WATCHED = 6


def warn_of_preload(found: Modes, cases: Sequence[LoadCase]) -> None:
    """Warn of load cases whose forces would stiffen or soften the lowest elastic mode.

    By the work of the geometric stiffness in the modes found without it (Rayleigh's quotient), the
    first order of the change. A case that cannot be solved stiffens nothing.

    Parameters
    ----------
    found : Modes
        Of one pose, without preload.
    cases : sequence of LoadCase

    Warns
    -----
    ModelWarning
        Names the load case, the change and the option.
    """
    square = (2.0 * np.pi * found.frequencies) ** 2
    elastic = np.flatnonzero((square > 0) & np.isfinite(square))
    watched = elastic[:1] if elastic.size else np.arange(len(square))
    if not watched.size or found.placed.stiffening is not None:
        return
    # a structure that is free in all its modes: rounding is no frequency
    floor = 0.0 if elastic.size else 1e-9
    for case in cases:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                work = _work(found, case)[watched[0]]
        except StrutworkError:
            continue
        before = float(square[watched[0]])
        after = before + work
        if abs(work) <= max(2.0 * NOTABLE * before, floor):
            continue
        change = (
            f"would change the first frequency from {np.sqrt(before) / (2 * np.pi):.4g} to about "
            f"{np.sqrt(after) / (2 * np.pi):.4g} Hz"
            if after > 0
            else "would take away the stiffness of the first mode"
        )
        warnings.warn(
            f"load case {case.name}: its forces {change}, and no preload is named. Give --preload "
            f'"{case.name}", or preload = "{case.name}" in the file, if it acts while the '
            "structure vibrates.",
            ModelWarning,
            stacklevel=3,
        )


def _work(found: Modes, case: LoadCase) -> Array:
    """φᵀ G φ of every mode, (m,), rad²/s²."""
    stiffening = preloaded(found.placed, case).stiffening
    total = np.zeros(len(found.frequencies))
    if stiffening is not None:
        for _, nodes, part in stiffening.contributions():
            at = found.shapes[:, nodes].reshape(len(total), -1)
            total += np.einsum("mi,ij,mj->m", at, part, at)
    return total
