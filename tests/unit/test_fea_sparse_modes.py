"""Shift-invert Lanczos on a sparse null-space basis, beside the dense solution."""

from __future__ import annotations

import importlib
import itertools
from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

import strutwork.fea.ordering
import strutwork.fea.sparse_modes
from strutwork.errors import MechanismError, ModelError, NumericalError
from strutwork.fea import axial_forces, modes
from strutwork.fea.factorize import factorize
from strutwork.fea.sparse_modes import SPARSE_FROM
from strutwork.fea.sparse_reduction import reduce_sparse
from strutwork.msa import PlacedStructure, rod, solve, system_of
from tests.structure_cases import LIBRARY
from tests.structures import BAR, TUBE, Model, cantilever, wrench
from tests.vibration import heavy, oscillators

ORDERED = f"Lanczos, {factorize(sp.csc_array(sp.eye_array(3))).name}"


def lattice(cells: int, elements: int, mass: str = "consistent") -> Model:
    """A free cube of equal round beams: every mode of the cubic group's threefold kinds."""
    model = Model()
    places = list(itertools.product(range(cells + 1), repeat=3))
    model.nodes(**{f"n{i}.{j}.{k}": (0.3 * i, 0.3 * j, 0.3 * k) for i, j, k in places})
    for here in places:
        for d in range(3):
            there = [*here]
            there[d] += 1
            if there[d] <= cells:
                ends = [f"n{i}.{j}.{k}" for i, j, k in (here, there)]
                model.beam(" ".join(ends), *ends, TUBE, elements=elements, mass=mass)
    return model


def meshed(name: str, elements: int) -> PlacedStructure:
    """The first pose of a structure of the library with finer beams."""
    model = heavy(name)
    model.beams = [replace(b, elements=elements) for b in model.beams]
    placed = model.place()
    return placed[(0,) * len(placed.batch)]


FLEXIBLE = [n for n in LIBRARY if LIBRARY[n]().model.beams]


@pytest.mark.parametrize("name", FLEXIBLE)
def test_sparse_modes_are_the_dense_ones(name: str) -> None:
    placed = meshed(name, 8)
    dense, sparse = modes(placed, 14, method="dense"), modes(placed, 14, method="sparse")
    assert dense.solver == "dense"
    assert sparse.solver == ORDERED
    assert sparse.rigid_body_modes == dense.rigid_body_modes
    rigid = int(dense.rigid_body_modes)
    # both are backward stable: rounding times the spread of stiffness of a fine mesh
    np.testing.assert_allclose(sparse.frequencies[rigid:], dense.frequencies[rigid:], rtol=1e-8)
    assert np.all(sparse.frequencies[:rigid] == 0.0)
    np.testing.assert_allclose(sparse.total_mass, dense.total_mass)
    # multiplets cut at the end share their effective mass otherwise: compare sums of the rest
    np.testing.assert_allclose(
        sparse.effective_mass[:12].sum(axis=0),
        dense.effective_mass[:12].sum(axis=0),
        atol=1e-6 * dense.total_mass.max(),
    )


def test_a_structure_of_six_hundred_coordinates_with_joints_and_loops() -> None:
    placed = meshed("hexapod, spinning struts", 10)
    assert 500 < reduce_sparse(system_of(placed)).size < 900
    dense, sparse = modes(placed, 40, method="dense"), modes(placed, 40, method="sparse")
    assert sparse.rigid_body_modes == dense.rigid_body_modes == 6
    np.testing.assert_allclose(sparse.frequencies[6:], dense.frequencies[6:], rtol=1e-9)
    # a mode apart from its neighbours has the same shape and the same energy shares
    gap = np.diff(dense.frequencies[6:]) / dense.frequencies[7:]
    alone = np.flatnonzero((gap[:-1] > 1e-3) & (gap[1:] > 1e-3)) + 7
    assert len(alone) > 5
    overlap = np.einsum("mni,mni->m", sparse.shapes[alone], dense.shapes[alone])
    sizes = np.einsum("mni,mni->m", dense.shapes[alone], dense.shapes[alone])
    np.testing.assert_allclose(np.abs(overlap), sizes, rtol=1e-6)
    np.testing.assert_allclose(sparse.energy_shares[alone], dense.energy_shares[alone], atol=1e-6)
    np.testing.assert_allclose(sparse.energy_shares[6:].sum(axis=1), 1.0)


