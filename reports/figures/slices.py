"""A quantity of a survey along one or two of its directions, the others where it is extreme."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.reports.content import Figure
from strutwork.reports.figures.curves import Curve, curves, heat
from strutwork.reports.figures.theme import AXIS_COLOURS
from strutwork.reports.numbers import significant
from strutwork.reports.survey_words import Extreme, axes_of, largest, least, pose_text

Array = NDArray[Any]


def slice_figure(
    found: xr.Dataset,
    values: Array,
    quantity: tuple[str, str],
    key: str,
    data: str,
    *,
    worst_is_least: bool = True,
) -> Figure:
    """A map of a quantity, through the pose at which it is worst.

    Parameters
    ----------
    found : xarray.Dataset
        A survey.
    values : (grid)
        In the unit shown; NaN where no pose counts.
    quantity : (str, str)
        Name and unit.
    key : str
        Of the figure.
    data : str
        File with the numbers.
    worst_is_least : bool
    """
    axes = axes_of(found)
    pick = least if worst_is_least else largest
    worst = pick(found, values)
    # the two directions with most points; of equals the first
    order = sorted(axes, key=lambda d: -len(axes[d]))[:2]
    shown = [d for d in axes if d in order]
    held = {d: worst.task[d] for d in axes if d not in shown}
    index = tuple(slice(None) if d in shown else worst.index[i] for i, d in enumerate(axes))
    part = values[index]
    at = f", at {pose_text(held)}" if held else ""
    name, unit = quantity
    words = "least" if worst_is_least else "largest"
    caption = (
        f"{name[:1].upper()}{name[1:]}{at}: {words} of the entire workspace "
        f"{significant(worst.value)} {unit} at {worst.where}."
    )
    scales = {d: (np.degrees(axes[d]) if d.startswith("r") else 1e3 * axes[d]) for d in shown}
    titles = [f"{d} ({'deg' if d.startswith('r') else 'mm'})" for d in shown]
    alt = f"{name} over {' and '.join(shown)}{at}, the worst pose marked."
    if len(shown) == 1:
        spec = _line(scales[shown[0]], part, titles[0], f"{name} ({unit})")
        return Figure(key, caption, spec, alt, data, 360)
    marks = {f"{words}, {significant(worst.value)}": _place(scales, shown, worst, axes)}
    best = np.nanargmax(part) if worst_is_least else np.nanargmin(part)
    i, j = (int(k) for k in np.unravel_index(int(best), part.shape))
    marks[f"{'largest' if worst_is_least else 'least'} here, {significant(float(part[i, j]))}"] = (
        float(scales[shown[0]][i]),
        float(scales[shown[1]][j]),
    )
    spec = heat(
        scales[shown[0]], scales[shown[1]], part, (titles[0], titles[1], f"{name} ({unit})"), marks
    )
    return Figure(key, caption, spec, alt, data, 400)


def _place(
    scales: dict[str, Array], shown: Sequence[str], worst: Extreme, axes: dict[str, Array]
) -> tuple[float, float]:
    index = dict(zip(axes, worst.index, strict=True))
    x, y = (float(scales[d][index[d]]) for d in shown)
    return x, y


def _line(x: Array, values: Array, title: str, quantity: str) -> dict[str, Any]:
    return curves(x, [Curve("", values, AXIS_COLOURS["x"])], (title, quantity))
