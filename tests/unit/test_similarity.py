"""Structures scaled part by part, against the same structures built larger."""

from __future__ import annotations

from dataclasses import replace
from math import nan

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea import PartDamping, complex_modes, modes
from strutwork.fea.interface import Interface
from strutwork.fea.reduce_solid import tied
from strutwork.fea.solid import Solid
from strutwork.fea.solid_matrices import solid_matrices
from strutwork.fea.superelement import Superelement, superelement
from strutwork.kinematics import DIRECTIONS, GROUND, Body, Joint, Linkage, Placement
from strutwork.machines import MitSS1
from strutwork.machines.model_file import parse_model
from strutwork.machines.model_solid_element import SolidElement
from strutwork.machines.model_templates import template
from strutwork.meshes import block
from strutwork.msa import (
    Beam,
    PlacedStructure,
    PointMass,
    Section,
    Structure,
    rectangle,
    tool_compliance,
)
from strutwork.msa.materials import Material
from strutwork.studies.similarity import ROLLERS, SIMILAR, UNSCALED, JointScaling, scaled
from tests.structures import STEEL, Model, cantilever

STONE = Material.isotropic(78e9, 0.25, 3000.0, name="stone")


def everything() -> PlacedStructure:
    """A beam with offsets on a bushing, a spring, a mass, joints with limits and damping."""
    model = Model("tip")
    model.nodes(root=(0, 0, 0), tip=(0.6, 0.1, 0.2))
    section = Section(1e-3, 2e-7, 3e-7, 4e-7, shear_areas=(8e-4, 7e-4), outline=(0.03, 0.04))
    offsets = ((0.0, 0.0, 0.02), (0.01, 0.0, 0.0))
    model.beam("beam", "root", "tip", section, offsets=offsets, elements=2)
    model.ground(foot=(0, 0, 0))
    root = np.tril(np.ones((6, 6))) + 6 * np.eye(6)
    matrix = tuple(tuple(row) for row in (1e6 * (root @ root.T)).tolist())
    model.joint("seat", "bushing", ("foot", "root"), matrix=matrix, damping={"x": 3.0, "ry": 5.0})
    model.support(
        "tip", "x", stiffness={"y": 1e5, "rz": 1e3}, limits={"z": (-0.1, 0.2), "rx": (-1.0, 1.0)}
    )
    placed = model.place()
    mass = PointMass("tip", 3.0, ((2.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 0.0, 2.0)), (0.1, 0, 0))
    return replace(placed.structure, masses=(mass,)).at(placed.placement)


def test_every_length_area_moment_and_mass_by_its_power() -> None:
    there = scaled(everything(), 2.0).structure
    beam, mass = there.beams[0], there.masses[0]
    section = beam.section
    assert (section.area, section.second_moment_y, section.second_moment_z) == (4e-3, 32e-7, 48e-7)
    assert (section.torsion_constant, section.shear_areas) == (64e-7, (32e-4, 28e-4))
    assert section.outline == (0.06, 0.08)
    assert beam.offsets == ((0.0, 0.0, 0.04), (0.02, 0.0, 0.0))
    assert (mass.mass, mass.inertia[1][1], mass.offset) == (24.0, 64.0, (0.2, 0.0, 0.0))


