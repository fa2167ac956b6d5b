"""Temperature on the surfaces of the solids that an error sheet heats unevenly."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.machines.model import Model
from strutwork.machines.model_solid_element import SolidElement
from strutwork.reports.content import Block, Figure
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.figures.solid import colour_bar, scene
from strutwork.reports.figures.theme import rounded
from strutwork.reports.numbers import significant
from strutwork.reports.page import plain
from strutwork.studies.error_inputs import ErrorInputs

Array = NDArray[Any]

TEMPERATURES = "error-temperatures.csv"

#: Points of surfaces beyond which the view is left out; the file has them all.
MOST_POINTS = 30_000


def heat_blocks(model: Model, inputs: ErrorInputs) -> tuple[list[Block], list[DataFile]]:
    """A view and the file of the temperatures; none where all are uniform.

    Parameters
    ----------
    model : Model
    inputs : ErrorInputs
    """
    changes: dict[str, Array] = {}
    for heat in (h for t in inputs.temperatures for h in t.solids):
        changes[heat.part] = changes.get(heat.part, 0.0) + heat.surface
    uneven = {s: c for s in model.solids if (c := changes.get(s.name)) is not None and np.ptp(c)}
    if not uneven:
        return [], []
    rows = [
        (solid.name, *(float(v) for v in (*point, change)))
        for solid, surface in uneven.items()
        for point, change in zip(solid.points, surface, strict=True)
    ]
    heads = ["solid", "x, m", "y, m", "z, m", "change of temperature, K"]
    files = [csv_file(TEMPERATURES, "change of temperature on the surfaces of solids", heads, rows)]
    if len(rows) > MOST_POINTS:
        return [], files
    words = "; ".join(
        f"{solid.name} {significant(float(c.min()))} to {significant(float(c.max()))} K"
        for solid, c in uneven.items()
    )
    figure = Figure(
        "error-temperatures",
        "Change of temperature on the surfaces of solids, after a long time",
        _view(uneven),
        f"Surfaces of solids coloured by the change of their temperature: {words}.",
        TEMPERATURES,
        420,
    )
    return [figure], files


def _view(heated: Mapping[SolidElement, Array]) -> dict[str, Any]:
    low = min(float(c.min()) for c in heated.values())
    high = max(float(c.max()) for c in heated.values())
    traces = []
    for m, (solid, changes) in enumerate(heated.items()):
        used, corners = np.unique(solid.triangles, return_inverse=True)
        where = 1e3 * solid.points[used]
        traces.append(
            {
                "type": "mesh3d",
                "name": plain(solid.name),
                **dict(zip("xyz", (rounded(c) for c in where.T), strict=True)),
                **dict(zip("ijk", (c.tolist() for c in corners.reshape(-1, 3).T), strict=True)),
                "intensity": rounded(changes[used], 4),
                "colorscale": "RdBu",
                "cmin": low,
                "cmax": high,
                "showscale": m == 0,
                "colorbar": colour_bar("change of temperature, K"),
                "lighting": {"ambient": 0.85, "diffuse": 0.3, "specular": 0.05},
                "hovertemplate": "%{intensity:.3g} K<extra>" + plain(solid.name) + "</extra>",
            }
        )
    return scene(traces)
