"""The margin of a machine over task coordinates: tilted, turned, with a coordinate to spare."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Placement, Poses, jacobians, rotation_y, rotation_z
from strutwork.kinematics.capsules import Capsule, Interference, outlines
from strutwork.kinematics.follow import Follower
from strutwork.kinematics.margins import Margins, best, of_slacks, placement_slacks, worst
from strutwork.kinematics.turns import rotation_matrix
from strutwork.machines.limits import Limit
from strutwork.machines.model import Model
from strutwork.msa import Structure
from strutwork.studies.margin_bounds import Bound

Array = NDArray[Any]

#: The coordinate of a tool that turns about its own axis.
ROLL = "roll"
#: Condition of the drives falls with the share that is asked; poses without drives have none.
CONDITIONING = "conditioning of the drives"


@dataclass(frozen=True)
class Spare:
    """A coordinate that no task fixes: a pose is good where one of its values makes it so.

    Parameters
    ----------
    name : str or (joint, direction)
        A direction of the tool, `roll` about its own axis, or a joint coordinate.
    values : (k,)
        That are tried, m or rad.
    """

    name: str | tuple[str, str]
    values: Array

    def __post_init__(self) -> None:
        known = isinstance(self.name, tuple) or self.name in (*DIRECTIONS, ROLL)
        if not known or not np.size(self.values) or not np.all(np.isfinite(self.values)):
            raise ModelError(
                "spare coordinate",
                f"{self.name} is unknown or has no finite values.",
                f"Name a direction, {ROLL}, or JOINT:DIRECTION, and values in m or rad.",
            )


def tilted(tilt: float, azimuth: float = 0.0, roll: float = 0.0) -> Array:
    """Rotation of a tool tilted towards an azimuth about its axis at home, (3, 3).

    Parameters
    ----------
    tilt : float
        rad.
    azimuth : float
        From x about z, rad.
    roll : float
        About the tool's own axis, rad.
    """
    turn = rotation_z(np.asarray(azimuth))
    return np.asarray(turn @ rotation_y(np.asarray(tilt)) @ turn.T @ rotation_z(np.asarray(roll)))


def dexterous(tilt: float, azimuths: int = 12, rolls: ArrayLike = 0.0) -> Array:
    """Rotations of tilts up to an angle, all ways round, at every roll, (k, 3, 3).

    Upright, half the tilt and the whole, each at `azimuths` evenly spaced: a sample, on whose
    number the result depends.

    Parameters
    ----------
    tilt : float
        Largest, rad.
    azimuths : int
        Of each tilt.
    rolls : (r,) or float
        About the tool's own axis, rad.
    """
    found = []
    for roll in np.atleast_1d(np.asarray(rolls, dtype=float)):
        found.append(tilted(0.0, 0.0, float(roll)))
        for share in (0.5, 1.0):
            found += [
                tilted(share * tilt, 2 * np.pi * k / azimuths, float(roll)) for k in range(azimuths)
            ]
    return np.array(found)


def beam_capsules(structure: Structure) -> list[Capsule]:
    """Capsules about the beams whose sections have outer sizes: half the largest is the radius.

    Parameters
    ----------
    structure : Structure
    """
    return [
        Capsule(beam.name, beam.nodes, 0.5 * max(beam.section.outline))
        for beam in structure.beams
        if beam.section.outline
    ]


def interference_of(model: Model, radius: float | None) -> Interference:
    """Links that may collide, free of one another at home.

    A body with shapes is looked at as these, another as capsules.

    Parameters
    ----------
    model : Model
    radius : float or None
        Of every moving body's outline, m; None: beams, as thick as their sections.

    Raises
    ------
    ModelError
        No shape and no beam whose section has an outer size; two parts that overlap at home;
        shapes of a machine that is placed by its own formulas, or without their library.
    """
    linkage = model.structure.linkage
    if model.shapes and model.closed_form is not None:
        raise ModelError(
            "interference",
            (
                "of meshes needs the rotations of the bodies, which the machine's own formulas "
                "do not give."
            ),
            "Use the same model without its `closed_form`.",
        )
    owner, index = linkage.body_of_node, linkage.node_index
    shaped = {int(owner[index[shape.node]]) for shape in model.shapes}
    found = [
        capsule
        for capsule in (
            beam_capsules(model.structure) if radius is None else outlines(linkage, radius)
        )
        if int(owner[index[capsule.nodes[0]]]) not in shaped
    ]
    if not found and not model.shapes:
        raise ModelError(
            "interference",
            "finds no beam with a known outer size and no shape.",
            "Give a radius of the links, or [[shapes]] of bodies.",
        )
    return Interference(linkage, tuple(found), model.shapes).check(model.placement)


@dataclass(eq=False)
class MachineMargin:
    """Margins of a machine at task coordinates: by reach, joint ranges, and what else is asked.

    A machine with formulas of its own is placed by them; another is followed from pose to pose,
    or moved straight from home where the tool is turned or a coordinate is spare.

    Parameters
    ----------
    model : Model
    directions : tuple of str
        What points give, m and rad; what is not named stays as at home, where it can.
    step : (d,)
        How far apart points of the grid are, m and rad.
    turns : (k, 3, 3)
        Rotation matrices of the tool in its own axes at home; all must be good.
    spare : Spare or None
    interference : Interference or None
    conditioning : float or None
        Least reciprocal condition number of the drives, as a share of that at home.
    told : callable or None
        Called with how many poses are done, and of how many, where they are followed.
    bounds : tuple of Bound
        What else a pose must keep, as an amplification or a stiffness.

    Raises
    ------
    ModelError
        No tool, or a direction in which it cannot move.
    """

    model: Model
    directions: tuple[str, ...]
    step: Array
    turns: Array = field(default_factory=lambda: np.eye(3)[None])
    spare: Spare | None = None
    interference: Interference | None = None
    conditioning: float | None = None
    told: Callable[[int, int], None] | None = None
    bounds: tuple[Bound, ...] = ()

    def __post_init__(self) -> None:
        self.model.require_tool()
        _ = self.held
        self._check_turns()
        if self.conditioning is not None and not 0.0 < self.conditioning < 1.0:
            raise ModelError(
                "conditioning", f"of {self.conditioning:g} is none.", "Give a share of home's."
            )

    @cached_property
    def home(self) -> Array:
        """Task coordinates of home, (6,), m and rad."""
        motion = self.model.motion
        return motion.task_of(motion.home_pose)

    @cached_property
    def held(self) -> tuple[str, ...]:
        """Directions that are given: those that are named, and others that can be held."""
        spare: tuple[str, ...] = ()
        joints: tuple[tuple[str, str], ...] = ()
        if self.spare is not None and isinstance(self.spare.name, tuple):
            joints = (self.spare.name,)
        elif self.spare is not None and self.spare.name in DIRECTIONS:
            spare = (self.spare.name,)
        named = (*self.directions, *spare)
        if len(set(named)) < len(named):
            raise ModelError(
                "spare coordinate", f"{spare[0]} is a direction of the grid.", "Name another."
            )
        return (*named, *self.model.motion.rest(named, joints))

    def _check_turns(self) -> None:
        motion = self.model.motion
        several = Poses.of(self.home[:3], motion.rotation @ self.turns)
        if self.spare is not None and self.spare.name == ROLL:
            several = Poses.of(self.home[:3], motion.rotation @ rotation_z(np.asarray(0.1)))
        moved = np.abs(motion.task_of(several) - self.home) > 1e-9
        wrong = [d for k, d in enumerate(DIRECTIONS) if moved[..., k].any() and d not in self.held]
        if wrong:
            raise ModelError(
                "workspace",
                f"rotates the tool in {', '.join(wrong)}, which it cannot hold.",
                "The tool holds " + ", ".join(self.held) + "; choose another azimuth or roll.",
            )

    @property
    def follows(self) -> bool:
        """Whether poses are followed from one another, so that a grid is asked at once."""
        plain = len(self.turns) == 1 and np.array_equal(self.turns[0], np.eye(3))
        return self.model.closed_form is None and plain and self.spare is None

    @cached_property
    def _follower(self) -> Follower:
        fixed = {d: float(self.home[DIRECTIONS.index(d)]) for d in self.held}
        for d in self.directions:
            del fixed[d]
        return Follower(self.model.motion, self.directions, fixed, self.step, self._tell)

    @property
    def quick(self) -> bool:
        """Whether many thousands of poses take seconds: by formulas, or by compiled steps."""
        return self._by_formula or (self.follows and self._follower.quick)

    def _tell(self, done: int, total: int) -> None:
        if self.told is not None:
            self.told(done, total)

    @cached_property
    def ranges(self) -> tuple[Limit, ...]:
        """Joint ranges that count: a range only the machine's own formulas know needs them."""
        if self._by_formula:
            return self.model.limits
        names = self.model.motion.joints.names
        return tuple(x for x in self.model.limits if (x.joint, x.coordinate) in names)

    @property
    def _by_formula(self) -> bool:
        joint = self.spare is not None and isinstance(self.spare.name, tuple)
        return self.model.closed_form is not None and not joint

    def __call__(self, points: Array) -> Margins:
        """Margins of points, (p,) of (p, d)."""
        return worst([self._best(points, turn)[0] for turn in self.turns])

    def chosen(self, points: Array) -> Array:
        """Value of the spare coordinate with the largest margin, (p,), m or rad.

        Of several turns, that of the first.

        Parameters
        ----------
        points : (p, d)
            Task coordinates, m and rad.
        """
        assert self.spare is not None  # noqa: S101 - asked for only where there is one
        return np.asarray(self.spare.values)[self._best(points, self.turns[0])[1]]

    def _best(self, points: Array, turn: Array) -> tuple[Margins, NDArray[np.intp]]:
        if self.spare is None:
            placement = self._placed(points, turn, None)
            return self._margins(placement), np.zeros(len(points), dtype=np.intp)
        return best(
            [self._margins(self._placed(points, turn, float(v))) for v in self.spare.values]
        )

    def _margins(self, placement: Placement) -> Margins:
        slacks = placement_slacks(placement, self.ranges, self.interference)
        if self.conditioning is not None:
            slacks[CONDITIONING] = self._conditioning(placement)
        good = np.flatnonzero(placement.reachable)
        for bound in self.bounds if good.size else ():
            for words, slack in bound(placement[good]).items():
                slacks[words] = np.ones(placement.batch)
                slacks[words][good] = slack
        return of_slacks(slacks)

    def _conditioning(self, placement: Placement) -> Array:
        assert self.conditioning is not None  # noqa: S101 - asked for only then
        good = np.flatnonzero(placement.reachable)
        slack = np.ones(placement.batch)
        if good.size:
            share = self._reciprocal(placement[good]) / self._at_home
            slack[good] = (share - self.conditioning) / (1.0 - self.conditioning)
        return slack

    def _reciprocal(self, placement: Placement) -> Array:
        found = jacobians(self.model.structure.linkage, placement)
        return np.asarray(1.0 / found.condition(self._length))

    @cached_property
    def _length(self) -> float:
        home = jacobians(self.model.structure.linkage, self.model.placement)
        return float(np.asarray(home.length))

    @cached_property
    def _at_home(self) -> float:
        found = float(self._reciprocal(self.model.placement))
        if not found > 0.0:
            raise ModelError(
                "conditioning", "is zero at home, which is singular.", "Choose another home."
            )
        return found

    def _placed(self, points: Array, turn: Array, spare: float | None) -> Placement:
        if self.follows:
            return self._follower.place(points)
        motion = self.model.motion
        task = np.tile(self.home, (len(points), 1))
        task[:, [DIRECTIONS.index(d) for d in self.directions]] = points
        joints: dict[tuple[str, str], Any] = {}
        if self.spare is not None and spare is not None:
            name = self.spare.name
            if isinstance(name, tuple):
                joints[name] = spare
            elif name == ROLL:
                turn = turn @ rotation_z(np.asarray(spare))
            else:
                task[:, DIRECTIONS.index(name)] = spare
        rotation = rotation_matrix(task[:, 3:]) @ motion.rotation @ turn
        poses = Poses(task[:, :3], rotation)
        if self._by_formula and self.model.closed_form is not None:
            return self.model.closed_form(poses)
        wanted = motion.task_of(poses)
        given = {d: wanted[:, DIRECTIONS.index(d)] for d in self.held}
        return motion.move(task=given, joints=joints or None).placement
