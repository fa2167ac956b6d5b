"""Assembly forces of three equal struts, Table 2.

@phdthesis{son2002,
  author = {Son, Seung-Kil},
  title  = {A Hybrid Type Small 5-Axis {CNC} Milling Machine},
  school = {Massachusetts Institute of Technology},
  year   = {2002}
}

Section 6.6 and Table 2, page 85; the printed forces are read from the module
`strutwork.papers.son_2002.published`. The structure is reconstructed, since figures 40 and 42 are
not at hand, and its two stiffnesses are calibrated: agreement with the print is a fit. Cases II and
III test it where the stiffnesses were fitted to Case I alone, and then only as far as the structure
is right."""

from __future__ import annotations

from functools import cache
from itertools import product

import numpy as np
import pytest

from strutwork.overconstraint import (
    RigidAssembly,
    WorstCase,
    assembly_forces,
    distribution,
    rigid_equilibrium,
    tolerance_responses,
    worst_case,
)
from strutwork.papers.son_2002.assembly_table import (
    calibrate_assembly,
    joint_forces,
    published_forces,
    table_2_rows,
    table_2_worst_case,
)
from strutwork.papers.son_2002.strut_assembly import CASES, TILT, StrutAssembly
from strutwork.papers.son_2002.tolerances import table_2_joints, table_2_tolerances

KINDS = ("radial force", "axial force")


@cache
def worst(case: str) -> WorstCase:
    return table_2_worst_case(case)


def azimuth_forces(case: str, azimuths: np.ndarray) -> np.ndarray:
    """Radial and axial forces, (a, 2, 6), by the thesis's own formulas for each azimuth alone.

    d = [τ y cos φ, −τ l s·(cos φ, sin φ), τ y sin φ], written out apart from the tolerance zones.
    """
    assembly = StrutAssembly.case(case)
    strut = assembly.strut_of_joint
    y, s = assembly.points[:, 1], assembly.directions[strut]
    forces = []
    for i in range(3):
        cosine, sine = np.cos(azimuths)[:, None], np.sin(azimuths)[:, None]
        along = s[:, 0] * cosine + s[:, 2] * sine
        d = TILT * np.stack([y * cosine, -assembly.length * along, y * sine], axis=-1)
        d = np.where((strut == i)[:, None], d, 0.0)
        rigid = RigidAssembly(assembly.points, assembly.stiffness_matrices)
        forces.append(rigid_equilibrium(rigid, d).forces)
    return np.stack(forces)


@pytest.mark.parametrize("case", CASES)
def test_all_36_forces_with_the_stored_stiffnesses(case: str) -> None:
    found, printed = joint_forces(worst(case)), published_forces(case)
    # a fit of two numbers to all 36: 3.3 % at worst; 0.06 kN is rounding of the print and a bit
    allowed = np.maximum(0.04 * printed, 60.0)
    assert np.all(np.abs(found - printed) <= allowed)


def test_rows_of_the_table() -> None:
    rows = table_2_rows()
    assert len(rows) == 36
    assert {row.unit for row in rows} == {"kN"}
    assert {row.status for row in rows} == {"calibrated"}
    assert all("reconstructed" in row.note for row in rows)
    fitted = table_2_rows("case I")
    # layout and ratios were chosen with every case in view, so no case is predicted
    assert {r.status for r in fitted} == {"calibrated"}
    others = [r for r in fitted if " I " not in r.row]
    assert all("to match this case too" in r.note for r in others)
    # fitted to Case I alone, the rest within 5 %: the reconstruction's own transfer is 4.1 %
    assert max(abs(r.difference_percent) for r in others) < 5.0
    assert len(others) == 24


def test_calibration_can_be_repeated() -> None:
    on_one = calibrate_assembly(("I",))
    # stored to four digits; the criterion that it was fitted by is not known better than this
    assert on_one.stiffness == pytest.approx(139.8e6, rel=5e-4)
    assert on_one.axial_stiffness == pytest.approx(9.844e6, rel=5e-4)
    on_all = calibrate_assembly()
    # another criterion than the stored set's: the rms is lower, the largest error higher
    assert on_all.stiffness == pytest.approx(141.1e6, rel=2e-3)
    assert on_all.axial_stiffness == pytest.approx(9.549e6, rel=1e-2)
    stored = np.array([row.difference_percent / 100 for row in table_2_rows()])
    assert on_all.rms < np.sqrt(np.mean(stored**2)) < 1.1 * on_all.rms
    assert np.abs(stored).max() < on_all.largest


@pytest.mark.parametrize("case", CASES)
def test_both_joints_of_a_strut_carry_the_same_axial_force(case: str) -> None:
    axial = joint_forces(worst(case))[1]
    # equal stiffness and equal axial misfit; published alike
    np.testing.assert_allclose(axial[::2], axial[1::2], rtol=1e-9)
    assert np.array_equal(published_forces(case)[1, ::2], published_forces(case)[1, 1::2])


@pytest.mark.parametrize("case", CASES)
def test_end_effector_is_in_equilibrium_in_every_worst_case(case: str) -> None:
    found = worst(case)
    assembly = StrutAssembly.case(case)
    responses = found.responses
    for q in range(len(responses.quantities)):
        local = assembly_forces(responses.influence, found.misfits(q)).forces[:, :3]
        forces = np.einsum("nij,nj->ni", assembly.frames, local)
        moments = np.cross(assembly.points, forces)
        size = np.abs(forces).max()
        assert np.abs(forces.sum(axis=0)).max() < 1e-9 * size
        assert np.abs(moments.sum(axis=0)).max() < 1e-9 * size


@pytest.mark.parametrize("case", CASES)
def test_worst_case_against_every_combination_of_72_azimuths(case: str) -> None:
    azimuths = np.linspace(0.0, 2 * np.pi, 72, endpoint=False)
    each = azimuth_forces(case, azimuths)
    largest = np.zeros((2, 6))
    for first, second in product(range(72), repeat=2):
        total = each[0, first] + each[1, second] + each[2]
        size = np.stack([np.hypot(total[..., 0], total[..., 2]), np.abs(total[..., 1])], axis=1)
        largest = np.maximum(largest, size.max(axis=0))
    exact = joint_forces(worst(case))
    # never below the enumeration but for rounding; steps of 5° miss at most 1 − cos 2.5° = 0.1 %
    assert np.all(exact >= largest * (1 - 1e-12))
    np.testing.assert_allclose(exact, largest, rtol=1e-3)


@pytest.mark.parametrize("case", CASES)
def test_a_thousand_random_samples(case: str) -> None:
    assembly = StrutAssembly.case(case)
    placed = assembly.structure.at(assembly.placement())
    found = tolerance_responses(placed, table_2_tolerances())
    spread = distribution(found, 1000).values
    some = [found.index(name, kind) for kind in KINDS for name in table_2_joints()]
    ratio = spread.largest[some] / worst_case(found).value[some]
    # the thesis places the axes at random: a thousand come within 5 % and none exceeds
    assert np.all(ratio <= 1 + 1e-12)
    assert np.all(ratio >= 0.95)


def test_axial_force_tends_to_four_thirds_of_stiffness_tilt_and_length() -> None:
    length = 1e4
    assembly = StrutAssembly(length=length, width=0.2 * length)
    placed = assembly.structure.at(assembly.placement())
    axial = joint_forces(worst_case(tolerance_responses(placed, table_2_tolerances())))[1]
    limit = 4 / 3 * assembly.axial_stiffness * TILT * length
    # what is left goes with the end-effector's size over the length
    np.testing.assert_allclose(axial, limit, rtol=1e-3)
