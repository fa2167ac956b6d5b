"""Section IV: what the resolution of the six encoders leaves open at the tool."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from strutwork.errors import ModelError
from strutwork.kinematics import Placement, jacobians
from strutwork.kinematics.capability import Zonotope
from strutwork.kinematics.frames import cross_matrix
from strutwork.machines.gough_platform import GoughPlatform

Array = NDArray[Any]

#: Places along each side of the workspace, and of a map's workspaces.
STEPS, FEW = 7, 3
#: Tool points ahead of the plate that are studied, m.
AHEAD = (0.0, 0.1, 0.2, 0.3)
#: The box that tool points lie in, (low, high) by x, y and z from the plate's centre, m. Ours: the
#: paper's box (Fig. 4) is not legible.
BOX = ((-0.05, 0.05), (-0.05, 0.05), (0.1, 0.2))


def workspace(machine: GoughPlatform, steps: int = STEPS) -> Array:
    """Places of the plate's centre in its cube, (n, 3), m."""
    half = machine.workspace_side / 2.0
    line = np.linspace(-half, half, steps)
    level = np.array([0.0, 0.0, machine.plate_height])
    return np.asarray(np.array(list(product(line, repeat=3))) + level)


def corners(box: tuple[tuple[float, float], ...] = BOX) -> Array:
    """Corners of a box, (8, 3), m."""
    return np.array(list(product(*box)))


def tool_errors(machine: GoughPlatform, places: Array, arms: ArrayLike) -> Zonotope:
    """Errors of tool points for encoder errors of one (eqs. 11 to 14).

    Parameters
    ----------
    machine : GoughPlatform
        Its own tool centre point does not count.
    places : (p, 3)
        Of the plate's centre, m.
    arms : (a, 3)
        Tool points from the plate's centre, m.

    Returns
    -------
    Zonotope
        Batch (p, a).
    """
    bare = replace(machine, tool=(0.0, 0.0, 0.0))
    return _errors(bare, bare.place(bare.at_plate(places)), np.asarray(arms, dtype=float))


def _errors(machine: GoughPlatform, placement: Placement, arms: Array) -> Zonotope:
    forward = jacobians(machine.linkage, placement).forward[:, None]
    # Δp_T = Δp + Δr × EE_T
    return Zonotope(forward[..., :3, :] - cross_matrix(arms) @ forward[..., 3:, :])


def amplification(
    machine: GoughPlatform, arms: ArrayLike = ((0.0, 0.0, 0.0),), steps: int = STEPS
) -> float:
    """Criterion C_opt for encoder errors of one (eqs. 23, 24): worst error over the workspace.

    Over the signs of the errors and the corners of a box of tool points the maximum is exact,
    since the norm is convex in either; over the workspace it is that of a grid with the cube's
    corners.
    """
    return float(tool_errors(machine, workspace(machine, steps), arms).largest.max())


def amplifications(
    machines: list[GoughPlatform], arms: ArrayLike = ((0.0, 0.0, 0.0),), steps: int = FEW
) -> Array:
    """Of many geometries at once, as `amplification`, (n,)."""
    first = machines[0]
    made = [m.place(m.at_plate(workspace(m, steps))) for m in machines]
    together = Placement(
        np.concatenate([p.positions for p in made]),
        np.concatenate([p.frames for p in made]),
        np.concatenate([p.values for p in made]),
        made[0].names,
    )
    found = _errors(first, together, np.asarray(arms, dtype=float)).largest
    return np.asarray(found.reshape(len(machines), -1).max(axis=1))


@dataclass(frozen=True)
class LegRange:
    """Lengths of the legs over the workspace, m.

    Parameters
    ----------
    shortest, longest : float
        Exact: a length grows with the distance of the plate from where the leg is upright.
    """

    shortest: float
    longest: float


def _aside(machine: GoughPlatform) -> tuple[float, float]:
    """How little and how much a leg may lean over the workspace, level, m."""
    half = machine.workspace_side / 2.0
    # with the tool at the plate's centre or anywhere: what is aside of the axis counts
    offset = (machine.feet - machine.seats)[:, :2] - np.asarray(machine.tool[:2])
    near = np.linalg.norm(offset - np.clip(offset, -half, half), axis=1).min()
    far = np.linalg.norm(np.abs(offset) + half, axis=1).max()
    return float(near), float(far)


def leg_range(machine: GoughPlatform) -> LegRange:
    """Shortest and longest leg while the plate's centre moves in its cube."""
    near, far = _aside(machine)
    half = machine.workspace_side / 2.0
    low, high = machine.plate_height - half, machine.plate_height + half
    return LegRange(float(np.hypot(near, low)), float(np.hypot(far, high)))


