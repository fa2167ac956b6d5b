"""Legs of a parallel machine: chains of joints from the ground to the tool's body."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.linkage import Linkage

Array = NDArray[Any]
Ints = NDArray[np.int64]

#: A chain with more free directions than this is no leg for the compiled code.
LONGEST = 12


class LegChains(NamedTuple):
    """Free directions of the legs as integer arrays, passive ones of a leg first.

    Parameters
    ----------
    start : (l + 1,)
        Range of each leg's directions.
    passive : (l,)
        How many of them are passive.
    joint, axis : (d,)
        Index of the joint, and 0 to 2 for x, y, z.
    turns : (d,)
        1 where the direction is a rotation.
    sign : (d,)
        1 where the leg goes through the joint from its first node to its second, else −1; no unit.
    node : (d,)
        Node at the joint.
    drive : (d,)
        Row of the Jacobian, or −1.
    tool : int
        The tool's node.
    rotary : (a,)
        1 where a drive turns.
    """

    start: Ints
    passive: Ints
    joint: Ints
    axis: Ints
    turns: Ints
    sign: Array
    node: Ints
    drive: Ints
    tool: int
    rotary: Ints


def leg_paths(linkage: Linkage) -> list[list[tuple[int, int]]] | None:
    """Joints of each leg from the ground on, or None where the linkage does not fall into legs.

    It does where taking away ground and tool body leaves bodies in separate rows, each joined
    to the ground at one end and to the tool's body at the other.

    Parameters
    ----------
    linkage : Linkage
        With a tool.

    Returns
    -------
    list of list of (joint, sign), or None
        The sign is 1 where the leg goes through the joint from its first node to its second.
    """
    if linkage.ties:
        # a coordinate that follows another is none of its leg's own
        return None
    owner, index = linkage.body_of_node, linkage.node_index
    platform = linkage.tool_body
    # joints by the bodies that they join, −1 for the ground
    joints: dict[int, list[tuple[int, int, int]]] = {}
    for j, joint in enumerate(linkage.joints):
        first, second = (int(owner[index[n]]) for n in joint.between)
        if first == second:
            continue
        joints.setdefault(first, []).append((j, second, 1))
        joints.setdefault(second, []).append((j, first, -1))
    legs: list[list[tuple[int, int]]] = []
    seen: set[int] = set()
    for begin in joints.get(-1, []):
        joint_index, body, sign = begin
        path = [(joint_index, sign)]
        while body != platform:
            if body in seen or body == -1 or len(joints[body]) != 2:
                return None
            seen.add(body)
            onward = [step for step in joints[body] if step[0] != path[-1][0]]
            if not onward:
                return None
            joint_index, body, sign = onward[0]
            path.append((joint_index, sign))
        legs.append(path)
    if len(seen) + 1 != len(linkage.body_names) or len(joints.get(platform, [])) != len(legs):
        return None
    return legs


def leg_chains(linkage: Linkage) -> LegChains | None:
    """The legs of a linkage, or None where it has no legs that let the tool move in all ways.

    Those of `leg_paths` do whose joints have six free directions or more.

    Parameters
    ----------
    linkage : Linkage
        With a tool and drives.
    """
    legs = leg_paths(linkage)
    return None if legs is None else _packed(linkage, legs)


def _packed(linkage: Linkage, legs: list[list[tuple[int, int]]]) -> LegChains | None:
    held = linkage.elastic_or_locked() & ~linkage.driven_mask()
    row = {pair: i for i, pair in enumerate(linkage.driven)}
    start, passive = [0], []
    listed: list[tuple[int, int, int, float, int, int]] = []
    for path in legs:
        steps = [
            (
                j,
                d % 3,
                int(d >= 3),
                float(sign),
                linkage.node_index[linkage.joints[j].between[0]],
                row.get((linkage.joints[j].name, DIRECTIONS[d]), -1),
            )
            for j, sign in path
            for d in range(6)
            if not held[j, d]
        ]
        drives = sum(step[-1] >= 0 for step in steps)
        if not 6 <= len(steps) <= LONGEST or drives > 6 or len(steps) - drives < 6 - drives:
            return None
        listed += sorted(steps, key=lambda step: step[-1] >= 0)
        start.append(len(listed))
        passive.append(len(steps) - drives)
    if sum(step[-1] >= 0 for step in listed) != len(linkage.driven):
        return None
    joint, axis, turns, sign, node, drive = zip(*listed, strict=True)
    return LegChains(
        np.asarray(start, dtype=np.int64),
        np.asarray(passive, dtype=np.int64),
        np.asarray(joint, dtype=np.int64),
        np.asarray(axis, dtype=np.int64),
        np.asarray(turns, dtype=np.int64),
        np.asarray(sign, dtype=float),
        np.asarray(node, dtype=np.int64),
        np.asarray(drive, dtype=np.int64),
        linkage.node_index[linkage.tool or ""],
        np.asarray([d.startswith("r") for _, d in linkage.driven], dtype=np.int64),
    )
