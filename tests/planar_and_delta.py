"""A biglide and a linear Delta whose tools do not turn, with their inverse kinematics."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, axes_frame

Array = NDArray[Any]

#: Passive slides, one on the other, that carry the tool and let it not turn.
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


class Gliders:
    """Sliders on rails, each with a rod of one length to the tool, which slides along some axes.

    Parameters
    ----------
    rails : (r, 3)
        Directions of the rails.
    origins : (r, 3)
        A point of each, m.
    seats : (r, 3)
        Ends of the rods on the tool, from its centre, m.
    rod : float
        m.
    slides : str
        Axes along which the tool can go, as in "xy".
    turning : str
        Type of the joints of the rods.
    """

    def __init__(
        self, rails: Array, origins: Array, seats: Array, rod: float, slides: str, turning: str
    ) -> None:
        self.rails, self.origins, self.seats = (
            np.asarray(a, float) for a in (rails, origins, seats)
        )
        self.rod, self.slides, self.turning = rod, slides, turning

    @cached_property
    def linkage(self) -> Linkage:
        legs = range(1, len(self.rails) + 1)
        nodes = [f"{n}{i}" for i in legs for n in ("rail", "slider", "foot", "root", "end", "seat")]
        slide = [f"{s}{n}" for s in self.slides for n in "ab"]
        bodies = [Body(GROUND, (*(f"rail{i}" for i in legs), f"{self.slides[0]}a"))]
        joints = []
        for i in legs:
            bodies += [
                Body(f"slider body{i}", (f"slider{i}", f"foot{i}")),
                Body(f"rod{i}", (f"root{i}", f"end{i}")),
            ]
            joints += [
                Joint(f"rail{i}", "prismatic", (f"rail{i}", f"slider{i}"), driven=("z",)),
                Joint(f"lower{i}", self.turning, (f"foot{i}", f"root{i}")),
                Joint(f"upper{i}", self.turning, (f"end{i}", f"seat{i}")),
            ]
        for s, following in zip(self.slides, self.slides[1:], strict=False):
            bodies.append(Body(f"slide {s}", (f"{s}b", f"{following}a")))
        last = self.slides[-1]
        bodies.append(Body("plate", (f"{last}b", "tool", *(f"seat{i}" for i in legs))))
        joints += [Joint(f"along {s}", "prismatic", (f"{s}a", f"{s}b")) for s in self.slides]
        return Linkage((*nodes, *slide, "tool"), tuple(bodies), tuple(joints), "tool")

    def place(self, tool: Array) -> Placement:
        """At places of the tool, (p, 3): each slider behind the tool on its rail."""
        seat = tool[:, None] + self.seats
        apart = seat - self.origins
        along = (apart * self.rails).sum(axis=-1)
        square = self.rod**2 - (apart**2).sum(axis=-1) + along**2
        rho = along - np.sqrt(np.maximum(square, 0.0))
        foot = self.origins + rho[..., None] * self.rails
        parts = [foot, foot, foot, foot, seat, seat]
        legs = np.stack(parts, axis=2).reshape(len(tool), -1, 3)
        ways = np.repeat(tool[:, None], 2 * len(self.slides) + 1, axis=1)
        rail, up = axes_frame(self.rails), np.eye(3)
        frames = [f for r in rail for f in (r, up, up)] + [axes_frame(AXES[s]) for s in self.slides]
        return Placement(
            np.concatenate([legs, ways], axis=1),
            np.broadcast_to(np.stack(frames), (len(tool), len(frames), 3, 3)),
            rho,
            tuple((f"rail{i + 1}", "z") for i in range(len(self.rails))),
            np.where((square < 0.0).any(axis=1), 1, 0).astype(np.int8),
            ("a rod is too short",),
        )


def biglide(turning: str = "revolute") -> Gliders:
    """Rails along x and y through the origin, rods of 1 m; "spherical" makes rods that spin."""
    rails = np.eye(3)[:2]
    return Gliders(rails, np.zeros((2, 3)), np.zeros((2, 3)), 1.0, "xy", turning)


def linear_delta(rod: float, reach: float) -> Gliders:
    """Three upright rails; `reach` is their radius less the plate's, m. Rods that spin."""
    directions = np.array([[np.sqrt(3) / 2, 0.5, 0], [0, -1, 0], [-np.sqrt(3) / 2, 0.5, 0]])
    return Gliders(
        np.tile([0.0, 0.0, 1.0], (3, 1)),
        np.zeros((3, 3)),
        reach * directions,
        rod,
        "xyz",
        "spherical",
    )
