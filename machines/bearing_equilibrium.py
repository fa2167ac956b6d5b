"""Equilibrium of a structure whose bearings stiffen with load: a secant loop."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.contact import Bearing
from strutwork.errors import ContactError, NumericalError
from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.rows import characteristic_length
from strutwork.machines.bearing_states import BearingState, Equilibrium
from strutwork.machines.model import Model
from strutwork.msa import LoadCase, PlacedStructure, StaticSolution, solve

Array = NDArray[Any]

#: Displacements of two steps that differ by less, as a share of the largest, have settled.
SETTLED = 1e-9

#: Steps after which the loop gives up.
STEPS = 200


def equilibrium(model: Model, case: LoadCase) -> Equilibrium:
    """Equilibrium of a load case, with each bearing at the stiffness of its load.

    Solve, displacement and secant of each bearing, solve again, until the displacements of all
    nodes agree.

    Parameters
    ----------
    model : Model
    case : LoadCase

    Raises
    ------
    ContactError
        A row of a bearing, or a guide of given stiffness, loses its preload.
    NumericalError
        The displacements do not settle.
    StrutworkError
        As `strutwork.msa.solve`.
    """
    found = _contacts(model)
    length = characteristic_length(model.placement)
    size = np.array([1.0, 1.0, 1.0, length, length, length])
    matrices = {joint: bearing.tangent() for joint, bearing in found.items()}
    before: Array | None = None
    stretches: dict[str, Array] = {}
    placed, steps = _with(model, matrices), 0
    for _ in range(STEPS):
        steps += 1
        solution = solve(placed, [case])
        moved = solution.displacements[..., 0] * size
        stretches = {joint: _stretch(model, solution, case, joint) for joint in found}
        change = np.inf if before is None else np.abs(moved - before).max(initial=0.0)
        if not found or change <= SETTLED * np.abs(moved).max(initial=0.0):
            break
        matrices = {j: bearing.secant(stretches[j]) for j, bearing in found.items()}
        placed, before = _with(model, matrices), moved
    else:
        _require_closed(model, case, stretches)
        raise NumericalError(
            f"bearings of {', '.join(found)}",
            f"do not settle under the case {case.name} after {STEPS} steps.",
            "A preload is nearly lost: give the bearings more, or lower the load.",
        )
    _require_closed(model, case, stretches)
    _require_given(model, case, solution)
    states = tuple(_state(model, j, b, stretches[j]) for j, b in found.items())
    energy = solution.strain_energy + sum(_energy(s, found[s.joint], matrices) for s in states)
    tangents = {s.joint: s.tangent for s in states}
    return Equilibrium(
        replace(solution, strain_energy=energy), states, steps, placed, _with(model, tangents)
    )


def _contacts(model: Model) -> dict[str, Bearing]:
    """Bearings of the joints, of those that have contacts."""
    made = {joint: entry.bearing for joint, entry in model.bearings.items()}
    return {joint: bearing for joint, bearing in made.items() if bearing is not None}


def _with(model: Model, matrices: Mapping[str, Array]) -> PlacedStructure:
    """The structure with other stiffnesses of bearings; what the joint has beside them stays."""
    if not matrices:
        return model.placed
    structure = model.structure
    joints = []
    for joint in structure.linkage.joints:
        if joint.name in matrices:
            own = joint.stiffness_matrix - model.bearings[joint.name].stiffness
            k = own + matrices[joint.name]
            joint = replace(joint, matrix=tuple(tuple(r) for r in k.tolist()))  # noqa: PLW2901
        joints.append(joint)
    linkage = replace(structure.linkage, joints=tuple(joints))
    return replace(model.placed, structure=replace(structure, linkage=linkage))


def _stretch(model: Model, solution: StaticSolution, case: LoadCase, joint: str) -> Array:
    """Displacement of the second side against the first beyond a misfit, joint axes, (6,)."""
    linkage = model.structure.linkage
    first, second = (
        linkage.node_index[n] for n in linkage.joints[linkage.joint_index[joint]].between
    )
    u = solution.displacements[..., 0]
    turn = np.asarray(model.placement.frames)[linkage.joint_index[joint]].T
    moved = (u[second] - u[first]).reshape(2, 3) @ turn.T
    gap = [case.gaps.get((joint, d), 0.0) for d in DIRECTIONS]
    return np.asarray((moved.ravel() - gap) * _mask(model, joint))


def _mask(model: Model, joint: str) -> Array:
    return np.array([d in model.bearings[joint].held for d in DIRECTIONS], dtype=float)


def _state(model: Model, joint: str, bearing: Bearing, q: Array) -> BearingState:
    return BearingState(
        joint,
        model.bearings[joint],
        q,
        bearing.loads(q),
        bearing.secant(q),
        bearing.tangent(q),
        bearing.bearing_share(q),
    )


def _energy(state: BearingState, bearing: Bearing, matrices: Mapping[str, Array]) -> float:
    """Work that the contacts took beyond the preload, less what their secant counts, J."""
    q, start, contacts = state.displacement, bearing.start, bearing.contacts
    work = contacts.energy(start + q) - contacts.energy(start) - contacts.loads(start) @ q
    return float(work - 0.5 * q @ matrices[state.joint] @ q)


def _require_closed(model: Model, case: LoadCase, stretches: Mapping[str, Array]) -> None:
    for joint, q in stretches.items():
        bearing = model.bearings[joint].bearing
        rows = () if bearing is None else bearing.opened(q)
        if bearing is None or not rows:
            continue
        share = bearing.opening(q)
        load = bearing.loads(q)
        raise ContactError(
            f"bearing {model.bearings[joint].name} of the joint {joint}",
            f"loses its preload under the case {case.name}: {' and '.join(rows)} "
            f"{'bears' if len(rows) == 1 else 'bear'} nothing at "
            f"{_words(load)}. It opens at {_words(bearing.loads(share * q))}.",
            f"Its preload ({model.bearings[joint].preload}) is too small for this load: give the "
            "entry more, choose a larger bearing, or lower the load.",
        )


def _require_given(model: Model, case: LoadCase, solution: StaticSolution) -> None:
    """Guides of given stiffness whose load opens them."""
    index = model.structure.linkage.joint_index
    for joint, entry in model.bearings.items():
        for direction, limit in entry.opens_at.items():
            i = DIRECTIONS.index(direction)
            force = float(solution.joint_forces[index[joint], i, 0])
            if abs(force) >= limit:
                unit = "N·m" if direction.startswith("r") else "N"
                raise ContactError(
                    f"bearing {entry.name} of the joint {joint}",
                    f"opens under the case {case.name}: it bears {abs(force):.4g} {unit} in "
                    f"{direction}, and its contact opens at {limit:.4g} {unit}.",
                    "Choose a larger one or more preload, or lower the load.",
                )


def _words(load: Sequence[float] | Array) -> str:
    """A load by its forces across and along the axis, and its moment."""
    x, y, z, rx, ry, rz = (float(v) for v in load)
    parts = (
        (np.hypot(x, y), "N across the axis"),
        (abs(z), "N along it"),
        (float(np.linalg.norm([rx, ry, rz])), "N·m"),
    )
    largest = max(value for value, _ in parts)
    return ", ".join(f"{v:.4g} {unit}" for v, unit in parts if v > 1e-6 * largest) or "no load"
