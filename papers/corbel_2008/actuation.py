"""Section III: condition of the linear Delta, and what its rods' errors turn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq, minimize_scalar

from strutwork.kinematics import Linkage, Placement, Poses, jacobians
from strutwork.kinematics.capability import Zonotope
from strutwork.kinematics.error_transmission import error_transmission
from strutwork.kinematics.frames import cross_matrix
from strutwork.machines.linear_delta import LEGS, SIDES, LinearDelta, leg

Array = NDArray[Any]

#: Places along each side of the square: the condition is worst at a corner or in the middle of a
#: side, and a finer grid finds no worse (`FINE`).
STEPS, FINE = 3, 13
#: Lengths of the rods that are studied, m.
RODS = (0.7, 0.8, 0.9, 1.0)
#: A largest condition number that exceeds the least by this part is as good.
FLAT = 0.01


def square(machine: LinearDelta, steps: int = STEPS) -> Array:
    """Places of the tool in a section of the workspace, (n, 3), m."""
    half = machine.workspace_side / 2.0
    line = np.linspace(-half, half, steps)
    return np.array(list(product(line, line, (0.0,))))


def condition(machine: LinearDelta, places: ArrayLike) -> Array:
    """Condition number of the Jacobian over the tool's three motions, (...)."""
    placement = machine.place(Poses.of(places))
    # translations alone: no length says what counts as a radian
    return jacobians(machine.linkage, placement).condition(1.0)


def singular_values(machine: LinearDelta, places: ArrayLike) -> Array:
    """Of the Jacobian, tool speed by carriage speed, (..., 3)."""
    placement = machine.place(Poses.of(places))
    forward = jacobians(machine.linkage, placement).forward[..., :3, :]
    return np.asarray(np.linalg.svd(forward, compute_uv=False))


def with_reach(machine: LinearDelta, reach: float, rod: float | None = None) -> LinearDelta:
    """The machine with another ΔR, m, by its rails' radius, and another L, m."""
    length = machine.rod_length if rod is None else rod
    return replace(machine, base_radius=machine.platform_radius + reach, rod_length=length)


def worst_conditions(machines: Sequence[LinearDelta], steps: int = STEPS) -> Array:
    """Largest condition number over the workspace of many machines at once, (n,)."""
    # the machine is its own mirror image in x
    made = [m.place(Poses.of(p[p[:, 0] >= 0.0])) for m in machines for p in [square(m, steps)]]
    together = Placement(
        np.concatenate([p.positions for p in made]),
        np.concatenate([p.frames for p in made]),
        np.concatenate([p.values for p in made]),
        made[0].names,
    )
    found = jacobians(_linkage(), together).condition(1.0)
    return np.asarray(found.reshape(len(made), -1).max(axis=1))


@cache
def _linkage() -> Linkage:
    """Of a Delta of any size: what is compiled for it is kept."""
    return LinearDelta().linkage


@dataclass(frozen=True)
class BestReach:
    """The ΔR whose largest condition number is least.

    Parameters
    ----------
    rod, reach : float
        L and ΔR, m.
    worst : float
        Largest condition number over the workspace.
    low, high : float
        Between them ΔR is as good, but for `FLAT`, m.
    """

    rod: float
    reach: float
    worst: float
    low: float
    high: float


def best_reach(rod: float, machine: LinearDelta | None = None) -> BestReach:
    """Best ΔR for rods of a length, m, over the workspace's square, to 1e-7 m."""
    base = LinearDelta() if machine is None else machine

    def worst(reach: float) -> float:
        return float(worst_conditions([with_reach(base, reach, rod)])[0])

    # isotropic in the middle of the workspace at √(2/3) L; beyond it every rod lies flatter
    top = np.sqrt(2.0 / 3.0) * rod
    most = min(top, rod - 1.01 * np.sqrt(0.5) * base.workspace_side)
    found = minimize_scalar(
        worst, bounds=(0.3 * rod, most), method="bounded", options={"xatol": 1e-7}
    )
    limit = (1.0 + FLAT) * found.fun

    def over(reach: float) -> float:
        return float(worst(reach) - limit)

    low, high = (brentq(over, end, found.x, xtol=1e-6) for end in (0.3 * rod, most))
    return BestReach(rod, float(found.x), float(found.fun), float(low), float(high))


