"""What several tests of vibration need: small oscillators, and matrices by another way."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eig

from strutwork.msa import PlacedStructure, PointMass, Spring, system_of
from strutwork.msa.constraints import orthonormal_rows, scales
from strutwork.msa.mass import mass_matrix
from tests.structure_cases import LIBRARY
from tests.structures import Model

Array = NDArray[Any]

BODY = ((0.01, 0.0, 0.0), (0.0, 0.02, 0.0), (0.0, 0.0, 0.015))


def oscillators(*pairs: tuple[float, float], joints: dict[str, Any] | None = None) -> Model:
    """Masses in a row that slide along x, each on a joint to the one before.

    `pairs` are (stiffness, mass), the first to ground; a stiffness of zero leaves it free.
    `joints` adds options to every joint's.
    """
    model = Model(f"m{len(pairs)}")
    model.ground(m0=(0, 0, 0))
    for i, (stiffness, mass) in enumerate(pairs, 1):
        options = dict(joints or {})
        if stiffness:
            options["stiffness"] = {"z": stiffness}
        model.joint(f"J{i}", "prismatic", (f"m{i - 1}", f"m{i}"), (1, 0, 0), **options)
        if mass:
            model.masses.append(PointMass(f"m{i}", mass))
    return model


def heavy(name: str) -> Model:
    """A structure of the library, with a mass where its parts have none of their own."""
    model = LIBRARY[name]().model
    rigid = not model.beams or name == "tripod of pinned rods"
    if rigid:
        assert model.tool is not None
        model.masses.append(PointMass(model.tool, 2.0, BODY, (0.01, 0.02, 0.03)))
    if name == "hexapod, rigid spinning struts":
        for i in range(6):
            # each half strut turns with a body of its own
            model.masses.append(PointMass(f"foot{i}", 0.4, BODY))
            model.masses.append(PointMass(f"head{i}", 0.3, BODY))
    return model


def block_on_springs(**stiffness: float) -> Model:
    """A rigid body on one spring to ground at its centre."""
    model = Model("body")
    model.nodes(body=(0, 0, 0))
    model.springs.append(Spring("bed", ("body",), stiffness))
    model.masses.append(PointMass("body", 2.0, BODY))
    return model


def saddle_point_matrices(placed: PlacedStructure) -> tuple[Array, Array, Array]:
    """K, M and independent rows A of one pose on all unknowns, scaled to one unit."""
    system = system_of(placed)
    d = scales(system)[0]
    rows = orthonormal_rows(system).basis[0]
    rows = rows[np.any(rows, axis=1)]
    outer = np.outer(d, d)
    return system.stiffness[0] * outer, mass_matrix(system)[0] * outer, rows


def saddle_point_frequencies(placed: PlacedStructure) -> Array:
    """Frequencies, Hz, ascending, from the pencil with multipliers, rigid-body modes with it.

    Shifted by −(ω₀)² so that floating structures can be solved, and inverted, which
    sends multipliers and motions without mass to zero.
    """
    k, m, rows = saddle_point_matrices(placed)
    n, r = len(k), len(rows)
    shift = 1e-2 * np.trace(k) / np.trace(m) / n
    size = np.abs(k).max()
    matrix = np.block([[(k + shift * m) / size, rows.T], [rows, np.zeros((r, r))]])
    right = np.concatenate([m / size, np.zeros((r, n))])
    flexibility = np.linalg.solve(matrix, right)[:n]
    values = eig(flexibility, right=False)
    assert np.abs(values.imag).max() <= 1e-6 * np.abs(values).max()
    real = values.real[values.real > 1e-13 * values.real.max()]
    squares = np.sort(1.0 / real - shift)
    return np.asarray(np.sqrt(np.maximum(squares, 0.0)) / (2 * np.pi))
