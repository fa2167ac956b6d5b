"""Mass of rigid bodies from the matrices that vibrate."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, axes_frame
from strutwork.machines.load import load
from strutwork.msa import Beam, Material, PointMass, Structure, tube
from strutwork.msa.body_mass import body_masses, stretched_parts
from strutwork.msa.mass import mass_properties
from tests.dynamics import HEAVY

AWAY = np.array([5.0, -3.0, 2.0])


def rod(elements: int, density: float | None = 7870.0) -> Structure:
    linkage = Linkage(
        ("wall", "root", "tip", "end"),
        (Body(GROUND, ("wall",)), Body("rod", ("root", "tip", "end"))),
        (Joint("hinge", "revolute", ("wall", "root")),),
    )
    material = Material.isotropic(205e9, poissons_ratio=0.29, density=density, name="steel")
    beams = (
        Beam("b", ("root", "tip"), material, tube(0.03, 0.02), elements=elements),
        Beam("c", ("tip", "end"), material, tube(0.03, 0.02)),
    )
    disc = PointMass("end", 0.7, ((0.002, 0, 0), (0, 0.001, 0), (0, 0, 0.001)), (0.05, 0.0, 0.0))
    return Structure(linkage, beams, masses=(disc,))


def placement() -> Placement:
    points = np.array([[0, 0, 0], [0, 0, 0], [0.3, 0.4, 0], [0.6, 0.8, 0.0]])
    return Placement(points + AWAY, axes_frame([[0, 1.0, 0]]), np.zeros(0))


@pytest.mark.parametrize("elements", [1, 4])
def test_a_slender_tube_with_a_disc(elements: int) -> None:
    found = body_masses(rod(elements).at(placement()))
    area = np.pi / 4 * (0.03**2 - 0.02**2)
    tube_mass = 7870.0 * area * 1.0
    assert found.mass[0] == pytest.approx(tube_mass + 0.7, rel=1e-12)
    along = np.array([0.6, 0.8, 0.0])
    middle, disc = 0.5 * along, along + np.array([0.05, 0, 0])
    centre = (tube_mass * middle + 0.7 * disc) / (tube_mass + 0.7)
    np.testing.assert_allclose(found.centre[0], centre + AWAY, rtol=1e-12)
    bending = 7870.0 * np.pi / 64 * (0.03**4 - 0.02**4)
    own = (tube_mass / 12 + bending) * (np.eye(3) - np.outer(along, along))
    own += 2 * bending * np.outer(along, along)
    whole = own + np.diag([0.002, 0.001, 0.001])
    for mass, place in ((tube_mass, middle), (0.7, disc)):
        arm = place - centre
        whole += mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    np.testing.assert_allclose(found.inertia[0], whole, rtol=1e-9, atol=1e-11)


@pytest.mark.parametrize("name", HEAVY)
def test_bodies_weigh_what_the_structure_weighs(name: str) -> None:
    """Less what stands on ground nodes, which moves in no way."""
    model = load(name)
    placed = model.structure.at(model.placement)
    whole, found = mass_properties(placed), body_masses(placed)
    assert found.mass.sum() <= whole.total * (1 + 1e-12)
    owner = model.structure.linkage.body_of_node
    index = model.structure.linkage.node_index
    parts = [
        *(b.nodes for b in model.structure.beams),
        *((m.node,) for m in model.structure.masses),
    ]
    if all(owner[index[nodes[0]]] >= 0 for nodes in parts):
        assert found.mass.sum() == pytest.approx(float(whole.total), rel=1e-9)
        centre = found.mass @ found.centre / found.mass.sum()
        np.testing.assert_allclose(centre, whole.centre, atol=1e-9)


def test_without_mass() -> None:
    with pytest.raises(ModelError, match="no density"):
        body_masses(rod(1, None).at(placement()))
    linkage = rod(1).linkage
    bare = Structure(linkage, masses=(PointMass("wall", 3.0),))
    with pytest.raises(ModelError, match="no moving body with mass"):
        body_masses(bare.at(placement()))


def test_parts_that_end_where_a_joint_slides() -> None:
    tripod = load("examples/03_tripod.toml").structure
    assert stretched_parts(tripod) == tuple(f"beam cylinder{i}" for i in (1, 2, 3))
    assert stretched_parts(rod(1)) == ()