def rod_gain(machine: LinearDelta, places: ArrayLike) -> Array:
    """Displacement and rotation of the platform by each rod's length, (..., 6, 6), m and rad per m.

    By the joints' rows alone: nothing is held twice, so that no force comes into it.
    """
    # the z of a rod's ball lies along the rod
    columns = [(leg(i, f"ball-{s}"), "z") for i in LEGS for s in SIDES]
    placement = machine.place(Poses.of(places))
    return error_transmission(machine.linkage, placement, columns).matrix


def turn_by_difference(machine: LinearDelta, places: ArrayLike) -> Array:
    """Rotation by a difference of a parallelogram's rods, times d, for each leg, (..., 3).

    One where the platform turns by just δ/d.
    """
    gain = rod_gain(machine, places)[..., 3:, :]
    halves = 0.5 * (gain[..., 1::2] - gain[..., ::2])
    return np.asarray(machine.rod_spacing * np.linalg.norm(halves, axis=-2))


def worst_turn(machine: LinearDelta, places: ArrayLike) -> Array:
    """Largest rotation for rods that are each wrong by up to one, (...), rad/m."""
    return Zonotope(rod_gain(machine, places)[..., 3:, :]).largest


def worst_deviation(machine: LinearDelta, places: ArrayLike, ahead: float) -> Array:
    """Largest displacement of a tool point ahead of the plate, m, by the same errors, (...)."""
    gain = rod_gain(machine, places)
    arm = cross_matrix([0.0, 0.0, ahead])
    return Zonotope(gain[..., :3, :] - arm @ gain[..., 3:, :]).largest


@dataclass(frozen=True)
class ActuationStudy:
    """What is found of the Delta.

    Parameters
    ----------
    machine : LinearDelta
    rods, reaches, worst : (l,), (r,), (l, r)
        L and ΔR of the map, m, and the largest condition number over the workspace; NaN where
        rods are too short for it.
    fine, lines : (f,), (b, f)
        ΔR of the lines, m, and the same for the rods of `best`.
    best : tuple of BestReach
        For each of `RODS`.
    centre, corner : float
        Condition number in the middle of the workspace, and the largest.
    gains : (float, float)
        Least and largest singular value of the Jacobian over the workspace.
    """

    machine: LinearDelta
    rods: Array
    reaches: Array
    worst: Array
    fine: Array
    lines: Array
    best: tuple[BestReach, ...]
    centre: float
    corner: float
    gains: tuple[float, float]

    def __repr__(self) -> str:
        return f"<ActuationStudy: {self.worst.size} machines, condition {self.corner:.3f}>"

    def best_of(self, rod: float) -> BestReach:
        """The best for rods of one of the lengths."""
        return next(b for b in self.best if b.rod == rod)


def _mapped(machine: LinearDelta, rods: Array, reaches: Array) -> Array:
    """Largest condition numbers by L and ΔR, (l, r); NaN where rods are too short."""
    room = np.sqrt(0.5) * machine.workspace_side
    worst = np.full((len(rods), len(reaches)), np.nan)
    pairs = [(k, n) for k, n in np.ndindex(worst.shape) if reaches[n] + 1.02 * room < rods[k]]
    made = [with_reach(machine, float(reaches[n]), float(rods[k])) for k, n in pairs]
    worst[tuple(np.array(pairs).T)] = worst_conditions(made)
    return worst


@cache
def study_actuation() -> ActuationStudy:
    """The studies of section III, once."""
    machine = LinearDelta()
    rods, reaches = np.linspace(0.65, 1.1, 10), np.linspace(0.34, 0.74, 17)
    fine = np.linspace(0.34, 0.74, 41)
    places = square(machine, FINE)
    values = singular_values(machine, places)
    return ActuationStudy(
        machine,
        rods,
        reaches,
        _mapped(machine, rods, reaches),
        fine,
        _mapped(machine, np.array(RODS), fine),
        tuple(best_reach(rod, machine) for rod in RODS),
        float(condition(machine, [0.0, 0.0, 0.0])),
        float((values[:, 0] / values[:, -1]).max()),
        (float(values.min()), float(values.max())),
    )
