"""Damping ratio of every undamped mode."""

from __future__ import annotations

import warnings

import numpy as np
from scipy.optimize import linear_sum_assignment

from strutwork.errors import UnverifiedWarning
from strutwork.fea.coupled import AnyDamping, PartDamping, is_coupled
from strutwork.fea.damping import modal_ratios
from strutwork.fea.eigen import Array, Eigen, solve_eigen
from strutwork.fea.modes import Modes
from strutwork.fea.poles import find_poles
from strutwork.fea.reduction import Reduced, reduce_system
from strutwork.msa.assembly import system_of

#: Parts of a pole below this share of it are rounding.
REAL = 1e-9

#: A ratio below this is rounding of a mode that nothing damps.
ROUNDING = 1e-12

#: A ratio is verified where its error is at most this share of it, or below `REAL`.
VERIFIED = 1e-3


def damping_ratios(modes: Modes, damping: AnyDamping) -> Array:
    """Damping ratio ζ of every mode of one pose, (m,).

    Of damping that couples the modes, ζ = −Re s / |s| of the pole that holds most of the mode;
    one where it is critical or beyond. Zero for rigid-body modes. Not a number where the residual
    of the pole does not verify it to `VERIFIED`.

    Parameters
    ----------
    modes : Modes
        At one pose, m of them.
    damping : damping of any kind

    Raises
    ------
    ModelError
        Several poses.
    NumericalError
        Poles that cannot be told apart.

    Warns
    -----
    UnverifiedWarning
        Names the modes whose ratio is withheld.
    """
    frequencies = np.asarray(modes.frequencies)
    rigid = min(int(modes.rigid_body_modes), len(frequencies))
    ratios = np.zeros(len(frequencies))
    # damping of the whole needs no matrices, which of a large structure would not fit
    reduced = reduce_system(system_of(modes.placed)) if isinstance(damping, PartDamping) else None
    if reduced is None or not is_coupled(reduced, damping):
        simple = damping.background if isinstance(damping, PartDamping) else damping
        if simple is not None:
            square = (2.0 * np.pi * frequencies[rigid:]) ** -2.0
            # beyond critical a mode has two real poles
            ratios[rigid:] = np.minimum(modal_ratios(simple, square), 1.0)
        return ratios
    if len(frequencies) > rigid:
        found = _coupled(reduced, solve_eigen(reduced), damping)[: len(frequencies) - rigid]
        ratios[rigid : rigid + len(found)] = found
    lost = np.flatnonzero(np.isnan(ratios))
    if len(lost):
        named = ", ".join(f"{m + 1} ({frequencies[m]:.4g} Hz)" for m in lost)
        warnings.warn(
            f"damping ratios of the modes {named} are withheld: the residual of their poles does "
            "not verify them. Poles that nearly coincide are the usual cause: change the damping "
            "slightly.",
            UnverifiedWarning,
            stacklevel=2,
        )
    return ratios


def _coupled(reduced: Reduced, eigen: Eigen, damping: AnyDamping) -> Array:
    """Ratios of all flexible modes that have mass; not a number where they are not verified."""
    model = find_poles(reduced, eigen, damping)
    size = np.abs(model.values)
    # of each pair the pole in the upper half plane; two real poles are one overdamped mode
    upper = model.values.imag >= -REAL * size
    chosen = upper & (model.values.real <= REAL * size)
    poles, shares, errors = model.values[chosen], model.shares[chosen], model.errors[chosen]
    # which pole is a mode's, the lower ones decide among themselves as the higher ones do
    rows, columns = linear_sum_assignment(-shares.T)
    ratios = np.full(shares.shape[1], np.nan)
    found = np.clip(-poles[columns].real / np.abs(poles[columns]), 0.0, 1.0)
    sure = errors[columns] <= np.maximum(VERIFIED * found, REAL)
    found[found <= np.maximum(errors[columns], ROUNDING)] = 0.0
    ratios[rows] = np.where(sure, found, np.nan)
    return ratios
