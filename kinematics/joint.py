"""Joints: six directions, each free, locked, elastic or driven."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from functools import cached_property
from math import isfinite, pi
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError

DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")

#: In place of a direction: the angle between the two shafts of a universal joint.
BEND = "bend"

#: Locked directions by joint type, in joint axes: z is the axis, y = z × x.
JOINT_TYPES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "fixed": DIRECTIONS,
        "revolute": ("x", "y", "z", "rx", "ry"),
        "prismatic": ("x", "y", "rx", "ry", "rz"),
        "cylindrical": ("x", "y", "rx", "ry"),
        "helical": ("x", "y", "z", "rx", "ry"),
        "universal": ("x", "y", "z", "ry"),
        "spherical": ("x", "y", "z"),
        "planar": ("z", "rx", "ry"),
        "bushing": (),
        "support": (),
    }
)


class State(IntEnum):
    """State of a joint direction in statics, where driven directions are held."""

    FREE = 0
    LOCKED = 1
    ELASTIC = 2


@dataclass(frozen=True)
class Joint:
    """A joint between two coincident nodes.

    Parameters
    ----------
    name : str
        Unique within its linkage.
    type : str
        A key of `JOINT_TYPES`; "support" locks just the directions of `locks`.
    between : (str, str)
        The two nodes; relative motion is that of the second against the first.
    stiffness : mapping of direction to float
        Directions made elastic, N/m or N·m/rad.
    damping : mapping of direction to float
        Viscous damping, N·s/m or N·m·s/rad.
    driven : tuple of directions
        Actuated directions: free for kinematics; held in statics, or elastic where
        `stiffness` names them. Each is free by the joint's type, or elastic: a direction that
        the type or `locks` holds cannot move, whatever drives it.
    limits : mapping of direction to (low, high)
        Range of the joint coordinate, m or rad.
    matrix : (6, 6) nested tuples or None
        A bushing's full symmetric stiffness in joint axes, or that of a bearing in a joint of
        another type; the directions of its diagonal are elastic.
    locks : tuple of directions
        Locked directions in addition to those of the type.
    pitch : float or None
        Of a helical joint: along its axis for one right-handed turn, m; negative for a left-hand
        thread. Its row z holds the way along the axis to that of its turn, and rz is free.
    bearing : str
        Name of the bearing whose stiffness it has; empty for none.

    Raises
    ------
    ModelError
        An unknown type or direction, a negative stiffness, an asymmetric matrix, a drive in a
        locked direction.
    """

    name: str
    type: str
    between: tuple[str, str]
    stiffness: Mapping[str, float] = field(default_factory=dict)
    damping: Mapping[str, float] = field(default_factory=dict)
    driven: tuple[str, ...] = ()
    limits: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    matrix: tuple[tuple[float, ...], ...] | None = None
    locks: tuple[str, ...] = ()
    pitch: float | None = None
    bearing: str = ""

    def __post_init__(self) -> None:
        part = f"joint {self.name}"
        if self.type not in JOINT_TYPES:
            raise ModelError(
                part, f'unknown type "{self.type}".', "Choose one of: " + ", ".join(JOINT_TYPES)
            )
        if self.between[0] == self.between[1]:
            raise ModelError(
                part,
                f'joins node "{self.between[0]}" to itself.',
                "Give the joint two nodes at the same place, one on each side.",
            )
        for what, named in (
            ("stiffness", self.stiffness),
            ("damping", self.damping),
            ("driven", self.driven),
            ("limits", self.limits),
            ("locks", self.locks),
        ):
            for direction in named:
                if direction not in DIRECTIONS:
                    raise ModelError(
                        part,
                        f'{what} names the unknown direction "{direction}".',
                        "Directions are " + ", ".join(DIRECTIONS) + ".",
                    )
        for what, values in (("stiffness", self.stiffness), ("damping", self.damping)):
            for direction, value in values.items():
                if not isfinite(value) or value < 0 or (what == "stiffness" and value == 0):
                    raise ModelError(
                        part,
                        f"{what} in {direction} is {value!r}.",
                        "Give a positive finite number; leave the direction out to make it "
                        "locked or free as the type says.",
                    )
        if self.matrix is not None:
            _check_matrix(part, np.asarray(self.matrix, dtype=float))
            if self.type != "bushing" and not self.bearing:
                raise ModelError(
                    part,
                    f"a {self.type} joint cannot have a matrix.",
                    'Use type = "bushing", or name elastic directions in stiffness.',
                )
            if self.stiffness:
                raise ModelError(part, "has both matrix and stiffness.", "Keep one of the two.")
        elastic = self.matrix is not None or self.stiffness
        if self.type == "bushing" and not elastic and not any(self.damping.values()):
            raise ModelError(
                part,
                "a bushing without matrix or stiffness or damping.",
                "Give it a matrix or a stiffness; damping alone makes it a dashpot.",
            )
        self._check_pitch(part)
        self._check_driven(part)

    @property
    def lead(self) -> float:
        """Along the axis for one radian, m; 0 of joints that are not helical."""
        return 0.0 if self.pitch is None else self.pitch / (2.0 * pi)

    def _check_pitch(self, part: str) -> None:
        if self.type != "helical":
            if self.pitch is not None:
                raise ModelError(
                    part, f"is {self.type} and has a pitch.", 'Use type = "helical", or drop it.'
                )
            return
        if self.pitch is None or not isfinite(self.pitch) or self.pitch == 0.0:
            raise ModelError(
                part,
                f"is helical with the pitch {self.pitch!r}.",
                "Give its travel along the axis per turn, m, not zero; negative for a left-hand "
                "thread.",
            )
        if "z" in (*self.stiffness, *self.damping, *self.limits, *self.driven):
            raise ModelError(
                part,
                "is helical: z follows rz and takes no stiffness, damping, limit or drive.",
                "Name rz, which is free; give the nut's stiffness to a bushing beside it.",
            )

    def _check_driven(self, part: str) -> None:
        held = {*JOINT_TYPES[self.type], *self.locks} - set(self.stiffness)
        wrong = [d for d in DIRECTIONS if d in self.driven and d in held]
        if not wrong:
            return
        free = [d for d in DIRECTIONS if d not in held]
        kinds = [kind for kind, locked in JOINT_TYPES.items() if locked and wrong[0] not in locked]
        remedy = (
            f"Of this joint {', '.join(free)} can be driven; " if free else "It has no free one; "
        ) + (f"{wrong[0]} is free in {', '.join(kinds)} joints. " if kinds else "")
        raise ModelError(
            part,
            f"drives {', '.join(wrong)}, which a {self.type} joint locks"
            f"{'' if set(wrong) <= set(JOINT_TYPES[self.type]) else ' or its locks hold'}.",
            remedy + "Directions are those of the joint's own axes, whose z is its axis.",
        )

    @cached_property
    def states(self) -> tuple[State, ...]:
        """State of each of the six directions in statics (driven directions are held)."""
        locked = {*JOINT_TYPES[self.type], *self.locks, *self.driven} - set(self.stiffness)
        elastic = {d for d, k in zip(DIRECTIONS, np.diag(self.stiffness_matrix), strict=True) if k}
        return tuple(
            State.ELASTIC if d in elastic else State.LOCKED if d in locked else State.FREE
            for d in DIRECTIONS
        )

    @property
    def stiffness_matrix(self) -> NDArray[np.float64]:
        """Stiffness of the elastic directions in joint axes, (6, 6); zero elsewhere."""
        if self.matrix is not None:
            return np.asarray(self.matrix, dtype=float)
        return np.diag([float(self.stiffness.get(d, 0.0)) for d in DIRECTIONS])

    @property
    def couples(self) -> bool:
        """Whether the stiffness of one direction acts on another, as of a loaded bearing."""
        matrix = self.stiffness_matrix
        return self.matrix is not None and bool(np.any(matrix - np.diag(np.diag(matrix))))


def _check_matrix(part: str, matrix: NDArray[np.float64]) -> None:
    if matrix.shape != (6, 6) or not np.all(np.isfinite(matrix)):
        raise ModelError(part, "matrix is not 6 x 6 finite numbers.", "Give six rows of six.")
    gap = np.abs(matrix - matrix.T)
    if gap.max() > 1e-9 * np.abs(matrix).max():
        i, j = np.unravel_index(int(gap.argmax()), gap.shape)
        raise ModelError(
            part,
            f"matrix is not symmetric: entry ({DIRECTIONS[i]}, {DIRECTIONS[j]}) is "
            f"{matrix[i, j]:g}, its mirror {matrix[j, i]:g}.",
            "A stiffness matrix is symmetric; check the order x y z rx ry rz.",
        )
    # translations in N/m and rotations in N m/rad differ by a length squared: scale before judging
    scale = np.sqrt(np.abs(np.diag(matrix)))
    scale[scale == 0] = 1.0
    if np.linalg.eigvalsh(matrix / np.outer(scale, scale)).min() < -1e-9:
        raise ModelError(
            part,
            "matrix has a negative eigenvalue: it would release energy.",
            "Check signs and the order x y z rx ry rz.",
        )
