"""The cutter: how many teeth pass, and how they lag behind along the axis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from strutwork.cutting.numbers import positive
from strutwork.errors import ModelError


@dataclass(frozen=True)
class Cutter:
    """A milling cutter with equally spaced teeth.

    Parameters
    ----------
    diameter : float
        m.
    teeth : int
    helix : float
        Helix angle, rad; zero for straight teeth.
    lead : float
        Angle between the cutting edge and the plane across the axis (κ), rad; π/2 for an end mill.
    runout : float
        Offset of the cutter's axis from that of the spindle, m. It changes the load of each tooth
        (`strutwork.cutting.forces`), and stability not at all as long as every tooth cuts.

    Raises
    ------
    ModelError
        A diameter, a number of teeth or an angle out of range.
    """

    diameter: float
    teeth: int
    helix: float = 0.0
    lead: float = 0.5 * np.pi
    runout: float = 0.0

    def __post_init__(self) -> None:
        positive("cutter", "diameter", self.diameter)
        if isinstance(self.teeth, bool) or int(self.teeth) != self.teeth or self.teeth < 1:
            raise ModelError("cutter", f"has {self.teeth} teeth.", "Give a whole number from 1.")
        if not 0.0 <= self.helix < 0.5 * np.pi:
            raise ModelError(
                "cutter", f"has a helix angle of {self.helix:g} rad.", "Give 0 to below π/2."
            )
        if not 0.0 < self.lead <= 0.5 * np.pi:
            raise ModelError(
                "cutter", f"has a lead angle of {self.lead:g} rad.", "Give above 0 to π/2."
            )
        if not 0.0 <= self.runout < 0.5 * self.diameter:
            raise ModelError(
                "cutter",
                f"has a runout of {self.runout:g} m.",
                "Give the offset of its axis, zero or more and less than its radius.",
            )

    @property
    def pitch(self) -> float:
        """Angle between teeth, rad."""
        return 2.0 * np.pi / self.teeth

    @property
    def lag(self) -> float:
        """Angle by which the edge lags behind per depth, 2 tan(helix)/diameter, rad/m."""
        return 2.0 * float(np.tan(self.helix)) / self.diameter
