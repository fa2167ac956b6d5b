"""Poles of a damped structure, each with a bound of its error from its own residual.

With K + iD + sC + s²M in undamped modes of unit strain energy, K is the identity and M the
diagonal of μ = 1/ω². Multiplied by λ² for λ = 1/s it is a monic quadratic problem in λ, whose
largest eigenvalues are the lowest poles: those that matter are the best determined, and motions
without mass, whose dashpots give poles at any distance, have λ near zero and spoil nothing. (The
problem in s divides by their dashpots. Tisseur and Meerbergen 2001, section 3, on linearising
and scaling.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.coupled import AnyDamping, damped_matrices
from strutwork.fea.eigen import Array, Eigen
from strutwork.fea.reduction import Reduced

#: Dashpots that resist a motion by less than this share of the largest do not resist it.
DRAG = 1e-10

#: Eigenvalues λ below this share of the matrix are rounding: such a motion follows at once.
PROMPT = 1e-14


@dataclass(frozen=True)
class Poles:
    """Poles of one pose.

    Parameters
    ----------
    values : (k,)
        s, rad/s.
    errors : (k,)
        Of s as a share of it, by the residual of the structure's own matrices.
    shapes : (c, k)
        On the independent coordinates, m and rad of any size.
    shares : (k, m)
        Share of each undamped mode that has mass in the strain energy of a pole's shape; what
        motions without mass store is missing.
    left, right : (c, k)
        The flexible receptance is Σ left rightᵀ / (s − values) + constant: their products are in
        m/(N·s).
    constant : (c, c)
        Of motions that neither mass nor dashpot delays, m/N.
    dragged, still : (c, d), (c, r)
        Rigid-body modes that dashpots resist, and those that none does; mass-normalised, 1/√kg.
    drag : (d,)
        Dashpots on the dragged ones, 1/s.
    """

    values: Array
    errors: Array
    shapes: Array
    shares: Array
    left: Array
    right: Array
    constant: Array
    dragged: Array
    still: Array
    drag: Array


def find_poles(reduced: Reduced, eigen: Eigen, damping: AnyDamping) -> Poles:
    """All poles of (K + iD + sC + s²M) u = f but those of the rigid-body modes at zero.

    Parameters
    ----------
    reduced : Reduced
        At one pose.
    eigen : Eigen
        Its modes.
    damping : damping of any kind

    Raises
    ------
    ModelError
        Several poses.
    NumericalError
        Poles that cannot be told apart.
    """
    if len(reduced.stiffness) != 1:
        raise ModelError("poles", f"of {len(reduced.stiffness)} poses.", "Give one pose.")
    try:
        return _find_poles(reduced, eigen, damping)
    except np.linalg.LinAlgError as error:
        raise NumericalError(
            "poles", "cannot be distinguished.", "Change the damping slightly."
        ) from error


def _find_poles(reduced: Reduced, eigen: Eigen, damping: AnyDamping) -> Poles:
    matrices = damped_matrices(reduced, eigen, damping)
    viscous = matrices.viscous[0]
    stiffness = matrices.stiffness[0]
    if np.any(matrices.structural):
        stiffness = stiffness + 1j * matrices.structural[0]
    massive = eigen.finite[0]
    flexible, root = eigen.flexibility[0][:, massive], np.sqrt(eigen.square[0][massive])
    still, dragged, drag = _split(eigen.rigid[0], viscous, flexible / root)
    delayed, prompt = split_massless(
        eigen.flexibility[0][:, ~massive], viscous, float(root.max(initial=0.0))
    )
    # coordinates: modes of unit strain energy, with what follows them at once
    basis = np.concatenate([flexible, delayed], axis=1)
    constant: Array = np.zeros_like(reduced.stiffness[0])
    if prompt.shape[1]:
        inner = prompt.T @ stiffness @ prompt
        constant = prompt @ np.linalg.solve(inner, prompt.T)
        basis = basis - prompt @ np.linalg.solve(inner, prompt.T @ (stiffness @ basis))
    k, c = basis.T @ stiffness @ basis, basis.T @ viscous @ basis
    pull = (basis.T @ (viscous @ dragged)) / drag
    matrix, given = _linearised(k, c, pull, root, drag)
    eigenvalues, vectors = np.linalg.eig(matrix)
    dual = np.linalg.inv(vectors)
    d, m = len(drag), len(root)
    given = given @ np.concatenate([dragged.T, basis.T])
    parts = dual @ given
    late = np.abs(eigenvalues) > PROMPT * np.abs(matrix).sum(axis=1).max(initial=0.0)
    constant = constant + (basis @ vectors[d + m :, ~late]) @ parts[~late]
    eigenvalues, vectors = eigenvalues[late], vectors[:, late]
    values, moved = 1.0 / eigenvalues, vectors[d + m :]
    # a dragged coordinate is its velocity, which the state holds, over s
    shapes = basis @ moved + (dragged @ vectors[:d]) * eigenvalues
    left = -(basis @ moved) * values - dragged @ vectors[:d]
    miss = stiffness @ shapes + (viscous @ shapes) * values + (reduced.mass[0] @ shapes) * values**2
    errors = _errors(eigenvalues, given @ miss, dual[late])
    energy = np.abs(moved) ** 2
    total = energy.sum(axis=0)
    shares = (energy[:m] / np.where(total > 0, total, 1.0)).T
    return Poles(
        values, errors, shapes, shares, left, parts[late].T, constant, dragged, still, drag
    )


def _linearised(k: Array, c: Array, pull: Array, root: Array, drag: Array) -> tuple[Array, Array]:
    """A and B of x = λ (λ − A)⁻¹ B f for the state x = (v, p, q).

    q are the coordinates, p = √μ q / λ of those with mass, v the velocities of the dragged
    rigid-body modes; f acts on v and q.
    """
    d, m, n = len(drag), len(root), len(k)
    v, q, heavy = slice(0, d), slice(d + m, None), np.arange(m)
    matrix = np.zeros((d + m + n,) * 2, dtype=k.dtype)
    matrix[d + heavy, d + m + heavy] = root
    matrix[v, v], matrix[v, q] = -np.diag(1.0 / drag), -pull.T
    lower = np.zeros((n, d + m + n), dtype=k.dtype)
    lower[:, v], lower[:, q] = pull, (pull * drag) @ pull.T - c
    lower[heavy, d + heavy] = -root
    matrix[q] = np.linalg.solve(k, lower)
    given = np.zeros((d + m + n, d + n), dtype=k.dtype)
    given[v, :d] = np.diag(1.0 / drag)
    given[q] = np.linalg.solve(k, np.concatenate([-pull, np.eye(n)], axis=1))
    return matrix, given


def _errors(eigenvalues: Array, miss: Array, dual: Array) -> Array:
    """Relative errors of poles, the least of three bounds (Wilkinson 1965, chapter 2).

    The residual times the pole's condition; the change to first order and what is left to the
    second, where no other pole is near; and of a double pole the square root of the residual.
    """
    if not len(eigenvalues):
        return np.zeros(0)
    size = np.linalg.norm(miss, axis=0)
    first = np.abs(np.einsum("kn,nk->k", dual, miss))
    bound = size * np.linalg.norm(dual, axis=1)
    apart = np.abs(eigenvalues[:, None] - eigenvalues) + np.diag(np.full(len(eigenvalues), np.inf))
    gap = np.minimum(apart.min(axis=1) / np.abs(eigenvalues), 1.0)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        second = np.where(gap > 2.0 * bound, first + bound**2 / gap, bound)
    double = np.sqrt(size * np.abs(eigenvalues).max() / np.abs(eigenvalues))
    return np.asarray(np.minimum(np.minimum(bound, second), double))


def _split(rigid: Array, viscous: Array, flexible: Array) -> tuple[Array, Array, Array]:
    """Rigid-body modes that no dashpot resists, those that some do, and how much."""
    rigid = rigid[:, np.any(rigid, axis=0)]
    if not rigid.shape[1]:
        return rigid, rigid, np.zeros(0)
    force = rigid.T @ viscous @ rigid
    others = np.abs(np.einsum("im,ij,jm->m", flexible, viscous, flexible)).max(initial=0.0)
    values, turn = np.linalg.eigh(force)
    resists = values > DRAG * max(float(others), float(np.trace(force)), 1e-300)
    return rigid @ turn[:, ~resists], rigid @ turn[:, resists], values[resists]


def split_massless(massless: Array, viscous: Array, longest: float) -> tuple[Array, Array]:
    """Motions without mass that dashpots resist, and those that none does.

    What a dashpot delays by less than rounding of the `longest` time is not delayed.

    Parameters
    ----------
    massless : (n, m)
        Of unit strain energy, 1/√(N/m).
    viscous : (n, n)
        Dashpots, N·s/m and the like.
    longest : float
        s.

    Returns
    -------
    delayed, prompt : (n, d) and (n, m − d)
        Of unit strain energy, 1/√(N/m).
    """
    if not massless.shape[1]:
        return massless, massless
    values, turn = np.linalg.eigh(massless.T @ viscous @ massless)
    resists = values > max(DRAG * float(values[-1]), PROMPT * longest)
    return massless @ turn[:, resists], massless @ turn[:, ~resists]
