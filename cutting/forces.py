"""Steady cutting forces over a turn: chip, edge, helix and runout."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.cutting.numbers import not_negative, positive
from strutwork.cutting.process import Milling

Array = NDArray[Any]

#: Slices along the depth of cut where the helix or the runout matters.
SLICES = 200


def cutting_force(process: Milling, depth: float, feed: float, angles: ArrayLike) -> Array:
    """Force on the tool while it cuts without vibration, (..., 3), N.

    Of a tooth that the runout lifts out of the chip only what it would cut counts: a negative
    chip is none. The tooth before it left its own surface, one pitch earlier.

    Parameters
    ----------
    process : Milling
    depth : float
        m.
    feed : float
        Per tooth, m.
    angles : (...)
        Of the first tooth at the tip of the cutter, clockwise from y, rad. The runout lies in
        the direction of that tooth.

    Raises
    ------
    ModelError
        A depth that is not positive, or a negative feed.
    """
    positive("milling", "depth of cut", depth)
    not_negative("milling", "feed per tooth", feed)
    cutter, k = process.cutter, process.coefficients
    entry, leave = process.angles
    s, c = np.sin(cutter.lead), np.cos(cutter.lead)
    steps = SLICES if cutter.lag else 1
    heights = (np.arange(steps) + 0.5) * depth / steps
    first = np.asarray(angles, dtype=float)
    total = np.zeros((*first.shape, 3))
    for tooth in range(cutter.teeth):
        angle = first[..., None] + tooth * cutter.pitch - cutter.lag * heights
        angle = np.mod(angle, 2.0 * np.pi)
        cuts = (angle >= entry) & (angle < leave)
        # the radius of a tooth changes by the part of the runout in its direction
        own, before = np.cos(tooth * cutter.pitch), np.cos((tooth + 1) * cutter.pitch)
        chip = s * (feed * np.sin(angle) + cutter.runout * (own - before))
        cuts &= chip > 0
        tangential = k.tangential * chip + k.edge_tangential
        radial = k.radial * chip + k.edge_radial
        axial = k.axial * chip + k.edge_axial
        sin, cos = np.sin(angle), np.cos(angle)
        force = np.stack(
            [
                -tangential * cos - (radial * s + axial * c) * sin,
                tangential * sin - (radial * s + axial * c) * cos,
                radial * c - axial * s,
            ],
            axis=-1,
        )
        total += np.where(cuts[..., None], force, 0.0).sum(axis=-2) * (depth / steps / s)
    return total
