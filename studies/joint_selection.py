"""Coordinates of joints by their names, as JOINT:DIRECTION, and the bend of universal joints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Joint, Placement
from strutwork.kinematics.joint import BEND, JOINT_TYPES
from strutwork.machines.model import Model
from strutwork.names import choices, listed, matches, visible

Array = NDArray[Any]


@dataclass(frozen=True)
class JointCoordinate:
    """A coordinate of a joint.

    Parameters
    ----------
    joint : str
    direction : str
        One of `DIRECTIONS` in which the joint is free, `BEND` of a universal joint, or what else
        the machine's own formulas give, as the swing of a ball joint; all of these are angles.
    """

    joint: str
    direction: str

    @property
    def label(self) -> str:
        """As a person names it."""
        return f"{self.joint}:{self.direction}"

    @property
    def turns(self) -> bool:
        """Whether it is an angle."""
        return self.direction not in ("x", "y", "z")

    @property
    def unit(self) -> str:
        """SI."""
        return "rad" if self.turns else "m"

    def values(self, placement: Placement) -> Array:
        """The coordinate at each pose, (...), m or rad.

        The bend is arccos(cos a · cos b) of the two angles a and b, zero where both are zero.

        Parameters
        ----------
        placement : Placement
            That gives the coordinate.
        """
        if self.direction != BEND or (self.joint, BEND) in placement.names:
            return self._one(placement, self.direction)
        a, b = (self._one(placement, d) for d in ("rx", "rz"))
        return np.asarray(np.arccos(np.clip(np.cos(a) * np.cos(b), -1.0, 1.0)))

    def _one(self, placement: Placement, direction: str) -> Array:
        if (self.joint, direction) not in placement.names:
            raise ModelError(
                f"joint {visible(self.joint)}",
                f"has no value of {direction} at these poses.",
                "Name a workspace in which the tool moves.",
            )
        return np.asarray(
            placement.values[..., placement.names.index((self.joint, direction))].real
        )


def coordinates_of(model: Model, selected: Sequence[str] = ()) -> tuple[JointCoordinate, ...]:
    """The coordinates of a machine's joints that some texts name, in the order of the joints.

    Parameters
    ----------
    model : Model
    selected : sequence of str
        JOINT for all coordinates of a joint, or JOINT:DIRECTION; a star stands for any characters.
        Every coordinate where there is none.

    Raises
    ------
    ModelError
        A joint that does not exist (the message names the nearest), one without a free direction,
        a direction in which it does not move or that the machine's formulas do not give; a machine
        without any.
    """
    given = _given(model)
    every = [c for joint in model.structure.linkage.joints for c in _of_joint(joint, given)]
    if not selected:
        if not every:
            raise ModelError(
                "joints",
                "have no free direction.",
                "Ask a machine whose joints move, or for another answer.",
            )
        return tuple(every)
    wanted: set[JointCoordinate] = set()
    for text in selected:
        wanted |= set(_matching(model, text, every))
    return tuple(c for c in every if c in wanted)


def _given(model: Model) -> tuple[tuple[str, str], ...]:
    """Coordinates that placements have: all that move, or those of the machine's own formulas."""
    if model.closed_form is not None:
        return model.placement.names
    return model.motion.joints.names


def _of_joint(joint: Joint, given: Sequence[tuple[str, str]]) -> list[JointCoordinate]:
    # formulas may give more than directions, as the swing of a ball joint
    own = [d for name, d in given if name == joint.name]
    found = [JointCoordinate(joint.name, d) for d in own]
    if joint.type == "universal" and {"rx", "rz"} <= set(own) and BEND not in own:
        found.append(JointCoordinate(joint.name, BEND))
    return found


def _matching(model: Model, text: str, every: list[JointCoordinate]) -> list[JointCoordinate]:
    every_joint = model.structure.linkage.joints
    names = [j.name for j in every_joint]
    name, colon, direction = text.rpartition(":")
    # names of joints may contain colons
    if not colon or any(matches(n, text) for n in names):
        name, direction = text, "*"
    joints = [j for j in every_joint if matches(j.name, name)]
    if not joints:
        raise ModelError(
            f"joint {visible(name)}", "does not exist.", choices("Joints", name, names)
        )
    here = [j.name for j in joints]
    found = [c for c in every if c.joint in here and matches(c.direction, direction)]
    if found:
        return found
    own = [c.direction for c in every if c.joint in here]
    part = f"joint {visible(name)}"
    if not own:
        free = [d for d in DIRECTIONS if any(d not in _held(j) for j in joints)]
        if not free:
            raise ModelError(
                part,
                f"is {joints[0].type} and has no free direction, hence no coordinate.",
                "Name a joint that moves.",
            )
        raise ModelError(
            part,
            f"moves along {listed(free)}, whose values the machine's formulas do not give.",
            choices("Coordinates", text, [c.label for c in every]),
        )
    raise ModelError(
        part,
        f'has no coordinate "{visible(direction)}".',
        choices("Coordinates", f"{name}:{direction}", [c.label for c in every if c.joint in here]),
    )


def _held(joint: Joint) -> tuple[str, ...]:
    return (*JOINT_TYPES[joint.type], *joint.locks)
