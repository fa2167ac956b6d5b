from __future__ import annotations

from math import cos, pi, radians, sin, sqrt
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.special import ellipe, ellipk

from strutwork.contact import (
    STEEL,
    AngularContact,
    BallRail,
    Bearing,
    ContactLaw,
    CylindricalRollers,
    Elastic,
    ball_in_groove,
    in_series,
    line_contact,
    point_contact,
)
from strutwork.errors import ModelError

Array = NDArray[Any]

PAIR = AngularContact(
    15, 6.35e-3, 36e-3, radians(25.0), 0.52, 0.53, "back_to_back", 12e-3, preload=150.0
)
SINGLE = AngularContact(15, 6.35e-3, 36e-3, radians(25.0), 0.52, 0.53, preload=150.0)
RAIL = BallRail(12, 4e-3, 0.53, 0.52, 22e-3, 8e-3, 44e-3, interference=5e-6)
ROLLERS = CylindricalRollers(14, 9.6e-3, clearance=-6e-6, slices=8)
BEARINGS = {"pair": PAIR, "single": SINGLE, "rail": RAIL, "rollers": ROLLERS}


def radial_integral(share: float, exponent: float) -> float:
    """Sjövall's integral J_r of the load zone ε."""
    end = np.arccos(max(-1.0, 1.0 - 2.0 * share))

    def load(angle: float) -> float:
        return float((1.0 - (1.0 - cos(angle)) / (2.0 * share)) ** exponent * cos(angle))

    return float(quad(load, 0.0, end, epsabs=1e-12)[0] / pi)


def random_displacement(bearing: Bearing, seed: int) -> Array:
    """Of the order of the preload: some elements open."""
    random = np.random.default_rng(seed)
    translation, rotation = random.uniform(-3e-6, 3e-6, 3), random.uniform(-1e-4, 1e-4, 3)
    return np.concatenate([translation, rotation]) * bearing.mask


def test_a_sphere_on_a_plane() -> None:
    found = point_contact(1.0 / 0.01, 1.0 / 0.01)
    reduced = 0.5 * STEEL.plane
    assert found.law.constant == pytest.approx(4.0 / 3.0 * reduced * sqrt(0.01), rel=1e-12)
    # the elliptic integrals lead to the circle without a step
    beside = point_contact(1.0 / 0.01, 1.00001 / 0.01)
    assert beside.law.constant == pytest.approx(found.law.constant, rel=1e-5)


def test_the_ellipse_of_a_known_ratio() -> None:
    # Johnson 1985, equation 4.28: (A / B) follows from the ratio of the axes
    ratio = 6.0
    m = 1.0 - ratio**-2
    k, e = ellipk(m), ellipe(m)
    curvatures = (k - e) / (ratio**2 * e - k)
    assert point_contact(curvatures, 1.0).ratio == pytest.approx(ratio, rel=1e-10)


def test_contacts_in_series_share_a_force() -> None:
    first, second = ContactLaw(2e9), ContactLaw(5e9)
    both = in_series(first, second)
    approach = first.approach(300.0) + second.approach(300.0)
    assert both.force(approach) == pytest.approx(300.0)
    with pytest.raises(ModelError, match="two exponents"):
        in_series(first, line_contact(0.01))


def test_one_row_under_axial_load() -> None:
    """The contact angle rises from α₀ to α: F = Z C A^(3/2) sin α (cos α₀ / cos α − 1)^(3/2)."""
    row = SINGLE.row()
    span, rest = 0.05 * 6.35e-3, radians(25.0)
    for angle in np.radians([25.5, 27.0, 32.0]):
        shift = span * sin(angle - rest) / cos(angle)
        force = 15 * row.law.constant * (span * (cos(rest) / cos(angle) - 1.0)) ** 1.5 * sin(angle)
        assert row.loads([0.0, 0.0, shift, 0.0, 0.0, 0.0])[2] == pytest.approx(force, rel=1e-10)


def test_one_row_of_balls_under_radial_load_by_stribeck() -> None:
    """Q = 4.37 F / Z without clearance: 1 / J_r(1/2) for point contact."""
    row = AngularContact(400, 1e-4, 36e-3, 0.0, 0.52, 0.53).row()
    force = row.loads([1e-9, 0.0, 0.0, 0.0, 0.0, 0.0])[0]
    largest = row.elements([1e-9, 0.0, 0.0, 0.0, 0.0, 0.0]).max()
    # the sum over 400 balls for the integral, and the change of the contact angle
    assert largest * 400 / force == pytest.approx(4.37, abs=0.005)
    assert largest * 400 / force == pytest.approx(1.0 / radial_integral(0.5, 1.5), rel=1e-4)