def test_joints_follow_their_law() -> None:
    here = everything().structure.linkage
    for law, power in ((SIMILAR, (1, 3)), (ROLLERS, (0.8, 2.8)), (UNSCALED, (0, 0))):
        there = scaled(everything(), 2.0, law).structure.linkage
        support = there.joints[there.joint_index["support tip"]]
        assert support.stiffness == pytest.approx(
            {"y": 1e5 * 2 ** power[0], "rz": 1e3 * 2 ** power[1]}
        )
        assert support.limits == {"z": (-0.2, 0.4), "rx": (-1.0, 1.0)}
        seat = there.joints[there.joint_index["seat"]]
        ratio = seat.stiffness_matrix / here.joints[here.joint_index["seat"]].stiffness_matrix
        assert ratio[:3, :3] == pytest.approx(np.full((3, 3), 2 ** power[0]))
        assert ratio[:3, 3:] == pytest.approx(np.full((3, 3), 2 ** (sum(power) / 2)))
        assert ratio[3:, 3:] == pytest.approx(np.full((3, 3), 2 ** power[1]))
    assert UNSCALED.damping_exponents.tolist() == [0.0] * 6
    assert SIMILAR.damping_exponents.tolist() == [2.0] * 3 + [4.0] * 3
    assert str(JointScaling(0.5)) == "k ~ L^0.5, rotational L^2.5"


def test_a_larger_machine_is_the_machine_with_larger_dimensions() -> None:
    small, size = MitSS1(guide_stiffness=4e8), 1.7
    larger = MitSS1(
        guide_distances=tuple(size * w for w in small.guide_distances),  # type: ignore[arg-type]
        strut_lengths=tuple(size * w for w in small.strut_lengths),  # type: ignore[arg-type]
        joint_height=size * small.joint_height,
        joint_radius=size * small.joint_radius,
        joint_rise=size * small.joint_rise,
        pin_width=size * small.pin_width,
        radial_stiffness=size * 285e6,
        axial_stiffness=size * 19.1e6,
        guide_stiffness=size * 4e8,
        section=rectangle(size * 0.030, size * 0.160),
        housing_mass=size**3 * small.housing_mass,
        housing_inertia=size**5 * small.housing_inertia,
        strut_mass=size**3 * small.strut_mass,
    )
    x, z, b = np.array([0.0, 0.03]), np.array([0.0, -0.02]), np.array([0.0, 0.3])
    ours = scaled(small.structure.at(small.place(small.poses(x, z, b))), size)
    built = larger.structure.at(larger.place(larger.poses(size * x, size * z, b)))
    assert ours.placement.positions == pytest.approx(built.placement.positions, abs=1e-14)
    # strokes grow, angles stay
    assert ours.placement.values == pytest.approx(built.placement.values, rel=1e-12)
    assert tool_compliance(ours) == pytest.approx(tool_compliance(built), rel=1e-9, abs=1e-20)
    assert modes(ours, 6).frequencies == pytest.approx(modes(built, 6).frequencies, rel=1e-10)


def test_damping_keeps_its_share() -> None:
    model = cantilever(elements=2)
    model.joints[0] = replace(model.joints[0], stiffness={"rz": 4e4}, damping={"rz": 30.0})
    here = model.place()
    one, other = (complex_modes(p, PartDamping(), 2) for p in (here, scaled(here, 3.0)))
    assert np.max(one.damping_ratios) > 1e-3
    assert other.damping_ratios == pytest.approx(one.damping_ratios, rel=1e-8)


def column(size: float) -> Superelement:
    mesh = block((0.2, 0.3, 1.0), (2, 2, 5))
    x, y, z = mesh.points.T
    # no symmetry: else rounding would choose between mirrored places of its monitors
    points = np.stack([x * (1 + 0.2 * z), y * (1 - 0.3 * z) + 0.4 * x * x, z], axis=-1)
    solid = Solid(replace(mesh, points=size * points), {"solid": STONE}, 1, "column")
    ties = [Interface("foot", "-z"), Interface("head", "+z", kind="rigid")]
    return superelement(tied(solid, ties), solid.cells, modes=12)


def mounted(element: Superelement, stiffness: float) -> PlacedStructure:
    mount = {d: stiffness if d in "xyz" else 0.04 * stiffness for d in DIRECTIONS}
    linkage = Linkage(
        (*element.nodes, "ground"),
        (Body("column", element.nodes), Body(GROUND, ("ground",))),
        (Joint("mount", "bushing", ("ground", "foot"), stiffness=mount),),
        "head",
    )
    positions = np.vstack([element.positions, element.positions[0]])
    structure = Structure(linkage, elements=(element,))
    return structure.at(Placement(positions, np.eye(3)[None], np.zeros(0)))


