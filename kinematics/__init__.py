"""Kinematics: joints, linkages, placements, their constraint rows and what follows from them."""

from strutwork.kinematics.forward import FoundPoses, forward_kinematics
from strutwork.kinematics.frames import (
    angle,
    axes_frame,
    cross_matrix,
    rotation_x,
    rotation_y,
    rotation_z,
    tangent_rotation,
)
from strutwork.kinematics.jacobians import Jacobians, jacobians
from strutwork.kinematics.joint import DIRECTIONS, JOINT_TYPES, Joint, State
from strutwork.kinematics.linkage import GROUND, Body, Linkage
from strutwork.kinematics.manipulability import VelocityEllipsoid, velocity_ellipsoid
from strutwork.kinematics.mechanism import Mechanism, Poses, drive_values
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

__all__ = [
    "DIRECTIONS",
    "GROUND",
    "JOINT_TYPES",
    "Body",
    "ConstraintRows",
    "FoundPoses",
    "FreeMotion",
    "Jacobians",
    "Joint",
    "Linkage",
    "Mechanism",
    "Mobility",
    "NearMechanism",
    "Placement",
    "Poses",
    "SelfStress",
    "State",
    "VelocityEllipsoid",
    "angle",
    "axes_frame",
    "body_references",
    "characteristic_length",
    "characteristic_lengths",
    "check_coincidence",
    "constraint_rows",
    "cross_matrix",
    "drive_values",
    "forward_kinematics",
    "jacobians",
    "mobility",
    "near_motions",
    "rotation_x",
    "rotation_y",
    "rotation_z",
    "tangent_rotation",
    "velocity_ellipsoid",
]
