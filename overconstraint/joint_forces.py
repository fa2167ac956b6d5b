"""The forces and moments of a joint that tolerances lock in and limits bound."""

from __future__ import annotations

#: Name of each, the joint directions that it takes together, and its unit.
JOINT_FORCES = (
    ("radial force", ("x", "y"), "N"),
    ("axial force", ("z",), "N"),
    ("bending moment", ("rx", "ry"), "N*m"),
    ("torque", ("rz",), "N*m"),
)
