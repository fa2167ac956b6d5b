"""The reconstructed structure of Table 2: its joints, its stiffness, its cases."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.kinematics import cross_matrix, mobility
from strutwork.msa import tool_compliance
from strutwork.papers.son_2002.published import TABLE_2, table_2_row
from strutwork.papers.son_2002.strut_assembly import (
    CALIBRATED_ON_CASE_I,
    CASES,
    TILT,
    StrutAssembly,
    joint,
    strut_width,
)

numerals = pytest.mark.parametrize("numeral", CASES)


@numerals
def test_joints_stand_where_the_reconstruction_says(numeral: str) -> None:
    assembly = StrutAssembly.case(numeral)
    w = CASES[numeral][1]
    expected = [
        *([-0.095, w, 0.0], [-0.095, 0.0, 0.0]),
        *([0.095, w, 0.0], [0.095, 0.0, 0.0]),
        *([0.0, w, -0.150], [0.0, 0.0, -0.150]),
    ]
    np.testing.assert_array_equal(assembly.points, expected)
    span = assembly.feet - assembly.blocks
    np.testing.assert_allclose(np.linalg.norm(span, axis=-1), CASES[numeral][0], rtol=1e-15)
    np.testing.assert_array_equal(assembly.frames[:, :, 2], np.tile([0.0, 1.0, 0.0], (6, 1)))


def test_stiffness_stands_along_and_across_the_struts() -> None:
    assembly = StrutAssembly.case("I")
    k, axial = assembly.stiffness, assembly.axial_stiffness
    upright, flat = [2 * k, axial, k], [k, axial, 2 * k]
    expected = [upright, np.multiply(upright, [2, 1, 2])] * 2 + [flat, np.multiply(flat, [2, 1, 2])]
    np.testing.assert_allclose(
        assembly.stiffness_matrices, [np.diag(e) for e in expected], rtol=1e-15
    )


@numerals
def test_the_structure_is_a_rigid_body_on_six_springs(numeral: str) -> None:
    assembly = StrutAssembly.case(numeral)
    placement = assembly.placement()
    found = mobility(assembly.linkage, placement)
    # 18 elastic directions on six freedoms
    assert (found.mobility, found.redundant) == (0, 12)
    maps = np.concatenate(
        [np.broadcast_to(np.eye(3), (6, 3, 3)), -cross_matrix(assembly.points)], axis=-1
    )
    stiffness = np.einsum("nji,njk,nkl->il", maps, assembly.stiffness_matrices, maps)
    compliance = tool_compliance(assembly.structure.at(placement))
    np.testing.assert_allclose(compliance @ stiffness, np.eye(6), atol=1e-12)


def worst_forces(assembly: StrutAssembly) -> tuple[np.ndarray, np.ndarray]:
    """Largest radial and axial force of each joint, N, written out for this structure alone."""
    points, of = assembly.points, assembly.strut_of_joint
    stiffness, y = assembly.stiffness_matrices, assembly.points[:, 1]
    along = assembly.directions[of]
    maps = np.concatenate([np.broadcast_to(np.eye(3), (6, 3, 3)), -cross_matrix(points)], axis=-1)
    # displacement of joint n by the tilt of strut i: columns cos φ and sin φ
    moved = np.zeros((6, 3, 3, 2))
    each = np.arange(6)
    moved[each, 0, of, 0], moved[each, 2, of, 1] = y, y
    moved[each, 1, of, :] = -assembly.length * along[:, [0, 2]]
    moved = TILT * moved.reshape(6, 3, 6)
    whole = np.einsum("nji,njk,nkl->il", maps, stiffness, maps)
    rigid = np.linalg.solve(whole, np.einsum("nji,njk,nkm->im", maps, stiffness, moved))
    forces = np.einsum("nij,njm->nim", stiffness, maps @ rigid - moved).reshape(6, 3, 3, 2)
    angles = np.linspace(0.0, np.pi, 2001)
    unit = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    radial = np.einsum("pk,nkia->pnia", unit, forces[:, [0, 2]])
    return (
        np.linalg.norm(radial, axis=-1).sum(axis=-1).max(axis=0),
        np.linalg.norm(forces[:, 1], axis=-1).sum(axis=-1),
    )


@numerals
@pytest.mark.parametrize("fit", ["all", "case I"])
def test_the_stored_stiffnesses_are_those_that_were_calibrated(numeral: str, fit: str) -> None:
    """Table 2 by the reconstruction: all within max(4 %, 0.06 kN); fitted on Case I, within 5 %.

    The table prints two digits, and the structure is not the thesis's own.
    """
    fitted = {} if fit == "all" else dict(CALIBRATED_ON_CASE_I)
    found = np.stack(worst_forces(StrutAssembly.case(numeral, **fitted))) / 1e3
    printed = np.array(
        [
            [TABLE_2.value(table_2_row(numeral, n), quantity) for n in range(1, 7)]
            for quantity in ("Fr", "Fa")
        ]
    )
    allowed = np.maximum(0.04 * printed, 0.06) if fit == "all" else 0.05 * printed
    assert (np.abs(found - printed) <= allowed).all()


def test_names_and_cases() -> None:
    names = [j.name for j in StrutAssembly.case("II").linkage.joints]
    assert names == [joint(n) for n in range(1, 7)]
    with pytest.raises(ModelError, match=r"case IV(.|\n)*I, II, III"):
        StrutAssembly.case("IV")
    with pytest.raises(ModelError, match=r"StrutAssembly\.width"):
        StrutAssembly(length=0.5, width=0.0)


def test_width_of_a_strut_for_a_bending_stiffness() -> None:
    """Eq. 64 turned round: K = 3 E I / l³ with I = t w³ / 12."""
    length, thickness, stiffness, modulus = 0.5, 0.02, 40e6, 210e9
    width = strut_width(length, thickness, stiffness, modulus)
    inertia = thickness * width**3 / 12.0
    assert 3.0 * modulus * inertia / length**3 == pytest.approx(stiffness, rel=1e-13)
    # proportional to the length at one stiffness and thickness
    assert strut_width(2 * length, thickness, stiffness, modulus) == pytest.approx(2 * width)
    with pytest.raises(ModelError, match="strut width, thickness"):
        strut_width(length, 0.0, stiffness)
