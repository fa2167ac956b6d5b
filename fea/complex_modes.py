"""Complex modes of structures whose damping couples the undamped ones."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.coupled import AnyDamping
from strutwork.fea.eigen import solve_eigen
from strutwork.fea.poles import find_poles
from strutwork.fea.reduction import reduce_system
from strutwork.fea.validity import warn_beyond
from strutwork.msa.assembly import system_of
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]

#: Largest relative error of a pole, by its residual, with which modes are given out.
RESIDUAL = 1e-6


@dataclass(frozen=True)
class ComplexModes:
    """Damped modes of one pose.

    Parameters
    ----------
    frequencies : (m,)
        Undamped natural frequency |s| of each mode, Hz, ascending; zero for rigid-body modes.
    damping_ratios : (m,)
        ζ = −Re s / |s|; one where a mode is critically damped or beyond, zero for rigid-body
        modes.
    eigenvalues : (m,)
        s, rad/s, with positive imaginary part where it oscillates; a mode damped beyond
        critical has two real ones, which stand as two modes.
    shapes : (m, n, 6)
        Complex shape at the mesh nodes, largest entry one; no unit.
    """

    frequencies: Array
    damping_ratios: Array
    eigenvalues: Array
    shapes: Array

    def __repr__(self) -> str:
        return f"<ComplexModes: {len(self.frequencies)} modes, Hz>"


def complex_modes(placed: PlacedStructure, damping: AnyDamping, count: int = 10) -> ComplexModes:
    """Damped modes of a structure at one pose.

    From (K + iD + sC + s²M) φ = 0 (`strutwork.fea.poles`); of each pair of eigenvalues the
    one in the upper half plane is taken, where the sign of iD is that of a decay. A rigid-body
    motion is a mode at zero; one that dashpots drag also creeps to rest, and its decay stands
    as a second, real mode.

    Parameters
    ----------
    placed : PlacedStructure
        One pose.
    damping : damping of any kind
    count : int
        Number of modes.

    Returns
    -------
    ComplexModes

    Raises
    ------
    ModelError
        Several poses, a count below one, no mass.
    NumericalError
        Poles that their residuals do not verify.

    Warns
    -----
    ValidityWarning
        A frequency above the limit of a superelement.
    """
    if count < 1:
        raise ModelError("complex modes", f"{count} asked for.", "Request at least one.")
    system = system_of(placed)
    if system.poses != 1:
        raise ModelError("complex modes", f"of {system.poses} poses.", "Give one pose.")
    reduced = reduce_system(system)
    eigen = solve_eigen(reduced)
    found = find_poles(reduced, eigen, damping)
    at_zero = np.concatenate([found.still, found.dragged], axis=1)
    chosen = found.values.imag >= 0.0
    values = np.concatenate([np.zeros(at_zero.shape[1]), found.values[chosen]])
    vectors = np.concatenate([at_zero, found.shapes[:, chosen]], axis=1)
    errors = np.concatenate([np.zeros(at_zero.shape[1]), found.errors[chosen]])
    order = np.argsort(np.abs(values), kind="stable")[:count]
    if not np.all(errors[order] <= RESIDUAL):
        raise NumericalError(
            "complex modes",
            f"a pole has a relative error up to {errors[order].max():.2g} by its residual.",
            "Request fewer, or change the damping slightly: poles may nearly coincide.",
        )
    values, vectors = values[order], vectors[:, order]
    at_nodes = np.moveaxis(system.expand((reduced.basis[0] @ vectors)[None])[0], -1, 0)
    flat = at_nodes.reshape(len(values), -1)
    scale = flat[np.arange(len(values)), np.abs(flat).argmax(axis=1)]
    size = np.abs(values)
    ratios = np.divide(-values.real, size, out=np.zeros(len(values)), where=size > 0)
    # a motion that only creeps has no frequency
    warn_beyond(placed, float(size[values.imag > 0].max(initial=0.0)) / (2.0 * np.pi))
    return ComplexModes(size / (2.0 * np.pi), ratios, values, at_nodes / scale[:, None, None])
