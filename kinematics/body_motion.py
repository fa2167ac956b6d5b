"""Velocities and accelerations of all bodies of a linkage, from its constraint rows.

The rows A of the held joint directions and those R of the coordinates x fix the twists q̇ of the
bodies: A q̇ = 0, R q̇ = ẋ, so q̇ = N ẋ. Differentiated once more, A q̈ = −Ȧ q̇ and
R q̈ = ẍ − Ṙ q̇: nothing is differenced.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.coordinates import Coordinates, home_rows, require_independent
from strutwork.kinematics.independent import independent_rows
from strutwork.kinematics.motion import Motion, Moved
from strutwork.kinematics.motion_spaces import null_space
from strutwork.kinematics.placed_motion import PlacedMotion

Array = NDArray[Any]

#: Share of the largest singular value of the rows below which a motion is not held.
HELD = 1e-9
#: Part that a turn has in a motion of unit size before it counts as turning.
TURNS = 1e-6


@dataclass(frozen=True)
class BodyMotion:
    """What moves the bodies of a linkage, planned at home.

    Parameters
    ----------
    motion : Motion
    coordinates : Coordinates
        That describe it, as many as it has freedoms.
    points : (b, 3)
        Points of the bodies at home whose velocities are asked for, m.

    Raises
    ------
    ModelError
        Coordinates that depend on each other, or bodies that move although all of them stand,
        other than by spinning about one line.
    """

    motion: Motion
    coordinates: Coordinates
    points: Array

    def __post_init__(self) -> None:
        if not len(self.coordinates):
            raise ModelError(
                "motion", "is described by no coordinate.", "Name directions of the tool or joints."
            )
        require_independent(self.motion, self.coordinates)
        _ = self.plan

    @cached_property
    def plan(self) -> tuple[NDArray[np.intp], tuple[tuple[int, Array], ...]]:
        """Held rows that are independent, (r,), and bodies that spin freely, lines at home (3,).

        A spin is what no coordinate moves, as that of a strut between two ball joints: such
        bodies are taken not to turn about their lines.
        """
        held, given = home_rows(self.motion, self.coordinates)
        kept, _ = independent_rows(np.concatenate([held, given]), len(held))
        rows = [*held[kept[kept < len(held)]], *given]
        free = null_space(np.array(rows)[None], share=HELD)[0]
        free = free[:, np.abs(free).max(axis=0) > 0]
        free = free.reshape(len(free) // 6, 6, free.shape[1])
        spins: list[tuple[int, Array]] = []
        names = self.motion.linkage.body_names
        home = self.motion.joints.start(1).position[0] / self.motion.length
        drives = home_rows(self.motion, Coordinates((), self.motion.linkage.driven))[1]
        basis = np.eye(free.shape[-1])
        for body in range(len(names)):
            turning = free[body, 3:] @ basis
            if not basis.shape[1] or not (axis := _only_axis(turning)).any():
                continue
            row = axis @ turning
            spin = free @ (basis @ row)
            driven = np.abs(drives @ spin.ravel()).max(initial=0.0) > TURNS * np.abs(spin).max()
            if driven or not _turns_as_one(spin, home, body):
                continue
            spins.append((body, axis))
            rest = null_space(row[None, None], HELD * float(np.abs(row).max()))[0]
            basis = basis @ rest[:, np.abs(rest).max(axis=0) > 0]
        if basis.shape[1]:
            loose = np.abs(free @ basis).max(axis=(1, 2)) > TURNS
            raise ModelError(
                "motion",
                f"bodies {', '.join(n for n, one in zip(names, loose, strict=True) if one)} move "
                f"although {', '.join(self.coordinates.labels)} "
                f"{'stands' if len(self.coordinates) == 1 else 'stand'} still.",
                "Give further joint coordinates, or hold the joints that let them move.",
            )
        return kept[kept < len(held)], tuple(spins)

    @property
    def idle(self) -> tuple[str, ...]:
        """Bodies that spin freely about a line of theirs."""
        return tuple(self.motion.linkage.body_names[body] for body, _ in self.plan[1])

    def at(self, moved: Moved) -> PlacedMotion:
        """The motion at reached poses; batch axes are made one.

        Parameters
        ----------
        moved : Moved
            Poses that the motion has reached, any batch axes.

        Raises
        ------
        UnreachableError
            A pose that was not reached.
        """
        placement = moved.placement.require_reachable().flat()
        count = len(placement.positions)
        bodies = len(self.motion.linkage.body_names)
        return PlacedMotion(
            self,
            placement,
            moved.bodies.position.reshape(count, bodies, 3),
            moved.bodies.rotation.reshape(count, bodies, 3, 3),
        )


def _only_axis(turning: Array) -> Array:
    """The line about which a body turns in all of some motions, (3, k) to (3,), else zero."""
    left, values, _ = np.linalg.svd(turning)
    if values[0] <= TURNS or (len(values) > 1 and values[1] > TURNS * values[0]):
        return np.zeros(3)
    return np.asarray(left[:, 0])


def _turns_as_one(twists: Array, points: Array, body: int) -> bool:
    """Whether all bodies that move turn about one line as a body does, (b, 6) about points."""
    size = np.abs(twists).max()
    moving = np.abs(twists).max(axis=1) > TURNS * size
    spin, pace = twists[body, 3:], twists[body, :3]
    alike = pace + np.cross(spin, points[moving] - points[body])
    gap = np.abs(twists[moving] - np.concatenate([alike, np.tile(spin, (len(alike), 1))], axis=1))
    # about a line that stays where it is: no shift along it
    return bool(gap.max() <= TURNS * size and abs(pace @ spin) <= TURNS * size**2)
