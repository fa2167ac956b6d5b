"""Patch tests: constant strain states of a straight beam divided in any way, in any direction.

The beam is a chain of pieces of unequal lengths; a state of constant strain must come out
exactly, whatever the division, since it is in the space of every element.
"""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from strutwork.msa import LoadCase, solve
from tests.structures import BAR, STEEL, Model, vector

LENGTH = 0.8
# unequal pieces, none shorter than 3.75 % of the length
cuts = st.lists(st.integers(1, 19), max_size=5, unique=True).map(
    lambda found: [(2 * n + (n % 2) * 0.5) / 40 for n in found]
)
directions = st.integers(0, 2**32 - 1)
# elements as short as 1.25 % of the beam bend 5e5 times harder than the whole of it
TOLERANCE = 1e-7


def chain(shares: list[float], seed: int, shear: bool, elements: int) -> tuple[Model, np.ndarray]:
    rng = np.random.default_rng(seed)
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    axes[:, 1] *= np.sign(np.linalg.det(axes))
    model = Model()
    at = [0.0, *sorted(shares), 1.0]
    names = [f"n{i}" for i in range(len(at))]
    model.nodes(**{n: LENGTH * s * axes[:, 0] for n, s in zip(names, at, strict=True)})
    for i in range(len(at) - 1):
        model.beam(
            f"b{i}", names[i], names[i + 1], BAR,
            orientation=vector(axes[:, 2]), shear=shear, elements=elements,
        )  # fmt: skip
    model.support("n0")
    return model, axes


@given(cuts, directions, st.booleans(), st.integers(1, 3))
def test_constant_strain_states(shares: list[float], seed: int, shear: bool, elements: int) -> None:
    model, axes = chain(shares, seed, shear, elements)
    e, g = STEEL.youngs_modulus, STEEL.shear_modulus
    strain, twist, curvature_y, curvature_z = 1e-4, 0.02, 0.03, -0.05
    loads = {
        "tension": (e * BAR.area * strain, 0, 0, 0, 0, 0),
        "torsion": (0, 0, 0, g * BAR.torsion_constant * twist, 0, 0),
        "bending y": (0, 0, 0, 0, e * BAR.second_moment_y * curvature_y, 0),
        "bending z": (0, 0, 0, 0, 0, e * BAR.second_moment_z * curvature_z),
    }
    six = np.kron(np.eye(2), axes)
    last = list(model.positions)[-2]
    cases = [LoadCase(n, ((last, tuple((six @ w).tolist())),)) for n, w in loads.items()]
    found = solve(model.place(), cases)
    local = np.einsum("ji,njm->nim", six, found.displacements)
    x = found.placed.positions @ axes[:, 0]
    zero = np.zeros_like(x)
    expected = {
        "tension": (strain * x, zero, zero, zero, zero, zero),
        "torsion": (zero, zero, zero, twist * x, zero, zero),
        # w = −κ x²/2 with rotation κ x about y; v = κ x²/2 with rotation κ x about z
        "bending y": (zero, zero, -curvature_y * x**2 / 2, zero, curvature_y * x, zero),
        "bending z": (zero, curvature_z * x**2 / 2, zero, zero, zero, curvature_z * x),
    }
    for m, (name, state) in enumerate(expected.items()):
        reference = np.stack(state, axis=-1)
        # the support's ground node stands at x = 0 and does not move
        gap = np.abs(local[..., m] - reference).max()
        assert gap <= TOLERANCE * np.abs(reference).max(), name
        # end forces: the same wrench in every piece, with opposite signs at its ends
        force = found.beam_forces[..., m]
        wrench = np.asarray(loads[name], dtype=float)
        largest = np.abs(wrench).max()
        assert np.abs(force[:, 1] - wrench).max() <= TOLERANCE * largest, name
        assert np.abs(force[:, 0] + wrench).max() <= TOLERANCE * largest, name


@given(cuts, directions, st.booleans())
def test_strain_energy_of_constant_states_is_that_of_the_rod(
    shares: list[float], seed: int, shear: bool
) -> None:
    model, axes = chain(shares, seed, shear, 1)
    last = list(model.positions)[-2]
    force, moment = 1000.0, 20.0
    six = np.kron(np.eye(2), axes)
    pull = LoadCase("pull", ((last, tuple((six @ [force, 0, 0, 0, 0, 0]).tolist())),))
    bend = LoadCase("bend", ((last, tuple((six @ [0, 0, 0, 0, moment, 0]).tolist())),))
    found = solve(model.place(), [pull, bend]).strain_energy
    e = STEEL.youngs_modulus
    expected = [
        force**2 * LENGTH / (2 * e * BAR.area),
        moment**2 * LENGTH / (2 * e * BAR.second_moment_y),
    ]
    np.testing.assert_allclose(found, expected, rtol=TOLERANCE)
