"""The granite L of the MIT-SS-1 free in space, code to code.

@phdthesis{son2002,
  title  = {Design Principles and Methodologies for Reconfigurable Machining Systems},
  author = {Son, Seung-Kil},
  school = {Massachusetts Institute of Technology},
  year   = {2002}
}

Section 6.2: granite bending 269.4 Hz and twisting 320.9 Hz, of a frame whose thicknesses are
not published. The dimensions here are those of a model that another finite element program
was given: depth 0.60, height 1.50, plate 0.184, base 0.228 m, quadratic hexahedra of about
0.17 m: 269.33 and 320.83 Hz. The width was not handed down: 0.9 m, of the envelope, twists at
320, the other 1.0 m at 298 Hz. It is no prediction of the thesis's numbers.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from strutwork.fea.solid_modes import solid_modes
from strutwork.meshes import l_frame
from tests.solid_cases import GRANITE, matrices_of

REFERENCE = np.array([269.33, 320.83])
ENVELOPE = (0.9, 0.6, 1.5)


def bending_and_twisting(
    width: float = 0.9, size: float = 0.17, ratio: float = 1.0, **stops: Sequence[float]
) -> np.ndarray:
    """The lowest two flexible modes, Hz."""
    mesh = l_frame((width, *ENVELOPE[1:]), 0.184, 0.228, size=size, stops=stops, corner_ratio=ratio)
    found = solid_modes(matrices_of(mesh, material=GRANITE), 8)
    assert found.rigid_body_modes == 6
    return found.frequencies[6:]


def test_reference_to_its_tolerance() -> None:
    # three layers in each plate and 0.15 m beyond. The reference's divisions were not handed
    # down: these are among the few, of those tried, that meet both numbers within 0.05 %
    found = bending_and_twisting(
        size=0.15,
        y=[*np.linspace(0, 0.184, 4), *np.linspace(0.184, 0.6, 5)],
        z=np.linspace(0, 0.228, 4).tolist(),
    )
    np.testing.assert_allclose(found, REFERENCE, rtol=5e-4)


def test_reference_with_cells_of_its_size() -> None:
    # two layers: 0.20 and 0.15 % above; the singular corner makes frequencies depend on the
    # divisions by as much. CalculiX with twenty-node hexahedra of reduced integration (C3D20R)
    # on this mesh: 270.22 and 321.13 Hz, with full integration (C3D20) 270.59 and 321.91
    found = bending_and_twisting()
    np.testing.assert_allclose(found, REFERENCE, rtol=2.5e-3)
    np.testing.assert_allclose(found, [270.2241, 321.1330], rtol=2.5e-3)
    assert np.all(found < [270.5875, 321.9087])


def test_width_that_was_not_handed_down() -> None:
    wide = bending_and_twisting(width=1.0)
    assert wide[1] == pytest.approx(298.4, abs=0.1)
    assert abs(wide[0] / REFERENCE[0] - 1) < 4e-3


@pytest.mark.slow
def test_converged_frame() -> None:
    # refined towards the corner, both fall 0.35 % below the reference: its mesh is not converged
    found = bending_and_twisting(size=0.1, ratio=4.0)
    assert np.all(found < REFERENCE)
    np.testing.assert_allclose(found, REFERENCE, rtol=4e-3)
