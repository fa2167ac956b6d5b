"""Properties that hold for every structure and every damping."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.fea import (
    LossFactor,
    ModalRatio,
    Port,
    Rayleigh,
    frequency_response,
    minimum_dynamic_stiffness,
    modes,
)
from strutwork.fea.damping import Damping
from strutwork.fea.eigen import solve_eigen
from strutwork.fea.modes import lowest
from strutwork.fea.reduction import reduce_system
from strutwork.msa import PlacedStructure, PointMass, system_of
from strutwork.msa.constraints import scales
from tests.structure_cases import LIBRARY
from tests.structures import BAR, TUBE, Model
from tests.vibration import BODY, heavy, saddle_point_frequencies, saddle_point_matrices

Array = NDArray[Any]

# structures whose tool moves along every axis
MOVING = [
    "cantilever",
    "offset bracket",
    "portal frame",
    "four-bar, flexible",
    "hexapod",
    "hexapod, spinning struts",
    "hexapod, rigid struts",
    "three-legged frame",
    "serial arm",
    "tripod machine",
    "elastic table",
    "block on bushings",
    "floating frame",
    "beam on springs",
    "two rods, spherical",
]
names = st.sampled_from(MOVING)
dampings = st.one_of(
    st.builds(ModalRatio, st.floats(1e-3, 0.5)),
    st.builds(LossFactor, st.floats(1e-3, 0.8)),
    st.builds(Rayleigh, st.floats(0.1, 10.0), st.floats(0.0, 1e-9)),
)
lines = st.lists(st.floats(0.5, 2000.0), min_size=1, max_size=3)
turns = st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1)


def first_pose(name: str) -> PlacedStructure:
    placed = heavy(name).place()
    return placed[(0,) * len(placed.batch)]


def tool_ports(placed: PlacedStructure, directions: str = "xyz") -> list[Port]:
    tool = placed.structure.linkage.tool
    assert tool is not None
    return [Port(tool, d) for d in directions]


@settings(max_examples=25)
@given(name=st.sampled_from(sorted(LIBRARY)), count=st.integers(1, 20))
def test_modes_are_orthogonal(name: str, count: int) -> None:
    """φᵀ M φ = 1 and φᵀ K φ = ω² of the lowest modes."""
    reduced = reduce_system(system_of(heavy(name).place()))
    eigen = solve_eigen(reduced)
    frequencies, phi = lowest(eigen, count)
    there = np.isfinite(frequencies)
    mass = np.swapaxes(phi, -1, -2) @ reduced.mass @ phi
    identity = np.eye(count) * there[:, None, :]
    assert np.abs(mass - identity).max() < 1e-8
    squares = np.where(there, 2 * np.pi * frequencies, 0.0) ** 2
    stiffness = np.swapaxes(phi, -1, -2) @ reduced.stiffness @ phi
    # the stiffness is rounded beside the highest frequency of the structure
    highest = 1.0 / eigen.square[eigen.finite].min(initial=1.0)
    gap = stiffness - squares[:, :, None] * np.eye(count)
    assert np.abs(gap).max() < 1e-8 * squares.max() + 1e-12 * highest


@settings(max_examples=25)
@given(name=names, damping=dampings, at=lines)
def test_receptances_are_reciprocal_and_the_two_methods_agree(
    name: str, damping: Damping, at: list[float]
) -> None:
    placed = first_pose(name)
    ports = tool_ports(placed)
    direct, modal = (
        frequency_response(placed, ports, ports, at, damping, method).receptance
        for method in ("direct", "all_modes")
    )
    size = np.abs(modal).max(axis=(-1, -2), keepdims=True)
    assert (np.abs(direct - np.swapaxes(direct, -1, -2)) / size).max() < 1e-8
    assert (np.abs(direct - modal) / size).max() < 1e-8


@settings(max_examples=20)
@given(name=names, eta=st.floats(1e-3, 0.8), line=st.floats(0.5, 2000.0))
def test_null_space_equals_saddle_point(name: str, eta: float, line: float) -> None:
    """H from the complex system with multipliers, which shares no coordinate with ours."""
    placed = first_pose(name)
    tool = placed.structure.linkage.tool
    assert tool is not None
    node = placed.structure.mesh_index[tool]
    vertex = placed.structure.vertex_of_node[node]
    # the tool stands for its cluster
    assert not np.any(placed.arms[node])
    k, m, rows = saddle_point_matrices(placed)
    assert np.all(scales(system_of(placed))[0, 6 * vertex + np.arange(3)] == 1.0)
    load = np.zeros((len(k) + len(rows), 3))
    load[6 * vertex + np.arange(3), np.arange(3)] = 1.0
    size = np.abs(k).max()
    z = (k * (1 + 1j * eta) - (2 * np.pi * line) ** 2 * m) / size
    matrix = np.block([[z, rows.T], [rows, np.zeros((len(rows),) * 2)]])
    expected = load.T @ np.linalg.solve(matrix, load.astype(complex)) / size
    ports = tool_ports(placed)
    found = frequency_response(placed, ports, ports, [line], LossFactor(eta), "all_modes")
    assert np.abs(found.receptance[0] - expected).max() < 1e-8 * np.abs(expected).max()


@pytest.mark.parametrize("name", LIBRARY)
def test_frequencies_are_those_of_the_saddle_point_pencil(name: str) -> None:
    placed = first_pose(name)
    found = modes(placed, 8)
    rigid = int(found.rigid_body_modes)
    expected = saddle_point_frequencies(placed)[: len(found.frequencies)]
    # a rigid-body mode is a square root of rounding in the pencil
    assert np.all(expected[:rigid] < 1e-3 * found.frequencies[rigid:].max(initial=1e3))
    np.testing.assert_allclose(found.frequencies[rigid:], expected[rigid:], rtol=1e-6)


@settings(max_examples=25)
@given(name=names, damping=dampings, low=st.floats(0.5, 300.0), width=st.floats(1.0, 600.0))
def test_the_minimum_lies_between_its_bounds_and_below_any_line(
    name: str, damping: Damping, low: float, width: float
) -> None:
    placed = first_pose(name)
    ports = tool_ports(placed)
    found = minimum_dynamic_stiffness(placed, ports, damping, (low, low + width))
    assert np.all(found.lower <= found.value * (1 + 1e-9))
    assert np.all(found.value <= found.upper * (1 + 1e-9))
    assert found.certified.all()
    at = np.linspace(low, low + width, 301)
    h = frequency_response(placed, ports, ports, at, damping, "all_modes").receptance
    grid = (1 / np.abs(np.einsum("fii->fi", h))).min(axis=0)
    assert np.all(found.value <= grid * (1 + 1e-8))


@settings(max_examples=15)
@given(
    lengths=st.lists(st.floats(0.1, 0.8), min_size=2, max_size=4),
    mass=st.floats(0.01, 50.0),
    offset=st.tuples(*[st.floats(-0.3, 0.3)] * 3),
)
def test_effective_masses_of_a_free_frame_sum_to_its_mass(
    lengths: list[float], mass: float, offset: tuple[float, float, float]
) -> None:
    model = Model("n0")
    model.nodes(n0=(0, 0, 0))
    at = np.zeros(3)
    for i, length in enumerate(lengths, 1):
        at = at + length * np.roll([1.0, 0.3, 0.1], i)
        model.nodes(**{f"n{i}": at})
        model.beam(f"b{i}", f"n{i - 1}", f"n{i}", BAR, orientation=(1.0, 2.0, 3.0))
    model.masses.append(PointMass("n0", mass, BODY, offset))
    found = modes(model.place(), 1000)
    assert found.rigid_body_modes == 6
    np.testing.assert_allclose(found.effective_mass.sum(axis=0), found.total_mass, rtol=1e-8)
    expected = mass + 7870.0 * BAR.area * sum(lengths) * np.sqrt(1.1)
    np.testing.assert_allclose(found.total_mass[:3], expected, rtol=1e-10)


TURNING = [
    "cantilever",
    "offset bracket",
    "portal frame",
    "hexapod",
    "serial arm",
    "tripod machine",
]


@settings(max_examples=20)
@given(name=st.sampled_from(TURNING), turn=turns, damping=dampings, at=lines)
def test_modes_and_responses_do_not_depend_on_the_frame(
    name: str, turn: tuple[float, ...], damping: Damping, at: list[float]
) -> None:
    rotation = Rotation.from_quat(turn).as_matrix()
    model = heavy(name)
    here, there = (m.place() for m in (model, model.turned(rotation, (3.0, -1.0, 2.0))))
    first, second = modes(here, 6), modes(there, 6)
    np.testing.assert_allclose(second.frequencies, first.frequencies, rtol=1e-8)
    np.testing.assert_allclose(
        second.effective_mass[..., :3].sum(-1), first.effective_mass[..., :3].sum(-1), atol=1e-6
    )
    tool = here.structure.linkage.tool
    assert tool is not None

    def response(placed: PlacedStructure, axes: Array) -> Array:
        ports = [Port(tool, (*map(float, axis), 0.0, 0.0, 0.0)) for axis in axes]
        return frequency_response(placed, ports, ports, at, damping, "all_modes").receptance

    expected, found = response(here, np.eye(3)), response(there, rotation.T)
    size = np.abs(expected).max(axis=(-1, -2), keepdims=True)
    assert (np.abs(found - expected) / size).max() < 1e-7


def tripod(radius: float, height: float, spin: float, lean: float) -> Model:
    """Three equal flexible legs about z, anywhere around it."""
    model = Model("tool")
    model.nodes(tool=(0, 0, height))
    for i in range(3):
        angle = spin + 2 * np.pi * i / 3
        out = np.array([np.cos(angle), np.sin(angle), 0.0])
        side = np.array([-np.sin(angle), np.cos(angle), 0.0])
        foot, top = radius * out, lean * radius * out + height * np.array([0.0, 0.0, 1.0])
        model.ground(**{f"base{i}": foot})
        model.nodes(**{f"plate{i}": top})
        model.joint(f"R{i}", "revolute", (f"base{i}", f"foot{i}"), side, stiffness={"rz": 2e4})
        model.joint(f"S{i}", "spherical", (f"head{i}", f"plate{i}"), stiffness={"z": 3e7})
        model.beam(f"leg{i}", f"foot{i}", f"head{i}", TUBE, elements=2, orientation=tuple(side))
    model.rigid("platform", "tool", *(f"plate{i}" for i in range(3)))
    disc = ((0.02, 0.0, 0.0), (0.0, 0.02, 0.0), (0.0, 0.0, 0.03))
    model.masses.append(PointMass("tool", 4.0, disc, (0.0, 0.0, 0.05)))
    return model


@settings(max_examples=20)
@given(
    radius=st.floats(0.2, 0.6),
    height=st.floats(0.3, 0.9),
    spin=st.floats(-np.pi, np.pi),
    lean=st.floats(0.2, 0.8),
    ratio=st.floats(0.005, 0.2),
)
def test_three_equal_legs_are_alike_along_x_and_y(
    radius: float, height: float, spin: float, lean: float, ratio: float
) -> None:
    placed = tripod(radius, height, spin, lean).place()
    ports = [Port("tool", d) for d in "xyz"]
    least = minimum_dynamic_stiffness(placed, ports, ModalRatio(ratio), (0.0, 1000.0))
    np.testing.assert_allclose(least.value[0], least.value[1], rtol=1e-6)
    np.testing.assert_allclose(least.static[0], least.static[1], rtol=1e-6)
    at = [5.0, 40.0, 170.0]
    h = frequency_response(placed, ports, ports, at, ModalRatio(ratio), "all_modes").receptance
    size = np.abs(h).max(axis=(1, 2))
    assert (np.abs(h[:, 0, 0] - h[:, 1, 1]) / size).max() < 1e-6
    # and neither axis knows of another
    for i, j in ((0, 1), (0, 2), (1, 2)):
        assert (np.abs(h[:, i, j]) / size).max() < 1e-6
