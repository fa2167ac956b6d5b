"""The tilting mode of the MIT-SS-1's spindle housing: its two readings and its postures.

The thesis names the mode and draws it, and the drawings are not at hand. Eq. 65 turns it into a
stiffness along x, which a tilt about y alone can do; section 6.2 finds it hardly changed by the
orientation of the spindle, which suits a tilt about x. The first is what the structure has; the
second would ask for the bearings of a pin to stand far nearer to each other than they do.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.fea.modes import modes
from strutwork.machines import mit_ss1_parts as parts
from strutwork.machines.mit_ss1 import NOMINAL_TILT, MitSS1
from strutwork.machines.mit_ss1_whole import MitSS1Whole
from strutwork.papers.son_2002.modes import COUNT, STRUTS, TILT, moving_patterns
from strutwork.studies.mode_matching import pattern_shares

Array = NDArray[Any]


def pin_width_for_tilt(machine: MitSS1, stiffness: float) -> float:
    """Distance of a pin's bearings at which the housing tilts that softly about x, m.

    Parameters
    ----------
    machine : MitSS1
    stiffness : float
        Sought, N·m/rad.
    """
    return float(np.sqrt(2.0 * stiffness / _radial(machine)))


def _radial(machine: MitSS1) -> float:
    """Stiffness along z of the three near bearings on the housing, N/m, in the mean of the two."""
    if machine.radial_stiffness is None:
        raise ModelError("MitSS1", "has rigid bearings.", "Give radial_stiffness.")
    at = machine.place(machine.home()).positions
    index = machine.linkage.node_index
    ends = (at[[index[parts.strut(i, end, "end")] for i in parts.STRUTS]] for end in parts.ENDS)
    strut = np.subtract(*ends)
    rise = strut[:, 2] / np.linalg.norm(strut, axis=1)
    return float(machine.radial_stiffness * 0.5 * (1.0 + machine.preload_factor) * (rise @ rise))


def posture_frequencies(
    whole: MitSS1Whole, x: ArrayLike = 0.0, b: ArrayLike | None = None
) -> xr.Dataset:
    """Frequencies of the tilting mode and of the strut assembly over x and tilt, Hz.

    Parameters
    ----------
    whole : MitSS1Whole
    x : (n,) or float
        m.
    b : (k,), optional
        rad; default seven tilts over the workspace.

    Returns
    -------
    Dataset
        tilt and struts, (x, b).

    Raises
    ------
    UnreachableError
        A posture that the machine cannot take.
    """
    along = np.atleast_1d(np.asarray(x, dtype=float))
    tilts = np.linspace(-NOMINAL_TILT, NOMINAL_TILT, 7) if b is None else np.asarray(b, dtype=float)
    grid = np.meshgrid(along, tilts, indexing="ij")
    placed = whole.structure.at(whole.place(whole.poses(grid[0], 0.0, grid[1])))
    found = modes(placed, COUNT)
    patterns = moving_patterns(whole)
    shares = pattern_shares(found, np.stack([patterns[n] for n in (TILT, STRUTS)]))
    # away from home the tilt shares its pattern with higher modes: the lowest that holds much
    strong = shares >= 0.5 * shares.max(axis=-1, keepdims=True)
    chosen = np.take_along_axis(found.frequencies, strong.argmax(axis=-1), axis=-1)
    return xr.Dataset(
        {
            "tilt": (("x", "b"), chosen[..., 0], {"units": "Hz", "long_name": TILT}),
            "struts": (("x", "b"), chosen[..., 1], {"units": "Hz", "long_name": STRUTS}),
        },
        coords={
            "x": ("x", along, {"units": "m"}),
            "b": ("b", tilts, {"units": "rad"}),
        },
    )
