"""Couplings: two joint coordinates that follow each other, by gears, a belt, a chain or a screw."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite

from strutwork.errors import ModelError
from strutwork.kinematics.joint import DIRECTIONS, Joint, State
from strutwork.names import choices

#: A joint coordinate by its joint and direction.
Coordinate = tuple[str, str]


@dataclass(frozen=True)
class Coupling:
    """The coordinate of one joint as a fixed multiple of that of another.

    Parameters
    ----------
    name : str
        Unique among joints and couplings.
    first, second : (joint, direction)
        Two coordinates that the types of their joints leave free, one of them driven at most.
    ratio : float
        Change of `second` per change of `first`, in m and rad: negative where they run against
        each other, as two gears in mesh do.

    Raises
    ------
    ModelError
        A ratio that is zero or not finite, a direction that does not exist, or one coordinate
        coupled with itself.
    """

    name: str
    first: Coordinate
    second: Coordinate
    ratio: float

    def __post_init__(self) -> None:
        part = f"coupling {self.name}"
        if not isfinite(self.ratio) or self.ratio == 0.0:
            raise ModelError(
                part,
                f"has the ratio {self.ratio!r}.",
                "Give the motion of the second coordinate per motion of the first, not zero.",
            )
        for _, direction in (self.first, self.second):
            if direction not in DIRECTIONS:
                raise ModelError(
                    part,
                    f'names the unknown direction "{direction}".',
                    "Directions are " + ", ".join(DIRECTIONS) + ".",
                )
        if self.first == self.second:
            raise ModelError(
                part, f"couples {':'.join(self.first)} with itself.", "Name two coordinates."
            )


@dataclass(frozen=True)
class Tie:
    """One coordinate that follows another: the row c − ratio · c_other = 0.

    Parameters
    ----------
    name : str
        Of the coupling, or of the helical joint.
    joint, direction : int
        The coordinate that follows; the row stands among those of its joint.
    other_joint, other_direction : int
        The coordinate that it follows.
    ratio : float
        m/m, m/rad, rad/m or rad/rad.
    """

    name: str
    joint: int
    direction: int
    other_joint: int
    other_direction: int
    ratio: float


def ties_of(
    joints: Sequence[Joint], index: Mapping[str, int], couplings: Sequence[Coupling]
) -> tuple[Tie, ...]:
    """The rows of helical joints and couplings, each with the coordinate that carries it.

    Of a coupling the second coordinate follows the first, unless it is driven or follows another
    already: then the first follows the second.

    Parameters
    ----------
    joints : sequence of Joint
        Of a linkage, in its order.
    index : mapping of str to int
        Number of each joint by its name.
    couplings : sequence of Coupling
        Between two of these joints each.

    Raises
    ------
    ModelError
        An unknown joint, a coordinate that is held, sprung or turns in all ways, two that are
        driven, or couplings that leave none to follow.
    """
    turn = DIRECTIONS.index("rz")
    found = {
        (j, 2): Tie(joint.name, j, 2, j, turn, joint.lead)
        for j, joint in enumerate(joints)
        if joint.lead
    }
    for coupling in couplings:
        part = f"coupling {coupling.name}"
        ends = [_end(part, joints, index, end) for end in (coupling.first, coupling.second)]
        driven = [DIRECTIONS[d] in joints[j].driven for j, d in ends]
        names = [":".join(coupling.first), ":".join(coupling.second)]
        if all(driven):
            raise ModelError(
                part,
                f"joins {names[0]} and {names[1]}, and both are driven: one follows the other.",
                "Remove one of the drives.",
            )
        first, second = ends
        if not driven[1] and second not in found:
            found[second] = Tie(coupling.name, *second, *first, coupling.ratio)
        elif not driven[0] and first not in found:
            found[first] = Tie(coupling.name, *first, *second, 1.0 / coupling.ratio)
        else:
            raise ModelError(
                part,
                f"joins {names[0]} and {names[1]}, which are driven or follow others already.",
                "Leave it out, or couple another coordinate.",
            )
    return tuple(found[key] for key in sorted(found))


def _end(
    part: str, joints: Sequence[Joint], index: Mapping[str, int], end: Coordinate
) -> tuple[int, int]:
    name, direction = end
    if name not in index:
        raise ModelError(
            part,
            f'names the unknown joint "{name}".',
            choices("Joints", name, index),
        )
    joint, d = joints[index[name]], DIRECTIONS.index(direction)
    states = joint.states
    free = [e for e, s in zip(DIRECTIONS, states, strict=True) if s == State.FREE]
    if direction not in (*free, *joint.driven):
        what = "is sprung" if states[d] == State.ELASTIC else "does not move"
        raise ModelError(
            part,
            f"couples {name}:{direction}, which {what}.",
            f"Of this joint {', '.join((*free, *joint.driven)) or 'nothing'} can be coupled.",
        )
    if d >= 3 and all(e in (*free, *joint.driven) for e in DIRECTIONS[3:]):
        raise ModelError(
            part,
            f"couples {name}:{direction}, but {name} rotates freely in all directions.",
            "Build it from single revolute joints and couple one of them.",
        )
    return index[name], d
