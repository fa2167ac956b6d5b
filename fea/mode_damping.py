"""Damping ratio of every undamped mode."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from fea.coupled import AnyDamping, PartDamping, is_coupled
from fea.damping import modal_ratios
from fea.eigen import solve_eigen
from fea.modes import Modes
from fea.pole_residue import pole_model
from fea.reduction import reduce_system
from msa.assembly import system_of

Array = NDArray[Any]

#: Parts of a pole below this share of it are rounding.
REAL = 1e-9


def damping_ratios(modes: Modes, damping: AnyDamping) -> Array:
    """Damping ratio ζ of every mode of one pose, (m,).

    Of damping that couples the modes, ζ = −Re s / |s| of the pole that holds most of the mode;
    one where it is critical or beyond. Zero for rigid-body modes.

    Raises
    ------
    ModelError
        Several poses; uncoupled damping beyond critical.
    """
    frequencies = np.asarray(modes.frequencies)
    rigid = int(modes.rigid_body_modes)
    reduced = reduce_system(system_of(modes.placed))
    ratios = np.zeros(len(frequencies))
    if not is_coupled(reduced, damping):
        simple = damping.background if isinstance(damping, PartDamping) else damping
        if simple is not None:
            square = (2.0 * np.pi * frequencies[rigid:]) ** -2.0
            ratios[rigid:] = modal_ratios(simple, square)
        return ratios
    model = pole_model(reduced, solve_eigen(reduced), [], damping)
    size = np.abs(model.poles)
    # of each pair the pole in the upper half plane; two real poles are one overdamped mode
    upper = model.poles.imag >= -REAL * size
    chosen = upper & (model.poles.real <= REAL * size) & (size > 0)
    poles, shares = model.poles[chosen], model.shares[chosen]
    count = min(len(frequencies) - rigid, shares.shape[1])
    rows, columns = linear_sum_assignment(-shares[:, :count].T)
    found = -poles[columns].real / np.abs(poles[columns])
    ratios[rigid + rows] = np.clip(found, 0.0, 1.0)
    return ratios
