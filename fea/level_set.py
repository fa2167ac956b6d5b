"""Level-set test: at which frequencies a receptance has a given magnitude."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eig

from strutwork.errors import ModelError
from strutwork.fea.modal import ModalModel

Array = NDArray[Any]


def level_crossings(model: ModalModel, port: int, level: float, pose: int = 0) -> Array:
    """Frequencies, Hz, at which the driving-point receptance has the magnitude `level`.

    With G(ω) = diag(1 − ω²μ + iωv + iη) and residues r, |rᵀG⁻¹r| = level where

        [ G          −r rᵀ/level ]
        [ −r rᵀ/level   conj(G)  ]

    is singular: a polynomial eigenproblem in ω whose real eigenvalues are the crossings (after
    Boyd and Balakrishnan 1990, for H∞ norms). Above the largest magnitude there are none.

    Parameters
    ----------
    model : ModalModel
        Without rigid-body modes.
    port : int
        Index into the model's ports.
    level : float
        m/N.
    pose : int

    Returns
    -------
    frequencies : (k,)
        Ascending, Hz.

    Raises
    ------
    ModelError
        A rigid-body mode that moves the port, or a level that is not positive.
    """
    if model.mobility_of_rigid_modes[pose, port, port] > 0:
        raise ModelError(
            f"port {model.ports[port]}",
            "is moved by a rigid-body mode: its receptance has no largest value.",
            "Hold the structure.",
        )
    if not (np.isfinite(level) and level > 0):
        raise ModelError("level", f"is {level!r}.", "Give a positive magnitude, m/N.")
    r = model.residues[pose, port]
    excited = np.abs(r) > 1e-9 * np.abs(r).max()
    r, square, viscous = r[excited], model.square[pose, excited], model.viscous[pose, excited]
    # frequencies in units of the first mode keep the pencil in range
    unit = 1.0 / np.sqrt(square.max())
    square, viscous = square * unit**2, viscous * unit
    n = len(r)
    eta = model.damping.structural
    scale = r / np.sqrt(level)
    coupling = -np.outer(scale, scale)
    identity = np.eye(n)
    p0 = np.block([[(1 + 1j * eta) * identity, coupling], [coupling, (1 - 1j * eta) * identity]])
    p2 = -np.diag(np.concatenate([square, square]))
    if not np.any(viscous):
        values = eig(p0, -p2, right=False)
        values = np.sqrt(values[np.isfinite(values)])
    else:
        p1 = 1j * np.diag(np.concatenate([viscous, -viscous]))
        size = 2 * n
        left = np.block([[np.zeros((size, size)), np.eye(size)], [-p0, -p1]])
        right = np.block([[np.eye(size), np.zeros((size, size))], [np.zeros((size, size)), p2]])
        values = eig(left, right, right=False)
        values = values[np.isfinite(values)]
    real = values[
        (np.abs(values.imag) < 1e-7 * np.maximum(np.abs(values), 1e-3)) & (values.real > 0)
    ]
    found = np.asarray(np.sort(real.real) * unit / (2.0 * np.pi))
    if not len(found):
        return found
    distinct = np.concatenate([[True], np.diff(found) > 1e-9 * found[1:]])
    return np.asarray(found[distinct])


def exceeds(
    model: ModalModel, port: int, level: float, band: tuple[float, float], pose: int = 0
) -> bool:
    """Whether the magnitude is above a level anywhere in a band.

    The crossings cut the band into pieces on which the magnitude stays on one side. Errors as
    `level_crossings`.

    Parameters
    ----------
    model : ModalModel
        Without rigid-body modes.
    port : int
        Index into the model's ports.
    level : float
        m/N.
    band : (float, float)
        Hz.
    pose : int
        Index into the model's poses.
    """
    low, high = band
    cuts = level_crossings(model, port, level, pose)
    edges = np.concatenate([[low], cuts[(cuts > low) & (cuts < high)], [high]])
    middles = (edges[:-1] + edges[1:]) / 2.0
    values = np.abs(model.receptance(np.concatenate([middles, [low, high]]))[pose, :, port, port])
    return bool(np.any(values > level))
