"""Groups of constraint rows, beside SciPy's connected components and dense rows."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from strutwork.machines.load import load
from strutwork.msa.assembly import system_of
from strutwork.msa.constraints import scales
from strutwork.msa.row_groups import UnitRows, _components, row_groups, unit_rows

FILES = ["machines/6-ups", "machines/3-rps", "04_four_bar", "06_table_on_two_rails"]
FILES += ["10_screws_and_belt"]


@pytest.mark.parametrize("name", FILES)
def test_rows_are_those_of_the_dense_matrix(name: str) -> None:
    system = system_of(load(f"examples/{name}.toml").placed)
    d = scales(system)[0]
    rows = unit_rows(system, d)
    scaled = system.rows[0] * d
    size = np.linalg.norm(scaled, axis=1)
    size[size == 0] = 1.0
    dense = np.zeros_like(scaled)
    dense[rows.row, rows.column] = rows.value
    np.testing.assert_allclose(dense, scaled / size[:, None], atol=1e-15)
    np.testing.assert_allclose(rows.size, size, rtol=1e-14)
    every = np.zeros_like(dense)
    for own, block, columns in row_groups(rows):
        every[np.ix_(own, columns)] += block
    np.testing.assert_array_equal(every, dense)


@pytest.mark.parametrize("seed", range(20))
def test_groups_are_connected_components(seed: int) -> None:
    random = np.random.default_rng(seed)
    count, edges = 60, int(random.integers(0, 90))
    first, second = random.integers(0, count, (2, edges))
    links = sp.coo_array((np.ones(edges), (first, second)), shape=(count, count))
    parts, label = connected_components(links, directed=False)
    found = _components(count, first, second)
    least = np.array([np.flatnonzero(label == k)[0] for k in range(parts)])
    np.testing.assert_array_equal(found, least[label])


def test_a_long_chain_is_one_group_and_a_row_of_zeros_one_of_its_own() -> None:
    count = 3000
    order = np.random.default_rng(1).permutation(count + 1)
    row = np.repeat(np.arange(count), 2)
    column = np.stack([order[:-1], order[1:]], axis=1).ravel()
    rows = UnitRows(row, column, np.ones(2 * count), np.ones(count + 1))
    chain, empty = row_groups(rows)
    assert chain[1].shape == (count, count + 1)
    assert empty[0].tolist() == [count]
    assert empty[1].shape == (1, 0)


def test_no_rows_are_no_groups() -> None:
    none = np.zeros(0, dtype=np.intp)
    assert list(row_groups(UnitRows(none, none, np.zeros(0), np.zeros(0)))) == []