def multiplicities(frequencies: np.ndarray) -> list[int]:
    apart = np.flatnonzero(np.diff(frequencies) > 1e-7 * frequencies[1:])
    return [int(n) for n in np.diff([0, *(apart + 1), len(frequencies)])]


def test_a_free_cube_keeps_pairs_and_triples() -> None:
    placed = lattice(2, 2).place()
    dense, sparse = modes(placed, 36, method="dense"), modes(placed, 36, method="sparse")
    np.testing.assert_allclose(sparse.frequencies[6:], dense.frequencies[6:], rtol=1e-9)
    found = multiplicities(sparse.frequencies[6:])
    # representations of the cubic group have one, two or three dimensions; the last is cut
    assert set(found[:-1]) <= {1, 2, 3}
    assert found.count(3) >= 5
    assert found.count(2) >= 2
    np.testing.assert_allclose(sparse.effective_mass.sum(axis=0), sparse.total_mass, rtol=1e-9)


def test_copies_that_lanczos_missed_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first run is made to lose one of each group; the next ones bring them back."""
    placed = lattice(2, 2).place()
    expected = modes(placed, 20, method="sparse").frequencies
    inner = strutwork.fea.sparse_modes._lanczos
    runs = []

    def forgetful(*arguments):  # type: ignore[no-untyped-def]
        values, vectors = inner(*arguments)
        runs.append(len(values))
        if len(values) == 14:
            keep = np.r_[1:14]
            return values[keep], vectors[:, keep]
        return values, vectors

    monkeypatch.setattr(strutwork.fea.sparse_modes, "_lanczos", forgetful)
    found = modes(placed, 20, method="sparse").frequencies
    assert len(runs) > 3
    np.testing.assert_allclose(found[:19], expected[:19], rtol=1e-9)


def test_large_single_poses_are_solved_sparse_and_batches_dense() -> None:
    placed = lattice(3, 2).place()
    assert reduce_sparse(system_of(placed)).size > SPARSE_FROM
    assert modes(placed, 8).solver == ORDERED
    small = cantilever(elements=4)
    assert modes(small.place(), 3).solver == "dense"
    small.positions["tip"] = np.array([[0.5, 0, 0], [0.6, 0, 0]])
    assert modes(small.place(), 3).solver == "dense"
    # asked for, the sparse solver takes the poses one by one
    apart = modes(small.place(), 3, method="sparse")
    np.testing.assert_allclose(apart.frequencies, modes(small.place(), 3).frequencies, rtol=1e-9)


def test_rotations_without_mass_take_no_part() -> None:
    placed = lattice(2, 3, mass="lumped").place()
    dense, sparse = modes(placed, 30, method="dense"), modes(placed, 30, method="sparse")
    np.testing.assert_allclose(sparse.frequencies[6:], dense.frequencies[6:], rtol=1e-9)


def test_preload() -> None:
    placed = cantilever(rod(0.01), 2.0, elements=30).place()
    tension = axial_forces(solve(placed, [wrench("pull", "tip", 3000.0)]), "pull")
    dense, sparse = (modes(placed, 8, tension, method=m) for m in ("dense", "sparse"))  # type: ignore[arg-type]
    np.testing.assert_allclose(sparse.frequencies, dense.frequencies, rtol=1e-9)
    assert sparse.frequencies[0] > 1.5 * modes(placed, 1).frequencies[0]
    for method in ("dense", "sparse"):
        with pytest.raises(NumericalError, match="buckles"):
            modes(placed, 8, -tension, method=method)  # type: ignore[arg-type]


def test_rigid_body_modes_alone_need_no_iteration() -> None:
    found = modes(lattice(1, 3).place(), 4, method="sparse")
    assert found.solver == "kinematics"
    assert found.rigid_body_modes == 6
    assert np.all(found.frequencies == 0.0)
    assert len(found.frequencies) == 4


def test_more_modes_than_lanczos_is_good_for() -> None:
    placed = cantilever(elements=4).place()
    with pytest.raises(ModelError, match="too many for Lanczos"):
        modes(placed, 20, method="sparse")
    large = lattice(3, 2).place()
    everything = modes(large, SPARSE_FROM)
    assert everything.solver == "dense"
    assert len(everything.frequencies) == SPARSE_FROM


def test_bad_input_is_told_as_by_the_dense_method() -> None:
    with pytest.raises(ModelError, match="has no mass"):
        modes(oscillators((1e4, 0.0)).place(), 1, method="sparse")
    with pytest.raises(ModelError, match="free motion without mass"):
        modes(oscillators(*[(1e4, 1.0)] * 9, (0.0, 0.0)).place(), 1, method="sparse")
    model = cantilever()
    model.support("tip")
    with pytest.raises(ModelError, match="every direction is locked"):
        modes(model.place(), 1, method="sparse")


def test_a_stiffness_that_is_not_positive_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    # the package's name fea.modes is the function
    module = importlib.import_module("strutwork.fea.modes")
    inner = module.reduce_sparse

    def weakened(*arguments):  # type: ignore[no-untyped-def]
        found = inner(*arguments)
        return replace(found, stiffness=sp.csc_array(found.stiffness - 1e5 * found.mass))

    monkeypatch.setattr(module, "reduce_sparse", weakened)
    with pytest.raises((MechanismError, NumericalError), match="mechanism"):
        modes(cantilever(elements=20).place(), 3, method="sparse")


def test_an_inaccurate_mode_is_withheld(monkeypatch: pytest.MonkeyPatch) -> None:
    inner = strutwork.fea.sparse_modes._lanczos

    def rough(*arguments):  # type: ignore[no-untyped-def]
        values, vectors = inner(*arguments)
        return values, vectors * (1.0 + 1e-5 * np.arange(len(vectors)))[:, None]

    monkeypatch.setattr(strutwork.fea.sparse_modes, "_lanczos", rough)
    with pytest.raises(NumericalError, match=r"residual of the mode at .* withheld"):
        modes(cantilever(elements=20).place(), 3, method="sparse")


def laplacian(n: int) -> sp.csc_array:
    line = sp.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(n, n))
    one = sp.eye_array(n)
    return sp.csc_array(sp.kron(line, one) + sp.kron(one, line))


@pytest.mark.parametrize("ordering", ["METIS", "none"])
def test_factorisations_solve_and_tell_their_name(
    ordering: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if ordering == "none":
        monkeypatch.setattr(strutwork.fea.ordering, "pymetis", None)
    matrix = laplacian(12)
    factor = factorize(matrix, "superlu")
    assert factor.name == ("SuperLU" if ordering == "none" else "SuperLU ordered by METIS")
    assert factor.name in repr(factor)
    right = np.random.default_rng(0).normal(size=(144, 3))
    for one in (right, right[:, 0]):
        solution = factor.solve(one)
        assert solution.shape == one.shape
        np.testing.assert_allclose(matrix @ solution, one, atol=1e-12)
    assert factor.negative_pivots() == 0
    # 1.0 lies above so many eigenvalues of the Laplacian on a square, in closed form
    single = 2 - 2 * np.cos(np.pi * np.arange(1, 13) / 13)
    below = int(np.count_nonzero(single[:, None] + single < 1.0))
    shifted = factorize(sp.csc_array(matrix - 1.0 * sp.eye_array(144)), "superlu")
    assert shifted.negative_pivots() == below


def test_a_singular_matrix_is_an_error() -> None:
    with pytest.raises(NumericalError, match="singular"):
        factorize(sp.csc_array((5, 5)))


def test_without_metis_the_modes_are_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    placed = cantilever(BAR, elements=20).place()
    ordered = modes(placed, 6, method="sparse")
    monkeypatch.setattr(strutwork.fea.ordering, "pymetis", None)
    plain = modes(placed, 6, method="sparse")
    assert plain.solver == ORDERED.removesuffix(" ordered by METIS")
    np.testing.assert_allclose(plain.frequencies, ordered.frequencies, rtol=1e-10)
