"""What Son 2002 asks of its machine (chapter 7) and measures on it (chapter 9); computed values."""

from __future__ import annotations

from math import nan, pi

import numpy as np

from strutwork.machines import MitSS1
from strutwork.papers.son_2002.planar_kinematics import planar_kinematics, strut_rows
from strutwork.papers.son_2002.published import MODES, TABLE_6, table_6_row
from strutwork.papers.son_2002.stiffness_table import computed_stiffness
from strutwork.papers.statements import Statement

TESTS = "tests/verification/son_2002"

#: Speed that section 9.1.3 calls the theoretical limit of the feed, read as that of the drives.
DRIVE_SPEED = 1.0

#: Equivalent stiffness of the tilt along x, N/m, arm to the spindle's end, m, and the tilting
#: frequency of the housing as measured and with the spindle, Hz (sections 9.2.1 and 9.2.2).
TILT_STIFFNESS, ARM, TILT, WITH_SPINDLE = 6.46e6, 0.070, 79.2, 71.3

CHOSEN = "the granite, the mounts, the housing and the bearings are calibrated to frequencies"


def tool_speed() -> float:
    """Speed along x and z in the worst direction anywhere in the nominal workspace, tilt held, m/s.

    A strut's block moves by v·u / u_z for a velocity v of the housing: of a unit velocity at most
    1 / |u_z|.
    """
    found = planar_kinematics()
    grid = np.meshgrid(found["x"], found["b"], indexing="ij")
    _, directions = strut_rows(MitSS1(), *grid)
    return DRIVE_SPEED * float(np.nanmin(np.abs(directions[..., 2])))


def targets() -> tuple[Statement, ...]:
    """Chapter 7."""
    here = f"{TESTS}/test_statements.py"
    stiffness = computed_stiffness()[0]
    soft = int(np.argmin(stiffness))
    tilt = MODES.value("spindle housing tilt", "measured")
    return (
        Statement(
            "chapter 7",
            "target: rapid motion in the workspace",
            "m/s",
            0.5,
            tool_speed(),
            "predicted",
            "least in any direction of the plane at drives of 1 m/s, the limit of section 9.1.3: "
            "below the target at the corners of the nominal workspace",
            f"{here}::test_rapid_motion",
        ),
        Statement(
            "chapter 7",
            f"target: stiffness; computed along {'xyz'[soft]} at home, the least",
            "N/µm",
            30.0,
            float(stiffness[soft]) / 1e6,
            "calibrated",
            CHOSEN,
            f"{here}::test_stiffness_along_y_is_what_it_was_calibrated_to",
        ),
        Statement(
            "chapter 7",
            "target: lowest frequency of the structure",
            "Hz",
            70.0,
            tilt,
            "calibrated",
            "the housing's tilt is calibrated to the measured frequency",
            f"{TESTS}/test_modes.py::test_measured_frequencies_with_a_softer_preloading_side",
        ),
        Statement(
            "chapter 7",
            "target: acceleration",
            "m/s²",
            2 * 9.81,
            nan,
            "not reproducible",
            "no force of a drive is printed",
            f"{here}::test_every_chapter_with_results_is_there",
        ),
    )


def measured() -> tuple[Statement, ...]:
    """Section 9.1: what was measured on the machine and no model of ours holds."""
    here = f"{TESTS}/test_statements.py::test_every_chapter_with_results_is_there"
    why = "measured; clearance, friction and the controller are not in the model"
    ends = "not computed"
    return (
        Statement(
            "Table 5",
            "repeatability of the end-effector, x and z, and of the blocks",
            "µm",
            "< 4 and < 2; < 2",
            ends,
            "not reproducible",
            why,
            here,
        ),
        Statement(
            "section 9.1.3",
            "tracking error below 25 mm/s",
            "µm",
            "within ±5",
            ends,
            "not reproducible",
            why,
            here,
        ),
    )


def spindle() -> tuple[Statement, ...]:
    """Equations 65 and 66: the housing's tilt with and without a spindle."""
    test = f"{TESTS}/test_modal_arithmetic.py"
    inertia = MitSS1().housing_inertia
    equivalent = inertia * (2 * pi * TILT) ** 2 / ARM**2
    along_x = 1e6 * TABLE_6.value(table_6_row(-50, 30), "Kx")
    return (
        Statement(
            "eq. 65",
            "stiffness along x of the tilt, at the spindle's end",
            "N/µm",
            TILT_STIFFNESS / 1e6,
            equivalent / 1e6,
            "calibrated",
            "the housing's inertia is chosen so that this comes out",
            f"{test}::test_tilting_stiffness_and_inertia",
        ),
        Statement(
            "section 9.2.1",
            "resultant stiffness along x at x = −50 mm, b = 30°",
            "N/µm",
            4.7,
            1e-6 / (1.0 / along_x + 1.0 / TILT_STIFFNESS),
            "predicted",
            "arithmetic of two printed numbers",
            f"{test}::test_resultant_stiffness_at_the_spindle_end",
        ),
        Statement(
            "eq. 66",
            "tilting frequency with the spindle",
            "Hz",
            WITH_SPINDLE,
            nan,
            "not reproducible",
            "the inertia with the spindle is not printed; the number asks for "
            f"{(TILT / WITH_SPINDLE) ** 2:.3f} times the {inertia:.4f} kg m² without",
            f"{test}::test_frequency_with_the_spindle_needs_this_inertia",
        ),
    )
