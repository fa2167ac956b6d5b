"""Outlines of bodies, from the tables of a model file to meshes that move with them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from strutwork.errors import ModelError
from strutwork.kinematics import GROUND, Linkage, axes_frame
from strutwork.kinematics.mesh_shapes import MeshShape
from strutwork.kinematics.sliding import fixed_nodes
from strutwork.machines.model_parts import unknown
from strutwork.machines.model_schema import ModelTable
from strutwork.machines.model_solid_mesh import at_field
from strutwork.machines.part_files import part_file
from strutwork.meshes.surfaces import check_closed, check_one_body, read_surface

#: Shapes of a file at most: pairs of them grow with their square.
MOST_SHAPES = 200


def shapes_of(
    tables: ModelTable, folder: Path, linkage: Linkage, places: Mapping[str, ArrayLike]
) -> tuple[MeshShape, ...]:
    """The outlines of a file's bodies.

    Parameters
    ----------
    tables : ModelTable
    folder : Path
        Where names of files begin.
    linkage : Linkage
    places : mapping of node to (3,)
        Of every node, in the file's configuration, m.

    Raises
    ------
    ModelError
        An unknown body, a name used twice, too many shapes; a file that is missing, too large,
        damaged, or no closed surface of one body. Names the field.
    """
    if len(tables.shapes) > MOST_SHAPES:
        raise ModelError(
            "shapes",
            f"are {len(tables.shapes)}; at most {MOST_SHAPES} are allowed.",
            "Join those of one body.",
        )
    nodes = _nodes(tables, linkage)
    found: dict[str, MeshShape] = {}
    for i, table in enumerate(tables.shapes):
        name, field = table.name or table.body, f"shapes[{i}]"
        if table.body not in nodes:
            if table.body == GROUND:
                raise ModelError(
                    f"{field}.body", "is the ground, and nothing is supported.", "Add a support."
                )
            raise unknown(f"{field}.body", "body, beam or solid", table.body, nodes)
        if name in found:
            raise ModelError(
                field, f'has the name "{name}" of another shape.', "Give it a name of its own."
            )
        path = part_file(table.surface, folder, f"{field}.surface")
        with at_field(f"{field}.surface"):
            surface = read_surface(path, table.unit or "m")
            check_closed(surface)
            check_one_body(surface)
        rotation = axes_frame(table.axis, table.second_axis, field)
        node = _held(linkage, nodes[table.body], f"{field}.body")
        points = surface.points @ rotation.T + np.asarray(table.position)
        with at_field(f"{field}.surface"):
            place = np.asarray(places[node], dtype=float)
            found[name] = MeshShape(name, node, place, points, surface.triangles)
    return tuple(found.values())


def _held(linkage: Linkage, node: str, field: str) -> str:
    """A node of the same body that stays where it is on it."""
    body = linkage.body_of_node[linkage.node_index[node]]
    if body < 0:
        return node
    mine = np.flatnonzero((linkage.body_of_node == body) & fixed_nodes(linkage))
    if not len(mine):
        raise ModelError(
            field,
            "has no node that stays fixed on the body: each is the first of a joint that slides.",
            "Give the body one more node.",
        )
    return linkage.nodes[int(mine[0])]


def _nodes(tables: ModelTable, linkage: Linkage) -> dict[str, str]:
    """A node of every part that may have a shape."""
    named = {
        **{t.name: t.nodes[0] for t in tables.bodies},
        **{t.name: t.from_ for t in tables.beams},
        **{t.name: t.interfaces[0].node for t in tables.solids if t.interfaces},
    }
    still = np.flatnonzero(linkage.body_of_node < 0)
    if len(still):
        named.setdefault(GROUND, linkage.nodes[int(still[0])])
    return named
