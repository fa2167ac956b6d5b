"""Figures of two machines: both as they stand, and their differences as bars."""

from __future__ import annotations

from math import isfinite, log10
from typing import Any

from strutwork.reports.content import Figure
from strutwork.reports.data_files import DataFile, csv_file, json_file
from strutwork.reports.designs.result import DesignComparison
from strutwork.reports.designs.row import Row
from strutwork.reports.figures.model import model_view
from strutwork.reports.figures.theme import INK, axis, layout
from strutwork.reports.numbers import significant
from strutwork.reports.page import plain

#: As in the tables of the page: B is worse, B is better; each bar says so in words too.
COLOURS = {"A better": "#a02c2c", "B better": "#1a6b4a"}
NEITHER = "#9aa3ad"
_MARKS = {"A better": " A", "B better": " B"}

#: Questions whose quantities are drawn.
DRAWN = ("home", "worst", "vibration", "mass", "forces", "reach")

#: Ratios beyond are drawn at the edge.
EDGE = 100.0

PICTURE = "pictures.json"
BARS = "differences.csv"


def drawings(found: DesignComparison) -> tuple[tuple[Figure, ...], DataFile]:
    """Both machines where they stand, and the file beside them.

    Parameters
    ----------
    found : DesignComparison
    """
    figures, content = [], {}
    for mark, design in (("A", found.a), ("B", found.b)):
        model = design.standing
        figures.append(
            Figure(
                f"machine-{mark.lower()}",
                f"{mark}: {design.title}, {found.where}. Drag to rotate, scroll to zoom.",
                model_view(model),
                f"Three-dimensional drawing of machine {mark}.",
                PICTURE,
                height=380,
            )
        )
        positions = dict(
            zip(model.structure.linkage.nodes, model.placement.positions.tolist(), strict=True)
        )
        content[mark] = {
            "name": design.name,
            "nodes": positions,
            "beams": {b.name: list(b.nodes) for b in model.structure.beams},
            "joints": {
                j.name: {"type": j.type, "between": list(j.between)}
                for j in model.structure.linkage.joints
            },
        }
    what = "what the drawings show: nodes in m, beams and joints"
    return tuple(figures), json_file(PICTURE, what, content)


def difference_bars(found: DesignComparison) -> tuple[Figure | None, DataFile | None]:
    """B over A of every quantity with a ratio that differs, and the file beside it.

    Parameters
    ----------
    found : DesignComparison

    Returns
    -------
    figure, file
        None where nothing has a ratio.
    """
    drawn = [(row, ratio) for row in found.rows if (ratio := _ratio(row)) is not None]
    if not drawn:
        return None, None
    names = [_label(row) for row, _ in drawn]
    clipped = [min(max(ratio, 1.0 / EDGE), EDGE) for _, ratio in drawn]
    verdicts = [row.verdict for row, _ in drawn]
    trace: dict[str, Any] = {
        "type": "bar",
        "orientation": "h",
        "y": [plain(name) for name in names],
        # bars of a logarithmic axis begin at their base
        "x": [value - 1.0 for value in clipped],
        "base": [1.0] * len(clipped),
        "marker": {
            "color": [COLOURS.get(v, NEITHER) for v in verdicts],
            "line": {"color": INK, "width": 0.5},
        },
        "text": [
            f"{significant(r, 2)}{_MARKS.get(v, '')}"
            for (_, r), v in zip(drawn, verdicts, strict=True)
        ],
        "textposition": "outside",
        "textfont": {"size": 11},
        "cliponaxis": False,
        "customdata": [
            plain(f"{row.quantity.name}: {significant(r, 4)}, {row.verdict}") for row, r in drawn
        ],
        "hovertemplate": "%{customdata}<extra></extra>",
        "showlegend": False,
    }
    low, high = min(*clipped, 0.8), max(*clipped, 1.5)
    ticks = [0.01, 0.1, 1, 10, 100] if high / low > 30.0 else [0.1, 0.2, 0.5, 1, 2, 5, 10]
    return (
        Figure(
            "difference-bars",
            "B over A, on a logarithmic scale: to the right of 1 the number of B is the larger. "
            "The letter after a ratio is the better machine, where the difference is marked; "
            f'stiffness without "worst" is that {found.where}. Ratios beyond {EDGE:g} or below '
            "its inverse are drawn at the edge.",
            {
                "data": [trace],
                "layout": layout(
                    bargap=0.25,
                    xaxis=axis(
                        "B / A",
                        type="log",
                        range=_range(low, high),
                        tickvals=ticks,
                        ticktext=[f"{t:g}" for t in ticks],
                        tickangle=0,
                    ),
                    yaxis=axis("", autorange="reversed", ticks=""),
                    margin={"l": 60, "r": 16, "t": 34, "b": 52},
                ),
            },
            "Horizontal bars: the ratio of machine B to machine A for every quantity.",
            BARS,
            height=110 + 22 * len(drawn),
        ),
        csv_file(
            BARS,
            "ratio of B to A of each quantity",
            ("key", "quantity", "ratio", "verdict"),
            [
                [row.quantity.key, name, ratio, row.verdict]
                for (row, ratio), name in zip(drawn, names, strict=True)
            ],
        ),
    )


#: Names that leave a narrow window room for the bars.
_SHORT = {
    "mass": "mass",
    "locked_force": "locked force",
    "locked_moment": "locked moment",
    "limit_used": "limit used",
    "tool_deviation": "tool deviation",
    "poses_taken": "poses reached",
}


def _label(row: Row) -> str:
    """The quantity in two or three words, as in "worst rx, free"."""
    question, key = row.quantity.question, row.quantity.key
    meaning, _, direction = key.rpartition("_")
    if question in {"home", "worst"}:
        lead = "worst " if question == "worst" else ""
        return f"{lead}{direction}, {meaning.rpartition('_')[2]}"
    if question == "vibration":
        return f"{'frequency' if 'frequency' in key else 'dynamic'} {direction}"
    return _SHORT.get(key, row.quantity.name)


def _ratio(row: Row) -> float | None:
    """B over A; None where one has no positive number, or where the question is not drawn."""
    a, b = row.a.number, row.b.number
    if row.quantity.question not in DRAWN or not row.quantity.better or not row.compared:
        return None
    if a is None or b is None or not (isfinite(a) and isfinite(b) and a > 0.0 and b > 0.0):
        return None
    return b / a


def _range(low: float, high: float) -> list[float]:
    """Powers of ten with room for the words beside the bars."""
    room = 0.3 * (log10(high) - log10(low))
    return [log10(low) - (room if low < 1.0 else 0.05), log10(high) + room]
