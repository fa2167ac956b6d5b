"""Forces that misfits lock into over-constrained linkages.

@article{pellegrino1986,
  author  = {Pellegrino, Sergio and Calladine, Christopher R.},
  title   = {Matrix analysis of statically and kinematically indeterminate frameworks},
  journal = {International Journal of Solids and Structures},
  volume  = {22}, number = {4}, pages = {409--428}, year = {1986},
}
@article{gonzalez2006,
  author  = {Gonz{\\'a}lez, Manuel and Dopico, Daniel and Lugr{\\'i}s, Urbano and Cuadrado, Javier},
  title   = {A benchmarking system for {MBS} simulation software: problem standardization and
             performance measurement},
  journal = {Multibody System Dynamics},
  volume  = {16}, number = {2}, pages = {179--190}, year = {2006},
}

With S the states of self-stress (columns), F the flexibility of what carries them and e the
misfits, the forces are t = −S (Sᵀ F S)⁻¹ Sᵀ e for errors e that lengthen a member; with the
sign of a joint's gap, which closes it, the force on the second side is +S (Sᵀ F S)⁻¹ Sᵀ g.
The states of self-stress are found here by statics alone, from the lines of the members. Exact:
1e-9 is left for the round-off of a solve.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import null_space

from strutwork.kinematics import DIRECTIONS, mobility
from strutwork.msa import LoadCase, PlacedStructure, solve
from tests.structure_cases import bricard, four_bar, plate_on_four
from tests.structures import Model

METHODS = ("saddle_point", "null_space", "condensed", "sparse")
methods = pytest.mark.parametrize("method", METHODS)


@methods
@pytest.mark.parametrize("leg", range(4))
def test_square_plate_on_four_equal_springs_one_longer(method: str, leg: int) -> None:
    """± k d/4, alternating around the plate."""
    k, d = 2e6, 1e-3
    case = LoadCase("long", gaps={(f"support c{leg}", "z"): d})
    placed = plate_on_four(stiffness={"z": k}).place()
    found = solve(placed, [case], method)  # type: ignore[arg-type]
    signs = [1.0 if (i - leg) % 2 == 0 else -1.0 for i in range(4)]
    forces = [found.joint_force(f"support c{i}", "long")[2] for i in range(4)]
    np.testing.assert_allclose(forces, np.multiply(signs, k * d / 4), rtol=1e-12)
    assert found.strain_energy[0] == pytest.approx(4 * (k * d / 4) ** 2 / (2 * k), rel=1e-12)


@methods
def test_nine_elastic_struts_on_a_rigid_platform(method: str) -> None:
    """Three struts too many, of nine stiffnesses and nine errors."""
    rng = np.random.default_rng(8)
    count = 9
    feet = rng.uniform(-1, 1, (count, 3)) * [1, 1, 0.2]
    heads = rng.uniform(-0.5, 0.5, (count, 3)) + np.array([0, 0, 1.0])
    stiffness, error = rng.uniform(1e7, 9e7, count), rng.normal(size=count) * 1e-4
    along = (heads - feet) / np.linalg.norm(heads - feet, axis=1)[:, None]
    model = Model("tool")
    model.nodes(tool=(0, 0, 1))
    for i in range(count):
        model.ground(**{f"base{i}": feet[i]})
        model.nodes(**{f"plate{i}": heads[i], f"slide{i}": (feet[i] + heads[i]) / 2})
        across = np.cross(along[i], (0, 1, 0))
        second = np.cross(across, along[i])
        model.joint(f"U{i}", "universal", (f"base{i}", f"foot{i}"), across, second)
        model.joint(
            f"P{i}", "prismatic", (f"slide{i}", f"rod{i}"), along[i],
            driven=("z",), stiffness={"z": stiffness[i]},
        )  # fmt: skip
        model.joint(f"S{i}", "spherical", (f"head{i}", f"plate{i}"))
        model.rigid(f"cylinder{i}", f"foot{i}", f"slide{i}")
        model.rigid(f"piston{i}", f"rod{i}", f"head{i}")
    model.rigid("platform", "tool", *(f"plate{i}" for i in range(count)))
    placed = model.place()
    lines = np.concatenate([along, np.cross(heads, along)], axis=1).T
    states = null_space(lines)
    assert states.shape == (9, 3)
    assert mobility(placed.structure.linkage, placed.placement).redundant == 3
    flexibility = np.diag(1 / stiffness)
    expected = states @ np.linalg.solve(states.T @ flexibility @ states, states.T @ error)
    case = LoadCase("errors", gaps={(f"P{i}", "z"): error[i] for i in range(count)})
    found = solve(placed, [case], method)  # type: ignore[arg-type]
    force = [found.joint_force(f"P{i}", "errors")[2] for i in range(count)]
    np.testing.assert_allclose(force, expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())
    assert found.strain_energy[0] == pytest.approx(
        0.5 * expected @ flexibility @ expected, rel=1e-9
    )


def softened(placed: PlacedStructure, rng: np.random.Generator) -> PlacedStructure:
    """The same linkage with every locked direction elastic."""
    linkage = placed.structure.linkage
    joints = tuple(
        replace(
            joint,
            stiffness={
                d: float(rng.uniform(1e6, 9e6) if d in "xyz" else rng.uniform(1e4, 9e4))
                for d, state in zip(DIRECTIONS, joint.states, strict=True)
                if state
            },
        )
        for joint in linkage.joints
    )
    return replace(placed.structure, linkage=replace(linkage, joints=joints)).at(placed.placement)


@pytest.mark.parametrize(
    ("example", "gruebler", "redundant"),
    [(four_bar(False), -2, 3), (bricard(False), 0, 1)],
    ids=["four-bar", "Bricard"],
)
def test_spatial_linkages_that_gruebler_counts_wrong(
    example: object, gruebler: int, redundant: int
) -> None:
    """Planar four-bar in space: Grübler −2, mobility 1, three redundant. Bricard (IFToMM A04):
    Grübler 0, mobility 1, one redundant. Their self-stress carries the forces of misfits."""
    placed = example.model.place()  # type: ignore[attr-defined]
    linkage = placed.structure.linkage
    found = mobility(linkage, placed.placement)
    # the drive of the examples is one joint direction
    assert (found.gruebler, found.mobility, found.mobility_locked) == (gruebler, 1, 0)
    assert (found.redundant, len(found.self_stress)) == (redundant, redundant)
    soft = softened(placed, np.random.default_rng(5))
    names = [
        (joint.name, d)
        for joint in soft.structure.linkage.joints
        for d, state in zip(DIRECTIONS, joint.states, strict=True)
        if state
    ]
    states = np.array(
        [[state.forces.get(name, 0.0) for name in names] for state in found.self_stress]
    ).T
    joints = {joint.name: joint for joint in soft.structure.linkage.joints}
    flexibility = np.diag([1 / joints[j].stiffness[d] for j, d in names])
    gap = np.random.default_rng(6).normal(size=len(names)) * 1e-4
    expected = states @ np.linalg.solve(states.T @ flexibility @ states, states.T @ gap)
    case = LoadCase("misfits", gaps=dict(zip(names, gap, strict=True)))
    for method in METHODS:
        solution = solve(soft, [case], method)  # type: ignore[arg-type]
        force = [solution.joint_force(j, "misfits")[DIRECTIONS.index(d)] for j, d in names]
        np.testing.assert_allclose(force, expected, atol=1e-8 * np.abs(expected).max())


def test_states_of_self_stress_are_in_balance_on_every_body() -> None:
    """Forces of a state on the bodies add to nothing, by the joints' own axes and places."""
    for example in (four_bar(False), bricard(False)):
        placed = example.model.place()
        linkage, placement = placed.structure.linkage, placed.placement
        for state in mobility(linkage, placement).self_stress:
            total = np.zeros((len(linkage.body_names) + 1, 6))
            for (name, d), value in state.forces.items():
                j = linkage.joint_index[name]
                axis = placement.frames[j][:, DIRECTIONS.index(d) % 3]
                for node, sign in zip(linkage.joints[j].between, (-1.0, 1.0), strict=True):
                    i = linkage.node_index[node]
                    force = sign * value * axis if d in "xyz" else np.zeros(3)
                    moment = sign * value * axis if d not in "xyz" else np.zeros(3)
                    moment = moment + np.cross(placement.positions[i], force)
                    total[linkage.body_of_node[i]] += [*force, *moment]
            assert np.abs(total[:-1]).max() < 1e-9
            assert max(abs(v) for v in state.forces.values()) > 0.1
