"""Complex modes of structures whose damping couples the undamped ones."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eig

from fea.coupled import AnyDamping, damped_matrices
from fea.eigen import solve_eigen
from fea.reduction import reduce_system
from msa.assembly import system_of
from msa.structure import PlacedStructure
from strutwork.errors import ModelError

Array = NDArray[Any]

#: Dashpots that resist a motion by less than this share of the largest do not resist it.
DRAG = 1e-10


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
        Complex shape at the mesh nodes, largest entry one.
    """

    frequencies: Array
    damping_ratios: Array
    eigenvalues: Array
    shapes: Array

    def __repr__(self) -> str:
        return f"<ComplexModes: {len(self.frequencies)} modes, Hz>"


def complex_modes(placed: PlacedStructure, damping: AnyDamping, count: int = 10) -> ComplexModes:
    """Damped modes of a structure at one pose.

    From the state-space problem of (K + iD + sC + s²M) φ = 0; of each pair of eigenvalues the
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
    """
    if count < 1:
        raise ModelError("complex modes", f"{count} asked for.", "Ask for at least one.")
    system = system_of(placed)
    if system.poses != 1:
        raise ModelError("complex modes", f"of {system.poses} poses.", "Give one pose.")
    reduced = reduce_system(system)
    eigen = solve_eigen(reduced)
    matrices = damped_matrices(reduced, eigen, damping)
    stiffness = matrices.stiffness[0] + 1j * matrices.structural[0]
    viscous = matrices.viscous[0]
    finite = eigen.finite[0]
    # mass-normalised undamped modes as coordinates, and motions without mass beside them
    flexible = (eigen.flexibility[0] * np.where(finite, eigen.circular[0], 0.0))[:, finite]
    massless = eigen.flexibility[0][:, ~finite]
    still, dragged = _dragged(eigen.rigid[0], viscous, flexible)
    values, vectors = _state_space(stiffness, viscous, dragged, flexible, massless)
    at_zero = np.concatenate([still, dragged], axis=1)
    values = np.concatenate([np.zeros(at_zero.shape[1]), values])
    vectors = np.concatenate([at_zero, vectors], axis=1)
    order = np.argsort(np.abs(values), kind="stable")[:count]
    values, vectors = values[order], vectors[:, order]
    at_nodes = np.moveaxis(system.expand((reduced.basis[0] @ vectors)[None])[0], -1, 0)
    flat = at_nodes.reshape(len(values), -1)
    scale = flat[np.arange(len(values)), np.abs(flat).argmax(axis=1)]
    size = np.abs(values)
    ratios = np.divide(-values.real, size, out=np.zeros(len(values)), where=size > 0)
    return ComplexModes(size / (2.0 * np.pi), ratios, values, at_nodes / scale[:, None, None])


def _dragged(rigid: Array, viscous: Array, flexible: Array) -> tuple[Array, Array]:
    """Rigid-body modes that no dashpot resists, and those that some do."""
    if not rigid.shape[1]:
        return rigid, rigid
    force = rigid.T @ viscous @ rigid
    size = max(np.abs(np.diag(flexible.T @ viscous @ flexible)).max(initial=0.0), np.trace(force))
    values, turn = np.linalg.eigh(force)
    resists = values > DRAG * max(size, 1e-300)
    turned = rigid @ turn
    return turned[:, ~resists], turned[:, resists]


def _state_space(
    stiffness: Array, viscous: Array, dragged: Array, flexible: Array, massless: Array
) -> tuple[Array, Array]:
    """Eigenvalues and shapes beside the rigid-body modes at zero.

    The state holds the velocities of the dragged rigid-body modes, whose places do not matter,
    places and velocities of the flexible modes, and places of the motions without mass.
    """
    d, m, z = dragged.shape[1], flexible.shape[1], massless.shape[1]
    basis = np.concatenate([dragged, flexible, massless], axis=1)
    k, c = basis.T @ stiffness @ basis, basis.T @ viscous @ basis
    if not np.any(k.imag):
        k = k.real
    # coordinates q = (dragged, flexible, massless); its velocities v are of the first two
    v, f, last = slice(0, d + m), slice(d, d + m), slice(d + m, None)
    if z and not np.abs(c[last]).max() > DRAG * np.abs(c).max():
        # without dashpots on them the motions without mass follow statically
        follow = -np.linalg.solve(k[last, last], k[last, v])
        k = k[v, v] + k[v, last] @ follow
        c, z = c[v, v], 0
        basis = basis[:, v] + massless @ follow
    left = np.zeros((d + 2 * m + z,) * 2, dtype=k.dtype)
    right: Array = np.eye(d + 2 * m + z)
    place, speed, tail = slice(0, m), slice(m, 2 * m + d), slice(2 * m + d, None)
    left[place, m + d : 2 * m + d] = np.eye(m)
    left[speed, place], left[speed, speed] = -k[v, f], -c[v, v]
    if z:
        left[speed, tail] = -k[v, last]
        left[tail, place], left[tail, speed], left[tail, tail] = (
            -k[last, f],
            -c[last, v],
            -k[last, last],
        )
        right[speed, tail], right[tail, tail] = c[v, last], c[last, last]
        values, vectors = eig(left, right)
    else:
        values, vectors = np.linalg.eig(left)
    chosen = np.isfinite(values) & (values.imag >= 0.0)
    values, vectors = values[chosen], vectors[:, chosen]
    places = np.concatenate([vectors[m : m + d] / values, vectors[:m], vectors[tail]])
    return values, basis @ places
