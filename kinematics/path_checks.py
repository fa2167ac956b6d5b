"""Singularities, jumps and the end of reach along a trajectory."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import NumericalError, SingularPoseError, UnreachableError
from strutwork.kinematics.dynamics import Dynamics, PlacedDynamics
from strutwork.kinematics.motion import Moved
from strutwork.kinematics.trajectory import Trajectory

Array = NDArray[Any]

#: Halvings of an interval in which a singularity lies.
HALVINGS = 40
#: Share of the largest `held` below which a least one is looked for between samples, how many
#: are, and share that counts as none.
NEAR, NEAREST, TOUCHED = 0.3, 8, 1e-6

SERIAL = "serial (type 1): a leg reaches the end of its working mode"
PARALLEL = "parallel (type 2): the drives do not hold the tool there"
BOTH = "serial and parallel at once (type 3)"


def move_along(dynamics: Dynamics, trajectory: Trajectory, times: ArrayLike) -> Moved:
    """The linkage at times of a trajectory; poses that it cannot take are marked.

    Parameters
    ----------
    dynamics : Dynamics
        Of the machine.
    trajectory : Trajectory
        Of coordinates of its tool and joints.
    times : (p,)
        s.
    """
    values = trajectory.at(times)[0]
    names = trajectory.coordinates.names
    task = {d: values[:, k] for k, (joint, d) in enumerate(names) if not joint}
    joints = {pair: values[:, k] for k, pair in enumerate(names) if pair[0]}
    return dynamics.motion.move(task=task or None, joints=joints or None)


def placed_along(
    dynamics: Dynamics, trajectory: Trajectory, times: Array
) -> tuple[Moved, PlacedDynamics]:
    """The dynamics at times of a trajectory.

    Parameters
    ----------
    dynamics : Dynamics
        Of the machine.
    trajectory : Trajectory
        Of the dynamics' coordinates.
    times : (p,)
        s.

    Raises
    ------
    UnreachableError, SingularPoseError
        A pose that cannot be taken, or at which the coordinates fail; names its time.
    """
    moved = move_along(dynamics, trajectory, times)
    bad = np.flatnonzero(~moved.reached)
    if bad.size:
        first = int(bad[0])
        raise UnreachableError(
            _place(trajectory, float(times[first])),
            f"cannot be reached: {moved.placement.reason(first)}.",
            "Keep the path within reach of the machine.",
        )
    placed = dynamics.bodies.at(moved)
    lost = np.flatnonzero(placed.singular)
    if lost.size:
        raise singular_at(trajectory, float(times[lost[0]]), SERIAL)
    return moved, dynamics.at(moved)


def singular_at(trajectory: Trajectory, when: float, kind: str) -> SingularPoseError:
    """The error of a singularity on a path.

    Parameters
    ----------
    trajectory : Trajectory
        The path.
    when : float
        s.
    kind : str
        `SERIAL`, `PARALLEL` or `BOTH`.
    """
    return SingularPoseError(
        _place(trajectory, when),
        f"passes through a singularity, {kind}.",
        "Lead the path around it.",
    )


def _place(trajectory: Trajectory, when: float) -> str:
    """`trajectory at t = 0.2 s, x = 12 mm, rz = -3 deg`."""
    words = [f"trajectory at t = {when:.6g} s"]
    for (joint, direction), value in zip(
        trajectory.coordinates.names, trajectory.at([when])[0][0], strict=True
    ):
        label = f"{joint}:{direction}" if joint else direction
        turns = direction.startswith("r")
        shown = float(np.degrees(value)) if turns else 1e3 * float(value)
        words.append(f"{label} = {shown:.5g} {'deg' if turns else 'mm'}")
    return ", ".join(words)


@dataclass(frozen=True)
class Way:
    """Neighbouring poses of a path.

    Parameters
    ----------
    times : (p,)
        s.
    sign, driven : (p,)
        As `PlacedMotion.sign` and `PlacedDynamics.drive_sign`, no unit.
    points, speeds : (p, b, 3)
        Of the bodies, m and m/s.
    """

    times: Array
    sign: Array
    driven: Array
    points: Array
    speeds: Array

    def _parts(self) -> tuple[Array, ...]:
        return self.times, self.sign, self.driven, self.points, self.speeds

    def then(self, other: Way) -> Way:
        """The poses of both, one way after the other.

        Parameters
        ----------
        other : Way
            Poses that follow.
        """
        pairs = zip(self._parts(), other._parts(), strict=True)
        return Way(*(np.concatenate(pair) for pair in pairs))

    @property
    def end(self) -> Way:
        """Its last pose."""
        return Way(*(part[-1:] for part in self._parts()))


def check_way(dynamics: Dynamics, trajectory: Trajectory, way: Way) -> None:
    """Refuse a path with a singularity or a jump between neighbouring poses.

    Parameters
    ----------
    dynamics : Dynamics
        Of the machine.
    trajectory : Trajectory
        The path.
    way : Way
        Its poses, times ascending.

    Raises
    ------
    SingularPoseError, NumericalError
        Names the time, and the kind or the body.
    """
    times, sign, points, speeds = way.times, way.sign, way.points, way.speeds
    # the drives' rates per coordinate change sense at both kinds, the rows alone at serial ones
    serial, parallel = np.diff(sign) != 0, np.diff(sign * way.driven) != 0
    crossed = np.flatnonzero(serial | parallel)
    if crossed.size:
        k = int(crossed[0])
        kind = BOTH if serial[k] and parallel[k] else SERIAL if serial[k] else PARALLEL
        when = _bisected(dynamics, trajectory, times[k], times[k + 1])
        raise singular_at(trajectory, when, kind)
    span = np.diff(times)[:, None]
    gap = np.diff(points, axis=0) - span[..., None] * (speeds[1:] + speeds[:-1]) / 2.0
    pace = np.linalg.norm(speeds, axis=-1)
    allowed = span * (pace[1:] + pace[:-1]) / 2.0 + 1e-6 * dynamics.motion.length
    jump = np.argwhere(np.linalg.norm(gap, axis=-1) > allowed)
    if len(jump):
        k, body = (int(i) for i in jump[0])
        raise NumericalError(
            f"trajectory between t = {times[k]:.6g} s and {times[k + 1]:.6g} s",
            f"jumps: {dynamics.motion.linkage.body_names[body]} would have to change to another "
            "assembly or working mode, or the samples are too far apart.",
            "Give more samples, or keep the path on one branch.",
        )


def _bisected(dynamics: Dynamics, trajectory: Trajectory, low: float, high: float) -> float:
    """Time between two at which a sign changes."""
    wanted = _signs(dynamics, trajectory, low)
    for _ in range(HALVINGS):
        middle = (low + high) / 2.0
        found = _signs(dynamics, trajectory, middle)
        if found is None:
            return middle
        low, high = (middle, high) if found == wanted else (low, middle)
    return (low + high) / 2.0


def _signs(dynamics: Dynamics, trajectory: Trajectory, when: float) -> tuple[float, float] | None:
    moved = move_along(dynamics, trajectory, [when])
    if not moved.reached.all():
        return None
    placed = PlacedDynamics(dynamics, dynamics.bodies.at(moved))
    if placed.placed.singular.any():
        return None
    return float(placed.placed.sign[0]), float(placed.drive_sign[0])


def check_touched(dynamics: Dynamics, trajectory: Trajectory, times: Array, held: Array) -> None:
    """Refuse a singularity that the path touches between two poses without changing sides.

    Parameters
    ----------
    dynamics : Dynamics
        Of the machine.
    trajectory : Trajectory
        The path.
    times : (p,)
        s, ascending.
    held : (p,)
        As `PlacedDynamics.held` at these times, no unit.

    Raises
    ------
    SingularPoseError
        Names the time.
    """
    # imported late: it takes a third of a small command's start
    from scipy.optimize import minimize_scalar  # noqa: PLC0415

    padded = np.concatenate([[np.inf], held, [np.inf]])
    least = np.flatnonzero(
        (held <= padded[:-2]) & (held <= padded[2:]) & (held < NEAR * held.max())
    )
    near = least[np.argsort(held[least])][:NEAREST]

    def hold(when: float) -> float:
        moved = move_along(dynamics, trajectory, [when])
        if not moved.reached.all():
            return 0.0
        placed = dynamics.bodies.at(moved)
        return 0.0 if placed.singular.any() else float(PlacedDynamics(dynamics, placed).held[0])

    for k in near:
        low, high = times[max(k - 1, 0)], times[min(k + 1, len(times) - 1)]
        found = minimize_scalar(
            hold, bounds=(low, high), method="bounded", options={"xatol": 1e-9 * (high - low)}
        )
        if found.fun < TOUCHED * held.max():
            raise singular_at(trajectory, float(found.x), PARALLEL)
