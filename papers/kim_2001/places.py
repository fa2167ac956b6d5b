"""Where the tool can be, and how far it yields there (Figs 8, 9 and 13)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import Poses, tangent_rotation
from strutwork.machines.eclipse_prototype import EclipsePrototype
from strutwork.msa.tool import tool_compliance
from strutwork.papers.kim_2001.comparison import HORIZONTAL, at_plate
from strutwork.papers.kim_2001.drive_rows import gram_at

Array = NDArray[Any]

#: Where a ball's range is counted from: the link's direction at home, or half way between that and
#: the one with the spindle horizontal.
Socket = Literal["home", "midway"]

#: Steps of half a turn of the spindle about the vertical (the other half is its mirror image), and
#: of a whole one about its own axis.
TURNS, ROLLS = 12, 48
#: Distances of the tool from the guide's axis that are looked at, m.
DISTANCES = np.arange(0.0, 0.1501, 0.0025)
#: Places of the tool from the guide's axis along x and y, m (Fig. 13).
ACROSS = np.linspace(-0.05, 0.05, 15)


def link_directions(machine: EclipsePrototype, poses: Poses) -> tuple[Array, NDArray[np.bool_]]:
    """Links away from the platform in its axes, (..., 3, 3), and which poses are reached."""
    placement = machine.place(poses)
    index = machine.linkage.node_index
    ends = placement.positions[..., [index[f"platform/P{i}"] for i in (1, 2, 3)], :]
    roots = placement.positions[..., [index[f"leg{i}/root"] for i in (1, 2, 3)], :]
    away = (roots - ends) / machine.link_length
    return np.asarray(away @ poses.rotation), placement.reachable


def socket_axes(machine: EclipsePrototype, socket: Socket) -> Array:
    """Middle of each ball's range in the platform's axes, (3, 3)."""
    home, _ = link_directions(machine, machine.home())
    if socket == "home":
        return home
    lying, _ = link_directions(machine, machine.tilted(np.radians(HORIZONTAL)))
    middle = home + lying
    return np.asarray(middle / np.linalg.norm(middle, axis=-1, keepdims=True))


def positioning_radius(tilt: float, socket: Socket) -> float:
    """Radius of the positioning workspace at a tilt, m.

    Section IV: the points at which the spindle, tilted so far, can be turned all the way round the
    vertical; its own turn is free. The guide is a whole circle, so that distance from its axis is
    all that counts: and so far as no stroke of the columns is printed, height does not.

    Parameters
    ----------
    tilt : float
        β, deg.
    socket : "home" or "midway"

    Returns
    -------
    float
        Up to the first distance that is lost, in steps of 2.5 mm and 150 mm at most; below zero
        where not even the axis is reached.
    """
    machine = EclipsePrototype(drives="8")
    turn = np.linspace(0.0, np.pi, TURNS + 1)
    roll = np.arange(ROLLS) * (2.0 * np.pi / ROLLS)
    beta = np.radians(tilt)
    normal = np.stack(
        [
            np.sin(beta) * np.cos(turn),
            np.sin(beta) * np.sin(turn),
            np.full(len(turn), np.cos(beta)),
        ],
        axis=-1,
    )
    shape = (len(DISTANCES), len(turn), ROLLS)
    rotation = tangent_rotation(np.broadcast_to(normal[:, None], (*shape[1:], 3)), roll)
    place = np.zeros((*shape, 3))
    place[..., 0] = DISTANCES[:, None, None]
    place[..., 2] = machine.home().position[2]
    poses = Poses.of(place, np.broadcast_to(rotation, (*shape, 3, 3)))
    away, reached = link_directions(machine, poses)
    cosine = np.sum(away * socket_axes(machine, socket), axis=-1)
    good = (cosine >= np.cos(machine.ball_range)).all(axis=-1) & reached
    every = good.any(axis=-1).all(axis=-1)
    lost = len(DISTANCES) if every.all() else int(np.argmin(every))
    return float(DISTANCES[lost - 1]) if lost else -1.0


@dataclass(frozen=True)
class Across:
    """Norm of the compliance of the tool's position over a horizontal plane, (x, y).

    Parameters
    ----------
    structural : (n, n)
        Of links and columns, m/N.
    joint : (n, n)
        Of the drives alone, each as stiff along its path as the others, over that at the middle.
    """

    structural: Array
    joint: Array


def across(tilt: float) -> Across:
    """Fig. 13's norms at a tilt, deg, in the plane of the guide.

    The columns' drive and that along the guide are given the same stiffness along their paths,
    and the tool stands at the platform's centre as in Table II (both ours).
    """
    machine = at_plate()
    x, y = np.meshgrid(ACROSS, ACROSS, indexing="ij")
    place = np.stack([x, y, np.zeros_like(x)], axis=-1)
    rotation = machine.tilted(np.radians(tilt)).rotation
    poses = Poses.of(place, np.broadcast_to(rotation, (*x.shape, 3, 3)))
    placed = machine.structure.at(machine.place(poses))
    structural = np.linalg.norm(tool_compliance(placed)[..., :3, :3], axis=(-2, -1))
    yielding = np.linalg.inv(gram_at(machine, poses, machine.base_radius))[..., :3, :3]
    joint = np.linalg.norm(yielding, axis=(-2, -1))
    return Across(structural, joint / joint[len(ACROSS) // 2, len(ACROSS) // 2])


def joint_compliance(tilt: float) -> Array:
    """Compliance of the tool's position by the drives alone, (3, 3), up to a factor.

    Six drives of equal stiffness along their paths; the document calls its magnitudes relative.
    """
    machine = at_plate()
    gram = gram_at(machine, machine.tilted(np.radians(tilt)), machine.base_radius)
    return np.asarray(np.linalg.inv(gram)[:3, :3])


def joint_ellipsoid(tilt: float) -> Array:
    """Semi-axes of the drives' compliance over the largest at tilt 0, largest first, (3,)."""
    unit = np.linalg.eigvalsh(joint_compliance(0.0))[-1]
    return np.asarray(np.linalg.eigvalsh(joint_compliance(tilt))[::-1] / unit)


def joint_directions(tilt: float) -> Array:
    """Directions of these semi-axes as columns, (3, 3)."""
    return np.asarray(np.linalg.eigh(joint_compliance(tilt))[1][:, ::-1])
