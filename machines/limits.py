"""Joint ranges of machines: those of any linkage, where the machines look for them."""

from strutwork.kinematics.limits import SLACK, Limit, check_limits, joint_limits, joint_limits_of

__all__ = ["SLACK", "Limit", "check_limits", "joint_limits", "joint_limits_of"]
