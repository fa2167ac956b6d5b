"""Moving the links of a robot until its loops close."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.turns import rotation_vector
from strutwork.machines.robots.poses import Pose, about, axis_angle
from strutwork.machines.robots.robot import WORLD, Freedom, Link, Robot, RobotJoint

Array = NDArray[Any]

#: Largest gap of a loop that is closed, as a share of the robot's size.
CLOSED = 1e-9
#: Evaluations at most, and the gap from which the last digits are worth their time.
TRIES, NEARLY = 60, 1e-3

MOVED = (
    "The links were moved from the configuration of the file to one in which loops close and "
    "joints are within their limits."
)


def assembled(robot: Robot) -> Robot:
    """The robot where its loops close, its couplings hold, and joints are within their limits.

    Where the configuration of the file does that, nothing moves. Otherwise the joint coordinates
    are changed by least squares, from those of the file.

    Parameters
    ----------
    robot : Robot

    Raises
    ------
    ModelError
        A loop that cannot be closed from there; names it and its gap.
    """
    tree, chords = split(robot)
    start = dict(robot.start) | _into_limits(robot, tree)
    if not start and not any(joint.parent_place is not None for joint in chords):
        return robot
    moves = _Moves(robot, tree, chords, start)
    values = moves.solved()
    found = moves.robot(values)
    if not start and not np.any(values):
        return replace(found, notes=robot.notes)
    return found


def split(robot: Robot) -> tuple[list[tuple[RobotJoint, bool]], list[RobotJoint]]:
    """A tree from the world outwards, and the joints that close loops.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    tree : list of (RobotJoint, bool)
        True where the way outwards goes from the joint's child to its parent.
    chords : list of RobotJoint
    """
    tree: list[tuple[RobotJoint, bool]] = []
    used: set[str] = set()
    placed = {WORLD}
    loops = {j.name for j in robot.joints if j.parent_place is not None}
    for root in (WORLD, *(link.name for link in robot.links)):
        placed.add(root)
        grown = True
        while grown:
            grown = False
            for joint in robot.joints:
                if joint.name in used or joint.name in loops:
                    continue
                inside = joint.parent in placed, joint.child in placed
                if inside[0] != inside[1]:
                    tree.append((joint, inside[1]))
                    placed |= {joint.parent, joint.child}
                    used.add(joint.name)
                    grown = True
    return tree, [joint for joint in robot.joints if joint.name not in used]


def _into_limits(robot: Robot, tree: list[tuple[RobotJoint, bool]]) -> dict[tuple[str, str], float]:
    """Displacements of joints that the file draws outside their limits."""
    found = {}
    followers = {coupled.follower for coupled in robot.couplings}
    for joint, _ in tree:
        for f in joint.freedoms:
            if f.limits is None or (joint.name, f.direction) in followers:
                continue
            inside = min(max(f.home, f.limits[0]), f.limits[1])
            if inside != f.home:
                found[joint.name, f.direction] = inside - f.home
    return found


class _Moves:
    """Places of the links over displacements of the joints of a tree."""

    def __init__(
        self,
        robot: Robot,
        tree: list[tuple[RobotJoint, bool]],
        chords: list[RobotJoint],
        start: Mapping[tuple[str, str], float],
    ) -> None:
        self.base, self.tree, self.chords, self.start = robot, tree, chords, start
        in_tree = {joint.name for joint, _ in tree}
        self.ties = {
            c.follower: c
            for c in robot.couplings
            if c.follower[0] in in_tree and c.leader[0] in in_tree
        }
        own = [(joint.name, f.direction) for joint, _ in tree for f in joint.freedoms]
        self.names = [name for name in own if name not in self.ties]
        points = [link.origin for link in robot.links] + [joint.place for joint in robot.joints]
        self.size = float(np.ptp(np.array(points), axis=0).max(initial=0.0)) or 1.0

    def displaced(self, values: Array) -> dict[str, Pose]:
        """Displacement of every link."""
        amounts = dict(zip(self.names, values, strict=True))

        def amount(name: tuple[str, str], depth: int = 0) -> float:
            if name in amounts:
                return float(amounts[name])
            tie = self.ties[name]
            if depth > len(self.ties):
                raise ModelError(
                    f"coupling {tie.name}", "follows itself.", "Remove one of the couplings."
                )
            return tie.ratio * amount(tie.leader, depth + 1) + self.start.get(name, 0.0)

        found = {WORLD: Pose()}
        for joint, reverse in self.tree:
            own = Pose(joint.place, joint.axes)
            given = [amount((joint.name, f.direction)) for f in joint.freedoms]
            moved = own @ _motion(joint, given) @ own.inverse
            before, after = joint.parent, joint.child
            if reverse:
                before, after, moved = after, before, moved.inverse
            found[after] = found.get(before, Pose()) @ moved
        return found

    def gaps(self, values: Array) -> Array:
        """What is open in the loops, in shares of the robot's size."""
        placed = self.displaced(values)
        parts = [np.zeros(0)]
        for joint in self.chords:
            first, second = _sides(joint, placed)
            parts.append(_gap(joint.kind, first, second, self.size))
        return np.concatenate(parts)

    def solved(self) -> Array:
        """Displacements at which the loops close."""
        values = np.array([self.start.get(name, 0.0) for name in self.names])
        if not self.chords or not len(values):
            self._require_closed(values)
            return values
        if np.abs(self.gaps(values)).max(initial=0.0) > CLOSED / 100:
            # imported late: SciPy is slow to import, and most robots are closed as drawn
            from scipy.optimize import least_squares

            low, high = self._ranges()
            values = np.clip(values, low, high)
            span = {"bounds": (low, high)}
            values = least_squares(self.gaps, values, max_nfev=TRIES, **span).x
            gap = float(np.abs(self.gaps(values)).max(initial=0.0))
            if CLOSED / 100 < gap < NEARLY:
                # the last digits, which plain differences do not give
                tight = {"xtol": 1e-15, "ftol": 1e-15, "gtol": 1e-15, "jac": "3-point"}
                values = least_squares(self.gaps, values, max_nfev=20, **span, **tight).x
        self._require_closed(values)
        return values

    def _ranges(self) -> tuple[Array, Array]:
        """Displacements that the limits of the joints allow, (n,) and (n,)."""
        limits = {
            (joint.name, f.direction): (f.limits[0] - f.home, f.limits[1] - f.home)
            for joint, _ in self.tree
            for f in joint.freedoms
            if f.limits is not None
        }
        spans = [limits.get(name, (-np.inf, np.inf)) for name in self.names]
        return np.array([low for low, _ in spans]), np.array([high for _, high in spans])

    def _require_closed(self, values: Array) -> None:
        placed = self.displaced(values)
        for joint in self.chords:
            gap = float(np.abs(_gap(joint.kind, *_sides(joint, placed), self.size)).max(initial=0))
            if gap > CLOSED:
                raise ModelError(
                    f"joint {joint.name}",
                    f"closes a loop that stays open by {1e3 * gap * self.size:.4g} mm.",
                    "Check its two frames, or give the joints a configuration near a closed one.",
                )

    def robot(self, values: Array) -> Robot:
        """The robot there."""
        placed = self.displaced(values)
        amounts = self._all_amounts(values)
        base = self.base
        joints = {joint.name: _tree_joint(joint, placed, amounts) for joint, _ in self.tree} | {
            joint.name: _chord(joint, placed) for joint in self.chords
        }
        tool = base.tool
        if tool is not None:
            tool = (tool[0], placed.get(tool[0], Pose()).at(tool[1]))
        return replace(
            base,
            links=tuple(_link(link, placed.get(link.name, Pose())) for link in base.links),
            joints=tuple(joints[joint.name] for joint in base.joints),
            tool=tool,
            points=tuple((n, k, placed.get(k, Pose()).at(p)) for n, k, p in base.points),
            start=(),
            notes=(
                *base.notes,
                MOVED,
            ),
        )

    def _all_amounts(self, values: Array) -> dict[tuple[str, str], float]:
        found = {n: float(v) for n, v in zip(self.names, values, strict=True)}
        for _ in self.ties:
            for name, tie in self.ties.items():
                if tie.leader in found:
                    found[name] = tie.ratio * found[tie.leader] + self.start.get(name, 0.0)
        return found


