"""Stiffness at the tool of a machine where it stands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

from strutwork.html import table
from strutwork.kinematics import DIRECTIONS
from strutwork.msa import axis_stiffness_blocked, axis_stiffness_free

Array = NDArray[Any]


@dataclass(frozen=True)
class ToolStiffness:
    """Stiffness at the tool centre point, global axes.

    Parameters
    ----------
    compliance : (6, 6)
        m/N, 1/N, rad/(N·m); translations first.
    """

    compliance: Array

    @property
    def free(self) -> Array:
        """1/C_ii, the other directions free to follow, (6,): N/m, then N·m/rad."""
        return axis_stiffness_free(self.compliance)

    @property
    def blocked(self) -> Array:
        """(C⁻¹)_ii, the other directions blocked, (6,): N/m, then N·m/rad."""
        return axis_stiffness_blocked(self.compliance)

    def __repr__(self) -> str:
        x, y, z = self.free[:3] / 1e6
        return f"<ToolStiffness, free: x {x:.4g}, y {y:.4g}, z {z:.4g} N/µm>"

    def _repr_html_(self) -> str:
        rows = [
            (d, f"{f / scale:.4g}", f"{b / scale:.4g}", unit)
            for d, f, b in zip(DIRECTIONS, self.free, self.blocked, strict=True)
            for scale, unit in [(1e6, "N/µm") if d in "xyz" else (1e3, "kN·m/rad")]
        ]
        return table("Stiffness at the tool", rows, ("", "others free", "others blocked", ""))
