"""NAFEMS T4: steady conduction in two dimensions with convection, in a block one cell thick.

@techreport{nafems1990standard,
  title       = {The Standard {NAFEMS} Benchmarks},
  institution = {NAFEMS},
  year        = {1990},
  note        = {TNSB, Rev. 3, test T4}
}

0.6 x 1.0 m, k = 52 W/(m K); 100 K along y = 0, h = 750 W/(m² K) to 0 K along x = 0.6 and y = 1,
insulated along x = 0. Target at x = 0.6, y = 0.2: 18.3 K. The series of separated variables
(Carslaw and Jaeger 1959, section 5.3) gives it to any digit.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from strutwork.fea.solid import Solid
from strutwork.fea.solid_heat import HeatedSolid, HeatedSurface
from strutwork.meshes.block import block
from tests.solid_cases import STEEL

WIDTH, HEIGHT, CONDUCTIVITY, FILM = 0.6, 1.0, 52.0, 750.0


def series(x: float, y: float) -> float:
    """K, from a hundred terms cos(λ x) f(y) with λ tan(λ a) = h / k."""
    ratio, total = FILM / CONDUCTIVITY, 0.0
    for n in range(100):
        low, high = (n + 1e-12) * np.pi, (n + 0.5 - 1e-12) * np.pi
        a = brentq(lambda v: v * np.sin(v) - ratio * WIDTH * np.cos(v), low, high, xtol=1e-14)
        rate = a / WIDTH
        share = 4.0 * np.sin(a) / (2.0 * a + np.sin(2.0 * a))
        # f' + (h / k) f = 0 at the top, f = 1 at the bottom, without large numbers
        back = (rate - ratio) / (rate + ratio) * np.exp(-2.0 * rate * HEIGHT)
        f = (np.exp(-rate * y) + back * np.exp(rate * y)) / (1.0 + back)
        total += 100.0 * share * np.cos(rate * x) * f
    return float(total)


def test_the_temperature_of_the_point_e() -> None:
    mesh = block((WIDTH, HEIGHT, 0.1), (9, 15, 1))
    solid = Solid(mesh, dict.fromkeys(mesh.regions, STEEL))
    heated = HeatedSolid(solid, ())
    surfaces = [
        HeatedSurface("-y", change=100.0),
        HeatedSurface("+x", film=FILM),
        HeatedSurface("+y", film=FILM),
    ]
    found = heated.steady(dict.fromkeys(solid.used_regions, CONDUCTIVITY), surfaces)
    at = np.linalg.norm(heated.points - [WIDTH, 0.2, 0.0], axis=1).argmin()
    # three digits are printed
    np.testing.assert_allclose(found[at], 18.3, atol=0.06)
    # quadratic cells of a fifteenth of the height, beside a jump of temperature at the corner
    np.testing.assert_allclose(found[at], series(WIDTH, 0.2), rtol=1e-3)
