"""What a chapter on the stability of cutting shows of a machine at home."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from strutwork.cutting import described_frame, described_milling, described_speeds
from strutwork.errors import ModelError
from strutwork.fea import ModalRatio
from strutwork.machines.described_process import DescribedProcess
from strutwork.machines.model import Model
from strutwork.reports.lobes import TargetLobes, target_lobes
from strutwork.reports.vibration import Target, model_target, some_modes, target_modes
from strutwork.reports.vibration_study import VibrationStudy, drawn_lines

KEY = "stability"


@dataclass(frozen=True)
class CutStudy:
    """A machine's cut at home.

    Parameters
    ----------
    described : DescribedProcess
    lobes : TargetLobes
    mode : VibrationStudy
        The mode that limits the depth, alone.
    """

    described: DescribedProcess
    lobes: TargetLobes
    mode: VibrationStudy

    def __repr__(self) -> str:
        return f"<CutStudy: {self.lobes!r}>"


def study_cut(model: Model) -> CutStudy:
    """Lobes, exact limits, the rose, and the mode that limits the depth.

    Parameters
    ----------
    model : Model
        With a process.

    Raises
    ------
    ModelError
        No process, or as `target_lobes`.
    """
    given = model.process
    if given is None:
        raise ModelError("process", "is missing.", "Add a table [process], or give --process.")
    target = model_target(model if model.title else replace(model, title=KEY), KEY)
    if target.damping is None and given.modal_ratio is not None:
        target = replace(target, damping=ModalRatio(given.modal_ratio))
    found = target_lobes(
        target,
        described_milling(given),
        described_frame(given, model.rotation),
        model.require_tool(),
        described_speeds(given),
        given.feed_per_tooth,
        None,
    )
    return CutStudy(given, found, _limiting_mode(model, target, found))


def _limiting_mode(model: Model, target: Target, found: TargetLobes) -> VibrationStudy:
    effects = found.effects
    number = int(np.argmin(np.abs(effects.modes - effects.limiting_mode)))
    every = target_modes(target, number + 1)
    elastic = every.elastic.modes.frequencies
    nearest = int(np.argmin(np.abs(elastic - effects.limiting_mode)))
    rigid = int(every.modes.rigid_body_modes)
    one = slice(rigid + nearest, rigid + nearest + 1)
    modes = replace(some_modes(every.modes, one), rigid_body_modes=np.asarray(0))
    ratios = None if every.ratios is None else every.ratios[one]
    alone = replace(every, modes=modes, ratios=ratios, idle=())
    return VibrationStudy(
        KEY, target.title, alone, drawn_lines(model), (0.0, 0.0), None, (), np.empty(0)
    )
