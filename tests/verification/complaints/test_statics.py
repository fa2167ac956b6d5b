"""What users of other codes complain of, as far as statics can answer it.

Gathered from the issue trackers of structural codes: numbers 1, 2, 4, 5 and 7 of the list that
the project keeps; the others belong to vibration and to reports. No number is cited: each test
states a property.
"""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from strutwork.errors import MechanismError
from strutwork.msa import LoadCase, PointMass, solve, tool_compliance
from tests.structure_cases import LIBRARY, portal_frame, stewart, tripod_machine
from tests.structures import Model, wrench

METHODS = ("saddle_point", "null_space", "condensed", "sparse")


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("name", "joint", "direction"),
    [
        ("four-bar, flexible", "R1", "rz"),
        ("four-bar, rigid", "R1", "rz"),
        ("Bricard, flexible", "R1", "rz"),
        ("Bricard, rigid", "R1", "rz"),
        ("serial arm", "J1", "z"),
        ("serial arm", "J2", "rx"),
        ("door on two hinges", "upper", "rz"),
    ],
)
def test_1_an_unstable_model_is_an_error_that_names_what_moves(
    name: str, joint: str, direction: str, method: str
) -> None:
    """A stiffness forgotten: never a number, always the joint and its direction."""
    example = LIBRARY[name]()
    model = example.model
    i = next(i for i, j in enumerate(model.joints) if j.name == joint)
    forgotten = {d: k for d, k in model.joints[i].stiffness.items() if d != direction}
    model.joints[i] = replace(model.joints[i], stiffness=forgotten, driven=())
    placed = model.place()
    first = placed[(0,) * len(placed.batch)]
    with pytest.raises(MechanismError) as caught:
        solve(first, [example.cases[0]], method)  # type: ignore[arg-type]
    assert f"{joint} in {direction}" in caught.value.part
    assert caught.value.remedy


@pytest.mark.parametrize("direction", range(6))
def test_1_a_support_forgotten_is_an_error_in_the_direction_that_it_held(direction: int) -> None:
    model = Model("tip")
    model.nodes(root=(0, 0, 0), tip=(0.5, 0.1, 0.2))
    model.beam("beam", "root", "tip")
    names = ["x", "y", "z", "rx", "ry", "rz"]
    free = names.pop(direction)
    model.support("root", *names)
    load = np.zeros(6)
    load[direction] = 1.0
    with pytest.raises(MechanismError) as caught:
        solve(model.place(), [wrench("push", "tip", *load)])
    assert caught.value.part == f"joints support root in {free}"


@pytest.mark.parametrize("name", ["hexapod", "tripod machine", "Bricard, flexible", "portal frame"])
def test_2_constraints_are_exact_and_bring_no_stiffness_of_their_own(name: str) -> None:
    """No penalty: locked directions do not give, and all flexibility scales with the parts'."""
    example = LIBRARY[name]()
    placed = example.model.place()
    found = solve(placed, [example.cases[0]])
    linkage = placed.structure.linkage
    index = linkage.node_index
    largest = np.abs(found.displacements[..., :3, :]).max()
    for j, joint in enumerate(linkage.joints):
        first, second = (index[n] for n in joint.between)
        slip = found.displacements[..., second, :, 0] - found.displacements[..., first, :, 0]
        turned = np.einsum(
            "...ij,...ki->...kj",
            placed.placement.frames[..., j, :, :],
            slip.reshape(*slip.shape[:-1], 2, 3),
        ).reshape(slip.shape)
        locked = [d for d, state in enumerate(joint.states) if state == 1]
        assert np.abs(turned[..., locked]).max(initial=0.0) <= 1e-11 * largest / example.length
    soft = example.model
    factor = 1e-7
    for beam in list(soft.beams):
        material = replace(
            beam.material,
            youngs_modulus=beam.material.youngs_modulus * factor,
            shear_modulus=beam.material.shear_modulus * factor,
        )
        soft.beams[soft.beams.index(beam)] = replace(beam, material=material)
    soft.joints = [
        replace(j, stiffness={d: k * factor for d, k in j.stiffness.items()}) for j in soft.joints
    ]
    softened = solve(soft.place(), [example.cases[0]])
    gap = softened.displacements * factor - found.displacements
    assert np.abs(gap).max() <= 1e-9 * np.abs(found.displacements).max()
    gap = softened.joint_forces - found.joint_forces
    assert np.abs(gap).max() <= 1e-9 * np.abs(found.joint_forces).max()


