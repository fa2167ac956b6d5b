"""Receptance as a sum over poles, where damping couples the undamped modes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.fea.coupled import AnyDamping
from strutwork.fea.eigen import Eigen
from strutwork.fea.poles import find_poles
from strutwork.fea.ports import Port, port_motions
from strutwork.fea.reduction import Reduced

Array = NDArray[Any]


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
        Motion at the ports of each pole's left and right shape; their products are in m/(N·s).
    constant : (q, q)
        R, of motions that neither mass nor dashpot delays, m/N.
    moving : (q, q)
        G, of rigid-body modes that nothing drags, 1/kg.
    """

    ports: tuple[Port, ...]
    poles: Array
    left: Array
    right: Array
    constant: Array
    moving: Array

    def __repr__(self) -> str:
        return f"<PoleModel: {len(self.ports)} ports, {len(self.poles)} poles>"

    def receptance(self, frequencies: ArrayLike) -> Array:
        """H, (f, q, q), complex, m/N.

        Parameters
        ----------
        frequencies : (f,)
            Hz, positive.
        """
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

    Motions without mass that no dashpot resists follow statically; with a dashpot they bring a
    state of first order.

    Parameters
    ----------
    reduced : Reduced
        One pose.
    eigen : Eigen
    ports : sequence of Port
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
    found = find_poles(reduced, eigen, damping)
    at, at_rigid = (array[0] for array in port_motions(reduced, ports, eigen.rigid))

    def seen(rigid: Array) -> Array:
        return np.asarray(at_rigid @ np.linalg.lstsq(eigen.rigid[0], rigid, rcond=None)[0])

    dragged, moved = seen(found.dragged), seen(found.still)
    return PoleModel(
        tuple(ports),
        np.concatenate([found.values, np.zeros(len(found.drag))]),
        np.concatenate([at @ found.left, dragged], axis=1),
        np.concatenate([at @ found.right, dragged / found.drag], axis=1),
        at @ found.constant @ at.T,
        moved @ moved.T,
    )
