"""Linkages that fall into legs, and the walk over all bodies beside which legs are held."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.kinematics import Body, Joint, Linkage, Placement, Poses, axes_frame
from strutwork.kinematics.given import given
from strutwork.kinematics.linkage import GROUND
from strutwork.kinematics.motion import Motion, Moved
from strutwork.kinematics.walk import Walk
from tests.linkages import gough, open_chain

Array = NDArray[Any]


def walked(motion: Motion, poses: Poses) -> Moved:
    """Where all bodies go at once, by the rows of all joints."""
    wanted = given(motion.joints, motion.home_pose, motion.home_values, poses, None, None)
    walk = Walk(motion.joints, motion.rotation, wanted)
    walk.go(np.arange(wanted.poses))
    return motion._moved(walk, wanted)


def around(motion: Motion, count: int, shift: float, turn: float, seed: int) -> Poses:
    """Poses within `shift`, m, and `turn`, rad, of home in each direction."""
    random = np.random.default_rng(seed)
    home = motion.home_pose
    turns = Rotation.from_rotvec(random.uniform(-turn, turn, (count, 3))).as_matrix()
    return Poses(home.position + random.uniform(-shift, shift, (count, 3)), turns @ home.rotation)


def platform_with_balls_below() -> Motion:
    """A Gough platform upside down: balls at the ground, universal joints at the platform.

    Every other leg's joints are named from the platform to the ground.
    """
    machine = gough()
    home = machine.place(machine.home())
    joints = list(machine.linkage.joints)
    frames = home.frames.copy()
    for i in range(6):
        lower, slide, upper = joints[3 * i : 3 * i + 3]
        frames[[3 * i, 3 * i + 2]] = frames[[3 * i + 2, 3 * i]]
        between = [lower.between, slide.between, upper.between]
        if i % 2:
            between = [(b, a) for a, b in between]
        joints[3 * i] = Joint(lower.name, "spherical", between[0])
        joints[3 * i + 1] = replace(slide, between=between[1])
        joints[3 * i + 2] = Joint(upper.name, "universal", between[2])
    linkage = replace(machine.linkage, joints=tuple(joints))
    return Motion(linkage, replace(home, frames=frames, values=np.zeros(0), names=()))


def arm(*, backward: bool = False) -> Motion:
    """A serial arm of six hinges, none of which meet in a ball."""
    points = [[0, 0, 0], [0.1, 0, 0.4], [0.5, 0.05, 0.5], [0.8, 0, 0.45], [0.9, 0.1, 0.4]]
    points += [[1.0, 0.1, 0.5], [1.1, 0, 0.5]]
    axes = [[0, 0, 1], [0, 1, 0], [0, 1, 0.2], [1, 0, 0.1], [0, 1, 0], [1, 0.3, 0], [0, 0, 1]]
    linkage, placement = open_chain(points, axes)
    if backward:
        joints = tuple(replace(j, between=j.between[::-1]) for j in linkage.joints)
        linkage = replace(linkage, joints=joints)
    return Motion(linkage, placement)


def three_universal_legs() -> Motion:
    """Legs of two universal joints and a cylindrical one between: six freedoms without a ball."""
    base, plate = [0.0, 2.1, 4.2], [0.3, 2.3, 4.6]
    nodes, bodies, joints, places, frames = [], [], [], [], []
    ground, top = [], []
    for i, (a, b) in enumerate(zip(base, plate, strict=True)):
        foot = np.array([0.5 * np.cos(a), 0.5 * np.sin(a), 0.0])
        head = np.array([0.3 * np.cos(b), 0.3 * np.sin(b), 0.6])
        middle = 0.5 * (foot + head)
        names = [f"{n}{i}" for n in ("base", "foot", "slide", "rod", "head", "plate")]
        nodes += names
        places += [foot, foot, middle, middle, head, head]
        ground.append(names[0])
        top.append(names[5])
        bodies += [Body(f"lower{i}", tuple(names[1:3])), Body(f"upper{i}", tuple(names[3:5]))]
        along = axes_frame(head - foot)
        joints += [
            Joint(f"U{i}", "universal", (names[0], names[1])),
            Joint(f"C{i}", "cylindrical", (names[2], names[3]), driven=("z", "rz")),
            # every other one is named from the platform on
            Joint(f"V{i}", "universal", (names[4], names[5]) if i % 2 else (names[5], names[4])),
        ]
        # a universal joint holds the turn about the leg, its y axis
        frames += [along[:, [1, 2, 0]], along, along[:, [1, 2, 0]]]
    linkage = Linkage(
        (*nodes, "tool"),
        (Body(GROUND, tuple(ground)), Body("platform", (*top, "tool")), *bodies),
        tuple(joints),
        "tool",
    )
    places.append(np.array([0.05, 0.0, 0.65]))
    return Motion(linkage, Placement(np.array(places), np.array(frames), np.zeros(0)))
