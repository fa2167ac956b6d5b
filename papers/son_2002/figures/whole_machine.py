"""The MIT-SS-1 on its granite in 3-D."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.machines.mit_ss1_frame import MOUNTS, mount
from strutwork.machines.mit_ss1_whole import MitSS1Whole
from strutwork.meshes.boundary import boundary
from strutwork.meshes.surfaces import surface_of
from strutwork.papers.son_2002.figures.mode_surface import CAMERA
from strutwork.papers.son_2002.figures.planar_machine import RAIL_SIDE, planar_machine_traces
from strutwork.reports.figures.shapes import Shape, cylinder, mesh
from strutwork.reports.figures.solid import scene, segments

Array = NDArray[Any]

#: Sizes that matter for the drawing alone, m.
MOUNT_RADIUS, MOUNT_HEIGHT = 0.05, 0.08


def whole_machine_view(whole: MitSS1Whole) -> dict[str, Any]:
    """Granite, mounts, rails, struts, bearings, spindle housing and tool at home; mm."""
    machine = whole.machine
    frame = whole.frame
    granite = surface_of(frame.mesh, boundary(frame.mesh))
    points = granite.points - whole.origin
    low, high = (frame.base + v - whole.origin[2] for v in frame.rail_foot)
    front = frame.plate - whole.origin[1]
    at = dict(zip(whole.granite.nodes, whole.granite.positions - whole.origin, strict=True))
    down = np.array([0.0, 0.0, -MOUNT_HEIGHT])
    mounts = [
        cylinder(at[mount(i)], at[mount(i)] + down, MOUNT_RADIUS, f"mount {i}, elastic")
        for i in MOUNTS
    ]
    inner = planar_machine_traces(
        machine,
        machine.place(machine.home()),
        rails=(front + RAIL_SIDE / 2, low, high),
    )
    figure = scene(
        [
            mesh(
                [Shape(points, np.asarray(granite.triangles), "granite, a solid")],
                "granite",
                "#b8b2a6",
                flatshading=True,
            ),
            segments(_cell_edges(whole), "mesh", "#8d877b", 1, showlegend=False),
            mesh(mounts, "mount, elastic", "#3d4854"),
            *inner,
        ]
    )
    figure["layout"]["scene"]["camera"] = CAMERA
    return figure


def _cell_edges(whole: MitSS1Whole) -> list[tuple[Array, Array]]:
    """Edges of the solid's cells on its surface, a little outside of it."""
    mesh_ = whole.frame.mesh
    faces = np.concatenate([f.nodes for f in boundary(mesh_).faces])
    pairs = np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2)
    edges = np.unique(np.sort(pairs, axis=1), axis=0)
    points = mesh_.points - whole.origin
    return [(points[a], points[b]) for a, b in edges]
