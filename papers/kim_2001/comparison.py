"""What Kim et al. 2001 print, computed on the prototype with its calibrated dimensions."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import jacobians
from strutwork.machines.eclipse_prototype import Drives, EclipsePrototype
from strutwork.msa.sections import rod
from strutwork.msa.tool import tool_compliance
from strutwork.papers.kim_2001.published import AXES, BARRIERS, PROTOTYPE, TABLE_2
from strutwork.papers.published_rows import PublishedRow

Array = NDArray[Any]

#: Radii of the study of the links, m, and one so large that a link is rigid.
RADII, RIGID = (0.015, 0.020, 0.025, 0.033, 0.035), 1.0
#: Horizontal in the sense of Table II, deg: at 90 a joint centre lies on the guide's axis when
#: the platform's centre does, which no placement names; this is its limit.
HORIZONTAL = 90.0 - 1e-4


@dataclass(frozen=True)
class Ellipsoid:
    """Compliance of the tool's position, as an ellipsoid.

    Parameters
    ----------
    magnitudes : (3,)
        Semi-axes, m/N, largest first.
    axes : (3, 3)
        Their unit directions as columns.
    """

    magnitudes: Array
    axes: Array

    @property
    def norm(self) -> float:
        """Frobenius norm of the compliance, m/N."""
        return float(np.linalg.norm(self.magnitudes))


def at_plate(drives: Drives = "6") -> EclipsePrototype:
    """The prototype with the tool at the platform's centre, in the plane of the guide."""
    return EclipsePrototype(tool_below=0.0, pole_height=0.0, drives=drives)


def position_compliance(
    machine: EclipsePrototype, tilt: float, thin: tuple[int, float] | None = None
) -> Array:
    """Compliance of the tool's position at a tilt about y, (3, 3), m/N.

    Parameters
    ----------
    machine : EclipsePrototype
    tilt : float
        β at γ = 0, deg.
    thin : (int, float), optional
        A leg, from one, whose link has this radius, m, instead.
    """
    structure = machine.structure
    if thin is not None:
        name, section = f"leg{thin[0]}/link", rod(2.0 * thin[1])
        structure = replace(
            structure,
            beams=tuple(
                replace(b, section=section) if b.name == name else b for b in structure.beams
            ),
        )
    placed = structure.at(machine.place(machine.tilted(np.radians(tilt))))
    return np.asarray(tool_compliance(placed)[:3, :3])


def ellipsoid(
    machine: EclipsePrototype, tilt: float, thin: tuple[int, float] | None = None
) -> Ellipsoid:
    """Compliance ellipsoid; parameters as of `position_compliance`."""
    magnitudes, axes = np.linalg.eigh(position_compliance(machine, tilt, thin))
    return Ellipsoid(magnitudes[::-1], axes[:, ::-1])


def barriers(roll: float = 0.0, drives: Drives = "6") -> Array:
    """Tilt angles, deg, at which the six drives of the prototype no longer hold its platform.

    Roots of the determinant between points 0.05° apart, by a line between them: it is smooth,
    and the angles are right to 1e-4°.

    Parameters
    ----------
    roll : float
        γ, deg.
    """
    tilt = np.arange(1.0, 89.0, 0.05) + 0.013
    machine = EclipsePrototype(drives=drives)
    placement = machine.place(machine.tilted(np.radians(tilt), np.radians(roll)))
    found = jacobians(machine.linkage, placement).determinant()
    at = np.flatnonzero(np.sign(found[1:]) != np.sign(found[:-1]))
    return np.asarray(tilt[at] + 0.05 * found[at] / (found[at] - found[at + 1]))


def radius_study(tilt: float) -> tuple[tuple[float, float], ...]:
    """Radius of all links, m, and the norm of the compliance over that with rigid links."""
    machine = at_plate()
    rigid = ellipsoid(replace(machine, link_radius=RIGID), tilt).norm
    return tuple((r, ellipsoid(replace(machine, link_radius=r), tilt).norm / rigid) for r in RADII)


def one_link_thin(tilt: float, radius: float = 0.015) -> tuple[float, ...]:
    """Norm of the compliance with one link so thin, over that with all as built; legs 1 to 3."""
    machine = at_plate()
    whole = ellipsoid(machine, tilt).norm
    return tuple(ellipsoid(machine, tilt, (leg, radius)).norm / whole for leg in (1, 2, 3))


def table_2_rows() -> tuple[PublishedRow, ...]:
    """The magnitudes of Table II beside computed values; four dimensions were fitted to them."""
    found = {
        f"{axis} at tilt {name} deg": float(value)
        for name, tilt in (("0", 0.0), ("90", HORIZONTAL))
        for axis, value in zip(AXES, ellipsoid(at_plate(), tilt).magnitudes, strict=True)
    }
    note = "fitted together to 5 % of the matrix's norm; the smallest axes are not met alone"
    return tuple(
        PublishedRow(v.row, v.quantity, v.unit, v.value, found[v.quantity], "calibrated", note)
        for v in TABLE_2
    )


def barrier_rows() -> tuple[PublishedRow, ...]:
    """The two singular tilt angles beside the computed values at γ = 0."""
    return tuple(
        PublishedRow(
            PROTOTYPE, v.quantity, v.unit, v.value, float(ours), "calibrated", "at spindle angle 0"
        )
        for v, ours in zip(BARRIERS, barriers(), strict=True)
    )
