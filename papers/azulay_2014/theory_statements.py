"""What section 2 of Azulay et al. 2014 says of kinematics and dynamics, beside computed values."""

from __future__ import annotations

from strutwork.papers.published_rows import Status
from strutwork.papers.statements import Statement

RIGID = "tests/verification/azulay_2014/test_rigid_body.py"
MODES = "tests/unit/test_kinematics_assembly_modes.py"


def theory() -> tuple[Statement, ...]:
    """Statements of section 2 that can be held against something."""
    rows: tuple[tuple[str, str, str, str, Status, str, str], ...] = (
        (
            "section 2.1",
            "solutions of the direct kinematics at given drives",
            "four unique",
            "16 complex; with all joints above the guide eight at home",
            "not reproducible",
            "the number of real ones changes with the pose; four is one of those that occur",
            f"{MODES}::test_every_mode_has_the_drives_of_the_machine",
        ),
        (
            "eqs 14 to 18",
            "the machine as three chains and a platform, separated at the ball joints",
            "a formula",
            "the chains' formulas give the same drive forces as the constraint rows",
            "predicted",
            "an exact law: 1e-9",
            "tests/unit/test_dynamics_legs.py::test_leg_by_leg_as_by_rows",
        ),
        (
            "eq. 19",
            "inverse of Z_i",
            "Z_i⁻¹ q̇_i",
            "Z_i is 3 x 6 and has none; V_pc is meant",
            "not reproducible",
            "as printed; the corrected formula is right",
            f"{RIGID}::test_rates_of_a_chain_do_not_tell_the_twist",
        ),
        (
            "eqs 25, 26",
            "geometric Jacobian through rates of ZYZ angles",
            "H J",
            "H is singular at β = 0, which is home",
            "not reproducible",
            "as printed; the rows of the drives give it at every pose",
            f"{RIGID}::test_euler_rates_fail_at_home",
        ),
        (
            "eq. 27",
            "equations of motion in the drives' space",
            "a formula",
            "power of the drives is the rate of energy; mass symmetric, Ṁ − 2C skew",
            "predicted",
            "an exact law: 1e-9 of the powers",
            f"{RIGID}::test_power_of_the_drives_is_the_rate_of_energy",
        ),
        (
            "eq. 29",
            "bias in the drives' space",
            "multiplied by V_pc",
            "must be multiplied by Q̇",
            "not reproducible",
            "as printed; the corrected formula is right",
            f"{RIGID}::test_bias_in_the_drives_space_takes_their_rates",
        ),
    )
    return tuple(
        Statement(place, what, "", published, ours, status, why, test)
        for place, what, published, ours, status, why, test in rows
    )