def heights(machine: GoughPlatform) -> tuple[float, float]:
    """Least and largest height of the plate at home whose legs keep their range, m.

    Raises
    ------
    ModelError
        No height does.
    """
    near, far = _aside(machine)
    half = machine.workspace_side / 2.0
    low = np.sqrt(max(machine.shortest_leg**2 - near**2, 0.0)) + half
    high = np.sqrt(max(machine.longest_leg**2 - far**2, 0.0)) - half
    if low > high:
        raise ModelError(
            "measuring platform",
            f"no height keeps its legs within {machine.shortest_leg:g} to "
            f"{machine.longest_leg:g} m over the workspace.",
            "Take smaller radii, or a smaller workspace.",
        )
    return float(low), float(high)


def lowest(machine: GoughPlatform) -> GoughPlatform:
    """The machine with its workspace as near to the base as its legs allow.

    Raises
    ------
    ModelError
        As `heights`.
    """
    return replace(machine, plate_height=heights(machine)[0])


def widest_base(machine: GoughPlatform) -> float:
    """Largest r_b that the range of the legs allows over the workspace, to 1e-6 m."""

    def gap(radius: float) -> float:
        made = replace(machine, base_radius=radius)
        near, far = _aside(made)
        low = np.sqrt(max(made.shortest_leg**2 - near**2, 0.0))
        return float(np.hypot(far, low + made.workspace_side) - made.longest_leg)

    return float(brentq(gap, machine.plate_radius * 2.0, machine.longest_leg, xtol=1e-6))


def mapped(machine: GoughPlatform, first: tuple[str, Array], second: tuple[str, Array]) -> Array:
    """Amplification over two dimensions, tool points in `BOX`, each as low as its legs allow.

    Parameters
    ----------
    machine : GoughPlatform
    first, second : (field, values)
        Of the machine, (a,) and (b,), SI.

    Returns
    -------
    amplification : (a, b)
        NaN where no height keeps the legs' range.
    """
    values = np.full((len(first[1]), len(second[1])), np.nan)
    places, made = [], []
    for place in np.ndindex(values.shape):
        change = {first[0]: float(first[1][place[0]]), second[0]: float(second[1][place[1]])}
        try:
            made.append(lowest(replace(machine, **change)))  # type: ignore[arg-type]
        except ModelError:
            continue
        places.append(place)
    values[tuple(np.array(places).T)] = amplifications(made, corners())
    return values


@dataclass(frozen=True)
class MeasuringStudy:
    """What is found of the measuring platform.

    Parameters
    ----------
    machine : GoughPlatform
    ahead, by_ahead : (t,)
        Tool points ahead of the plate, m, and the amplification there.
    box : float
        Amplification for tool points in `BOX`.
    pairs, radii, by_plate : (a,), (b,), (a, b)
        α_TP, rad, r_TP, m, and the amplification in the box.
    base_pairs, base_radii, by_base : (c,), (e,), (c, e)
        The same of α_b and r_b.
    widest, at_widest : float
        Largest r_b that the legs' range allows, m, and its amplification in the box.
    """

    machine: GoughPlatform
    ahead: Array
    by_ahead: Array
    box: float
    pairs: Array
    radii: Array
    by_plate: Array
    base_pairs: Array
    base_radii: Array
    by_base: Array
    widest: float
    at_widest: float

    def __repr__(self) -> str:
        return f"<MeasuringStudy: amplification {self.box:.3f} in the box of tools>"


@cache
def study_measuring() -> MeasuringStudy:
    """The studies of section IV, once."""
    machine = GoughPlatform()
    ahead = np.linspace(0.0, 0.3, 61)
    arms = np.stack([0.0 * ahead, 0.0 * ahead, ahead], axis=-1)
    by_ahead = tool_errors(machine, workspace(machine), arms).largest.max(axis=0)
    pairs, radii = np.radians(np.linspace(10.0, 60.0, 11)), np.linspace(0.05, 0.12, 15)
    base_pairs, base_radii = np.radians(np.linspace(2.0, 30.0, 15)), np.linspace(0.3, 0.44, 15)
    widest = widest_base(machine)
    wide = replace(machine, base_radius=widest - 1e-6)
    return MeasuringStudy(
        machine,
        ahead,
        by_ahead,
        amplification(machine, corners()),
        pairs,
        radii,
        mapped(machine, ("plate_pair", pairs), ("plate_radius", radii)),
        base_pairs,
        base_radii,
        mapped(machine, ("base_pair", base_pairs), ("base_radius", base_radii)),
        widest,
        amplification(lowest(wide), corners()),
    )
