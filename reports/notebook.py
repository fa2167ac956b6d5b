"""Drawings of a machine for a notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from strutwork.errors import ModelError
from strutwork.machines.model import Model
from strutwork.names import choices
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
from strutwork.studies.dataset_units import stated_unit, unit_at

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
        raise ModelError("plot", "is asked for both a case and a mode.", "Give one of them.")
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
    title = (
        f"{name}: drawn {times(factor)} times its true size, at most {significant(1e6 * largest)} "
        "µm"
    )
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
    for part in (motion, *([motion["also"]] if "also" in motion else [])):
        moves, trace = part["modes"][mode - 1], view["data"][part["trace"]]
        for axis in "xyz":
            rest = np.array(part["rest"][axis], dtype=float)
            trace[axis] = (rest + np.array(moves[axis], dtype=float)).tolist()
        if "colour" in part:
            trace[part["colour"]] = moves["size"]
        else:
            trace["line"] = trace["line"] | {"color": moves["size"]}
    return view, f"Mode {mode}: {significant(float(found[mode - 1]), 4)} Hz"


def survey_figure(dataset: xr.Dataset, name: str | None, label: str | None) -> go.Figure:
    """A number over one or two directions of the poses; the worst pose is marked.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of a survey over a grid.
    name : str or None
        Of a variable; None for the first of numbers.
    label : str or None
        Of its further dimension; None for the first.

    Raises
    ------
    ModelError
        No such variable or label, or poses along more than two directions.
    """
    import plotly.graph_objects as go

    poses = tuple(str(d) for d in dataset["status"].dims)
    wide = [d for d in poses if dataset.sizes[d] > 1]
    numbers = [str(n) for n, v in dataset.data_vars.items() if v.dtype.kind == "f"]
    name = next((n for n in numbers if n != "joint_coordinate"), "") if name is None else name
    if name not in numbers:
        raise ModelError("plot", f'finds no "{name}".', choices("Variables", name, numbers))
    if not 1 <= len(wide) <= 2:
        raise ModelError(
            "plot",
            f"draws poses along one or two directions, and these vary along {len(wide)}.",
            "Select some first: dataset.sel(z=0.0), or dataset.isel(z=0).",
        )
    chosen, word = _labelled(dataset[name], poses, label)
    unit, scale = _shown_unit(unit_at(dataset, name, word))
    at_one = {d: 0 for d in poses if d not in wide}
    values = scale * chosen.isel(at_one).transpose(*wide).to_numpy()
    axes = [_shown_axis(dataset, d) for d in wide]
    title = f"{name.replace('_', ' ')} {word}".rstrip() + (f", {unit}" if unit else "")
    # of a stiffness or a frequency the least is the worst, of an error or a force the largest
    pick = np.nanargmin if _less_is_worse(name) else np.nanargmax
    worst = np.unravel_index(int(pick(values)), values.shape)
    at, mark = [axis[1][i] for axis, i in zip(axes, worst, strict=True)], float(values[worst])
    traces: list[Any] = [
        go.Scatter(x=axes[0][1], y=values, mode="lines+markers", name=title)
        if len(wide) == 1
        else go.Contour(x=axes[0][1], y=axes[1][1], z=values.T, colorbar={"title": unit or None}),
        go.Scatter(
            x=at[:1],
            y=[mark] if len(wide) == 1 else at[1:],
            mode="markers",
            marker={"symbol": "x", "size": 12, "color": "#c0392b"},
            name=f"worst: {significant(mark)} {unit}".rstrip(),
            showlegend=True,
        ),
    ]
    return go.Figure(traces).update_layout(
        title=title,
        xaxis_title=axes[0][0],
        yaxis_title=title if len(wide) == 1 else axes[1][0],
        legend={"orientation": "h", "y": 1.08},
    )


def _labelled(
    variable: xr.DataArray, poses: tuple[str, ...], label: str | None
) -> tuple[xr.DataArray, str]:
    """A variable at one label of each further dimension, and the word for it."""
    words = []
    for dim in [d for d in variable.dims if d not in poses]:
        known = [str(v) for v in variable[dim].to_numpy()]
        word = known[0] if label is None else label
        if word not in known:
            raise ModelError("plot", f'finds no "{word}".', choices("Labels", word, known))
        variable = variable.isel({dim: known.index(word)})
        words.append(word)
    return variable, " ".join(words)


def _less_is_worse(name: str) -> bool:
    return any(word in name for word in ("stiffness", "frequency", "margin"))


def _shown_axis(dataset: xr.Dataset, direction: str) -> tuple[str, Any]:
    unit, scale = _shown_unit(stated_unit(dataset[direction]))
    return f"{direction}, {unit}", scale * dataset[direction].to_numpy()


def _shown_unit(unit: str) -> tuple[str, float]:
    """The unit in which people read a quantity, and the factor to it."""
    known = {
        "m": ("mm", 1e3),
        "rad": ("deg", float(np.degrees(1.0))),
        "N/m": ("N/µm", 1e-6),
        "N m/rad": ("kN·m/rad", 1e-3),
        "1": ("", 1.0),
    }
    return known.get(unit, (unit, 1.0))
