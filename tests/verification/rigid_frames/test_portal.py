"""Portal frames and continuous beams against formulas of the handbooks.

@book{kleinlogel1952,
  author    = {Kleinlogel, Adolf},
  title     = {Rigid Frame Formulas},
  publisher = {Frederick Ungar}, address = {New York}, year = {1952},
}

The rectangular frame with clamped feet (height h, span L, columns I₁, girder I₂,
k = (I₂/I₁)(h/L)), girder under a uniform load w and under a side load P at its height:

    w: M_A = w L²/12(k+2), M_B = w L²/6(k+2), thrust w L²/4h(k+2)
    P: M_A = P h (3k+1)/2(6k+1), M_B = 3 P h k/2(6k+1)

The formulas take no account of tension and shear: the model has Euler-Bernoulli members whose
area is 10⁴ times that of a real one, which leaves about 1e-6 of a difference.
"""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.msa import LineLoad, LoadCase, Section, solve
from tests.structures import STEEL, Model, cantilever, wrench

HEIGHT, SPAN = 3.0, 5.0
COLUMN, GIRDER = 8e-6, 2e-5
STIFFENED = 1e-5


def portal() -> Model:
    model = Model()
    model.nodes(a=(0, 0, 0), b=(0, 0, HEIGHT), c=(SPAN, 0, HEIGHT), d=(SPAN, 0, 0))
    column, girder = (Section(50.0, i, i, i) for i in (COLUMN, GIRDER))
    model.beam("left", "a", "b", column, orientation=(1.0, 0, 0))
    model.beam("girder", "b", "c", girder)
    model.beam("right", "d", "c", column, orientation=(1.0, 0, 0))
    model.support("a")
    model.support("d")
    return model


K = GIRDER / COLUMN * HEIGHT / SPAN


def test_uniform_load_on_the_girder() -> None:
    w = 4000.0
    down = (0.0, 0.0, -w)
    case = LoadCase("w", line_loads=(LineLoad("girder", down, down),))
    found = solve(portal().place(), [case])
    foot = found.joint_force("support a", "w")
    thrust = w * SPAN**2 / (4 * HEIGHT * (K + 2))
    moment = w * SPAN**2 / (12 * (K + 2))
    np.testing.assert_allclose(foot[[0, 2, 4]], [thrust, w * SPAN / 2, moment], rtol=STIFFENED)
    corner = found.beam_forces[1, 0, 4, 0]
    assert abs(corner) == pytest.approx(w * SPAN**2 / (6 * (K + 2)), rel=STIFFENED)
    other = found.joint_force("support d", "w")
    np.testing.assert_allclose(other[[0, 2, 4]], foot[[0, 2, 4]] * [-1, 1, -1], rtol=1e-8)


def test_side_load_at_the_height_of_the_girder() -> None:
    p = 1500.0
    found = solve(portal().place(), [wrench("P", "b", p)])
    foot = found.joint_force("support a", "P")
    moment = p * HEIGHT * (3 * K + 1) / (2 * (6 * K + 1))
    # half of the load in each foot
    np.testing.assert_allclose(foot[[0, 4]], [-p / 2, -moment], rtol=STIFFENED)
    corner = 3 * p * HEIGHT * K / (2 * (6 * K + 1))
    assert abs(found.beam_forces[1, 0, 4, 0]) == pytest.approx(corner, rel=STIFFENED)
    # overturning: P h less the feet's moments, over the span
    lift = (p * HEIGHT - 2 * moment) / SPAN
    assert foot[2] == pytest.approx(-lift, rel=STIFFENED)


def test_a_beam_on_three_supports() -> None:
    """Two equal spans under a uniform load: 3/8, 10/8 and 3/8 of w L; w L²/8 over the middle
    (theorem of three moments)."""
    w, span = 900.0, 2.0
    model = Model()
    model.nodes(a=(0, 0, 0), b=(span, 0, 0), c=(2 * span, 0, 0))
    section = Section(1e-2, 1e-5, 1e-5, 1e-5)
    model.beam("first", "a", "b", section)
    model.beam("second", "b", "c", section)
    model.support("a", "x", "y", "z", "rx")
    model.support("b", "y", "z")
    model.support("c", "y", "z")
    down = (0.0, 0.0, -w)
    lines = tuple(LineLoad(beam, down, down) for beam in ("first", "second"))
    found = solve(model.place(), [LoadCase("w", line_loads=lines)])
    for node, share in (("a", 3), ("b", 10), ("c", 3)):
        force = found.joint_force(f"support {node}", "w")[2]
        # exact in Euler-Bernoulli's theory: round-off only
        assert force == pytest.approx(share / 8 * w * span, rel=1e-9)
    assert abs(found.beam_forces[0, 1, 4, 0]) == pytest.approx(w * span**2 / 8, rel=1e-9)


def test_a_propped_cantilever_that_sinks() -> None:
    """3 EI d/L³ at the prop that sinks by d."""
    ei = STEEL.youngs_modulus * 1e-5
    model = cantilever(Section(1e-2, 1e-5, 1e-5, 1e-5), length=2.0)
    model.support("tip", "z")
    found = solve(model.place(), [LoadCase("sink", gaps={("support tip", "z"): -3e-3})])
    assert found.joint_force("support tip", "sink")[2] == pytest.approx(
        -3 * ei * 3e-3 / 8, rel=1e-9
    )
