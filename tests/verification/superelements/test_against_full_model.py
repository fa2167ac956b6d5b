"""Superelements against the solid they were made of.

@article{CraigBampton1968,
  author = {Craig, Roy R. and Bampton, Mervyn C. C.},
  title = {Coupling of Substructures for Dynamic Analyses},
  journal = {AIAA Journal}, volume = {6}, number = {7}, pages = {1313--1319}, year = {1968}}

@article{Rubin1975,
  author = {Rubin, Sheldon},
  title = {Improved Component-Mode Representation for Structural Dynamic Analysis},
  journal = {AIAA Journal}, volume = {13}, number = {8}, pages = {995--1006}, year = {1975}}

The reference is our own full model, so the reduction alone is tested. Statics are exact but for
rounding; frequencies below half of the highest retained fixed-interface frequency hold to 1e-4,
the accuracy that the reduction promises.
"""

from functools import cache

import numpy as np
import pytest
import scipy.linalg as sla
from scipy.spatial.transform import Rotation

from strutwork.errors import ModelError
from strutwork.fea import modes
from strutwork.fea.interface import Interface
from strutwork.fea.reduce_solid import tied
from strutwork.fea.solid import Solid
from strutwork.fea.solid_matrices import solid_matrices
from strutwork.fea.superelement import Superelement, superelement
from strutwork.fea.tied_solid import TiedSolid
from strutwork.kinematics import DIRECTIONS, GROUND, Body, Joint, Linkage, Placement
from strutwork.meshes import block
from strutwork.msa import LoadCase, PlacedStructure, PointMass, Structure, solve, tool_compliance
from strutwork.msa.mass import mass_properties
from strutwork.msa.materials import Material

ALUMINIUM = Material.isotropic(70e9, 0.3, density=2700.0, name="aluminium")
MOUNT = {d: 1e8 if d in "xyz" else 1e6 for d in DIRECTIONS}
SPREAD = 5.0


@cache
def solid(kind: str) -> Solid:
    divisions = (2, 3, 8) if kind == "hexahedra" else (4, 5, 14)
    return Solid(
        block((0.2, 0.3, 1.0), divisions),
        {"solid": ALUMINIUM},
        order=2 if kind == "hexahedra" else 1,
        name="column",
    )


@cache
def whole(kind: str) -> TiedSolid:
    return tied(solid(kind), [Interface("foot", "-z"), Interface("head", "+z", kind="rigid")])


@cache
def reduced(kind: str, method: str = "craig_bampton") -> Superelement:
    return superelement(whole(kind), solid(kind).cells, modes=18, method=method)  # type: ignore[arg-type]


def mounted(element: Superelement, turn: np.ndarray) -> PlacedStructure:
    """On an elastic mount at its foot, a mass on its head, turned in space."""
    linkage = Linkage(
        (*element.nodes, "ground"),
        (Body("column", element.nodes), Body(GROUND, ("ground",))),
        (Joint("mount", "bushing", ("ground", "foot"), stiffness=MOUNT),),
        "head",
    )
    positions = np.vstack([element.positions, element.positions[0]]) @ turn.T
    structure = Structure(linkage, elements=(element,), masses=(PointMass("head", SPREAD),))
    return structure.at(Placement(positions, turn[None], np.zeros(0)))


