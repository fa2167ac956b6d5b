"""Workspace, feed and straightness of the MIT-SS-1, and removal rate, beside Son 2002."""

from __future__ import annotations

from functools import cache
from math import nan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import jacobians
from strutwork.machines import MitSS1
from strutwork.machines.mit_ss1 import NOMINAL_TILT
from strutwork.overconstraint.accuracy import accuracy
from strutwork.overconstraint.sampling import variances
from strutwork.papers.son_2002.measured_statements import TESTS
from strutwork.papers.son_2002.planar_kinematics import singular_tilt
from strutwork.papers.son_2002.tolerances import pin_tolerances, rail_tolerances
from strutwork.papers.statements import Statement
from strutwork.studies.removal_rate import cutting_force, removal_exponents

Array = NDArray[Any]

HERE = f"{TESTS}/test_machine_statements.py"
SCALING = f"{TESTS}/test_scaling.py"

#: Accuracy of the parts as inspected, m (section 8.3), over the width of a pin.
INSPECTED = 15e-6

#: Line on which straightness is looked at, m to either side (sections 9.1.1 and 9.1.3).
LINE = 0.05

#: Line of Fig. 51, m to either side, and its feed, m/s.
FIGURE_51, FEED = 0.15, 0.010

#: Fig. 8: specific cutting energy, J/m³, and force, N; depth and width of cut, m.
FIGURE_8 = {
    "aluminium alloys": (0.76e9, 30.0),
    "cast irons": (3.55e9, 142.0),
    "steels": (6.01e9, 240.0),
}
CUT = 0.2e-3

#: Fig. 8: mass, kg, acceleration, m/s², and its force as printed, N.
MASS, ACCELERATION, INERTIA = 500.0, 0.5 * 9.80665, 2450.0


def removal_statements() -> tuple[Statement, ...]:
    """Section 3.2: forces of cutting and of inertia, and powers of the size."""
    rows = [
        Statement(
            "Fig. 8",
            f"cutting force, {material}",
            "N",
            printed,
            float(cutting_force(CUT, energy, (CUT, 0.0))),
            "predicted",
            "arithmetic of the printed energy and cut",
            f"{SCALING}::test_cutting_forces",
        )
        for material, (energy, printed) in FIGURE_8.items()
    ]
    rows.append(
        Statement(
            "Fig. 8",
            "inertia of 500 kg at 0.5 g",
            "N",
            INERTIA,
            MASS * ACCELERATION,
            "predicted",
            "arithmetic",
            f"{SCALING}::test_inertia_beside_cutting",
        )
    )
    for n in (3.0, 3.5):
        found = removal_exponents(n)
        for place, what, value in (
            ("eq. 22", "feed", found.feed),
            ("eq. 23", "deflection at the same removal rate", found.deflection),
        ):
            printed = (n - 3.0) / 2.0 if what == "feed" else -(n - 1.0) / 2.0
            rows.append(
                Statement(
                    place,
                    f"{what} ~ size^m, drives' force ~ size^{n:g}",
                    "",
                    printed,
                    value,
                    "predicted",
                    "the exponent as printed, at this power of the drives' force",
                    f"{SCALING}::test_constant_removal_rate",
                )
            )
    return tuple(rows)


@cache
def reach_along_x(tilt: float = 0.0) -> tuple[float, float]:
    """Ends along x at which all struts reach at every tilt up to ±`tilt`, m."""
    machine, x = MitSS1(), np.linspace(-0.3, 0.3, 6001)
    b = np.linspace(-tilt, tilt, 61) if tilt else np.zeros(1)
    good = machine.place(machine.poses(x[:, None], 0.0, b)).reachable.all(axis=1)
    return float(x[good].min()), float(x[good].max())


@cache
def tilts_in_the_middle() -> tuple[float, float, float]:
    """At x = 0: tilt of the actuator singularity, least and largest that struts reach, rad."""
    machine, b = MitSS1(), np.radians(np.linspace(-90.0, 90.0, 1801))
    good = machine.place(machine.poses(0.0, 0.0, b)).reachable
    return singular_tilt(machine, 0.0) or nan, float(b[good].min()), float(b[good].max())


@cache
def block_speeds() -> Array:
    """Least and largest speed of each block on the line of Fig. 51, (2, 3), m/s."""
    machine = MitSS1()
    placement = machine.place(machine.poses(np.linspace(-FIGURE_51, FIGURE_51, 301)))
    placement.require_reachable()
    rates = FEED * np.abs(jacobians(machine.linkage, placement).inverse[..., 0])
    return np.stack([rates.min(axis=0), rates.max(axis=0)])