def _motion(joint: RobotJoint, values: list[float]) -> Pose:
    """Motion of a joint in its own axes."""
    if joint.kind == "spherical":
        turn = np.array(values)
        angle = float(np.linalg.norm(turn))
        return Pose(rotation=axis_angle(turn, angle, joint.name)) if angle else Pose()
    found = Pose()
    for freedom, value in zip(joint.freedoms, values, strict=True):
        k = "xyz".index(freedom.direction[-1])
        if freedom.direction.startswith("r"):
            lead = (joint.pitch or 0.0) / (2 * np.pi) * value
            found = found @ Pose(lead * np.eye(3)[k], about(k, value))
        else:
            found = found @ Pose(value * np.eye(3)[k])
    return found


def _sides(joint: RobotJoint, placed: Mapping[str, Pose]) -> tuple[Pose, Pose]:
    """Where the two sides of a joint stand."""
    place = joint.place if joint.parent_place is None else joint.parent_place
    axes = joint.axes if joint.parent_axes is None else joint.parent_axes
    first = placed.get(joint.parent, Pose()) @ Pose(place, axes)
    return first, placed.get(joint.child, Pose()) @ Pose(joint.place, joint.axes)


def _gap(kind: str, first: Pose, second: Pose, size: float) -> Array:
    """What the held directions of a joint leave open, turns as they are."""
    shift = first.rotation.T @ (second.position - first.position) / size
    turn = first.rotation.T @ second.rotation
    if kind == "spherical":
        return np.asarray(shift)
    if kind == "universal":
        # z of the first is perpendicular to x of the second
        return np.array([*shift, turn[2, 0]])
    if kind in {"fixed", "prismatic"}:
        angles = rotation_vector(turn)
        return np.array([*(shift if kind == "fixed" else shift[:2]), *angles])
    # the z axes are parallel, and of one sense
    tilt = [turn[0, 2], turn[1, 2], min(turn[2, 2], 0.0)]
    shifts = {"revolute": shift, "cylindrical": shift[:2], "planar": shift[2:]}.get(kind, shift)
    return np.array([*shifts, *tilt])


