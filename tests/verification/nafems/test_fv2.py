"""NAFEMS FV2: free vibration of a pin-ended double cross in its plane.

@techreport{nafems1990,
  title       = {Selected Benchmarks for Natural Frequency Analysis},
  author      = {Abbassian, F. and Dawswell, D. J. and Knowles, N. C.},
  institution = {NAFEMS},
  year        = {1990},
  note        = {Test FV2}
}

Eight arms of 5 m, 0.125 m square, meet in a hub; their tips are pinned. Targets 11.336,
17.709 (7 times), 45.345, 57.390 (7 times) Hz. They ignore that arms stretch: converged
Euler-Bernoulli beams that stretch part each group of seven in 2 and 5, 17.681 and
17.709 Hz, 57.076 and 57.391 Hz. How often a frequency comes is the test.
"""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.fea import modes
from strutwork.msa import PlacedStructure
from tests.frame_files import chain, frame_file, in_plane, read

STEEL = {"youngs_modulus": "200 GPa", "poissons_ratio": 0.3, "density": "8000 kg/m^3"}
SQUARE = {"shape": "rectangle", "width_y": "0.125 m", "height_z": "0.125 m"}
TARGETS = [11.336, *(17.709,) * 7, 45.345, *(57.390,) * 7]
STRETCHING = [11.336, *(17.681,) * 2, *(17.709,) * 5, 45.345, *(57.076,) * 2, *(57.391,) * 5]


def double_cross(elements: int) -> PlacedStructure:
    content = frame_file(STEEL, SQUARE, "FV2")
    for i in range(8):
        angle = i * pi / 4
        tip = (5.0 * cos(angle), 5.0 * sin(angle), 0.0)
        chain(content, f"arm{i}", ("hub", (0, 0, 0)), (f"tip{i}", tip), elements, shear=False)
    in_plane(content, {f"tip{i}": ("x", "y") for i in range(8)})
    return read(content)


def groups(frequencies: NDArray[np.float64]) -> list[int]:
    """How often each frequency comes; equal means to 1e-6, the groups differ by 1e-3."""
    apart = np.flatnonzero(np.diff(frequencies) > 1e-6 * frequencies[1:])
    return [int(n) for n in np.diff([0, *(apart + 1), len(frequencies)])]


def test_four_elements_an_arm_meet_the_targets_with_their_multiplicity() -> None:
    found = modes(double_cross(4), 16).frequencies
    assert groups(found) == [1, 2, 5, 1, 2, 5]
    # four cubic elements raise the second bending of an arm, βh = 1.77, by (βh)⁴/1440 = 0.7 %
    np.testing.assert_allclose(found, TARGETS, rtol=7e-3)


@pytest.mark.parametrize("method", ["dense", "sparse"])
def test_converged_beams_part_the_groups_by_their_stretching(method: str) -> None:
    found = modes(double_cross(16), 16, method=method).frequencies  # type: ignore[arg-type]
    assert groups(found) == [1, 2, 5, 1, 2, 5]
    # the published beams have no rotary inertia, which lowers ours by (βr)²/2 and less: 3.2e-4
    # for the first bending of an arm and 1.3e-3 for the second (β = 3.93/5 and 7.07/5 per m)
    rotary = (np.array([3.1416, *(3.9266,) * 7, 6.2832, *(7.0686,) * 7]) / 5 * 0.0361) ** 2 / 2
    assert np.all(found <= np.array(STRETCHING) * (1 + 2e-5))
    assert np.all(found >= np.array(STRETCHING) * (1 - 1.2 * rotary))
