"""Lowest frequencies and least dynamic stiffness at a batch of poses, with damping of any kind."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.fea import Damping, Port
from strutwork.fea.coupled import AnyDamping, PartDamping, part_matrices
from strutwork.fea.dynamic_stiffness import minimum_of
from strutwork.fea.least_stiffness import least_dynamic_stiffness
from strutwork.msa import PlacedStructure, system_of
from strutwork.studies.dynamic import ONE_PERCENT, modal_data

Array = NDArray[Any]


def least_over_poses(
    placed: PlacedStructure,
    ports: tuple[Port, ...],
    damping: AnyDamping,
    band: tuple[float, float],
    count: int,
) -> tuple[Array, Array, Array]:
    """Frequencies, and the least driving-point dynamic stiffness in a band.

    Damping that leaves the modes uncoupled is summed over undamped modes, all poses at once.
    Where parts couple them, as dashpots do, each pose has poles of its own: the poles of one
    matrix after the other, as `least_dynamic_stiffness` finds them.

    Parameters
    ----------
    placed : PlacedStructure
        One batch axis (p,), under its preload where it has one.
    ports : tuple of Port, q
    damping : damping of any kind
    band : (float, float)
        Hz.
    count : int
        Frequencies.

    Returns
    -------
    frequencies : (p, count)
        Of the undamped elastic modes, Hz.
    value : (p, q)
        N/m.
    place : (p, q)
        Where it is reached, Hz.

    Raises
    ------
    ModelError
        As `modal_data` and `least_dynamic_stiffness`.
    """
    coupled = False
    background: Damping | None
    if isinstance(damping, PartDamping):
        coupled = any(np.any(m) for m in part_matrices(system_of(placed), damping))
        background = damping.background
    else:
        background = damping
    # frequencies are those of the undamped modes: where parts damp, any kind serves for them
    simple = ONE_PERCENT if coupled or background is None else background
    frequencies, model = modal_data(placed, ports, simple, count)
    if not coupled and background is None:
        # parts are named and none has any: says so
        least_dynamic_stiffness(placed[0], ports[0], ports[0], damping, band)
    if not coupled:
        least = minimum_of(model, band)
        return frequencies, least.value, least.frequency
    value, place = (np.empty((len(frequencies), len(ports))) for _ in range(2))
    for pose in range(len(frequencies)):
        for q, port in enumerate(ports):
            found = least_dynamic_stiffness(placed[pose], port, port, damping, band)
            value[pose, q], place[pose, q] = found.value, found.frequency
    return frequencies, value, place
