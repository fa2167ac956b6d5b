"""Circles on which a platform's joints run once the drives stand, read from a linkage's joints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.frames import cross, dot
from strutwork.kinematics.leg_chains import leg_paths
from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.placement import COINCIDENCE, Placement

Array = NDArray[Any]


@dataclass(frozen=True)
class PlatformCircles:
    """P_k(φ) = centre + radius (cos φ first + sin φ second), k = 1, 2, 3; φ = 0 where it stands.

    Parameters
    ----------
    centre, first, second : (..., 3, 3)
        m, and unit vectors; one row per joint.
    radius : (..., 3)
        m.
    joints : tuple of str
        Of the platform, one of each point.
    """

    centre: Array
    first: Array
    second: Array
    radius: Array
    joints: tuple[str, ...]

    def __repr__(self) -> str:
        return f"<PlatformCircles of {', '.join(self.joints)}, batch {self.radius.shape[:-1]}>"

    @property
    def points(self) -> Array:
        """Where the joints stand, (..., 3, 3), m."""
        return np.asarray(self.centre + self.radius[..., None] * self.first)

    @property
    def distances(self) -> Array:
        """Between the joints 1 and 2, 1 and 3, 2 and 3, (..., 3), m."""
        p = self.points
        apart = [p[..., i, :] - p[..., j, :] for i, j in ((0, 1), (0, 2), (1, 2))]
        return np.asarray(np.linalg.norm(np.stack(apart, axis=-2), axis=-1))


@dataclass(frozen=True)
class _Leg:
    """One way from the ground to the platform: its ball, and what turns freely before it."""

    ball: int
    node: int
    hinges: tuple[tuple[int, int], ...]
    #: A node of the hinges' joint, through which their axes go.
    through: int


def platform_circles(linkage: Linkage, placement: Placement) -> PlatformCircles | str:
    """Circles of three joints of the platform, or why there are none.

    There are where the platform hangs on three balls, and each runs on a circle with the drives
    held: about the one hinge of its leg, or on two legs that meet in it and turn about a point
    each.

    Parameters
    ----------
    linkage : Linkage
        With a tool.
    placement : Placement
        Poses, any batch axes.
    """
    paths = leg_paths(linkage)
    if paths is None:
        return "the linkage does not split into legs between ground and platform"
    legs = [_leg(linkage, path) for path in paths]
    if any(leg is None for leg in legs):
        return "a leg does not end in a ball joint on the platform, or slides with its drives held"
    known = [leg for leg in legs if leg is not None]
    groups = _groups(known, placement)
    if len(groups) != 3:
        return f"the platform hangs on {len(groups)} balls, not on three"
    circles = []
    for group in groups:
        free = tuple(len(leg.hinges) for leg in group)
        if free == (1,):
            circles.append(_about_hinge(group[0], placement))
        elif free == (2, 2) and all(_meets(leg) for leg in group):
            circles.append(_about_line(group, placement))
        else:
            name = linkage.joints[group[0].ball].name
            return f"{name} does not move on a circle with the drives held"
    centre, first, radius, axis = (
        np.stack([c[k] for c in circles], axis=-2 if k != 2 else -1) for k in range(4)
    )
    if not np.all(radius[placement.reachable] > COINCIDENCE):
        return "a joint of the platform lies on the axis about which it would rotate"
    names = tuple(linkage.joints[group[0].ball].name for group in groups)
    return PlatformCircles(centre, first, cross(axis, first), radius, names)


def _leg(linkage: Linkage, path: list[tuple[int, int]]) -> _Leg | None:
    held = linkage.elastic_or_locked() & ~linkage.driven_mask()
    passive = ~(held | linkage.driven_mask())
    *before, (ball, sign) = path
    if passive[ball, :3].any() or not passive[ball, 3:].all():
        return None
    hinges = [(j, d) for j, _ in before for d in range(6) if passive[j, d]]
    if not hinges or any(d < 3 for _, d in hinges):
        return None
    # on the platform's side, where it stays when other legs are looked at
    node = linkage.joints[ball].between[1 if sign > 0 else 0]
    through = linkage.joints[hinges[0][0]].between[1]
    return _Leg(ball, linkage.node_index[node], tuple(hinges), linkage.node_index[through])


def _groups(legs: list[_Leg], placement: Placement) -> list[list[_Leg]]:
    """Legs whose balls stand at the same place at every pose."""
    groups: list[list[_Leg]] = []
    for leg in legs:
        for group in groups:
            gap = placement.positions[..., leg.node, :] - placement.positions[..., group[0].node, :]
            if np.all(np.linalg.norm(gap, axis=-1)[placement.reachable] <= COINCIDENCE):
                group.append(leg)
                break
        else:
            groups.append([leg])
    return groups


def _meets(leg: _Leg) -> bool:
    """Whether its two hinges are those of one joint, whose axes meet."""
    (first, _), (second, _) = leg.hinges
    return first == second


def _about_hinge(leg: _Leg, placement: Placement) -> tuple[Array, ...]:
    ((j, d),) = leg.hinges
    axis = placement.frames[..., j, :, d % 3]
    positions = placement.positions
    return _circle(positions[..., leg.node, :], positions[..., leg.through, :], axis)


def _about_line(group: list[_Leg], placement: Placement) -> tuple[Array, ...]:
    """Both legs keep the ball at their lengths: it turns about the line of their other ends."""
    one, other = (placement.positions[..., leg.through, :] for leg in group)
    line = other - one
    axis = line / np.linalg.norm(line, axis=-1, keepdims=True)
    return _circle(placement.positions[..., group[0].node, :], one, axis)


def _circle(point: Array, through: Array, axis: Array) -> tuple[Array, ...]:
    """Centre, direction of the point from it, radius, axis."""
    arm = point - through
    centre = through + dot(arm, axis)[..., None] * axis
    out = point - centre
    radius = np.linalg.norm(out, axis=-1)
    return centre, out / np.where(radius > 0, radius, 1.0)[..., None], radius, axis
