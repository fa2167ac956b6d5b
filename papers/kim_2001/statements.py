"""Every result that Kim et al. 2001 print, beside the computed values."""

from __future__ import annotations

from math import nan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.machines.eclipse_prototype import EclipsePrototype
from strutwork.papers.kim_2001.comparison import (
    HORIZONTAL,
    at_plate,
    barrier_rows,
    barriers,
    ellipsoid,
    table_2_rows,
)
from strutwork.papers.kim_2001.drive_rows import least_singular_value
from strutwork.papers.kim_2001.machine_statements import machines, radii
from strutwork.papers.kim_2001.places import joint_directions, joint_ellipsoid, positioning_radius
from strutwork.papers.kim_2001.published import (
    AXES,
    DIRECTIONS,
    TABLE_1,
    TABLE_2_JOINT,
)
from strutwork.papers.kim_2001.reasons import FITTED, HERE, OURS, TESTS, UNDRAWN
from strutwork.papers.statements import Statement, stated

Array = NDArray[Any]


def statements() -> tuple[Statement, ...]:
    """All of them, in the order of the document."""
    return (
        *_kinematics(),
        *_table_1(),
        *_singular(),
        *_workspace(),
        *_castigliano(),
        *stated(table_2_rows(), "Table II", f"{OURS}::test_table_2"),
        *_directions(),
        *_joint(),
        *radii(),
        *machines(),
    )


def _kinematics() -> tuple[Statement, ...]:
    return (
        Statement(
            "section II.A",
            "kinematic degrees of freedom, each of three legs P P R S",
            "",
            6.0,
            6.0,
            "predicted",
            "rank of the constraint rows",
            f"{HERE}::test_six_freedoms",
        ),
        Statement(
            "eq. 3",
            "height of a ball: P_z = h + L sin φ",
            "",
            "the text would change the sign on the lower leg",
            "holds with φ > 0 on the leg from below and φ < 0 on the others",
            "predicted",
            "the equation is right and the sentence about signs is not",
            f"{OURS}::test_height_of_a_hinge",
        ),
        Statement(
            "eq. 1",
            "carriage on the far side of the guide, θ + π, is another solution",
            "",
            "prevented by interference of the links",
            "out of reach: L is less than R_b + R_p",
            "calibrated",
            FITTED,
            f"{HERE}::test_the_far_side_of_the_guide_is_out_of_reach",
        ),
        Statement(
            "section II.C",
            "degree of the polynomial of the forward kinematics",
            "",
            16.0,
            16.0,
            "predicted",
            "sixteen distinct complex solutions at general poses",
            f"{HERE}::test_sixteen_solutions",
        ),
    )


def _table_1() -> tuple[Statement, ...]:
    """Computing times and rates of convergence."""
    reasons = {
        "ms": "on a Pentium of 266 MHz",
        "%": "how starts are drawn and what counts as converged is not printed",
        "": "how starts are drawn and what counts as converged is not printed",
    }
    return tuple(
        Statement(
            "Table I",
            f"{v.row}: {v.quantity}",
            v.unit,
            v.value,
            nan,
            "not reproducible",
            "share of a computing time, on a Pentium of 266 MHz"
            if v.quantity.startswith("share")
            else reasons[v.unit],
            UNDRAWN,
        )
        for v in TABLE_1
    )


def _singular() -> tuple[Statement, ...]:
    machine = EclipsePrototype()
    by_platform, _, _ = least_singular_value("8", [0.0])
    by_guide, _, _ = least_singular_value("8", [0.0], length=machine.base_radius)
    lone = {d: _alone(d) for d in ("7a", "7b")}
    return (
        *stated(barrier_rows(), "section III", f"{OURS}::test_barriers"),
        Statement(
            "Fig. 4",
            "tilt at which a link lies in the plate and points at its centre",
            "deg",
            "approximately 30",
            f"{barriers()[1]:.1f}",
            "not reproducible",
            "such a link is singular whatever the dimensions; here it is that of leg 1 at the "
            "second singular tilt, and at the first no link lies in the plate",
            f"{HERE}::test_a_link_in_the_plate",
        ),
        Statement(
            "Fig. 5",
            "a ball above the guide's centre: infinite rates of joints",
            "",
            "yes",
            "rate times the ball's distance from the axis tends to 1",
            "predicted",
            "no dimension enters",
            f"{HERE}::test_a_ball_above_the_centre",
        ),
        Statement(
            "Fig. 6",
            "both barriers extend over every spindle angle",
            "",
            "yes",
            "the first up to 113°, the second up to 29°",
            "not reproducible",
            "by the calibrated dimensions; beyond 113° the balls of ±55° do not allow a tilt of "
            "90°, so the first lies on every path and the second does not",
            f"{HERE}::test_where_the_barriers_end",
        ),
        Statement(
            "section III",
            "drives beyond six that are needed against both barriers",
            "",
            2.0,
            2.0,
            "calibrated",
            FITTED,
            f"{OURS}::test_both_extra_drives_leave_none",
        ),
        Statement(
            "section III",
            "least singular value with eight drives, spindle angle 0",
            "",
            "not printed",
            f"{by_platform:.3f} by R_p, {by_guide:.3f} by R_b",
            "calibrated",
            (
                "G adds metres to radians, so a number needs a length, which the document does "
                "not state"
            ),
            f"{OURS}::test_both_extra_drives_leave_none",
        ),
        Statement(
            "section VIII",
            "singular tilts without the drive of the lower hinge",
            "deg",
            "approximately 30 and 60",
            lone["7b"],
            "not reproducible",
            "by the calibrated dimensions the drive of the upper hinge, where it is kept, removes "
            "the first",
            f"{OURS}::test_each_extra_drive_leaves_one_barrier",
        ),
        Statement(
            "section VIII",
            "the lower hinge's drive alone removes the singular tilts",
            "",
            "yes",
            f"leaves that at {lone['7a']}°",
            "not reproducible",
            "section III says itself that two are needed",
            f"{OURS}::test_each_extra_drive_leaves_one_barrier",
        ),
    )


