"""Assembly modes and reversal lines of the third leg beside eqs 2 and 4, solved by hand.

The reference is that of `test_published.py` in this folder.
"""

from __future__ import annotations

import numpy as np

from strutwork.kinematics.task_surfaces import Plane
from strutwork.machines import BiglideThirdLeg
from strutwork.machines.load import load
from strutwork.studies.machine_modes import machine_modes
from strutwork.studies.reversal_study import reversal_study

MACHINE = BiglideThirdLeg()


def turns(x: float, y: float) -> list[float]:
    """The two β at which the third carriage stands where it does at home, (−π, π]."""
    # (L₁ sin β + L₂)² + (x − L₁ + L₁ cos β)² + y² = L₂², which is A sin β + B cos β = C
    arm, third = MACHINE.arm_length, MACHINE.third_length
    a, b = 2.0 * arm * third, 2.0 * arm * (x - arm)
    c = -(arm**2 + (x - arm) ** 2 + y**2)
    middle, half = np.arctan2(a, b), np.arccos(c / np.hypot(a, b))
    return [float(np.angle(np.exp(1j * (middle + sign * half)))) for sign in (-1.0, 1.0)]


def test_all_four_assembly_modes() -> None:
    """Two places of the platform, each with two turns; to 1e-9, as the starts close to 1e-12."""
    model = load("biglide:third-leg")
    modes = machine_modes(model)
    task = model.motion.task_of(modes.tool)
    # either leg's carriages hold a circle about them of the radius L: they meet at S and there
    length = MACHINE.leg_length
    expected = [(x, x, turn) for x in (0.0, -length) for turn in turns(x, x)]
    assert len(task) == 4
    for place in expected:
        assert np.abs(task[:, [0, 1, 4]] - place).max(axis=1).min() < 1e-9
    np.testing.assert_allclose(task[:, [2, 3, 5]], 0.0, atol=1e-9)


def test_drives_turn_back_along_whole_lines() -> None:
    """Fed along x the second carriage and the third turn back at x = 0, whatever y.

    By eqs 2b and 4 the rates are x/√(L² − x²) and X/σ at β = 0, both zero there. All points of
    the plane have gradients: where a walk left joints open by 1e-11 m, some had none.
    """
    model = load("biglide:third-leg")
    axis = np.linspace(-0.4, 0.4, 9)
    study = reversal_study(model, Plane(("x", "y")), (axis, axis), "x")
    assert np.isfinite(study.found.gradient).all()
    assert study.lines["carriage1/guide:z"] == []
    for drive in ("carriage2/guide:z", "carriage3/guide:z"):
        (line,) = study.lines[drive]
        np.testing.assert_allclose(line[:, 0], 0.0, atol=1e-12)
        assert sorted(line[[0, -1], 1]) == [-0.4, 0.4]
