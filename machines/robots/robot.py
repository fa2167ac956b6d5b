"""A robot as all formats have it: rigid links, joints between them, couplings.

Everything stands in world axes in one configuration, home. The axes of a joint are those of
`strutwork.kinematics.joint`: z is its axis, x the second axis of a universal joint.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError

Array = NDArray[Any]

#: Name of what does not move, as SDFormat and MJCF reserve it.
WORLD = "world"

#: Free directions by joint type, in the order in which bodies in series would have them.
FREE: dict[str, tuple[str, ...]] = {
    "fixed": (),
    "revolute": ("rz",),
    "prismatic": ("z",),
    "cylindrical": ("z", "rz"),
    "helical": ("rz",),
    "universal": ("rz", "rx"),
    "spherical": ("rx", "ry", "rz"),
    "planar": ("x", "y", "rz"),
}

#: Links and joints at most, as a model file may have.
MAX_LINKS, MAX_JOINTS = 2_000, 1_000


@dataclass(frozen=True, eq=False)
class Link:
    """A rigid link.

    Parameters
    ----------
    name : str
    origin : (3,)
        Of its own frame, m.
    axes : (3, 3)
        Rotation matrix of its own frame, axes as columns.
    mass : float
        kg.
    centre : (3,)
        Centre of mass, m.
    inertia : (3, 3)
        About the centre, world axes, kg·m².

    Raises
    ------
    ModelError
        A mass or an inertia that no body has.
    """

    name: str
    origin: Array
    axes: Array = field(default_factory=lambda: np.eye(3))
    mass: float = 0.0
    centre: Array = field(default_factory=lambda: np.zeros(3))
    inertia: Array = field(default_factory=lambda: np.zeros((3, 3)))

    def __post_init__(self) -> None:
        part = f"link {self.name}"
        values = (self.mass, *np.ravel(self.centre), *np.ravel(self.inertia), *self.origin)
        if not np.all(np.isfinite(values)):
            raise ModelError(
                part, "has a mass, place or inertia that is not finite.", "Give finite numbers."
            )
        if self.mass < 0:
            raise ModelError(
                part, f"has the mass {self.mass:g} kg.", "Give a mass of at least zero."
            )
        least = float(np.linalg.eigvalsh(self.inertia).min())
        if least < -1e-9 * float(np.abs(self.inertia).max(initial=0.0)) - 1e-12 * self.mass:
            raise ModelError(
                part,
                f"has a negative principal moment of inertia, {least:.4g} kg·m².",
                "Check signs and units of its inertia.",
            )
        if self.mass == 0 and np.any(self.inertia):
            raise ModelError(part, "has an inertia but no mass.", "Give its mass.")


@dataclass(frozen=True)
class Freedom:
    """A direction in which a joint moves.

    Parameters
    ----------
    direction : str
        In the axes of the joint.
    home : float
        Coordinate at home, m or rad.
    limits : (low, high) or None
        Range of the coordinate, m or rad.
    driven : bool
    damping : float
        N·s/m or N·m·s/rad.
    effort, speed : float or None
        The most that its drive can do, N or N·m, m/s or rad/s.
    """

    direction: str
    home: float = 0.0
    limits: tuple[float, float] | None = None
    driven: bool = False
    damping: float = 0.0
    effort: float | None = None
    speed: float | None = None


@dataclass(frozen=True, eq=False)
class RobotJoint:
    """A joint between two links, or between a link and the world.

    Parameters
    ----------
    name : str
    kind : str
        A key of `FREE`.
    parent, child : str
        Links; motion is that of the child relative to the parent.
    place : (3,)
        m; on the child where `parent_place` is given too.
    axes : (3, 3)
        Rotation matrix, joint axes as columns; on the child where `parent_axes` are given too.
    freedoms : tuple of Freedom
        In the order of `FREE`.
    pitch : float or None
        Of a helical joint, m per turn.
    parent_place, parent_axes : (3,) and (3, 3), or None
        Where the parent's side stands, as long as the joint is not assembled.
    """

    name: str
    kind: str
    parent: str
    child: str
    place: Array
    axes: Array = field(default_factory=lambda: np.eye(3))
    freedoms: tuple[Freedom, ...] = ()
    pitch: float | None = None
    parent_place: Array | None = None
    parent_axes: Array | None = None

    def __post_init__(self) -> None:
        if self.kind != "fixed" and not self.freedoms:
            made = tuple(Freedom(direction) for direction in FREE[self.kind])
            object.__setattr__(self, "freedoms", made)
        if self.parent == self.child:
            raise ModelError(
                f"joint {self.name}", f'joins link "{self.parent}" to itself.', "Name two links."
            )
        if not np.all(np.isfinite((*self.place, *np.ravel(self.axes)))):
            raise ModelError(
                f"joint {self.name}", "has a place or an axis that is not finite.", "Correct it."
            )

    @property
    def axis(self) -> Array:
        """Z of its axes, (3,)."""
        return np.asarray(self.axes[:, 2])

    @property
    def second(self) -> Array:
        """X of its axes, (3,)."""
        return np.asarray(self.axes[:, 0])

    def vector(self, direction: str) -> Array:
        """The axis of one direction, (3,).

        Parameters
        ----------
        direction : str
        """
        return np.asarray(self.axes[:, "xyz".index(direction[-1])])


@dataclass(frozen=True)
class Coupled:
    """A joint coordinate that follows another.

    Parameters
    ----------
    name : str
    leader, follower : (joint, direction)
    ratio : float
        Change of the follower per change of the leader, m and rad.
    """

    name: str
    leader: tuple[str, str]
    follower: tuple[str, str]
    ratio: float


@dataclass(frozen=True, eq=False)
class Robot:
    """Links, joints and couplings at home.

    Parameters
    ----------
    title : str
    links : tuple of Link
        `WORLD` is none of them.
    joints : tuple of RobotJoint
    couplings : tuple of Coupled
    gravity : (3,) tuple or None
        m/s².
    tool : (link, (3,)) or None
        The link that carries the tool centre point, and its place, m.
    tool_name : str
    notes : tuple of str
        What the format or the model has and is not taken over, a sentence each.
    points : tuple of (name, link, (3,))
        Named points of links, m.
    start : tuple of ((joint, direction), float)
        Displacements from the configuration of the file to the one that is wanted, m and rad:
        `assembled` makes them.

    Raises
    ------
    ModelError
        Too many parts, a name used twice, or a joint of an unknown link.
    """

    title: str
    links: tuple[Link, ...]
    joints: tuple[RobotJoint, ...]
    couplings: tuple[Coupled, ...] = ()
    gravity: tuple[float, float, float] | None = (0.0, 0.0, -9.80665)
    tool: tuple[str, Array] | None = None
    tool_name: str = "tcp"
    notes: tuple[str, ...] = ()
    points: tuple[tuple[str, str, Array], ...] = ()
    start: tuple[tuple[tuple[str, str], float], ...] = ()

    def __post_init__(self) -> None:
        for what, count, most in (
            ("links", len(self.links), MAX_LINKS),
            ("joints", len(self.joints), MAX_JOINTS),
        ):
            if count > most:
                raise ModelError(
                    "robot", f"has {count} {what}; at most {most} are allowed.", "Split it."
                )
        known = {WORLD}
        for link in self.links:
            if link.name in known:
                raise ModelError(
                    f"link {link.name}",
                    "is defined twice, or has the name of the world.",
                    "Give every link its own name.",
                )
            known.add(link.name)
        names = set()
        for joint in self.joints:
            if joint.name in names:
                raise ModelError(
                    f"joint {joint.name}",
                    "is defined twice.",
                    "Give every joint and every loop its own name.",
                )
            names.add(joint.name)
            for end in (joint.parent, joint.child):
                if end not in known:
                    raise ModelError(
                        f"joint {joint.name}",
                        f'names the unknown link "{end}".',
                        "Define the link, or correct the name.",
                    )

    @property
    def mass(self) -> float:
        """Total mass of the links, kg."""
        return float(sum(link.mass for link in self.links))

    @property
    def centre(self) -> Array:
        """Centre of that mass, (3,), m; zero without mass."""
        total = self.mass
        if total == 0:
            return np.zeros(3)
        return np.asarray(sum(link.mass * link.centre for link in self.links) / total)
