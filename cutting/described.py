"""The process that a model file or a process file describes."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.cutting.coefficients import ForceCoefficients
from strutwork.cutting.cutter import Cutter
from strutwork.cutting.materials import material
from strutwork.cutting.process import Milling
from strutwork.cutting.tip_response import Frame
from strutwork.machines.described_process import DescribedProcess

Array = NDArray[Any]


def described_milling(described: DescribedProcess) -> Milling:
    """A milling cut as it is described.

    Parameters
    ----------
    described : DescribedProcess

    Raises
    ------
    ModelError
        A material that the library does not have, or an angle out of range.
    """
    if described.material:
        coefficients = material(described.material)
    else:
        coefficients = ForceCoefficients(*described.coefficients, source=described.source)
    cutter = Cutter(described.diameter, described.teeth, described.helix, described.lead)
    way: Any = described.way
    return Milling(cutter, coefficients, described.immersion, way)


def described_frame(described: DescribedProcess, rotation: Array) -> Frame:
    """Axes of a described process in global axes.

    Parameters
    ----------
    described : DescribedProcess
    rotation : (3, 3)
        Rotation matrix of the tool where the machine stands; axis and feed turn with it.

    Raises
    ------
    ModelError
        A direction of length zero, or a feed along the axis.
    """
    return Frame(Frame.along(described.axis, described.feed).matrix @ np.asarray(rotation).T)


def described_speeds(described: DescribedProcess) -> Array:
    """Spindle speeds (s,), rpm.

    Parameters
    ----------
    described : DescribedProcess
    """
    return np.linspace(*described.speeds, described.points)