def test_2_a_rigid_body_is_rigid_whatever_its_size() -> None:
    """A long rigid arm turns its root's rotation into displacement, nothing more."""
    for reach in (1.0, 30.0):
        model = Model("far")
        model.nodes(root=(0, 0, 0), tip=(0.5, 0, 0), far=(0.5, reach, 0))
        model.beam("beam", "root", "tip")
        model.support("root")
        model.rigid("arm", "tip", "far")
        found = solve(model.place(), [wrench("twist", "tip", 0, 0, 0, 1.0)])
        twist = found.displacement("tip", "twist")[3]
        assert found.displacement("far", "twist")[2] == pytest.approx(reach * twist, rel=1e-12)


def test_4_gravity_weighs_every_part_once() -> None:
    """Reactions carry the sum of beams, masses and nothing else."""
    for name in ("portal frame", "tripod machine", "serial arm"):
        model = LIBRARY[name]().model
        model.masses.append(PointMass(model.tool or "", 7.0))
        placed = model.place()
        g = np.array([1.0, -2.0, -9.0])
        found = solve(placed, [LoadCase("g", gravity=(1.0, -2.0, -9.0))])
        length, _ = placed.beam_geometry
        mass = sum(m.mass for m in model.masses)
        mass = mass + sum(
            (b.material.density or 0.0) * b.section.area * length[..., i]
            for i, b in enumerate(model.beams)
        )
        total = np.zeros((*placed.batch, 3))
        linkage = placed.structure.linkage
        for j, joint in enumerate(linkage.joints):
            owner = [linkage.body_of_node[linkage.node_index[n]] for n in joint.between]
            if owner[0] < 0 <= owner[1]:
                force = found.joint_forces[..., j, :3, 0]
                total += np.einsum("...ij,...j->...i", placed.placement.frames[..., j, :, :], force)
        np.testing.assert_allclose(total, -np.asarray(mass)[..., None] * g, rtol=1e-8)


def test_5_every_number_of_a_solution_is_in_its_dictionary() -> None:
    example = portal_frame()
    found = solve(example.model.place(), example.cases)
    data = json.loads(json.dumps(found.to_dict()))
    for m, case in enumerate(found.cases):
        one = data[case]
        stacked = np.array(list(one["displacements"].values()))
        np.testing.assert_array_equal(stacked, found.displacements[: len(stacked), :, m])
        np.testing.assert_array_equal(
            list(one["joint_forces"].values()), found.joint_forces[..., m]
        )
        ends = [[b["from"], b["to"]] for b in one["beam_forces"].values()]
        np.testing.assert_array_equal(ends, found.beam_forces[..., m])
        assert one["strain_energy"] == found.strain_energy[m]


@pytest.mark.parametrize("make", [stewart, tripod_machine, portal_frame])
def test_7_the_answer_does_not_depend_on_how_the_model_lies(make: object) -> None:
    """Turned onto and across every global axis, where default orientations change over."""
    expected = None
    for turn in Rotation.create_group("O"):
        rotation = turn.as_matrix()
        example = make()  # type: ignore[operator]
        c = tool_compliance(example.model.turned(rotation).place())
        six = np.kron(np.eye(2), rotation)
        back = six.T @ c @ six
        expected = back if expected is None else expected
        assert np.abs(back - expected).max() <= 1e-8 * np.abs(expected).max()
