"""Linkages of textbooks, for the tests: topology and placement in a few lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, Poses, axes_frame

Array = NDArray[Any]


def chain(
    points: ArrayLike, axes: ArrayLike, driven: int | None = None, closed: bool = True
) -> tuple[Linkage, Placement]:
    """A chain of rigid bars hinged by revolutes, from the ground and, when closed, back to it.

    Parameters
    ----------
    points, axes : (r, 3)
        Place, m, and axis of each revolute. An open chain has its tool at the last point,
        which carries no revolute.
    driven : int, optional
        The revolute that is an actuator.
    closed : bool
    """
    points, axes = np.asarray(points, dtype=float), np.asarray(axes, dtype=float)
    hinges = len(points) if closed else len(points) - 1
    bars = len(points) - 1
    nodes = tuple(f"{side}{i}" for i in range(hinges) for side in "ab")
    bodies = [Body(GROUND, ("a0", f"b{bars}") if closed else ("a0",))]
    for i in range(bars):
        end = f"a{i + 1}" if i + 1 < hinges else "tool"
        bodies.append(Body(f"bar{i + 1}", (f"b{i}", end)))
    joints = tuple(
        Joint(f"R{i + 1}", "revolute", (f"a{i}", f"b{i}"), driven=("rz",) if i == driven else ())
        for i in range(hinges)
    )
    positions = np.repeat(points[:hinges], 2, axis=0)
    if not closed:
        nodes = (*nodes, "tool")
        positions = np.concatenate([positions, points[-1:]])
    linkage = Linkage(nodes, tuple(bodies), joints, None if closed else "tool")
    return linkage, Placement(positions, axes_frame(axes[:hinges]), np.zeros(0))


@dataclass(frozen=True)
class Gough:
    """A Gough platform: six legs, each universal, driven prismatic, spherical.

    Parameters
    ----------
    base, platform : (6, 3) nested tuples
        Joint centres, m; the platform's in its own frame, whose origin is the tool.
    lower : str
        Type of the joints at the base: "spherical" makes legs that spin.
    """

    base: tuple[tuple[float, float, float], ...]
    platform: tuple[tuple[float, float, float], ...]
    lower: str = "universal"

    @cached_property
    def linkage(self) -> Linkage:
        legs = range(1, 7)
        ends = ("base", "foot", "slide", "rod", "head", "plate")
        nodes = tuple(f"{end}{i}" for i in legs for end in ends)
        bodies = [
            Body(GROUND, tuple(f"base{i}" for i in legs)),
            Body("platform", (*(f"plate{i}" for i in legs), "tool")),
        ]
        joints = []
        for i in legs:
            bodies += [
                Body(f"cylinder{i}", (f"foot{i}", f"slide{i}")),
                Body(f"piston{i}", (f"rod{i}", f"head{i}")),
            ]
            joints += [
                Joint(f"U{i}", self.lower, (f"base{i}", f"foot{i}")),
                Joint(f"P{i}", "prismatic", (f"slide{i}", f"rod{i}"), driven=("z",)),
                Joint(f"S{i}", "spherical", (f"head{i}", f"plate{i}")),
            ]
        return Linkage((*nodes, "tool"), tuple(bodies), tuple(joints), "tool")

    def place(self, poses: Poses) -> Placement:
        base = np.asarray(self.base)
        local = np.asarray(self.platform)
        plate = poses.position[..., None, :] + np.einsum("...ij,lj->...li", poses.rotation, local)
        leg = plate - base
        length = np.linalg.norm(leg, axis=-1)
        middle = base + leg / 2
        base = np.broadcast_to(base, plate.shape)
        by_leg = np.stack([base, base, middle, middle, plate, plate], axis=-2)
        positions = np.concatenate(
            [by_leg.reshape(*poses.batch, 36, 3), poses.position[..., None, :]], axis=-2
        )
        along = axes_frame(leg / length[..., None])
        # a universal joint holds the spin about the leg, which is its y axis
        lower = along[..., [1, 2, 0]] if self.lower == "universal" else along
        frames = np.stack([lower, along, along], axis=-3).reshape(*poses.batch, 18, 3, 3)
        return Placement(positions, frames, length, tuple((f"P{i}", "z") for i in range(1, 7)))

    def home(self) -> Poses:
        return Poses.of([0.0, 0.0, 0.5])

    def skeleton(self) -> Sequence[tuple[str, str]]:
        return [(f"base{i}", f"plate{i}") for i in range(1, 7)]


def gough(lower: str = "universal") -> Gough:
    """A Gough platform with joints on two circles in pairs."""
    base = np.radians([-10, 10, 110, 130, 230, 250])
    plate = np.radians([-50, 50, 70, 170, 190, 290])

    def circle(angles: Array, radius: float) -> tuple[tuple[float, float, float], ...]:
        return tuple((radius * float(np.cos(a)), radius * float(np.sin(a)), 0.0) for a in angles)

    return Gough(circle(base, 0.4), circle(plate, 0.2), lower)


def slider_crank(
    turn: float, crank: float = 0.1, rod: float = 0.3, rotation: ArrayLike | None = None
) -> tuple[Linkage, Placement]:
    """Crank (driven), connecting rod and slider with the tool; `turn` is the crank's, rad."""
    pin = np.array([crank * np.cos(turn), crank * np.sin(turn), 0.0])
    slider = np.array([pin[0] + np.sqrt(rod**2 - pin[1] ** 2), 0.0, 0.0])
    zero = np.zeros(3)
    frame = np.eye(3) if rotation is None else np.asarray(rotation, dtype=float)
    linkage = Linkage(
        ("o", "c0", "c1", "r0", "r1", "s", "guide", "tool"),
        (
            Body(GROUND, ("o", "guide")),
            Body("crank", ("c0", "c1")),
            Body("rod", ("r0", "r1")),
            Body("slider", ("s", "tool")),
        ),
        (
            Joint("crank", "revolute", ("o", "c0"), driven=("rz",)),
            Joint("pin", "revolute", ("c1", "r0")),
            Joint("wrist", "revolute", ("r1", "s")),
            Joint("guide", "prismatic", ("guide", "tool")),
        ),
        "tool",
    )
    points = np.array([zero, zero, pin, pin, slider, slider, slider, slider])
    frames = np.stack([np.eye(3)] * 3 + [axes_frame([1.0, 0.0, 0.0])])
    return linkage, Placement(points @ frame.T, frame @ frames, np.zeros(0))


def open_chain(
    points: ArrayLike, axes: ArrayLike, kinds: Sequence[str] | None = None
) -> tuple[Linkage, Placement]:
    """An open chain whose joints are all driven: revolutes, or prismatic joints along the axes."""
    linkage, placement = chain(points, axes, closed=False)
    names = ["revolute"] * len(linkage.joints) if kinds is None else kinds
    joints = tuple(
        Joint(j.name, kind, j.between, driven=("rz",) if kind == "revolute" else ("z",))
        for j, kind in zip(linkage.joints, names, strict=True)
    )
    return Linkage(linkage.nodes, linkage.bodies, joints, "tool"), placement