def full(kind: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Stiffness and mass of the mounted full model, dense, and its ports."""
    model = whole(kind)
    ports = model.ports.toarray()
    stiffness = model.stiffness.toarray()
    stiffness += ports[:, :6] @ np.diag(list(MOUNT.values())) @ ports[:, :6].T
    mass = model.mass.toarray()
    mass += ports[:, 6:] @ np.diag([SPREAD] * 3 + [0.0] * 3) @ ports[:, 6:].T
    return stiffness, mass, ports


@pytest.mark.parametrize("kind", ["hexahedra", "linear"])
@pytest.mark.parametrize("method", ["craig_bampton", "krylov"])
def test_statics_are_exact(kind: str, method: str) -> None:
    stiffness, _, ports = full(kind)
    expected = ports[:, 6:].T @ np.linalg.solve(stiffness, ports[:, 6:])
    placed = mounted(reduced(kind, method), np.eye(3))
    got = tool_compliance(placed)
    # rounding of two solutions with condition numbers near 1e8
    np.testing.assert_allclose(got, expected, atol=1e-8 * np.abs(expected).max())


@pytest.mark.parametrize("kind", ["hexahedra", "linear"])
def test_frequencies_below_half_the_cutoff(kind: str) -> None:
    stiffness, mass, _ = full(kind)
    element = reduced(kind)
    values = sla.eigh(stiffness, mass, eigvals_only=True, subset_by_index=[0, 19])
    expected = np.sqrt(values) / (2 * np.pi)
    below = expected[expected < element.cutoff / 2]
    assert len(below) >= 10
    placed = mounted(element, np.eye(3))
    got = modes(placed, len(below)).frequencies
    np.testing.assert_allclose(got, below, rtol=1e-4)
    # a reduction restrains: no frequency comes out lower
    assert np.all(got >= below * (1 - 1e-7))


def test_krylov_is_exact_at_low_frequency() -> None:
    stiffness, mass, _ = full("hexahedra")
    values = sla.eigh(stiffness, mass, eigvals_only=True, subset_by_index=[0, 5])
    got = modes(mounted(reduced("hexahedra", "krylov"), np.eye(3)), 6).frequencies
    np.testing.assert_allclose(got, np.sqrt(values) / (2 * np.pi), rtol=1e-6)


def test_turned_in_space() -> None:
    element = reduced("hexahedra")
    turn = Rotation.from_rotvec([0.4, -1.1, 0.8]).as_matrix()
    first, second = mounted(element, np.eye(3)), mounted(element, turn)
    # rounding of the turned matrices beside the softest motion, ten orders below the stiffest
    np.testing.assert_allclose(modes(second, 8).frequencies, modes(first, 8).frequencies, rtol=1e-6)
    blocks = np.kron(np.eye(2), turn)
    np.testing.assert_allclose(
        tool_compliance(second),
        blocks @ tool_compliance(first) @ blocks.T,
        atol=1e-7 * np.abs(tool_compliance(first)).max(),
    )


def test_rigid_motion_costs_nothing_and_mass_adds_up() -> None:
    element = reduced("hexahedra")
    placed = mounted(element, np.eye(3))
    found = mass_properties(placed)
    column = 0.2 * 0.3 * 1.0 * 2700.0
    np.testing.assert_allclose(found.total, column + SPREAD, rtol=1e-10)
    height = (column * 0.5 + SPREAD * 1.0) / (column + SPREAD)
    np.testing.assert_allclose(found.centre, [0.1, 0.15, height], rtol=1e-9)


def test_gravity_weighs_the_whole_solid() -> None:
    placed = mounted(reduced("hexahedra"), np.eye(3))
    solution = solve(placed, [LoadCase("gravity", gravity=(0.0, 0.0, -9.81))])
    weight = 9.81 * (0.2 * 0.3 * 1.0 * 2700.0 + SPREAD)
    np.testing.assert_allclose(
        solution.joint_force("mount", "gravity"), [0, 0, weight, 0, 0, 0], atol=1e-6 * weight
    )


def test_nodes_that_stand_elsewhere_are_refused() -> None:
    element = reduced("hexahedra")
    placed = mounted(element, np.eye(3))
    moved = placed.placement.positions.copy()
    moved[1, 0] += 1e-3
    aside = placed.structure.at(Placement(moved, placed.placement.frames, np.zeros(0)))
    with pytest.raises(ModelError, match="superelement column: its nodes are"):
        element.stiffness(aside)


def test_too_many_modes_are_refused() -> None:
    mesh = block((1, 1, 1), (1, 1, 1))
    small = Solid(mesh, {"solid": ALUMINIUM}, order=1)
    with pytest.raises(ModelError, match="12 modes are too many"):
        superelement(tied(small, [Interface("a", "-x")]), small.cells)


def test_average_interface_is_as_soft_as_a_spread_load() -> None:
    """RBE3 against a distributed load: the mean displacement under a uniform traction."""
    model = tied(solid("hexahedra"), [Interface("head", "+z")], fixed=["-z"])
    ports = model.ports.toarray()
    compliance = ports.T @ np.linalg.solve(model.stiffness.toarray(), ports)
    nodes, areas = model.patches[0].nodes, np.zeros(len(model.points))
    # uniform traction along y of unit resultant on the head, written by hand
    found, area = solid_matrices(solid("hexahedra")).patch("+z")
    areas[found] = area
    load = np.zeros((len(model.points), 3))
    load[:, 1] = areas / areas.sum()
    right = model.recovery.T @ load.ravel()
    moved = np.linalg.solve(model.stiffness.toarray(), right)
    mean = (model.recovery @ moved).reshape(-1, 3)[nodes, 1] @ areas[nodes] / areas.sum()
    # the same load and the same reading: rounding alone
    np.testing.assert_allclose(compliance[1, 1], mean, rtol=1e-8)
    # a rigid head is stiffer
    rigid = tied(solid("hexahedra"), [Interface("head", "+z", kind="rigid")], fixed=["-z"])
    hard = rigid.ports.toarray()
    stiffer = hard.T @ np.linalg.solve(rigid.stiffness.toarray(), hard)
    assert stiffer[1, 1] < compliance[1, 1]
