"""Receptance as a sum over poles, where damping couples the undamped modes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fea.coupled import AnyDamping, damped_matrices
from fea.eigen import Eigen
from fea.ports import Port, port_motions
from fea.reduction import Reduced
from strutwork.errors import ModelError, NumericalError

Array = NDArray[Any]

#: Dashpots that resist a motion by less than this share of the largest do not resist it.
DRAG = 1e-10


@dataclass(frozen=True)
class PoleModel:
    """Receptance between ports of one pose as a sum over poles, for ω > 0.

    H(ω) = Σ l_k r_kᵀ / (iω − s_k) + R − G / ω²

    Poles need not stand in conjugate pairs: structural damping makes the stiffness complex.

    Parameters
    ----------
    ports : tuple of Port
    poles : (k,)
        s, rad/s.
    left, right : (q, k)
    constant : (q, q)
        R, of motions that neither mass nor dashpot delays, m/N.
    moving : (q, q)
        G, of rigid-body modes that nothing drags, 1/kg.
    shares : (k, m)
        Part of each undamped flexible mode in the shape of a pole; rows add to one.
    """

    ports: tuple[Port, ...]
    poles: Array
    left: Array
    right: Array
    constant: Array
    moving: Array
    shares: Array

    def __repr__(self) -> str:
        return f"<PoleModel: {len(self.ports)} ports, {len(self.poles)} poles>"

    def receptance(self, frequencies: ArrayLike) -> Array:
        """H (f, q, q) at positive frequencies in Hz."""
        omega = 2.0 * np.pi * np.asarray(frequencies, dtype=float)
        factor = 1.0 / (1j * omega[:, None] - self.poles)
        response = (self.left * factor[:, None, :]) @ self.right.T + self.constant
        if np.any(self.moving):
            response = response - self.moving / omega[:, None, None] ** 2
        return np.asarray(response)


def pole_model(
    reduced: Reduced, eigen: Eigen, ports: Sequence[Port], damping: AnyDamping
) -> PoleModel:
    """Poles and residues of (K + iD + sC + s²M) u = f between ports.

    In the undamped modes as coordinates. Motions without mass that no dashpot resists follow
    statically and are condensed; with a dashpot they bring a state of first order.

    Parameters
    ----------
    reduced : Reduced
        One pose.
    eigen : Eigen
    ports : sequence of Port
        None where only the poles are wanted.
    damping : damping of any kind

    Returns
    -------
    PoleModel

    Raises
    ------
    ModelError
        Several poses, or a port that cannot move.
    NumericalError
        Poles that cannot be told apart: the sum does not hold.
    """
    if len(reduced.stiffness) != 1:
        raise ModelError("pole model", f"of {len(reduced.stiffness)} poses.", "Give one pose.")
    matrices = damped_matrices(reduced, eigen, damping)
    stiffness = matrices.stiffness[0]
    if np.any(matrices.structural):
        stiffness = stiffness + 1j * matrices.structural[0]
    viscous = matrices.viscous[0]
    at, at_rigid = np.zeros((0, reduced.size)), np.zeros((0, eigen.rigid.shape[-1]))
    if ports:
        at, at_rigid = (array[0] for array in port_motions(reduced, ports, eigen.rigid))
    finite = eigen.finite[0]
    flexible = (eigen.flexibility[0] * np.where(finite, eigen.circular[0], 0.0))[:, finite]
    still, dragged = _split(eigen.rigid[0], viscous, flexible)
    delayed, prompt = _split_massless(eigen.flexibility[0][:, ~finite], viscous)
    d, m = dragged.shape[1], flexible.shape[1]
    n = d + m
    basis = np.concatenate([dragged, flexible, delayed], axis=1)
    k, c, out = basis.T @ stiffness @ basis, basis.T @ viscous @ basis, at @ basis
    k[:d], k[:, :d] = 0.0, 0.0
    constant: Array = np.zeros((len(at), len(at)))
    if prompt.shape[1]:
        inner, outer = prompt.T @ stiffness @ prompt, prompt.T @ stiffness @ basis
        outer[:, :d] = 0.0
        follow = -np.linalg.solve(inner, outer)
        constant = (at @ prompt) @ np.linalg.solve(inner, (at @ prompt).T)
        k, out = k + outer.T @ follow, out + (at @ prompt) @ follow
    left, right, load, see = _state_space(k, c, out, n)
    try:
        system = np.linalg.solve(right, left)
        poles, vectors = np.linalg.eig(system)
        given = np.linalg.solve(vectors, np.linalg.solve(right, load))
    except np.linalg.LinAlgError as error:
        raise NumericalError(
            "poles", "cannot be told apart.", "Change the damping by a little."
        ) from error
    shares = np.abs(vectors[d:n]) ** 2
    total = shares.sum(axis=0)
    moved = at_rigid @ np.linalg.lstsq(eigen.rigid[0], still, rcond=None)[0]
    return PoleModel(
        tuple(ports),
        poles,
        see @ vectors,
        given.T,
        constant,
        moved @ moved.T,
        (shares / np.where(total > 0, total, 1.0)).T,
    )


def _split(rigid: Array, viscous: Array, flexible: Array) -> tuple[Array, Array]:
    """Rigid-body modes that no dashpot resists, and those that some do."""
    rigid = rigid[:, np.any(rigid, axis=0)]
    if not rigid.shape[1]:
        return rigid, rigid
    force = rigid.T @ viscous @ rigid
    others = np.abs(np.einsum("im,ij,jm->m", flexible, viscous, flexible)).max(initial=0.0)
    values, turn = np.linalg.eigh(force)
    resists = values > DRAG * max(float(others), float(np.trace(force)), 1e-300)
    return rigid @ turn[:, ~resists], rigid @ turn[:, resists]


def _split_massless(massless: Array, viscous: Array) -> tuple[Array, Array]:
    """Motions without mass that dashpots resist, and those that none does."""
    if not massless.shape[1]:
        return massless, massless
    values, turn = np.linalg.eigh(massless.T @ viscous @ massless)
    resists = values > DRAG * max(float(values[-1]), 1e-300)
    return massless @ turn[:, resists], massless @ turn[:, ~resists]


def _state_space(k: Array, c: Array, out: Array, n: int) -> tuple[Array, Array, Array, Array]:
    """A, E, B and C of E x' = A x + B f, u = C x for the state (q, q', z).

    q are the first n coordinates, of unit mass; z the others, without mass.
    """
    z = len(k) - n
    size = 2 * n + z
    q, v, w = slice(0, n), slice(n, 2 * n), slice(2 * n, size)
    left = np.zeros((size, size), dtype=k.dtype)
    right = np.eye(size)
    load = np.zeros((size, len(out)), dtype=out.dtype)
    see = np.zeros((len(out), size), dtype=out.dtype)
    left[q, v] = np.eye(n)
    left[v, q], left[v, v], left[v, w] = -k[:n, :n], -c[:n, :n], -k[:n, n:]
    left[w, q], left[w, v], left[w, w] = -k[n:, :n], -c[n:, :n], -k[n:, n:]
    right[v, w], right[w, w] = c[:n, n:], c[n:, n:]
    load[v], load[w] = out[:, :n].T, out[:, n:].T
    see[:, q], see[:, w] = out[:, :n], out[:, n:]
    return left, right, load, see
