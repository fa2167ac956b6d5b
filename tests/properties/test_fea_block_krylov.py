"""Properties of reduced models of random chains, networks and dampings."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from strutwork.fea.block_krylov import KrylovOptions, krylov_reduction
from strutwork.fea.block_krylov_damping import MatrixDamping
from strutwork.fea.factorize import factorize
from strutwork.fea.large_modes import lowest_modes
from tests.solids import frame, resonator

N = 60


def network(seed: int) -> tuple[sp.csc_array, sp.csc_array, np.random.Generator]:
    """Springs between random masses, all held to the ground softly."""
    random = np.random.default_rng(seed)
    ends = random.integers(0, N, size=(3 * N, 2))
    ends = ends[ends[:, 0] != ends[:, 1]]
    links = np.zeros((len(ends), N))
    links[np.arange(len(ends)), ends[:, 0]] = 1.0
    links[np.arange(len(ends)), ends[:, 1]] = -1.0
    springs = 10.0 ** random.uniform(0, 3, size=len(ends))
    stiffness = links.T @ (springs[:, None] * links) + np.diag(random.uniform(1, 10, N))
    mass = np.diag(10.0 ** random.uniform(-1, 1, N))
    return sp.csc_array(stiffness), sp.csc_array(mass), random


@settings(max_examples=20, deadline=None)
@given(
    seed=st.integers(0, 10**6),
    ports=st.integers(1, 3),
    dampers=st.integers(0, 2),
    floating=st.booleans(),
)
def test_a_reduced_response_is_symmetric_passive_and_right(
    seed: int, ports: int, dampers: int, floating: bool
) -> None:
    stiffness, mass, random = network(seed)
    loads = random.normal(size=(N, ports))
    at = random.normal(size=(N, dampers)) if dampers else None
    rates = random.uniform(0.1, 10, dampers) if dampers else None
    damping = MatrixDamping(loss_factor=0.02, ports=at, dashpots=rates)
    band = (0.05, 5.0)
    model = krylov_reduction(
        stiffness, mass, loads, band, damping, KrylovOptions(tolerance=1e-7, floating=floating)
    )
    lines = np.linspace(*band, 7)
    found = model.receptance(lines)
    np.testing.assert_allclose(found, np.swapaxes(found, 1, 2), atol=1e-9 * np.abs(found).max())
    # dampers take power: the imaginary part is negative semidefinite
    largest = np.linalg.eigvalsh(found.imag)[:, -1]
    assert np.all(largest <= 1e-9 * np.abs(found).max())
    for line, answer in zip(lines, found, strict=True):
        w = 2 * np.pi * line
        dense = (1 + 0.02j) * stiffness.toarray() - w**2 * mass.toarray()
        if at is not None and rates is not None:
            dense = dense + 1j * w * (at * rates) @ at.T
        exact = loads.T @ np.linalg.solve(dense, loads)
        assert np.linalg.norm(answer - exact) <= 1e-6 * np.linalg.norm(exact)


@settings(max_examples=30, deadline=None)
@given(
    size=st.tuples(st.integers(4, 9), st.integers(1, 3), st.integers(1, 3)),
    share=st.floats(-9, -2),
    frequency=st.floats(50, 1450),
    loss=st.floats(-4, -1),
    part=st.booleans(),
    dashpot=st.booleans(),
    further=st.booleans(),
    tolerance=st.floats(-7, -1.5),
)
def test_no_line_is_wrong_by_more_than_reported(
    size: tuple[int, int, int],
    share: float,
    frequency: float,
    loss: float,
    part: bool,
    dashpot: bool,
    further: bool,
    tolerance: float,
) -> None:
    """Frames of many sizes with a light resonator, which the ports hardly excite."""
    stiffness, mass, loads = resonator(frame(*size), 10.0**share, frequency)
    n, eta = stiffness.shape[0], 10.0**loss
    structural = None
    if part:
        half = sp.diags_array(np.arange(n) < n // 2, dtype=float)
        structural = sp.csc_array(eta * half @ stiffness @ half)
    ports = np.roll(loads[:, :1], n // 2, axis=0) if dashpot else None
    rates = np.full(1, 300.0) if dashpot else None
    damping = MatrixDamping(loss_factor=eta, ports=ports, dashpots=rates, structural=structural)
    band, limit = (5.0, 1500.0), 10.0**tolerance
    options = KrylovOptions(tolerance=limit, expansions=(0.0, 901.7) if further else (0.0,))
    model = krylov_reduction(stiffness, mass, loads, band, damping, options)
    assert model.residual.proven
    assert model.error <= limit
    own = model.natural_frequencies
    own = own[(own > band[0]) & (own < band[1])]
    lines = np.unique(np.r_[band, model.worst, frequency, frequency * (1 + eta / 2), own[:8]])
    bounds = model.errors(lines)
    for line, answer, bound in zip(lines, model.receptance(lines), bounds, strict=True):
        w = 2 * np.pi * line
        dynamic = (1 + 1j * eta) * stiffness - w**2 * mass
        if structural is not None:
            dynamic = dynamic + 1j * structural
        if ports is not None:
            dynamic = dynamic + 300j * w * sp.csc_array(ports @ ports.T)
        solved = factorize(sp.csc_array(dynamic), "superlu").solve(loads.astype(complex))
        exact = loads.T @ solved
        error = np.linalg.norm(answer - exact) / np.linalg.norm(exact)
        # at a resonance rounding moves the direct line, by more the less it is damped
        assert error <= bound + 1e-11 / eta
        # lines between those of the search have what it left of the tolerance
        assert bound <= min(1.25 * model.error, limit)


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 10**6), count=st.integers(1, 12), copies=st.integers(1, 3))
def test_lowest_modes_are_all_found_with_their_copies(seed: int, count: int, copies: int) -> None:
    stiffness, mass, _ = network(seed)
    many = sp.eye_array(copies)
    stiffness, mass = sp.csc_array(sp.kron(many, stiffness)), sp.csc_array(sp.kron(many, mass))
    found = lowest_modes(stiffness, mass, count)
    root = 1.0 / np.sqrt(mass.diagonal())
    square = np.linalg.eigvalsh(root[:, None] * stiffness.toarray() * root)[:count]
    np.testing.assert_allclose(found.frequencies, np.sqrt(square) / (2 * np.pi), rtol=1e-8)
