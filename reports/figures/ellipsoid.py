"""Compliance of the tool as an ellipsoid."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.reports.figures.shapes import Shape, ball, mesh
from strutwork.reports.figures.solid import scene
from strutwork.reports.figures.theme import INK, rounded
from strutwork.reports.numbers import significant

Array = NDArray[Any]

#: Names of the principal axes, and how thick each is drawn.
AXES = {"largest": 7, "middle": 5, "smallest": 3}

#: Half the side of the cube that all axes show, for each unit of the largest.
AIR = 1.1


def compliance_ellipsoid(
    compliance: Array,
    colour: str = "#4c7fb0",
    unit: str = "µm/N",
    factor: float = 1e6,
    what: str = "displacement under a unit force",
) -> dict[str, Any]:
    """The displacements that all unit forces cause, a surface with its principal axes.

    All three axes show the same range, so that a long and thin ellipsoid is one in the figure
    and its numbers do not run into each other.

    Parameters
    ----------
    compliance : (3, 3)
        Symmetric, not negative and not zero, SI.
    colour : str
    unit : str
        Of the drawing.
    factor : float
        From SI to that unit.
    what : str
        What a point of the surface is.
    """
    # a mesh is drawn in thousandths of its unit
    scaled = 1e-3 * factor * np.asarray(compliance)
    sphere = ball(np.zeros(3), 1.0, sides=40)
    surface = Shape(sphere.vertices @ scaled.T, sphere.faces, what)
    magnitudes, axes = np.linalg.eigh(scaled)
    traces = [mesh([surface], "compliance", colour, opacity=0.55)]
    for (name, width), size, axis in zip(AXES.items(), magnitudes[::-1], axes.T[::-1], strict=True):
        ends = 1e3 * size * np.stack([-axis, axis])
        traces.append(
            {
                "type": "scatter3d",
                "mode": "lines",
                "x": rounded(ends[:, 0]),
                "y": rounded(ends[:, 1]),
                "z": rounded(ends[:, 2]),
                "line": {"color": INK, "width": width},
                "name": f"{name}, {significant(1e3 * max(float(size), 0.0))} {unit}",
                "hoverinfo": "name",
            }
        )
    figure = scene(traces)
    reach = AIR * 1e3 * float(magnitudes[-1])
    view = figure["layout"]["scene"]
    view["aspectratio"] = dict.fromkeys("xyz", 1.0)
    for axis_name in "xyz":
        view[f"{axis_name}axis"] |= {
            "title": {"text": f"{axis_name} ({unit})", "font": {"size": 11}},
            "range": [-reach, reach],
            "nticks": 5,
        }
    return figure
