"""Natural frequencies of uniform beams under all classical end conditions.

@book{blevins1979,
  title     = {Formulas for Natural Frequency and Mode Shape},
  author    = {Blevins, Robert D.},
  publisher = {Van Nostrand Reinhold},
  year      = {1979},
  note      = {Tables 8-1 (bending), 8-16 (axial), 8-19 (torsion)}
}
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq

from strutwork.fea import Modes, modes
from strutwork.msa import Material, rod
from tests.structures import Model

Array = NDArray[np.float64]

LENGTH, DIAMETER, ELEMENTS = 2.0, 0.002, 40
MATERIAL = Material.isotropic(200e9, 0.25, density=8000.0)
RADIUS = DIAMETER / 4

#: What an end holds in bending, and what the two ends' axial motion and twist are held by.
HELD = {
    "clamped": ("y", "z", "ry", "rz"),
    "pinned": ("y", "z"),
    "guided": ("ry", "rz"),
    "free": (),
}


def characteristic(ends: tuple[str, str]) -> list[float]:
    """First roots λ = βL of the frequency equation (Blevins 1979, table 8-1), to 1e-12."""
    equations = {
        frozenset({"clamped"}): lambda x: np.cos(x) - 1 / np.cosh(x),
        frozenset({"free"}): lambda x: np.cos(x) - 1 / np.cosh(x),
        frozenset({"clamped", "free"}): lambda x: np.cos(x) + 1 / np.cosh(x),
        frozenset({"clamped", "pinned"}): lambda x: np.tan(x) - np.tanh(x),
        frozenset({"free", "pinned"}): lambda x: np.tan(x) - np.tanh(x),
        frozenset({"clamped", "guided"}): lambda x: np.tan(x) + np.tanh(x),
        frozenset({"free", "guided"}): lambda x: np.tan(x) + np.tanh(x),
        frozenset({"guided", "pinned"}): np.cos,
        frozenset({"pinned"}): np.sin,
        frozenset({"guided"}): np.sin,
    }
    function = equations[frozenset(ends)]
    grid = np.linspace(0.5, 16.0, 4001)
    values = function(grid)
    found = []
    for a, b, fa, fb in zip(grid[:-1], grid[1:], values[:-1], values[1:], strict=True):
        # a jump of the tangent is no root
        if fa * fb < 0 and max(abs(fa), abs(fb)) < 1.0:
            found.append(float(brentq(function, a, b, xtol=1e-13)))
    return found[:3]


def beam(first: tuple[str, ...], second: tuple[str, ...], **options: object) -> Model:
    model = Model()
    model.nodes(a=(0, 0, 0), b=(LENGTH, 0, 0))
    model.beam("beam", "a", "b", rod(DIAMETER), MATERIAL, shear=False, elements=ELEMENTS, **options)
    for node, locks in (("a", first), ("b", second)):
        if locks:
            model.support(node, *locks)
    return model


PAIRS = [
    ("clamped", "clamped"),
    ("clamped", "free"),
    ("clamped", "pinned"),
    ("clamped", "guided"),
    ("pinned", "pinned"),
    ("pinned", "guided"),
    ("guided", "guided"),
    ("free", "free"),
    ("free", "pinned"),
    ("free", "guided"),
]
#: Rigid-body motions in one plane of bending.
FLOATING = {
    ("guided", "guided"): 1,
    ("free", "free"): 2,
    ("free", "pinned"): 1,
    ("free", "guided"): 1,
}


def test_roots_are_the_published_ones() -> None:
    published = {
        ("clamped", "clamped"): [4.73004074, 7.85320462, 10.9956079],
        ("clamped", "free"): [1.87510407, 4.69409113, 7.85475744],
        ("clamped", "pinned"): [3.92660231, 7.06858275, 10.21017612],
        ("clamped", "guided"): [2.36502037, 5.49780392, 8.63937983],
        ("pinned", "guided"): [np.pi / 2, 3 * np.pi / 2, 5 * np.pi / 2],
        ("pinned", "pinned"): [np.pi, 2 * np.pi, 3 * np.pi],
    }
    for ends, roots in published.items():
        np.testing.assert_allclose(characteristic(ends), roots, rtol=6e-9)


def bending(ends: tuple[str, str], method: str) -> Modes:
    first, second = (HELD[end] for end in ends)
    # the beam may neither slide along x nor spin
    model = beam((*first, "x", "rx"), second)
    count = 2 * FLOATING.get(ends, 0) + 6
    return modes(model.place(), count, method=method)  # type: ignore[arg-type]


@pytest.mark.parametrize("method", ["dense", "sparse"])
@pytest.mark.parametrize("ends", PAIRS, ids="-".join)
def test_bending(ends: tuple[str, str], method: str) -> None:
    found = bending(ends, method)
    rigid = 2 * FLOATING.get(ends, 0)
    assert found.rigid_body_modes == rigid
    assert np.all(found.frequencies[:rigid] == 0.0)
    roots = np.repeat(characteristic(ends), 2)
    stiffness = MATERIAL.youngs_modulus * rod(DIAMETER).second_moment_z
    per_length = 8000.0 * rod(DIAMETER).area
    expected = roots**2 / (2 * np.pi * LENGTH**2) * np.sqrt(stiffness / per_length)
    # a round section bends in two planes: every frequency comes twice
    flexible = found.frequencies[rigid:]
    np.testing.assert_allclose(flexible[::2], flexible[1::2], rtol=1e-8)
    # cubic elements raise a frequency by (βh)⁴/1440 (4e-6 at βh = 0.27); rotary inertia lowers
    # it by about (βr)², 8e-6 at most
    np.testing.assert_allclose(flexible, expected, rtol=1e-5)


#: Ends of a bar, and kL/π of its first two modes: n for equal ends, n − 1/2 for others.
BARS = [("held", "held", (1.0, 2.0)), ("held", "free", (0.5, 1.5)), ("free", "free", (1.0, 2.0))]


@pytest.mark.parametrize(("first", "second", "waves"), BARS)
@pytest.mark.parametrize("motion", ["x", "rx"])
def test_axial_and_torsional(
    motion: str, first: str, second: str, waves: tuple[float, float]
) -> None:
    others = tuple(d for d in ("x", "y", "z", "rx", "ry", "rz") if d != motion)
    model = Model()
    nodes = {f"n{i}": (LENGTH * i / ELEMENTS, 0, 0) for i in range(ELEMENTS + 1)}
    model.nodes(**nodes)
    for i in range(ELEMENTS):
        model.beam(f"b{i}", f"n{i}", f"n{i + 1}", rod(DIAMETER), MATERIAL, shear=False)
    for i, node in enumerate(nodes):
        end = first if i == 0 else second if i == ELEMENTS else "free"
        model.support(node, *others, *((motion,) if end == "held" else ()))
    found = modes(model.place(), 3)
    floats = int((first, second) == ("free", "free"))
    assert found.rigid_body_modes == floats
    modulus = MATERIAL.youngs_modulus if motion == "x" else MATERIAL.shear_modulus
    speed = np.sqrt(modulus / 8000.0)
    expected = np.array(waves) * speed / (2 * LENGTH)
    # linear elements with consistent mass raise a frequency by (kh)²/24, here up to 1.03e-3
    share = (np.array(waves) * np.pi / ELEMENTS) ** 2 / 24
    flexible = found.frequencies[floats : floats + 2]
    np.testing.assert_allclose(flexible / expected - 1.0, share, rtol=0.02, atol=1e-8)


def test_refinement_converges_with_the_order_of_the_elements() -> None:
    """Twice the elements, a sixteenth of the error: the fourth power of the element's size."""
    errors = []
    root = characteristic(("clamped", "clamped"))[2]
    for pieces in (5, 10, 20):
        model = beam(("x", "rx", *HELD["clamped"]), HELD["clamped"])
        model.beams = [type(model.beams[0])(**{**vars(model.beams[0]), "elements": pieces})]
        found = modes(model.place(), 6).frequencies[4]
        ideal = root**2 / (2 * np.pi * LENGTH**2) * np.sqrt(200e9 / 8000.0) * RADIUS
        errors.append(found / ideal - 1.0)
    # rotary inertia's share, (βr)² ~ 8e-6, is taken off by differences
    first, second = errors[0] - errors[1], errors[1] - errors[2]
    assert first / second == pytest.approx(16.0, rel=0.15)
