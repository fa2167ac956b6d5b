"""Argyris' right-angle frame, clamped at one end: vibration out of its plane.

@article{argyris1979,
  title   = {Finite Element Method: The Natural Approach},
  author  = {Argyris, J. H. and Balmer, H. and Doltsinis, J. St. and Dunne, P. C. and Haase, M.
             and Kleiber, M. and Malejannakis, G. A. and Mlejnek, H.-P. and M{\\"u}ller, M.
             and Scharpf, D. W.},
  journal = {Computer Methods in Applied Mechanics and Engineering},
  volume  = {17--18},
  pages   = {1--106},
  year    = {1979}
}

Two legs of 240 mm, 30 mm high in the frame's plane and 3 mm thick, E = 71240 MPa, ν = 0.31,
ρ = 5e-9 t/mm³: 11.2732 and 30.5269 Hz.
"""

from __future__ import annotations

import numpy as np

from strutwork.fea import modes
from tests.frame_files import chain, frame_file, read, support

MATERIAL = {"youngs_modulus": "71240 MPa", "poissons_ratio": 0.31, "density": "5000 kg/m^3"}
SECTION = {"shape": "rectangle", "width_y": "3 mm", "height_z": "30 mm"}


def test_two_lowest_frequencies() -> None:
    content = frame_file(MATERIAL, SECTION, "right-angle frame")
    corner = ("corner", (0.0, 0.24, 0.0))
    chain(content, "post", ("foot", (0.0, 0.0, 0.0)), corner, 10, orientation=[1, 0, 0])
    chain(content, "arm", corner, ("tip", (0.24, 0.24, 0.0)), 10, orientation=[0, 1, 0])
    support(content, "foot")
    found = modes(read(content), 2)
    # 1 %: the published beams are coarser, and do not say how their corner joins
    np.testing.assert_allclose(found.frequencies, [11.2732, 30.5269], rtol=1e-2)
    # out of the plane: z, and rotations about x and y
    largest = np.abs(found.shapes[..., [0, 1, 5]]).max(axis=(1, 2))
    assert np.all(largest < 1e-9 * np.abs(found.shapes).max(axis=(1, 2)))
