"""One legend for figures side by side that all have the same."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from strutwork.reports.content import Row

#: Colours that may stand in an attribute.
_COLOUR = re.compile(r"#[0-9a-fA-F]{3,8}|rgba?\([\d., %]+\)|[a-z]+")


@dataclass(frozen=True)
class Sign:
    """An entry of a legend.

    Parameters
    ----------
    name : str
    colour : str
        As CSS writes it.
    look : str
        "line", "dashed", "dot", "area" or "hatched".
    """

    name: str
    colour: str
    look: str


def one_legend(row: Row) -> tuple[Row, tuple[Sign, ...]]:
    """A row whose figures share a legend without their own, and its entries; else as it is.

    Parameters
    ----------
    row : Row
    """
    found = [signs_of(figure.spec) for figure in row.figures]
    if len(found) < 2 or not found[0] or any(signs != found[0] for signs in found):
        return row, ()
    bare = tuple(
        replace(f, spec={**f.spec, "layout": {**f.spec["layout"], "showlegend": False}})
        for f in row.figures
    )
    return replace(row, figures=bare), found[0] or ()


def signs_of(spec: Mapping[str, Any]) -> tuple[Sign, ...] | None:
    """The legend of a figure; None where it has an entry that no simple sign stands for."""
    traces = [t for t in spec["data"] if t.get("visible", True) is True]
    if not spec["layout"].get("showlegend", len(traces) > 1):
        return ()
    signs: dict[str, Sign] = {}
    for trace in traces:
        name = str(trace.get("name", ""))
        if not name or not trace.get("showlegend", _listed(trace)):
            continue
        sign = _sign(name, trace)
        if sign is None or signs.setdefault(name, sign) != sign:
            return None
    return tuple(signs.values())


def _listed(trace: Mapping[str, Any]) -> bool:
    """Whether plotly lists a trace that says nothing of it."""
    return trace.get("type", "scatter") in {"scatter", "scattergl", "scatter3d", "bar", "histogram"}


def _sign(name: str, trace: Mapping[str, Any]) -> Sign | None:
    line, marker = trace.get("line", {}), trace.get("marker", {})
    if trace.get("type", "scatter").startswith("scatter"):
        drawn = "lines" in trace.get("mode", "lines")
        colour = line.get("color") if drawn else marker.get("color")
        solid = line.get("dash", "solid") == "solid"
        look = ("line" if solid else "dashed") if drawn else "dot"
    else:
        colour = trace.get("color", marker.get("color"))
        look = "hatched" if marker.get("pattern") else "area"
    # names are plotly's, with its marks for lines and for what it would read as markup
    if not isinstance(colour, str) or not _COLOUR.fullmatch(colour) or re.search("[<&]", name):
        return None
    return Sign(name, colour, look)
