"""Stiffness of profile rail carriages by preload, beside a manufacturer's table.

@manual{hiwin_compact,
  author = {{HIWIN}},
  title  = {Compact catalogue: linear guideways, ballscrews, linear stages}
}

Table 1.13 prints the stiffness of four-row carriages at three preloads, of which the second is 0.05
to 0.07 of the dynamic load rating and the third at least 0.10. Between contacts of rigid bodies the
stiffness grows as the cube root of the preload: by (0.10 / 0.07)^(1/3) = 1.13 to
(0.10 / 0.05)^(1/3) = 1.26. The dimensions of the balls and grooves are not printed, so that the
stiffness itself is not predicted; a load-deflection curve with them was not at hand. The smallest
and the largest size grow by less, 1.11: there the carriage itself takes a larger part.
"""

from __future__ import annotations

import pytest

from strutwork.contact import BallRail

#: Stiffness at the second and the third preload, N/µm.
PRINTED = {
    "HG20C": (540, 620),
    "HG25C": (630, 730),
    "HG30C": (770, 900),
    "HG35C": (830, 980),
    "HG45C": (940, 1090),
    "HG55C": (1080, 1230),
}


def growth(ratio: float) -> float:
    """Growth of the stiffness by that of the preload."""
    first, second = (
        BallRail(12, 4e-3, 0.53, 0.53, 22e-3, 8e-3, 44e-3, preload=force).bearing().tangent()
        for force in (1000.0, 1000.0 * ratio)
    )
    return float(second[1, 1] / first[1, 1])


@pytest.mark.parametrize("size", PRINTED)
def test_growth_with_preload(size: str) -> None:
    low, high = growth(0.10 / 0.07), growth(0.10 / 0.05)
    first, second = PRINTED[size]
    middle = 0.5 * (low + high)
    # the table prints ranges of the preload, which leave the growth open by as much
    assert middle == pytest.approx(second / first, abs=0.5 * (high - low))


def test_the_cube_root() -> None:
    # beside the turning of the contacts in their grooves, which adds 4 % at the larger preload
    assert growth(8.0) == pytest.approx(2.0, rel=0.04)