@pytest.mark.parametrize("clearance", [0.0, 4e-6, -8e-6])
def test_one_row_of_rollers_under_radial_load(clearance: float) -> None:
    """Sjövall: F = Z C δ^n J_r(ε) with ε = (1 − clearance / 2 δ_r) / 2; Q = 4.08 F / Z at ε = ½."""
    geometry = CylindricalRollers(600, 9.6e-3, clearance, slices=1)
    contacts, moved = geometry.bearing().contacts, 6e-6
    q = [moved, 0.0, 0.0, 0.0, 0.0, 0.0]
    force, largest = contacts.loads(q)[0], contacts.elements(q).max()
    share = 0.5 * (1.0 - clearance / (2.0 * moved))
    expected = 600 * largest * radial_integral(share, 10.0 / 9.0)
    assert force == pytest.approx(expected, rel=1e-4)
    if clearance == 0.0:
        assert largest * 600 / force == pytest.approx(4.08, abs=0.005)


def test_rollers_across_the_load_do_not_resist() -> None:
    # of eight rollers two lie across the load, closed by rounding alone
    contacts = CylindricalRollers(8, 9.6e-3, slices=1).bearing().contacts
    closed = contacts.law.slope(contacts.approach([1e-5, 0.0, 0.0, 0.0, 0.0, 0.0])) > 0.0
    assert np.count_nonzero(closed) == 3


@pytest.mark.parametrize("name", BEARINGS)
def test_loads_are_the_gradient_of_the_energy(name: str) -> None:
    contacts = BEARINGS[name].bearing().contacts
    q = random_displacement(BEARINGS[name].bearing(), 3)
    step = 1e-9
    for i, load in enumerate(contacts.loads(q)):
        way = step * np.eye(6)[i]
        slope = (contacts.energy(q + way) - contacts.energy(q - way)) / (2.0 * step)
        assert slope == pytest.approx(load, rel=1e-5, abs=1e-5 * np.abs(contacts.loads(q)).max())


@pytest.mark.parametrize("name", BEARINGS)
@pytest.mark.parametrize("seed", range(3))
def test_the_tangent_is_the_derivative_of_the_loads(name: str, seed: int) -> None:
    bearing = BEARINGS[name].bearing()
    q = random_displacement(bearing, seed)
    contacts, at = bearing.contacts, bearing.start + q
    exact = np.stack(
        [contacts.loads(at + 1e-30j * np.eye(6)[i]).imag / 1e-30 for i in range(6)], axis=-1
    )
    tangent = contacts.tangent(at)
    scale = np.sqrt(np.abs(np.diag(tangent)) + 1e-3)
    np.testing.assert_allclose(
        tangent / np.outer(scale, scale), exact / np.outer(scale, scale), atol=1e-9
    )
    np.testing.assert_allclose(tangent, tangent.T)
    assert np.linalg.eigvalsh(tangent / np.outer(scale, scale)).min() > -1e-9


@pytest.mark.parametrize("name", BEARINGS)
def test_the_secant_bears_the_load(name: str) -> None:
    bearing = BEARINGS[name].bearing()
    q = random_displacement(bearing, 1)
    secant = bearing.secant(q)
    load = bearing.loads(q)
    np.testing.assert_allclose(secant @ q, load, rtol=1e-9, atol=1e-9 * np.abs(load).max())
    np.testing.assert_allclose(secant, secant.T, rtol=1e-12, atol=1e-6)
    none = bearing.secant(np.zeros(6))
    np.testing.assert_allclose(none, bearing.tangent(), rtol=1e-12, atol=1e-6)


def test_free_directions_bear_nothing() -> None:
    for geometry in BEARINGS.values():
        bearing = geometry.bearing()
        free = ~bearing.mask
        stiffness = bearing.contacts.tangent(bearing.start)
        assert free.any()
        assert np.abs(stiffness[free]).max() < 1e-9 * np.abs(stiffness).max()


def test_a_pair_loses_its_preload_at_nearly_three_times_it() -> None:
    """With a constant contact angle a row opens at 2^(3/2) F₀, where the other has twice δ₀."""
    bearing, shift = PAIR.bearing(), PAIR.axial_shift()
    assert not bearing.opened([0.0, 0.0, 0.999 * shift, 0.0, 0.0, 0.0])
    assert bearing.opened([0.0, 0.0, 1.001 * shift, 0.0, 0.0, 0.0]) == ("the row at +z",)
    at = bearing.loads([0.0, 0.0, shift, 0.0, 0.0, 0.0])[2]
    # the angle grows, and the bearing stiffens by this
    assert 2.0**1.5 < at / PAIR.preload < 1.05 * 2.0**1.5
    assert bearing.opening([0.0, 0.0, 2.0 * shift, 0.0, 0.0, 0.0]) == pytest.approx(0.5, abs=1e-5)


