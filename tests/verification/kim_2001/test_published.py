"""Printed results of the document beside the calibrated prototype.

@article{kim2001,
  author  = {Kim, Jongwon and Park, Frank C. and Ryu, Sun Joong and others},
  title   = {Design and Analysis of a Redundantly Actuated Parallel Mechanism for Rapid Machining},
  journal = {IEEE Transactions on Robotics and Automation},
  volume  = {17},
  number  = {4},
  year    = {2001}
}

Four dimensions were fitted to Table II and to the two barriers: what is asserted here guards the
fit and is no validation.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from strutwork.kinematics import jacobians
from strutwork.machines import EclipsePrototype, variants
from strutwork.machines.load import load
from strutwork.papers.kim_2001.comparison import (
    HORIZONTAL,
    at_plate,
    barriers,
    ellipsoid,
    one_link_thin,
    radius_study,
)
from strutwork.papers.kim_2001.drive_rows import ROLLS, least_singular_value
from strutwork.papers.kim_2001.published import TABLE_2


@pytest.mark.parametrize(
    ("tilt", "printed"),
    # page with Table II: magnitudes and the force directions; at tilt 0 the largest axis, at 90
    # the smallest (its sign is free)
    [(0.0, (0.8688, 0.0, 0.4962)), (HORIZONTAL, (-0.1739, 0.0, 0.9848))],
)
def test_table_2(tilt: float, printed: tuple[float, float, float]) -> None:
    """5 % of the norm, to which it was calibrated; directions to 2°."""
    found = ellipsoid(at_plate(), tilt)
    name = "0" if tilt == 0.0 else "90"
    published = [v.value for v in TABLE_2 if v.quantity.endswith(f"tilt {name} deg")]
    assert len(published) == 3
    error = np.linalg.norm(found.magnitudes - published) / np.linalg.norm(published)
    assert error < 0.05
    axis = found.axes[:, 0 if tilt == 0.0 else 2]
    assert abs(axis @ np.array(printed)) > np.cos(np.radians(2.0))


@pytest.mark.parametrize(
    ("roll", "wanted"),
    [(0.0, (30.00, 60.01)), (10.0, (29.73, 63.16)), (20.0, (29.23, 72.70)), (30.0, (29.00,))],
)
def test_barriers(roll: float, wanted: tuple[float, ...]) -> None:
    """Printed as 30 and 60° (section VIII); our digits at other spindle angles, to 0.01°."""
    np.testing.assert_allclose(barriers(roll), wanted, atol=0.01)


@pytest.mark.parametrize(("drives", "left"), [("7a", 29.9982), ("7b", 60.0061)])
def test_each_extra_drive_leaves_one_barrier(drives: str, left: float) -> None:
    """At spindle angle 0: the margin falls to nothing at one of the two and not at the other."""
    machine = EclipsePrototype(drives=drives)  # type: ignore[arg-type]
    both = np.array([29.99816, 60.00615])
    margin = jacobians(machine.linkage, machine.place(machine.tilted(np.radians(both)))).margin(
        machine.platform_radius
    )
    gone = np.abs(both - left) < 1.0
    assert margin[gone].max() < 1e-4
    assert margin[~gone].min() > 0.05


@pytest.mark.parametrize(
    ("length", "upright", "turned"),
    [("platform_radius", 0.2351, 0.1498), ("base_radius", 0.2394, 0.1657)],
)
def test_both_extra_drives_leave_none(length: str, upright: float, turned: float) -> None:
    """Least singular values at spindle angle 0 and up to 30° to either side, our digits.

    They depend on the length that counts as one radian, which the document does not state; that
    they are not zero does not.
    """
    size = getattr(EclipsePrototype(), length)
    for rolls, wanted in (([0.0], upright), (ROLLS, turned)):
        value, _, _ = least_singular_value("8", rolls, length=size)
        assert value == pytest.approx(wanted, abs=1e-4)


def test_radius_of_the_links() -> None:
    """Flat from 35 mm on (section V); our ratios to rigid links, to their digits."""
    found = dict(radius_study(0.0))
    for radius, wanted in ((0.015, 1.71), (0.020, 1.225), (0.025, 1.092), (0.035, 1.024)):
        assert found[radius] == pytest.approx(wanted, abs=5e-3)


def test_the_printed_order_of_sensitivity_does_not_come_out() -> None:
    """Printed: the first link at tilt 0, the other two at 90. Ours is the other way about."""
    first, second, third = one_link_thin(0.0)
    assert second == pytest.approx(third)
    assert first < second
    first, second, third = one_link_thin(HORIZONTAL)
    assert first > second


def test_eight_drives_are_another_structure() -> None:
    """Section V treats the machine as if six drives held it: no bound on that of eight."""
    six = ellipsoid(at_plate(), 0.0)
    eight = ellipsoid(replace(at_plate(), drives="8"), 0.0)
    assert eight.magnitudes[0] < 0.5 * six.magnitudes[0]


def test_height_of_a_hinge() -> None:
    """Eq. 3: P_z = h + L sin φ with φ > 0 on the leg from below and φ < 0 on the others."""
    machine = EclipsePrototype()
    placement = machine.place(machine.tilted(np.radians(20.0), 0.1))
    value = dict(zip(placement.names, placement.values, strict=True))
    for i, sign in ((1, 1.0), (2, -1.0), (3, -1.0)):
        phi, height = value[f"leg{i}/hinge", "rz"], value[f"leg{i}/slide", "z"]
        seat = machine.linkage.node_index[f"platform/P{i}"]
        assert sign * phi > 0
        assert placement.positions[seat, 2] == pytest.approx(
            height + machine.link_length * np.sin(phi), abs=1e-15
        )


@pytest.mark.parametrize(("drives", "count"), [("6", 6), ("7a", 7), ("7b", 7), ("8", 8)])
def test_the_variants_have_their_drives(drives: str, count: int) -> None:
    machine = variants("eclipse-prototype")[drives].factory()
    found = jacobians(machine.linkage, machine.place(machine.home()))
    assert len(found.driven) == count
    assert load(f"eclipse-machine:{drives}").structure.masses
