"""Line contact of a roller with a raceway."""

from __future__ import annotations

from strutwork.contact.law import ContactLaw

#: Approach of a steel roller and one raceway: δ = 3.84·10⁻⁵ Q^0.9 / l^0.8, in mm, N and mm.
PALMGREN = 3.84e-5


def line_contact(length: float) -> ContactLaw:
    """Contact of a steel roller with one raceway, by Palmgren's formula.

    δ = 3.84·10⁻⁵ Q^0.9 / l^0.8 with δ and l in mm and Q in N (A. Palmgren, Ball and Roller
    Bearing Engineering, 3rd ed. 1959; also in Harris, Rolling Bearing Analysis). It holds for
    rollers and rings of steel and contains neither diameter.

    Parameters
    ----------
    length : float
        Effective length of the roller, m.
    """
    # per mm^(10/9) to per m^(10/9)
    millimetres = (1e3 * length) ** (8.0 / 9.0) * PALMGREN ** (-10.0 / 9.0)
    return ContactLaw(millimetres * 1e3 ** (10.0 / 9.0), 10.0 / 9.0)
