"""The compliance budget against springs in series and parallel, and hand values."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import MechanismError
from strutwork.msa import compliance_budget, tool_compliance
from tests.structure_cases import LIBRARY, stewart
from tests.structures import BAR, STEEL, TUBE, Model, cantilever_compliance

HELD = [name for name in LIBRARY if LIBRARY[name]().held]
WRENCH = (30.0, -20.0, 50.0, 3.0, 4.0, -5.0)


@pytest.mark.parametrize("name", HELD)
def test_shares_add_to_one_and_deflection_is_the_compliances(name: str) -> None:
    placed = LIBRARY[name]().model.place()
    budget = compliance_budget(placed, WRENCH)
    assert budget.shares.shape == (*placed.batch, len(budget.parts))
    np.testing.assert_allclose(budget.shares.sum(axis=-1), 1.0, rtol=1e-12)
    c = tool_compliance(placed)
    expected = np.einsum("i,...ij,j->...", WRENCH, c, WRENCH)
    np.testing.assert_allclose(budget.deflection, expected, rtol=1e-9)
    assert len(set(budget.parts)) == len(budget.parts)


@pytest.mark.parametrize("method", ["saddle_point", "null_space", "condensed", "sparse"])
def test_a_drive_a_joint_and_two_rods_in_series(method: str) -> None:
    model = Model("tip")
    model.ground(base=(0, 0, 0))
    model.nodes(a=(0, 0, 0.3), tip=(0, 0, 0.8))
    model.joint("slide", "prismatic", ("base", "s"), driven=("z",), stiffness={"z": 2e7})
    model.joint("seat", "fixed", ("a", "b"), stiffness={"z": 5e7})
    model.beam("lower", "s", "a", BAR)
    model.beam("upper", "b", "tip", TUBE, elements=3)
    budget = compliance_budget(model.place(), (0, 0, 100.0, 0, 0, 0), method)  # type: ignore[arg-type]
    e = STEEL.youngs_modulus
    flexibility = {
        "drive slide:z": 1 / 2e7,
        "joint seat:z": 1 / 5e7,
        "beam lower": 0.3 / (e * BAR.area),
        "beam upper": 0.5 / (e * TUBE.area),
    }
    total = sum(flexibility.values())
    assert set(budget.parts) == set(flexibility)
    for part, share in budget.to_dict().items():
        assert share == pytest.approx(flexibility[part] / total, rel=1e-9), part
    assert float(budget.deflection) == pytest.approx(total * 1e4, rel=1e-9)
    np.testing.assert_array_equal(budget.wrench, [0, 0, 100, 0, 0, 0])
    assert repr(budget) == "<ComplianceBudget: 4 parts, batch ()>"


def test_two_beams_of_a_bent_arm() -> None:
    """An elbow loaded across: the far beam bends, the near one bends and twists."""
    model = Model("tip")
    model.nodes(root=(0, 0, 0), elbow=(0.5, 0, 0), tip=(0.5, 0.3, 0))
    model.beam("near", "root", "elbow", TUBE)
    model.beam("far", "elbow", "tip", BAR)
    model.support("root")
    budget = compliance_budget(model.place(), (0, 0, 1.0, 0, 0, 0))
    near, far = (
        cantilever_compliance(beam, length)
        for beam, length in zip(model.beams, (0.5, 0.3), strict=True)
    )
    # at the elbow: unit force along z and its moment 0.3 about x
    load = np.array([0, 0, 1.0, 0.3, 0, 0])
    parts = {"beam near": load @ near @ load, "beam far": far[2, 2]}
    for part, value in parts.items():
        share = budget.to_dict()[part]
        assert share == pytest.approx(value / sum(parts.values()), rel=1e-9)


def test_parallel_springs_share_by_their_energy() -> None:
    placed = LIBRARY["beam on springs"]().model.place()
    budget = compliance_budget(placed, (0, 0, 1.0, 0, 0, 0)).to_dict()
    # symmetric about the tool in the middle
    assert budget["spring bed1"] == pytest.approx(budget["spring bed3"], rel=1e-8)
    assert budget["beam span1"] == pytest.approx(budget["beam span4"], rel=1e-8)
    # the anvil hangs on its mount and carries nothing
    assert budget["spring mount"] == pytest.approx(0.0, abs=1e-12)


def test_shares_do_not_depend_on_the_size_of_the_wrench() -> None:
    placed = stewart().model.place()
    one = compliance_budget(placed, WRENCH)
    other = compliance_budget(placed, np.multiply(WRENCH, -250.0))
    np.testing.assert_allclose(other.shares, one.shares, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(other.deflection, 250.0**2 * one.deflection, rtol=1e-9)


def test_rigid_struts_leave_it_to_the_drives() -> None:
    placed = LIBRARY["hexapod, rigid struts"]().model.place()
    budget = compliance_budget(placed, WRENCH)
    assert set(budget.parts) == {f"drive P{i}:z" for i in range(6)}
    assert np.all(budget.shares >= 0)


def test_a_wrench_on_a_mechanism_has_no_budget() -> None:
    placed = LIBRARY["tripod of pinned rods"]().model.place()
    budget = compliance_budget(placed, (1.0, 2.0, 3.0, 0, 0, 0))
    assert sum(budget.to_dict().values()) == pytest.approx(1.0, rel=1e-12)
    with pytest.raises(MechanismError):
        compliance_budget(placed, (0, 0, 0, 1.0, 0, 0))
