"""The forces of a milling cut as a cause of displacement: their mean and their harmonics."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.cutting.described import described_frame, described_milling
from strutwork.cutting.forces import cutting_force
from strutwork.errors import ModelError
from strutwork.kinematics import Placement
from strutwork.kinematics.tool_turns import ToolTurns
from strutwork.machines.described_process import DescribedProcess
from strutwork.machines.model import Model

Array = NDArray[Any]

#: Angles in the pitch of one tooth at which the force is computed.
ANGLES = 720


@dataclass(frozen=True)
class MillingCut:
    """How deep and fast a machine mills in the process that its model describes.

    Parameters
    ----------
    depth : float
        Along the tool, m.
    speed : float
        Of the spindle, rad/s.
    feed_per_tooth : float or None
        m; that of the process by default.
    harmonics : int
        Of the tooth frequency.
    """

    depth: float
    speed: float
    feed_per_tooth: float | None = None
    harmonics: int = 3


@dataclass(frozen=True)
class MillingForces:
    """Forces on the tool, global axes.

    Parameters
    ----------
    mean : (3,)
        N.
    frequencies : (h,)
        The tooth frequency and its multiples, Hz.
    amplitudes : (h, 3) complex
        N: the force is the real part of the amplitude times exp(iωt).
    """

    mean: Array
    frequencies: Array
    amplitudes: Array

    def __repr__(self) -> str:
        return f"<MillingForces: {len(self.frequencies)} harmonics, N>"


def milling_forces(model: Model, cut: MillingCut, placement: Placement) -> MillingForces:
    """Mean and harmonics of the cutting force of a machine's process.

    The feed and the axis of the process turn with the tool.

    Parameters
    ----------
    model : Model
        With a process.
    cut : MillingCut
    placement : Placement
        One pose.

    Raises
    ------
    ModelError
        No process, or a depth or feed that it does not take.
    """
    described = model.process
    if described is None:
        raise ModelError(
            "milling",
            "has no process.",
            "Add a table [process] to the model file, with cutter and material.",
        )
    turn = ToolTurns.of(model.structure.linkage, model.placement).at(placement[None])[0]
    axes = described_frame(described, model.rotation).matrix @ turn.T
    spectrum = _spectrum(described, cut) @ axes
    numbers = np.arange(1, cut.harmonics + 1)
    tooth = cut.speed / (2.0 * pi) * described.teeth
    return MillingForces(spectrum[0].real, tooth * numbers, 2.0 * spectrum[1:])


@lru_cache(maxsize=16)
def _spectrum(described: DescribedProcess, cut: MillingCut) -> Array:
    """Mean and coefficients of the harmonics in the axes of the process, (h + 1, 3), N.

    Kept, because it is the same at all poses.
    """
    process = described_milling(described)
    feed = described.feed_per_tooth if cut.feed_per_tooth is None else cut.feed_per_tooth
    pitch = 2.0 * pi / process.cutter.teeth
    angles = pitch * np.arange(ANGLES) / ANGLES
    force = cutting_force(process, cut.depth, feed, angles)
    return np.asarray(np.fft.rfft(force, axis=0)[: cut.harmonics + 1] / ANGLES)