def _link(link: Link, moved: Pose) -> Link:
    inertia = moved.rotation @ link.inertia @ moved.rotation.T
    return replace(
        link,
        origin=moved.at(link.origin),
        axes=moved.rotation @ link.axes,
        centre=moved.at(link.centre),
        inertia=(inertia + inertia.T) / 2,
    )


def _tree_joint(
    joint: RobotJoint, placed: Mapping[str, Pose], amounts: Mapping[tuple[str, str], float]
) -> RobotJoint:
    first, second = placed.get(joint.parent, Pose()), placed.get(joint.child, Pose())
    freedoms = tuple(
        replace(f, home=f.home + amounts[joint.name, f.direction]) for f in joint.freedoms
    )
    axes = _own_axes(joint.kind, first.rotation @ joint.axes, second.rotation @ joint.axes)
    return replace(joint, place=second.at(joint.place), axes=axes, freedoms=freedoms)


def _chord(joint: RobotJoint, placed: Mapping[str, Pose]) -> RobotJoint:
    first, second = _sides(joint, placed)
    along = first.rotation.T @ (second.position - first.position)

    def home(freedom: Freedom) -> float:
        slides = not freedom.direction.startswith("r")
        return freedom.home + (along["xyz".index(freedom.direction)] if slides else 0.0)

    return replace(
        joint,
        place=second.position,
        axes=_own_axes(joint.kind, first.rotation, second.rotation),
        freedoms=tuple(replace(f, home=home(f)) for f in joint.freedoms),
        parent_place=None,
        parent_axes=None,
    )


def _own_axes(kind: str, first: Array, second: Array) -> Array:
    """Axes of a joint: those of its first side, x of a universal joint from its second."""
    if kind != "universal":
        return first
    z, x = first[:, 2], second[:, 0]
    return np.stack([x, np.cross(z, x), z], axis=1)
