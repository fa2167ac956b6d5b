"""The two biglides: closed forms, faults, and the joints' rows as their derivative."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.kinematics import Poses, cross_matrix, drive_values, jacobians, rotation_z
from strutwork.kinematics.mobility import mobility
from strutwork.machines import Biglide, BiglideThirdLeg, variants
from strutwork.machines.load import load
from strutwork.msa.tool import tool_compliance

RANDOM = np.random.default_rng(11)
#: Places within the square that the document asks for, m, and turns, rad.
PLACES = RANDOM.uniform(-0.55, 0.55, (50, 2))
TURNS = RANDOM.uniform(-1.2, 1.2, 50)


def test_carriages_stand_where_the_formulas_say() -> None:
    """ρ₁ = x − √(1 − y²) and ρ₂ = y − √(1 − x²), written again here; 1e-15 m is rounding."""
    x, y = PLACES.T
    machine = Biglide()
    found = drive_values(machine, machine.place(machine.poses(x, y)))
    wanted = np.stack([x - np.sqrt(1 - y**2), y - np.sqrt(1 - x**2)], axis=-1)
    np.testing.assert_allclose(found, wanted, rtol=0.0, atol=1e-15)


def test_the_third_carriage() -> None:
    """ρ₃ = L₁ sin β − √(L₂² − X² − y²), X = x + L₁ (cos β − 1); rod and arm keep their lengths."""
    x, y = PLACES.T
    machine = BiglideThirdLeg()
    placement = machine.place(machine.poses(x, y, TURNS))
    ahead = x + 1.7 * (np.cos(TURNS) - 1.0)
    wanted = 1.7 * np.sin(TURNS) - np.sqrt(3.06**2 - ahead**2 - y**2)
    np.testing.assert_allclose(drive_values(machine, placement)[:, 2], wanted, rtol=0.0, atol=1e-14)
    at = {n: placement.positions[:, k] for n, k in machine.linkage.node_index.items()}
    for ends, length in ((("rod3/foot", "rod3/end"), 3.06), (("arm/root", "arm/end"), 1.7)):
        size = np.linalg.norm(at[ends[1]] - at[ends[0]], axis=-1)
        np.testing.assert_allclose(size, length, rtol=1e-14)
    # the rail stands upright through the arm's end at home, whatever the pose
    assert np.array_equal(at["rail3"][:, :2], np.tile([1.7, 0.0], (50, 1)))


@pytest.mark.parametrize("machine", [Biglide(), BiglideThirdLeg()], ids=["plane", "third-leg"])
def test_the_rows_are_the_derivative_of_the_formulas(machine: Biglide) -> None:
    """Complex steps in the directions that the tool has; both are exact but for rounding."""
    poses = machine.poses(*PLACES.T)
    if isinstance(machine, BiglideThirdLeg):
        poses = machine.poses(PLACES[:, 0], PLACES[:, 1], TURNS)
    rows = jacobians(machine.linkage, machine.place(poses)).inverse
    for k in (0, 1, 4) if machine.turning else (0, 1):
        twist = np.eye(6)[k]
        position = poses.position + 1e-30j * twist[:3]
        rotation = (np.eye(3) + 1e-30j * cross_matrix(twist[3:])) @ poses.rotation
        moved = drive_values(machine, machine.place(Poses(position, rotation)))
        np.testing.assert_allclose(rows[..., k], moved.imag / 1e-30, rtol=0.0, atol=1e-11)


@pytest.mark.parametrize(
    ("name", "freedoms", "redundant"), [("plane", 2, 10), ("third-leg", 3, 11)]
)
def test_it_moves_as_its_drives_do(name: str, freedoms: int, redundant: int) -> None:
    machine = variants("biglide")[name].factory()
    found = mobility(machine.linkage, machine.place(machine.home()))
    assert (found.mobility, found.mobility_locked) == (freedoms, 0)
    # three planar loops lock thrice each across the plane, and one parallelogram of two would do;
    # the third leg holds the tool's turn about its rod's first axis, which the platform does too
    assert found.redundant == redundant


def test_poses_that_it_cannot_take_say_why() -> None:
    machine = BiglideThirdLeg()
    turned = Poses.of([0.0, 0.0, 0.0], rotation_z(np.asarray(0.1)))
    for poses, words in (
        (Poses.of([0.0, 0.0, 1e-3], np.eye(3)), "is outside the plane"),
        (turned, "rotated about an axis other than y"),
        (machine.poses(0.0, 1.01), "leg 1: its end is farther"),
        (machine.poses(-1.01, 0.0), "leg 2: its end is farther"),
        (machine.poses(0.5, 0.5, np.pi), "leg 3: its end is farther"),
    ):
        small = replace(machine, third_length=1.0)
        placement = small.place(poses)
        assert not placement.reachable
        assert words in placement.reason(())
        assert np.isfinite(placement.positions).all()
    plane = Biglide()
    assert "parallelograms" in plane.place(turned).reason(())
    assert not plane.place(machine.poses(0.0, 0.0, 0.1)).reachable


@pytest.mark.parametrize("name", ["biglide", "biglide:third-leg"])
def test_it_carries_loads_and_has_mass(name: str) -> None:
    model = load(name)
    compliance = tool_compliance(model.placed)
    assert (np.linalg.eigvalsh(compliance) > 0.0).all()
    assert model.structure.masses
    # along x at home: a parallelogram's two rods in tension
    area = 2 * (0.05 * 0.12 - 0.04 * 0.11)
    assert compliance[0, 0] == pytest.approx(1.0 / (210e9 * area), rel=1e-9)


@pytest.mark.parametrize(
    ("field", "value"),
    [("leg_length", -1.0), ("pin_distance", np.nan), ("platform_mass", 0.0), ("arm_length", 0.0)],
)
def test_a_size_that_is_none_is_named(field: str, value: float) -> None:
    with pytest.raises(ModelError, match=field):
        BiglideThirdLeg(**{field: value})  # type: ignore[arg-type]
    with pytest.raises(ModelError, match="drive_stiffness"):
        Biglide(drive_stiffness=0.0)