def test_a_solid_of_the_same_mesh() -> None:
    mesh, size = block((0.2, 0.3, 1.0), (2, 2, 5)), 2.5
    one, other = (
        solid_matrices(Solid(replace(mesh, points=s * mesh.points), {"solid": STONE}, 1, "column"))
        for s in (1.0, size)
    )
    # exact but for rounding
    gap = abs(other.stiffness - size * one.stiffness).max()
    assert gap < 1e-12 * abs(other.stiffness).max()
    gap = abs(other.mass - size**3 * one.mass).max()
    assert gap < 1e-12 * abs(other.mass).max()


def test_a_superelement_scaled_is_that_of_the_larger_solid() -> None:
    size, factors = 2.5, [1.0] * 3 + [2.5] * 3
    grown, reduced = column(1.0).scaled(size), column(size)
    assert grown.positions == pytest.approx(reduced.positions, abs=1e-12)
    assert grown.fixed_frequencies == pytest.approx(reduced.fixed_frequencies, rel=1e-9)
    # as displacements at the solid's size, of the largest
    scale = np.tile(factors, len(grown.nodes))
    pairs = np.outer(scale, scale)
    for a, b in (
        (grown.local_stiffness, reduced.local_stiffness),
        (grown.local_mass, reduced.local_mass),
    ):
        assert np.abs((a - b) / pairs).max() < 1e-8 * np.abs(b / pairs).max()
    assert np.abs((grown.shapes - reduced.shapes) / scale).max() < 1e-8
    ours = scaled(mounted(column(1.0), 1e8), size)
    theirs = mounted(reduced, size * 1e8)
    theirs = replace(theirs.structure, linkage=ours.structure.linkage).at(theirs.placement)
    assert modes(ours, 6).frequencies == pytest.approx(modes(theirs, 6).frequencies, rel=1e-8)
    one, other = tool_compliance(ours), tool_compliance(theirs)
    assert np.abs(one - other).max() < 1e-9 * np.abs(other).max()


def test_a_solid_of_a_model_file_grows_from_the_origin() -> None:
    """Its nodes and its surface stand factor times as far, of the node that the machine has."""
    model = parse_model(template("gantry"))
    (bed,) = (e for e in model.placed.structure.elements if isinstance(e, SolidElement))
    grown = bed.scaled(2.5)
    assert grown.positions == pytest.approx(2.5 * bed.positions, abs=1e-12)
    assert grown.points == pytest.approx(2.5 * bed.points, abs=1e-12)
    mass, centre = bed.weighed
    # by the rigid body's mass matrix: rounding, and what the reduction leaves of it
    assert grown.weighed[0] == pytest.approx(2.5**3 * mass, rel=1e-9)
    assert grown.weighed[1] == pytest.approx(2.5 * centre, abs=1e-9)


class Block:
    """An element that knows nothing of sizes."""

    name = "block"
    nodes = ("root", "tip")

    def stiffness(self, at: PlacedStructure) -> np.ndarray:
        return np.zeros((*at.batch, 12, 12))


def test_what_cannot_be_scaled_is_named() -> None:
    placed = cantilever().place()
    with pytest.raises(ModelError, match=r"element block: a Block cannot be scaled"):
        scaled(replace(placed.structure, elements=(Block(),)).at(placed.placement), 2.0)
    for factor in (0.0, -1.0, nan):
        with pytest.raises(ModelError, match="factor"):
            scaled(placed, factor)
    with pytest.raises(ModelError, match="translational"):
        JointScaling(nan)


def test_the_material_stays() -> None:
    beam: Beam = scaled(cantilever().place(), 5.0).structure.beams[0]
    assert beam.material is STEEL
