"""Kinematics: joints, linkages, placements, their constraint rows and what follows from them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from strutwork.kinematics.frames import (
    angle,
    axes_frame,
    cross_matrix,
    rotation_x,
    rotation_y,
    rotation_z,
    tangent_rotation,
)
from strutwork.kinematics.joint import DIRECTIONS, JOINT_TYPES, Joint, State
from strutwork.kinematics.linkage import GROUND, Body, Linkage
from strutwork.kinematics.mobility import FreeMotion, Mobility, SelfStress, mobility
from strutwork.kinematics.near_mechanism import NearMechanism, near_motions
from strutwork.kinematics.placement import Placement, check_coincidence
from strutwork.kinematics.rows import (
    ConstraintRows,
    body_references,
    characteristic_length,
    characteristic_lengths,
    constraint_rows,
)
from strutwork.later import later

if TYPE_CHECKING:
    from strutwork.kinematics.assembly_modes import AssemblyModes
    from strutwork.kinematics.branches import Branches
    from strutwork.kinematics.capability import Zonotope, force_zonotope, velocity_zonotope
    from strutwork.kinematics.capsules import Capsule, Interference
    from strutwork.kinematics.drive_forces import Forces, inverse_dynamics
    from strutwork.kinematics.dynamics import Dynamics, PlacedDynamics
    from strutwork.kinematics.error_transmission import ErrorTransmission
    from strutwork.kinematics.forward import FoundPoses, forward_kinematics
    from strutwork.kinematics.inverse_survey import InverseSurvey
    from strutwork.kinematics.jacobians import Jacobians, jacobians
    from strutwork.kinematics.largest_shape import LargestShape
    from strutwork.kinematics.manipulability import VelocityEllipsoid, velocity_ellipsoid
    from strutwork.kinematics.margins import Margins
    from strutwork.kinematics.mechanism import Mechanism, Poses, drive_values
    from strutwork.kinematics.motion import Motion, Moved
    from strutwork.kinematics.regions import Regions
    from strutwork.kinematics.reversals import Reversals
    from strutwork.kinematics.singular_distance import singularity_distance
    from strutwork.kinematics.singular_poses import Singularity
    from strutwork.kinematics.singularities import singularities_on_line
    from strutwork.kinematics.singularity_curves import (
        SingularCurve,
        SingularPlane,
        singularities_in_plane,
    )
    from strutwork.kinematics.task_grid import TaskGrid
    from strutwork.kinematics.tool_drive_space import ToolDriveSpace
    from strutwork.kinematics.trajectory import Trajectory, roughness
    from strutwork.kinematics.transmission import Ellipsoids, force_ellipsoids, velocity_ellipsoids

__all__ = [
    "DIRECTIONS",
    "GROUND",
    "JOINT_TYPES",
    "AssemblyModes",
    "Body",
    "Branches",
    "Capsule",
    "ConstraintRows",
    "Dynamics",
    "Ellipsoids",
    "ErrorTransmission",
    "Forces",
    "FoundPoses",
    "FreeMotion",
    "Interference",
    "InverseSurvey",
    "Jacobians",
    "Joint",
    "LargestShape",
    "Linkage",
    "Margins",
    "Mechanism",
    "Mobility",
    "Motion",
    "Moved",
    "NearMechanism",
    "PlacedDynamics",
    "Placement",
    "Poses",
    "Regions",
    "Reversals",
    "SelfStress",
    "SingularCurve",
    "SingularPlane",
    "Singularity",
    "State",
    "TaskGrid",
    "ToolDriveSpace",
    "Trajectory",
    "VelocityEllipsoid",
    "Zonotope",
    "angle",
    "axes_frame",
    "body_references",
    "characteristic_length",
    "characteristic_lengths",
    "check_coincidence",
    "constraint_rows",
    "cross_matrix",
    "drive_values",
    "force_ellipsoids",
    "force_zonotope",
    "forward_kinematics",
    "inverse_dynamics",
    "jacobians",
    "mobility",
    "near_motions",
    "rotation_x",
    "rotation_y",
    "rotation_z",
    "roughness",
    "singularities_in_plane",
    "singularities_on_line",
    "singularity_distance",
    "tangent_rotation",
    "velocity_ellipsoid",
    "velocity_ellipsoids",
    "velocity_zonotope",
]

#: Files of names that are read when first asked for: compiled code and its libraries more than
#: double the time of an import.
_LATER = {
    "AssemblyModes": "assembly_modes",
    "Branches": "branches",
    "Capsule": "capsules",
    "Dynamics": "dynamics",
    "Ellipsoids": "transmission",
    "ErrorTransmission": "error_transmission",
    "Forces": "drive_forces",
    "FoundPoses": "forward",
    "Interference": "capsules",
    "InverseSurvey": "inverse_survey",
    "Jacobians": "jacobians",
    "LargestShape": "largest_shape",
    "Margins": "margins",
    "Mechanism": "mechanism",
    "Motion": "motion",
    "Moved": "motion",
    "PlacedDynamics": "dynamics",
    "Poses": "mechanism",
    "Regions": "regions",
    "Reversals": "reversals",
    "SingularCurve": "singularity_curves",
    "SingularPlane": "singularity_curves",
    "Singularity": "singular_poses",
    "TaskGrid": "task_grid",
    "ToolDriveSpace": "tool_drive_space",
    "Trajectory": "trajectory",
    "VelocityEllipsoid": "manipulability",
    "Zonotope": "capability",
    "drive_values": "mechanism",
    "force_ellipsoids": "transmission",
    "force_zonotope": "capability",
    "forward_kinematics": "forward",
    "inverse_dynamics": "drive_forces",
    "jacobians": "jacobians",
    "roughness": "trajectory",
    "singularities_in_plane": "singularity_curves",
    "singularities_on_line": "singularities",
    "singularity_distance": "singular_distance",
    "velocity_ellipsoid": "manipulability",
    "velocity_ellipsoids": "transmission",
    "velocity_zonotope": "capability",
}

__getattr__, __dir__ = later(__name__, _LATER)
