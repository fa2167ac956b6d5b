"""Compliance of the tool's position as an ellipsoid."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.reports.figures.shapes import Shape, ball, mesh
from strutwork.reports.figures.solid import scene
from strutwork.reports.figures.theme import INK, rounded

Array = NDArray[Any]


def compliance_ellipsoid(compliance: Array, colour: str = "#4c7fb0") -> dict[str, Any]:
    """The displacements that all unit forces cause, a surface in µm/N, with its principal axes.

    Parameters
    ----------
    compliance : (3, 3)
        Of the tool's position, m/N, symmetric and positive.
    colour : str
    """
    # a mesh is drawn in thousandths of its unit: mm/N become µm/N
    scaled = 1e3 * np.asarray(compliance)
    sphere = ball(np.zeros(3), 1.0, sides=40)
    surface = Shape(sphere.vertices @ scaled.T, sphere.faces, "displacement under a unit force")
    magnitudes, axes = np.linalg.eigh(scaled)
    traces = [mesh([surface], "compliance", colour, opacity=0.55)]
    for name, size, axis in zip(
        ("largest", "middle", "smallest"), magnitudes[::-1], axes.T[::-1], strict=True
    ):
        ends = 1e3 * size * np.stack([-axis, axis])
        traces.append(
            {
                "type": "scatter3d",
                "mode": "lines",
                "x": rounded(ends[:, 0]),
                "y": rounded(ends[:, 1]),
                "z": rounded(ends[:, 2]),
                "line": {"color": INK, "width": {"largest": 7, "middle": 5, "smallest": 3}[name]},
                "name": f"{name}, {1e3 * size:.3g} µm/N",
                "hoverinfo": "name",
            }
        )
    figure = scene(traces)
    for axis_name in "xyz":
        figure["layout"]["scene"][f"{axis_name}axis"]["title"]["text"] = f"{axis_name} (µm/N)"
    return figure
