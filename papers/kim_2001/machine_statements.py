"""What Kim et al. 2001 print of radii and of the machines built, beside the computed values."""

from __future__ import annotations

from math import nan

from strutwork.papers.kim_2001.comparison import HORIZONTAL, one_link_thin, radius_study
from strutwork.papers.kim_2001.published import MEASURED
from strutwork.papers.kim_2001.reasons import FITTED, HERE, OURS, UNDRAWN
from strutwork.papers.statements import Statement


def radii() -> tuple[Statement, ...]:
    """Compliance by the radii of links and columns, section V."""
    flat = dict(radius_study(0.0))[0.035]
    first, second, _ = one_link_thin(0.0)
    lying_first, lying_second, _ = one_link_thin(HORIZONTAL)
    order = f"{OURS}::test_the_printed_order_of_sensitivity_does_not_come_out"
    drawn = (
        "drawn without legible numbers; the computed one is shown in the chapters on radii and "
        "on workspace"
    )
    return (
        Statement(
            "section V",
            "compliance is flat from a link radius of 35 mm on",
            "",
            "yes; 33 mm chosen",
            f"{100 * (flat - 1):.1f} % above rigid links at tilt 0",
            "calibrated",
            FITTED,
            f"{OURS}::test_radius_of_the_links",
        ),
        Statement(
            "section V",
            "at tilt 0 the first link matters most",
            "",
            "yes",
            f"with a link of 15 mm: first {first:.2f}, others {second:.2f} of as built",
            "not reproducible",
            "the opposite with the calibrated dimensions",
            order,
        ),
        Statement(
            "section V",
            "at tilt 90 the other two links matter more",
            "",
            "yes",
            f"with a link of 15 mm: first {lying_first:.2f}, others {lying_second:.2f} of as built",
            "not reproducible",
            "the opposite with the calibrated dimensions",
            order,
        ),
        *(
            Statement(place, what, "", "a figure", "a figure", "not reproducible", drawn, test)
            for place, what, test in (
                ("Figs 11, 12", "ellipsoids", f"{OURS}::test_table_2"),
                ("Fig. 13", "norms over places of the tool", f"{HERE}::test_norms_over_a_plane"),
                ("Fig. 14", "norm by radius of each link", f"{HERE}::test_radii_add_up"),
                ("Fig. 15", "norm by radii of links and columns", f"{HERE}::test_radii_add_up"),
            )
        ),
    )


def machines() -> tuple[Statement, ...]:
    """What sections VI and VII give of the machines built."""
    joints = (
        "it includes the compliance of joints, drives and bearings, about which nothing is printed"
    )
    rated = "a rating of drives and spindles; nothing is printed from which it would follow"
    return (
        *(
            Statement(
                "sections VI, VII",
                f"{v.row}: stiffness {v.quantity}",
                "N/µm",
                v.value,
                nan,
                "not reproducible",
                joints,
                UNDRAWN,
            )
            for v in MEASURED
        ),
        *(
            Statement("sections VI, VII", what, unit, value, nan, "not reproducible", why, UNDRAWN)
            for what, unit, value, why in (
                ("eclipse-prototype: largest feed", "m/min", 1.5, rated),
                (
                    "eclipse-machine: workspace",
                    "mm",
                    "300 in diameter, 200",
                    "no stroke is printed",
                ),
                ("eclipse-machine: largest feed", "m/min", 3.3, rated),
                ("eclipse-machine: largest acceleration", "g", 0.1, rated),
                ("eclipse-machine: tool spindle", "", "2.2 kW, 4000 rpm", rated),
                ("eclipse-machine: workpiece spindle", "", "15 kW, 3000 rpm", rated),
            )
        ),
    )
