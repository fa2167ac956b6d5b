"""Mass of beams, points and structures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.msa import (
    LoadCase,
    Material,
    PlacedStructure,
    PointMass,
    rectangle,
    rigid_map,
    rod,
    solve,
    system_of,
)
from strutwork.msa.mass import (
    local_mass,
    mass_contributions,
    mass_matrix,
    mass_properties,
    point_mass_matrix,
    sparse_mass,
)
from tests.structures import BAR, STEEL, Model, cantilever

Array = NDArray[np.float64]

L, RHO_A, RHO_IY, RHO_IZ = 0.7, 8.0, 0.3, 0.2
INERTIA = np.array([RHO_A, RHO_IY + RHO_IZ, RHO_IY, RHO_IZ])


def element(phi: float = 0.0, inertia: Array = INERTIA) -> Array:
    properties = np.array([1.0, 1.0, 1.0, 1.0, phi * L**2, 0.5 * phi * L**2])
    return local_mass(np.array(L), properties, inertia)


def test_consistent_mass_of_a_slender_beam() -> None:
    """ρAL/420 and ρI/30L, Przemieniecki 1968, eq. 11.31 and 11.33."""
    m = element()
    beam = (
        RHO_A
        * L
        / 420
        * np.array(
            [
                [156, 22 * L, 54, -13 * L],
                [22 * L, 4 * L**2, 13 * L, -3 * L**2],
                [54, 13 * L, 156, -22 * L],
                [-13 * L, -3 * L**2, -22 * L, 4 * L**2],
            ]
        )
    )
    turn = (1 / (30 * L)) * np.array(
        [
            [36, 3 * L, -36, 3 * L],
            [3 * L, 4 * L**2, -3 * L, -(L**2)],
            [-36, -3 * L, 36, -3 * L],
            [3 * L, -(L**2), -3 * L, 4 * L**2],
        ]
    )
    # four Gauss points are exact for products of cubics: rounding only
    np.testing.assert_allclose(
        m[np.ix_((1, 5, 7, 11), (1, 5, 7, 11))], beam + RHO_IZ * turn, rtol=1e-13
    )
    sign = np.outer((1, -1, 1, -1), (1, -1, 1, -1))
    np.testing.assert_allclose(
        m[np.ix_((2, 4, 8, 10), (2, 4, 8, 10))], (beam + RHO_IY * turn) * sign, rtol=1e-13
    )
    for first, value in ((0, RHO_A), (3, RHO_IY + RHO_IZ)):
        np.testing.assert_allclose(
            m[np.ix_((first, first + 6), (first, first + 6))],
            value * L / 6 * np.array([[2, 1], [1, 2]]),
        )


@pytest.mark.parametrize("phi", [0.0, 0.4, 30.0])
def test_rigid_motion_has_the_mass_of_the_rigid_body(phi: float) -> None:
    """Shape functions with any shear flexibility carry a rigid motion exactly."""
    m = element(phi)
    motion = np.concatenate(
        [rigid_map(np.array([-L / 2, 0, 0])), rigid_map(np.array([L / 2, 0, 0]))]
    )
    slender = RHO_A * L**3 / 12
    expected = np.diag(
        [
            RHO_A * L,
            RHO_A * L,
            RHO_A * L,
            (RHO_IY + RHO_IZ) * L,
            slender + RHO_IY * L,
            slender + RHO_IZ * L,
        ]
    )
    np.testing.assert_allclose(motion.T @ m @ motion, expected, atol=1e-14, rtol=1e-12)
    np.testing.assert_allclose(m, m.T)
    assert np.linalg.eigvalsh(m).min() > 0


def test_shear_flexibility_changes_the_shapes() -> None:
    """Φ → ∞ makes the deflection linear: ρAL/3 at an end, and no coupling with its turn."""
    m = element(1e9, np.array([RHO_A, 0.0, 0.0, 0.0]))
    assert m[1, 1] == pytest.approx(RHO_A * L / 3, rel=1e-8)
    assert m[1, 7] == pytest.approx(RHO_A * L / 6, rel=1e-8)


def test_lumped_mass_is_half_at_either_end() -> None:
    placed = cantilever(length=0.5, mass="lumped").place()
    (name, _, matrix), *_ = mass_contributions(system_of(placed))
    half = 7870.0 * BAR.area * 0.25
    np.testing.assert_allclose(matrix[0], np.diag([half] * 3 + [0.0] * 3 + [half] * 3 + [0.0] * 3))
    assert name == "beam beam"


def test_a_point_mass_off_its_node() -> None:
    """Parallel axes: I + m (d² 1 − d dᵀ), and the moment m d between force and rotation."""
    offset, inertia = np.array([0.1, -0.2, 0.3]), np.diag([1.0, 2.0, 2.5])
    m = point_mass_matrix(3.0, inertia, offset)
    moved = inertia + 3.0 * (offset @ offset * np.eye(3) - np.outer(offset, offset))
    np.testing.assert_allclose(m[3:, 3:], moved, rtol=1e-14)
    np.testing.assert_allclose(m[:3, :3], 3.0 * np.eye(3))
    acceleration = np.array([0.0, 0.0, 0.0, 0.4, 0.5, -0.6])
    # force = mass times the acceleration of the centre
    np.testing.assert_allclose(
        (m @ acceleration)[:3], 3.0 * np.cross(acceleration[3:], offset), rtol=1e-13
    )


def test_a_point_mass_turns_with_the_nodes_that_carry_its_axes() -> None:
    turns = Rotation.from_euler("zyx", [[0.0, 0.0, 0.0], [0.7, 0.2, -0.4]]).as_matrix()
    model = Model("o")
    corners = {"o": (0.0, 0, 0), "x": (0.3, 0, 0), "y": (0.1, 0.2, 0)}
    model.nodes(**{n: turns @ np.array(p) for n, p in corners.items()})
    model.rigid("body", "o", "x", "y")
    inertia, offset = ((0.2, 0.01, 0), (0.01, 0.3, 0.02), (0, 0.02, 0.4)), (0.02, 0.05, -0.03)
    model.masses.append(PointMass("o", 4.0, inertia, offset, axes=("o", "x", "y")))
    found = mass_properties(model.place())
    np.testing.assert_allclose(found.total, 4.0)
    for pose, turn in enumerate(turns):
        np.testing.assert_allclose(found.centre[pose], turn @ offset, atol=1e-15)
        np.testing.assert_allclose(
            found.inertia[pose], turn @ np.array(inertia) @ turn.T, atol=1e-14
        )


def test_the_weight_of_a_mass_acts_at_its_centre_in_every_pose() -> None:
    turns = Rotation.from_euler("zyx", [[0.0, 0.0, 0.0], [0.7, 0.2, -0.4]]).as_matrix()
    model = Model("o")
    corners = {"o": (0.0, 0, 0), "x": (0.3, 0, 0), "y": (0.1, 0.2, 0)}
    model.nodes(**{n: turns @ np.array(p) for n, p in corners.items()})
    model.ground(g=(0.0, 0.0, 0.0))
    model.rigid("body", "o", "x", "y")
    model.joint("mount", "bushing", ("g", "o"), stiffness=dict.fromkeys(DIRECTIONS, 1e6))
    offset, gravity = (0.02, 0.05, -0.03), (1.0, 2.0, -9.81)
    model.masses.append(PointMass("o", 4.0, offset=offset, axes=("o", "x", "y")))
    placed = model.place()
    found = solve(placed, [LoadCase("weight", gravity=gravity)])
    force = 4.0 * np.array(gravity)
    for pose, turn in enumerate(turns):
        moved = found.displacement("o", "weight")[pose]
        np.testing.assert_allclose(moved[:3], force / 1e6, rtol=1e-9)
        np.testing.assert_allclose(moved[3:], np.cross(turn @ offset, force) / 1e6, rtol=1e-9)


def two_beams_and_a_mass(mass: str = "consistent") -> Model:
    model = Model("b")
    model.nodes(a=(0, 0, 0), b=(0.6, 0, 0), c=(0.6, 0.4, 0))
    model.beam("ab", "a", "b", rod(0.02), elements=3, mass=mass)
    model.beam("bc", "b", "c", rectangle(0.02, 0.03), Material.isotropic(70e9, 0.3, density=2700.0))
    model.masses.append(PointMass("c", 1.5, offset=(0.0, 0.1, 0.2)))
    return model


@pytest.mark.parametrize("mass", ["consistent", "lumped"])
def test_mass_properties_by_hand(mass: str) -> None:
    found = mass_properties(two_beams_and_a_mass(mass).place())
    masses = np.array([7870.0 * rod(0.02).area * 0.6, 2700.0 * 6e-4 * 0.4, 1.5])
    centres = np.array([[0.3, 0, 0], [0.6, 0.2, 0], [0.6, 0.5, 0.2]])
    assert found.total == pytest.approx(masses.sum(), rel=1e-12)
    centre = masses @ centres / masses.sum()
    np.testing.assert_allclose(found.centre, centre, rtol=1e-12)
    # about x: the consistent rod turns with ρ Ip L, the bar as a slender one with ρ I L more
    arms = centres - centre
    about_x = masses @ (arms[:, 1] ** 2 + arms[:, 2] ** 2)
    polar = 7870.0 * 2 * rod(0.02).second_moment_y * 0.6 if mass == "consistent" else 0.0
    bar = rectangle(0.02, 0.03)
    side = (
        min(bar.second_moment_y, bar.second_moment_z),
        max(bar.second_moment_y, bar.second_moment_z),
    )
    # along y, local z is global z: of width 20 mm along x and height 30 mm along z
    about_x += polar + masses[1] * 0.4**2 / 12 + 2700.0 * side[1] * 0.4
    assert found.inertia[0, 0] == pytest.approx(about_x, rel=1e-10)


def test_mass_properties_are_sums_over_the_matrix_that_vibrates() -> None:
    placed = two_beams_and_a_mass().place()
    system = system_of(placed)
    found = mass_properties(placed)
    reference = placed.structure.reference_nodes
    motion = rigid_map(system.placed.positions[0, reference] - found.centre).reshape(-1, 6)
    for matrix in (mass_matrix(system)[0], sparse_mass(system).toarray()):
        total = motion.T @ matrix @ motion
        np.testing.assert_allclose(np.diag(total)[:3], found.total, rtol=1e-12)
        np.testing.assert_allclose(total[3:, 3:], found.inertia, rtol=1e-10, atol=1e-14)
        np.testing.assert_allclose(total[:3, 3:], 0.0, atol=1e-12)


def test_what_stands_on_ground_counts_in_the_total() -> None:
    model = Model("tip")
    model.ground(root=(0, 0, 0))
    model.nodes(tip=(0.5, 0, 0))
    model.joint("weld", "fixed", ("root", "heel"))
    model.beam("beam", "heel", "tip", BAR)
    assert mass_properties(model.place()).total == pytest.approx(7870.0 * BAR.area * 0.5)


def test_offsets_carry_the_mass_with_the_beam() -> None:
    model = Model("b")
    model.nodes(a=(0, 0, 0), b=(0.5, 0, 0))
    shift = (0.0, 0.1, 0.0)
    model.beam("ab", "a", "b", BAR, offsets=(shift, shift))
    found = mass_properties(model.place())
    np.testing.assert_allclose(found.centre, [0.25, 0.1, 0.0], atol=1e-12)


@dataclass(frozen=True)
class Plate:
    """An element of another kind, with mass."""

    name: str = "plate"
    nodes: tuple[str, ...] = ("a", "b")

    def stiffness(self, at: PlacedStructure) -> Array:
        del at
        return np.zeros((1, 12, 12))

    def mass(self, at: PlacedStructure) -> Array:
        del at
        return np.eye(12)[None] * np.tile(np.repeat([2.0, 0.0], 3), 2)


def test_elements_bring_their_mass() -> None:
    model = cantilever()
    model.nodes(a=(0, 0, 0), b=(1.0, 0, 0))
    model.rigid("plate", "a", "b")
    structure = model.structure()
    with_plate = type(structure)(
        structure.linkage, structure.beams, (), structure.rigid, (), (Plate(),)
    )
    placed = with_plate.at(model.placement())
    alone = mass_properties(model.place()).total
    assert mass_properties(placed).total == pytest.approx(alone + 4.0)


def test_mass_needs_a_density() -> None:
    model = cantilever(material=Material.isotropic(70e9, 0.3, name="foam"))
    with pytest.raises(ModelError, match="has no density") as caught:
        mass_properties(model.place())
    assert caught.value.part == "material foam"


def test_a_structure_without_mass_says_so() -> None:
    model = Model("a")
    model.nodes(a=(0, 0, 0))
    model.support("a")
    with pytest.raises(ModelError, match="has no mass"):
        mass_properties(model.place())


def test_repr_tells_the_total() -> None:
    placed = two_beams_and_a_mass().place()
    assert "kg" in repr(mass_properties(placed))
    assert STEEL.density == 7870.0