def workspace_statements() -> tuple[Statement, ...]:
    """Sections 6.3 and 9.1: how far it reaches, and how its blocks move."""
    (low, high), (left, right) = reach_along_x(), reach_along_x(NOMINAL_TILT)
    singular, least, most = np.degrees(tilts_in_the_middle())
    least_speed, most_speed = 1e3 * block_speeds()
    speeds = ", ".join(f"{a:.1f} to {b:.1f}" for a, b in zip(least_speed, most_speed, strict=True))
    ends = (
        f"{1e3 * left:.0f} to {1e3 * right:.0f} mm against {1e3 * low:.0f} to {1e3 * high:.0f} mm"
    )
    return (
        Statement(
            "section 6.3",
            "x-z workspace with tilts of ±30° over that without",
            "",
            "smaller",
            f"{(right - left) / (high - low):.2f} along x: {ends}".replace("-", "−"),
            "predicted",
            "by the reach of the struts alone; travels and the values of Fig. 31 are not printed",
            f"{HERE}::test_reach_along_x",
        ),
        Statement(
            "section 6.3",
            "tilts at which collisions use up the workspace",
            "deg",
            "about +80 and −60",
            f"at x = 0 the struts reach from {least:.1f} to {most:.1f}, and from {singular:.1f} "
            "on beyond the actuator singularity".replace("-", "−"),
            "not reproducible",
            "shapes of struts, end-effector and stops are not printed; the limits by the joints "
            "alone are elsewhere",
            f"{HERE}::test_tilts_in_the_middle",
        ),
        Statement(
            "Fig. 32",
            "workspace over machine volume: commercial machines, the U5, the MIT-SS-1 with "
            "ancillaries",
            "%",
            "about 1; 2.1; about 1.5",
            "not computed",
            "not reproducible",
            "other makers' data, and an estimate of parts that were not built",
            f"{HERE}::test_reach_along_x",
        ),
        Statement(
            "Fig. 51",
            "300 mm along x at 10 mm/s: speeds of the drives",
            "mm/s",
            "vary in the MIT-SS-1, constant in a Cartesian machine",
            f"blocks {speeds}; slide x of the serial machine 10",
            "predicted",
            "with the tool upright; the curves of the figure carry no legible numbers",
            f"{HERE}::test_speeds_on_a_straight_line",
        ),
    )


@cache
def straightness() -> tuple[float, float]:
    """Largest and standard deviation of the tool along y from its mean over the line, m.

    Pins as accurate as the parts were inspected, rails as they were laid: the bearings give way
    until the over-constrained parts fit, at every place for the same errors. Of what is linear in
    the errors the mean over the line is taken off, since the plane's zero is the gauge's; the
    worst case over all zones is exact.
    """
    machine = MitSS1()
    placed = machine.structure.at(machine.place(machine.poses(np.linspace(-LINE, LINE, 21))))
    slope = INSPECTED / machine.pin_width
    found = accuracy(placed, (*pin_tolerances(slope, slope), *rail_tolerances()))
    gain = found.gain[:, 1] - found.gain[:, 1].mean(axis=0)
    worst = found.sources.supports(gain[:, None]).sum(axis=-1)
    spread = np.sqrt(gain**2 @ variances(found.sources))
    return float(worst.max()), float(spread.max())


def straightness_statement() -> Statement:
    """Section 9.1.1."""
    worst, spread = straightness()
    return Statement(
        "section 9.1.1",
        "straightness along x over 100 mm, from the plane",
        "µm",
        "within ±3",
        f"within ±{1e6 * worst:.1f} at worst; standard deviation {1e6 * spread:.1f}",
        "predicted",
        "pins within 15 µm over their width, as inspected (section 8.3), rails within 4 µm; play "
        "and eccentric bearings, which the thesis suspects, are not included",
        f"{HERE}::test_straightness",
    )


def screw_statement() -> Statement:
    """Section 9.2.2: a second pair of bearings at the ball screw."""
    return Statement(
        "Fig. 61",
        "frequency with a second pair of bearings at the screw, over that with one",
        "",
        1.4,
        float(np.sqrt(2.0)),
        "predicted",
        "the root of twice the stiffness, where nothing else is compliant; arithmetic",
        f"{HERE}::test_a_second_pair_of_bearings",
    )