def test_a_pair_has_twice_the_slope_of_a_row_and_back_to_back_resists_tilting() -> None:
    pair, single = PAIR.bearing().tangent(), SINGLE.bearing().tangent()
    assert pair[2, 2] == pytest.approx(2.0 * single[2, 2], rel=1e-9)
    assert pair[0, 0] == pytest.approx(2.0 * single[0, 0], rel=1e-9)
    # radial by axial stiffness: cot² α / 2 for a constant contact angle, which here grows by 1°
    assert pair[0, 0] / pair[2, 2] == pytest.approx(0.5 / np.tan(radians(25.0)) ** 2, rel=0.1)
    values = {f: getattr(PAIR, f) for f in PAIR.__dataclass_fields__}
    face = AngularContact(**(values | {"arrangement": "face_to_face"})).bearing().tangent()
    assert face[2, 2] == pytest.approx(pair[2, 2], rel=1e-9)
    assert pair[3, 3] > 1.5 * face[3, 3]


def test_a_carriage_in_closed_form() -> None:
    """k = 4 Z (3/2) C δ₀^(1/2) / 2 at 45°, beside the turning of the contacts."""
    bearing = RAIL.bearing()
    law = bearing.contacts.law
    exact = 4 * 12 * (0.5 * law.slope(5e-6) + 0.5 * law.force(5e-6) / (0.05 * 4e-3 + 5e-6))
    stiffness = bearing.tangent()
    assert stiffness[0, 0] == pytest.approx(float(exact), rel=1e-12)
    assert stiffness[1, 1] == pytest.approx(float(exact), rel=1e-12)
    # the same preload as a force of two rows
    force = 2 * 12 * float(law.force(5e-6)) * sin(radians(45.0))
    values = {f: getattr(RAIL, f) for f in RAIL.__dataclass_fields__}
    by_force = BallRail(**(values | {"interference": 0.0, "preload": force}))
    np.testing.assert_allclose(by_force.bearing().tangent(), stiffness, rtol=1e-9, atol=1e-3)
    crossed = BallRail(**(values | {"arrangement": "X"})).bearing().tangent()
    assert stiffness[5, 5] > 2.0 * crossed[5, 5]
    # a row opens where the carriage has gone δ₀ √2 upward
    assert bearing.opened([0.0, 6.9e-6, 0.0, 0.0, 0.0, 0.0]) == ()
    off = set(bearing.opened([0.0, 7.3e-6, 0.0, 0.0, 0.0, 0.0]))
    assert off == {"the row at −x −y", "the row at +x −y"}


def test_rollers_lose_their_preload_where_one_side_opens() -> None:
    bearing = ROLLERS.bearing()
    assert bearing.opened(np.zeros(6)) == ()
    assert bearing.opened([2e-6, 0.0, 0.0, 0.0, 0.0, 0.0]) == ()
    # half the interference of 6 µm is 3 µm: beyond, less than the circumference bears
    assert bearing.opened([1e-3, 0.0, 0.0, 0.0, 0.0, 0.0]) == ("one side",)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"balls": 2}, "at least three"),
        ({"balls": 40}, "more than its pitch diameter"),
        ({"inner_groove": 0.5}, "no wider than the ball"),
        ({"contact_angle": 2.0}, "outside 0 to 90"),
        ({"preload": -1.0}, "negative preload"),
        ({"spacing": 0.0}, "pair without a spacing"),
        ({"arrangement": "single"}, "single and has a spacing"),
        ({"contact_angle": 0.0, "preload": 1e9}, "cannot bear an axial preload"),
    ],
)
def test_bad_dimensions_of_a_ball_bearing(change: dict[str, Any], words: str) -> None:
    values = {f: getattr(PAIR, f) for f in PAIR.__dataclass_fields__}
    with pytest.raises(ModelError, match=words):
        AngularContact(**(values | change)).bearing()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"balls": 1}, "at least two"),
        ({"rail_groove": 0.4}, "no wider than the ball"),
        ({"contact_angle": 0.0}, "outside 0 to 90"),
        ({"width": -1.0}, "negative dimension"),
        ({"preload": 10.0}, "a preload and an interference"),
    ],
)
def test_bad_dimensions_of_a_carriage(change: dict[str, Any], words: str) -> None:
    values = {f: getattr(RAIL, f) for f in RAIL.__dataclass_fields__}
    with pytest.raises(ModelError, match=words):
        BallRail(**(values | change))


def test_bad_contacts() -> None:
    with pytest.raises(ModelError, match="bodies conform"):
        ball_in_groove(0.01, 0.5)
    with pytest.raises(ModelError, match="touch in a line"):
        point_contact(1e-12, 1e3)
    with pytest.raises(ModelError, match="positive constant"):
        ContactLaw(-1.0)
    for bad in (CylindricalRollers, lambda r, n: CylindricalRollers(5, n, slices=r - 2)):
        with pytest.raises(ModelError):
            bad(2, 0.01)
    with pytest.raises(ModelError, match="not positive"):
        CylindricalRollers(5, 0.0)
    assert Elastic(1e9, 0.0).plane == 1e9
