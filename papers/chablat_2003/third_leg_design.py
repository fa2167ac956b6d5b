"""The third leg's length chosen by the design engine (section 3.4, Fig. 8)."""

from __future__ import annotations

from functools import cache

import numpy as np

from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.biglide_third_leg import BiglideThirdLeg
from strutwork.papers.chablat_2003.published import THRESHOLD
from strutwork.papers.chablat_2003.third_leg import SIDE
from strutwork.studies.design import Design
from strutwork.studies.design_terms import Objective

#: Ratios L₂/L₁ among which is chosen, and their step.
STEP = 0.025
RATIOS = 1.7 + STEP * np.arange(11)

#: β at which every place of the square is asked, deg: in finer steps where the range may end.
BETA = np.concatenate([np.arange(-60.0, -48.0), np.arange(-48.0, 96.0, 8.0), np.arange(96.0, 131)])


def square(beta: np.ndarray = BETA) -> TaskGrid:
    """The places that decide over a square along the rails, each with some β.

    Both bounds are met first at a corner or in the middle of a side, as `turn_range` states, and
    y < 0 mirrors y > 0.

    Parameters
    ----------
    beta : (b,)
        deg.
    """
    half = SIDE / 2.0
    return TaskGrid(
        {"x": np.array([-half, 0.0, half]), "y": np.array([0.0, half]), "ry": np.radians(beta)}
    )


def third_leg_design(arm: float) -> Design:
    """The largest range of β that every place of the square allows, over the third leg's length.

    Eqs 4a and 4b bound the cosine of the angle between third leg and rail, and the sine of that
    between third leg and arm: both are cosines of the bend of a universal joint of the leg.

    Parameters
    ----------
    arm : float
        L₁, m.
    """
    bend = float(np.arccos(THRESHOLD))
    machine = BiglideThirdLeg(arm_length=arm, third_length=1.8 * arm, leg_bend=bend)
    lengths = [float(arm * ratio) for ratio in RATIOS]
    return Design.of(
        machine, {"third_length": lengths}, Objective.of("reach_ry"), workspace=square()
    )


@cache
def designed_third(arm: float) -> tuple[float, float]:
    """Ratio L₂/L₁ that the design chooses among `RATIOS`, and its range of β, rad.

    Parameters
    ----------
    arm : float
        L₁, m.
    """
    design = third_leg_design(arm)
    judged = design.judge(arm * RATIOS[:, None])
    best = int(np.argmin(design.targets(judged)[:, 0]))
    return float(RATIOS[best]), float(judged.values[best, 0])
