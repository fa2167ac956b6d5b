"""What takes part in a mode: effective masses by direction, strain energy by part."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.msa.assembly import System
from strutwork.msa.mass import mass_properties
from strutwork.msa.structure import rigid_map

Array = NDArray[Any]

#: The part that stands for the work of a preload.
PRELOAD = "preload"


def effective_mass(
    system: System, unknowns: Array, mass: Array | sp.csc_array
) -> tuple[Array, Array]:
    """Effective masses of modes, and the rigid mass that they add to.

    Parameters
    ----------
    system : System
    unknowns : (p, n, m)
        Mass-normalised shapes on the unknowns, 1/√kg and rad/(√kg·m).
    mass : (p, n, n), or sparse (n, n) for a batch of one
        kg, kg·m, kg·m².

    Returns
    -------
    effective : (p, m, 6)
        (φᵀ M r)² for r a unit motion along or about x y z through the centre of mass.
    total : (p, 6)
        rᵀ M r, whatever is held.
    """
    properties = mass_properties(system.placed)
    reference = system.placed.structure.reference_nodes
    arms = system.placed.positions[:, reference] - properties.centre[:, None, :]
    motion = rigid_map(arms).reshape(system.poses, -1, 6)
    push = (mass @ motion[0])[None] if sp.issparse(mass) else mass @ motion
    participation = np.swapaxes(unknowns, -1, -2) @ push
    turning = np.einsum("pii->pi", properties.inertia)
    total = np.concatenate([np.repeat(properties.total[:, None], 3, axis=1), turning], axis=1)
    return np.asarray(participation**2), total


def energy_shares(system: System, unknowns: Array, frequencies: Array) -> Array:
    """Share of every part in the strain energy of modes, (p, m, q); zero for rigid-body modes.

    Under a preload its own work is the last part.

    Parameters
    ----------
    system : System
    unknowns : (p, n, m)
        Shapes on the unknowns, of any size: m and rad.
    frequencies : (p, m)
        Hz; zero marks rigid-body modes.
    """
    structure = system.placed.structure
    moved = system.expand(unknowns)
    energy: dict[str, Array] = {}
    if structure.beams:
        ends = np.concatenate([moved[:, structure.segments[:, k]] for k in (1, 2)], axis=-2)
        stored = (ends * (system.placed.segment_stiffness @ ends)).sum(axis=-2)
        # the elements of a beam stand one after the other
        first = np.cumsum([0, *(beam.elements for beam in structure.beams[:-1])])
        by_beam = np.moveaxis(np.add.reduceat(stored, first, axis=1), 1, 0)
        energy = {
            f"beam {beam.name}": one for beam, one in zip(structure.beams, by_beam, strict=True)
        }
    for name, nodes, stiffness in system.contributions():
        if not name.startswith("beam "):
            at = moved[:, nodes].reshape(system.poses, -1, moved.shape[-1])
            energy[name] = energy.get(name, 0.0) + (at * (stiffness @ at)).sum(axis=1)
    if system.placed.stiffening is not None:
        energy[PRELOAD] = np.zeros((system.poses, moved.shape[-1]))
        for _, nodes, stiffness in system.placed.stiffening.contributions():
            at = moved[:, nodes].reshape(system.poses, -1, moved.shape[-1])
            energy[PRELOAD] += (at * (stiffness @ at)).sum(axis=1)
    if not energy:
        return np.zeros((*frequencies.shape, 0))
    stacked = np.stack(list(energy.values()), axis=-1)
    whole = stacked.sum(axis=-1, keepdims=True)
    vibrates = (frequencies > 0) & np.isfinite(frequencies)
    return np.where(vibrates[..., None], stacked / np.where(whole > 0, whole, 1.0), 0.0)
