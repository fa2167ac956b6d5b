"""The Eclipse machine: the prototype's successor with all columns up."""

from __future__ import annotations

from dataclasses import dataclass

from strutwork.machines.eclipse_prototype import EclipsePrototype


@dataclass(frozen=True, kw_only=True)
class EclipseMachine(EclipsePrototype):
    """All columns rise from the guide and all links descend to the platform (Kim 2001, VII).

    The paper prints the diameters of the guide's bearings and no other dimension: all others are
    those of the prototype, enlarged as its guide is (assumed), so that nothing here is a
    prediction of the machine that was built.

    Parameters
    ----------
    base_radius : float
        R_b, m: between the bearings of 2400 and 2600 mm in diameter (section VII).
    platform_radius, link_length, tool_below, pole_height, link_radius, column_radius : float
        m. As `EclipsePrototype`, enlarged by 1.25/0.275.
    below : (bool, bool, bool)
        No carriage stands below its joint centre.
    platform_mass : float
        kg. As `EclipsePrototype`, enlarged by the cube of that.
    """

    base_radius: float = 1.25
    platform_radius: float = 0.080 * 1.25 / 0.275
    link_length: float = 0.3121 * 1.25 / 0.275
    tool_below: float = 0.0912 * 1.25 / 0.275
    pole_height: float = -0.0912 * 1.25 / 0.275
    link_radius: float = 0.033 * 1.25 / 0.275
    column_radius: float = 0.0157 * 1.25 / 0.275
    below: tuple[bool, bool, bool] = (False, False, False)
    platform_mass: float = 10.0 * (1.25 / 0.275) ** 3
