"""Inverse Jacobians leg by leg: each leg's drives from the screws of its own joints."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.leg_chains import LegChains, leg_chains
from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.singular_values import compiled

Array = NDArray[Any]


def chains_of(linkage: Linkage) -> LegChains | None:
    """The legs of the linkage, made once and kept with it.

    Parameters
    ----------
    linkage : Linkage
        With a tool and drives.
    """
    # a frozen dataclass keeps derived data in its __dict__, as functools.cached_property does
    kept = linkage.__dict__
    if "_leg_chains" not in kept:
        kept["_leg_chains"] = leg_chains(linkage)
    chains: LegChains | None = kept["_leg_chains"]
    return chains


def legs_compiled(
    linkage: Linkage, placement: Placement
) -> tuple[Array, Array, NDArray[np.bool_]] | None:
    """Inverse Jacobian at p poses, or None where there are no such legs or no compiler.

    A tool twist t is Σ S q̇ over the joints of any one leg, S their screws. The vectors y with
    yᵀS = 0 for all passive joints of the leg are as many as it has drives, and give their rates:
    q̇ = (Yᵀ S_driven)⁻¹ Yᵀ t (Joshi and Tsai 2002, by reciprocal screws).

    Parameters
    ----------
    linkage : Linkage
        With a tool and drives.
    placement : Placement
        At p poses, one batch axis.

    Returns
    -------
    inverse : (p, a, 6)
    length : (p,)
        Largest distance of a leg's joint from the tool, m.
    doubtful : (p,) of bool
        Poses whose pivots are small: treat these by rank. Their `inverse` is zero.
    """
    if np.iscomplexobj(placement.positions) or not compiled():
        return None
    chains = chains_of(linkage)
    if chains is None:
        return None
    from strutwork.kinematics.leg_kernel import leg_rows  # noqa: PLC0415 - numba is slow to import

    count = placement.batch[0]
    inverse = np.zeros((count, len(linkage.driven), 6))
    length = np.empty(count)
    good = np.empty(count, dtype=np.bool_)
    leg_rows(
        chains,
        np.ascontiguousarray(placement.positions, dtype=float),
        np.ascontiguousarray(placement.frames, dtype=float),
        inverse,
        length,
        good,
    )
    return inverse, length, ~good