def _alone(drives: str) -> str:
    """The singular tilt that one extra drive leaves at spindle angle 0, deg."""
    fine = np.arange(20.0, 70.0, 0.01)
    _, tilt, _ = least_singular_value(drives, [0.0], fine)  # type: ignore[arg-type]
    return f"{tilt:.1f}"


def _workspace() -> tuple[Statement, ...]:
    upright, lying = (2e3 * positioning_radius(tilt, "midway") for tilt in (0.0, 90.0))
    why = (
        "axes of the balls' sockets and strokes of the columns are not printed; with balls of "
        "±55° counted from halfway between both tilts and no stroke"
    )
    return (
        Statement(
            "Fig. 8",
            "positioning workspace at tilt 0",
            "mm",
            "a figure; 100 in diameter and 100 high by section VI",
            f"{upright:.0f} in diameter",
            "not reproducible",
            why,
            f"{HERE}::test_positioning_workspace",
        ),
        Statement(
            "Fig. 9",
            "positioning workspace at tilt 90",
            "mm",
            "a figure; 100 in diameter and 100 high by section VI",
            f"{lying:.0f} in diameter",
            "not reproducible",
            why,
            f"{HERE}::test_positioning_workspace",
        ),
        Statement(
            "section IV",
            "workspace simply connected, found by experiment",
            "",
            "yes",
            "not asked",
            "not reproducible",
            "depends on strokes, sockets and shapes of links that are not printed",
            UNDRAWN,
        ),
    )


def _castigliano() -> tuple[Statement, ...]:
    six, eight = (1e6 * float(ellipsoid(m, 0.0).magnitudes[0]) for m in (at_plate(), at_plate("8")))
    return (
        Statement(
            "section V",
            "compliance of a determinate machine from the energy of its rods",
            "",
            "a formula",
            "agrees with the frame solution to 1e-9",
            "predicted",
            "an exact law, derived again since signs are illegible",
            f"{TESTS}/test_castigliano.py::test_the_frame_solution_is_castiglianos",
        ),
        Statement(
            "section V",
            "the formula is a reasonable analysis of the machine with eight drives",
            "",
            "yes",
            f"largest compliance at tilt 0 is {eight:.2f} µm/N with eight, {six:.2f} with six",
            "not reproducible",
            "with held drives the two additional ones carry load whatever the control intends",
            f"{OURS}::test_eight_drives_are_another_structure",
        ),
        Statement(
            "section VIII",
            "redundant drives may improve the stiffness",
            "",
            "yes",
            f"{six / eight:.1f} times at tilt 0, largest axis",
            "calibrated",
            FITTED,
            f"{OURS}::test_eight_drives_are_another_structure",
        ),
    )


def _directions() -> tuple[Statement, ...]:
    found: list[Statement] = []
    for (kind, axis, tilt), printed in DIRECTIONS.items():
        at = HORIZONTAL if tilt else 0.0
        structural = kind == "structural"
        axes = ellipsoid(at_plate(), at).axes if structural else joint_directions(at)
        ours = axes[:, AXES.index(axis)]
        angle = _between(np.array(printed), ours)
        lost = (kind, axis, tilt) == ("structural", "smallest", 0)
        close = structural and not lost
        found.append(
            Statement(
                "Table II",
                f"{kind}: direction of the {axis} axis at tilt {tilt} deg",
                "",
                _vector(np.array(printed)),
                f"{_vector(ours * np.sign(ours @ np.array(printed)))}, {angle:.1f}° off",
                "calibrated" if close else "not reproducible",
                FITTED
                if close
                else "not perpendicular to the printed largest: a sign is lost"
                if lost
                else "units and stiffnesses of the drives are not printed; six of equal "
                "stiffness along their paths are assumed",
                f"{OURS}::test_table_2" if structural else f"{HERE}::test_joint_ellipsoids",
            )
        )
    return tuple(found)


def _between(first: Array, second: Array) -> float:
    """Angle between two lines, deg."""
    cosine = float(abs(first @ second)) / float(np.linalg.norm(first) * np.linalg.norm(second))
    return float(np.degrees(np.arccos(min(cosine, 1.0))))


def _vector(values: Array) -> str:
    return ", ".join(f"{v:.4f}" for v in np.round(values, 4) + 0.0).replace("-", "−")


def _joint() -> tuple[Statement, ...]:
    """Magnitudes of the joint rows over the largest at tilt 0: the document's are relative."""
    ours = {0: joint_ellipsoid(0.0), 90: joint_ellipsoid(HORIZONTAL)}
    first = TABLE_2_JOINT.values[0].value
    found = []
    for value in TABLE_2_JOINT:
        axis, *_, tilt, _ = value.quantity.split()
        found.append(
            Statement(
                "Table II",
                f"joint: {value.quantity}, over the largest at tilt 0",
                "",
                value.value / first,
                float(ours[int(tilt)][AXES.index(axis)]),
                "not reproducible",
                "units and stiffnesses of the drives are not printed; six of equal stiffness "
                "along their paths are assumed",
                f"{HERE}::test_joint_ellipsoids",
            )
        )
    # one is the other's unit
    return tuple(found[1:])
