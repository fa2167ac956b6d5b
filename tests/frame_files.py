"""Frames for the verification cases, written as model files and read back."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from strutwork.machines.model_file import parse_model
from strutwork.msa import PlacedStructure
from tests.model_files import Content, toml

PLANE = ("z", "rx", "ry")


def frame_file(
    material: Mapping[str, Any], section: Mapping[str, Any], title: str = "frame"
) -> Content:
    """A model without nodes, of one material and one section."""
    return {
        "title": title,
        "materials": {"m": dict(material)},
        "sections": {"s": dict(section)},
        "nodes": {},
        "beams": [],
        "supports": [],
    }


def chain(content: Content, name: str, start: Any, end: Any, pieces: int, **options: Any) -> None:
    """Beams from node to node along a line; `start` and `end` are (node, coordinates)."""
    nodes = content["nodes"]
    names = [start[0], *(f"{name}.{i}" for i in range(1, pieces)), end[0]]
    for i, node in enumerate(names):
        share = i / pieces
        nodes.setdefault(
            node, [(1 - share) * a + share * b for a, b in zip(start[1], end[1], strict=True)]
        )
    for i in range(pieces):
        content["beams"].append(
            {
                "name": f"{name}.{i}",
                "from": names[i],
                "to": names[i + 1],
                "material": "m",
                "section": "s",
                **options,
            }
        )


def support(content: Content, node: str, *fixed: str) -> None:
    content["supports"].append({"node": node, "fixed": list(fixed) or "all"})


def in_plane(content: Content, held: Mapping[str, tuple[str, ...]]) -> None:
    """Keep every node in the x-y plane, and hold some of them in more directions."""
    for node in content["nodes"]:
        support(content, node, *PLANE, *held.get(node, ()))


def read(content: Content) -> PlacedStructure:
    model = parse_model(toml(content))
    return model.structure.at(model.placement)
