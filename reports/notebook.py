"""Drawings of a machine for a notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from strutwork.errors import ModelError
from strutwork.machines.model import Model
from strutwork.reports.chapters.model_loads import exaggeration
from strutwork.reports.figures.model import (
    deformed_shape,
    deformed_view,
    model_view,
)
from strutwork.reports.figures.vibration import mode_view
from strutwork.reports.model_solution import solve_model
from strutwork.reports.numbers import significant, times
from strutwork.reports.vibration_study import study_model_vibration

if TYPE_CHECKING:
    import plotly.graph_objects as go


def machine_figure(model: Model, case: str | None = None, mode: int | None = None) -> go.Figure:
    """A machine as it stands, deformed by a load case, or swinging in a mode.

    Parameters
    ----------
    model : Model
    case : str, optional
    mode : int, optional
        Elastic mode, from 1.

    Raises
    ------
    ModelError
        Both a case and a mode, or one that does not exist.
    StrutworkError
        A model that cannot be solved.
    """
    import plotly.graph_objects as go

    if case is not None and mode is not None:
        raise ModelError("plot", "is asked for a case and for a mode.", "Give one of them.")
    if case is not None:
        drawn, title = _deformed(model, case)
    elif mode is not None:
        drawn, title = _swinging(model, mode)
    else:
        drawn, title = model_view(model), model.title
    figure = go.Figure(data=drawn["data"], layout=drawn["layout"])
    return figure.update_layout(title=title, height=560, margin={"t": 60})


def _deformed(model: Model, name: str) -> tuple[dict[str, Any], str]:
    case = model.case(name)
    solution, number = solve_model(model), model.cases.index(case)
    largest, factor = exaggeration(solution, number)
    shape, moved = deformed_shape(model, solution.statics, number, factor)
    title = f"{name}: drawn {times(factor)} times as large, at most {significant(1e6 * largest)} µm"
    return deformed_view(model, shape, moved, case, "displacement (µm)"), title


def _swinging(model: Model, mode: int) -> tuple[dict[str, Any], str]:
    study = study_model_vibration(model, "mode")
    found = study.elastic.modes.frequencies
    if not 1 <= mode <= len(found):
        raise ModelError(
            "mode", f"{mode} does not exist.", f"Elastic modes 1 to {len(found)} were found."
        )
    view = mode_view(study, [str(k + 1) for k in range(len(found))])
    motion = view["motion"]
    moves = motion["modes"][mode - 1]
    trace = view["data"][motion["trace"]]
    for axis in "xyz":
        rest = np.array(motion["rest"][axis], dtype=float)
        trace[axis] = (rest + np.array(moves[axis], dtype=float)).tolist()
    trace["line"] = trace["line"] | {"color": moves["size"]}
    return view, f"Mode {mode}: {significant(float(found[mode - 1]), 4)} Hz"
