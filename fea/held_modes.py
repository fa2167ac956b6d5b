"""Lowest modes of a tied solid with the interfaces held."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import LinearOperator, eigsh

from strutwork.fea.tied_solid import StaticSolver

Array = NDArray[Any]


def held_modes(static: StaticSolver, count: int) -> tuple[Array, Array]:
    """Squared angular frequencies (m,), (rad/s)², and mass-normalised modes (c, m), 1/√kg.

    Parameters
    ----------
    static : StaticSolver
        Of the solid with c coordinates.
    count : int
        m, less than c.
    """
    solid = static.solid
    size = solid.stiffness.shape[0]
    operator = LinearOperator((size, size), matvec=lambda x: static.solve(x[:, None])[0][:, 0])
    start = np.random.default_rng(0).standard_normal(size)
    values, vectors = eigsh(
        solid.stiffness,
        k=count,
        M=solid.mass,
        sigma=0.0,
        OPinv=operator,
        v0=operator.matvec(solid.mass @ start),
    )
    return np.maximum(values, 0.0), np.asarray(vectors)
