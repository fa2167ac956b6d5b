"""Kinematics: joints, linkages, placements, their constraint rows and what follows from them."""

from kinematics.forward import FoundPoses, forward_kinematics
from kinematics.frames import (
    angle,
    axes_frame,
    cross_matrix,
    rotation_x,
    rotation_y,
    rotation_z,
    tangent_rotation,
)
from kinematics.jacobians import Jacobians, jacobians
from kinematics.joint import DIRECTIONS, JOINT_TYPES, Joint, State
from kinematics.linkage import GROUND, Body, Linkage
from kinematics.manipulability import VelocityEllipsoid, velocity_ellipsoid
from kinematics.mechanism import Mechanism, Poses, drive_values
from kinematics.mobility import FreeMotion, Mobility, SelfStress, mobility
from kinematics.near_mechanism import NearMechanism, near_motions
from kinematics.placement import Placement, check_coincidence
from kinematics.rows import (
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
