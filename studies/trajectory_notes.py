"""What a reader of a trajectory's numbers must know, in words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from strutwork.kinematics.following import Followed
from strutwork.kinematics.trajectory import Trajectory, roughness
from strutwork.machines.model import Model
from strutwork.msa.body_mass import stretched_parts

#: Rate at an end of the path, as a share of the largest, below which it begins or ends at rest:
#: a spline through rounded samples leaves a little.
REST = 1e-3
#: Share of the work by which it may differ from the change of energy: what integrals leave.
BALANCED = 1e-6
#: Moment that would hold a body from spinning, as a share of the drives' largest.
QUIET = 1e-9


def trajectory_notes(
    model: Model, followed: Followed, path: Trajectory, *, splined: bool
) -> list[str]:
    """What was assumed of the model and what is odd about the path, in words.

    Parameters
    ----------
    model : Model
    followed : Followed
    path : Trajectory
    splined : bool
        Whether derivatives come from splines through the samples.
    """
    dynamics, linkage = followed.dynamics, model.structure.linkage
    notes = []
    if splined:
        values = path.at(path.times)[0]
        notes += [str(one) for one in roughness(path.coordinates, path.times, values)]
    rates = np.abs(path.at(path.times)[1])
    quick = rates.max(axis=0, initial=0.0)
    moving = np.any(rates[[0, -1]] > REST * quick + 1e-12, axis=1)
    for end, at_end in zip(("begins", "ends"), moving, strict=True):
        if at_end:
            notes.append(f"the path {end} in motion, not at rest")
    light = [
        name
        for name, mass, moves in zip(
            linkage.body_names, dynamics.masses.mass, followed.moves, strict=True
        )
        if moves and mass == 0.0
    ]
    if light:
        notes.append(f"without mass: {_listed(light)}")
    stretched = stretched_parts(model.structure)
    if stretched:
        notes.append(f"with the mass that they have at home: {_listed(stretched)}")
    left_out = [f"spring {s.name}" for s in model.structure.springs]
    moves = set(model.motion.joints.names)
    left_out += [
        f"damping of {j.name}"
        for j in linkage.joints
        if any(value and (j.name, d) in moves for d, value in j.damping.items())
    ]
    if left_out:
        notes.append(
            f"left out, since bodies are rigid and joints have no losses: {_listed(left_out)}"
        )
    if dynamics.bodies.idle:
        notes.append(_idle_note(followed))
    if followed.imbalance > BALANCED:
        notes.append(
            f"work and energy differ by {followed.imbalance:.1e}: between samples the path changes "
            "more than the integrals over time can follow"
        )
    drives, freedoms = len(linkage.driven), len(path.coordinates)
    if drives > freedoms:
        notes.append(
            f"{drives} drives for {freedoms} freedoms: forces are those of least norm, moments "
            f"over the machine's size of {dynamics.motion.length:.4g} m"
        )
    return notes


def _idle_note(followed: Followed) -> str:
    idle = _listed(followed.dynamics.bodies.idle)
    largest = np.abs(followed.spins).max(initial=0.0)
    scale = followed.dynamics.motion.length * np.abs(followed.forces).max(initial=0.0)
    text = f"not rotating about their lines, since nothing drives them: {idle}"
    if largest > QUIET * scale:
        text += f"; {largest:.3g} N·m would start to rotate one of them"
    return text


def _listed(names: Sequence[str], most: int = 6) -> str:
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more
