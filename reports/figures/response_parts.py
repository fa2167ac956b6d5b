"""A frequency response in three plots over one frequency axis: magnitude, phase and real part."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.reports.figures.theme import axis, rounded
from strutwork.reports.figures.vibration import responses
from strutwork.reports.page import plain

#: Height shares of the three plots, from the bottom.
REAL, PHASE, MAGNITUDE = (0.0, 0.24), (0.32, 0.52), (0.6, 1.0)


def response_parts(
    curves: Mapping[str, tuple[ArrayLike, NDArray[Any], str, str]],
    marks: Sequence[tuple[str, float, float, str]],
) -> dict[str, Any]:
    """Magnitude, phase and real part of receptances, below one another.

    Parameters
    ----------
    curves : mapping of name to ((f,), (f,), str, str)
        Frequencies, Hz; complex receptances, m/N; colour and dash.
    marks : sequence of (str, float, float, str)
        As `strutwork.reports.figures.vibration.responses`.
    """
    sizes = {n: (f, np.abs(values), c, d) for n, (f, values, c, d) in curves.items()}
    figure = responses(sizes, marks)
    below = []
    for name, (frequencies, values, colour, dash) in curves.items():
        for key, numbers, unit in (
            ("y2", np.degrees(np.angle(values)), "°"),
            ("y3", 1e6 * np.real(values), " µm/N"),
        ):
            below.append(
                {
                    "type": "scatter",
                    "mode": "lines",
                    "name": plain(name),
                    "showlegend": False,
                    "x": rounded(frequencies, 6),
                    "y": rounded(numbers, 5),
                    "yaxis": key,
                    "line": {"color": colour, "width": 1.5, "dash": dash},
                    "hovertemplate": f"%{{x:.5g}} Hz: %{{y:.4g}}{unit}<extra>{plain(name)}</extra>",
                }
            )
    layout = figure["layout"]
    layout["xaxis"]["anchor"] = "y3"
    layout["yaxis"]["domain"] = list(MAGNITUDE)
    layout["yaxis"]["title"]["text"] = "magnitude (µm/N)"
    layout["yaxis2"] = axis("phase (°)", domain=list(PHASE), tickvals=[-180, -90, 0, 90, 180])
    layout["yaxis3"] = axis("real part (µm/N)", domain=list(REAL), exponentformat="power")
    return {"data": [*figure["data"], *below], "layout": layout}
