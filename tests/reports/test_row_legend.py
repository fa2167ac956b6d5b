"""Figures side by side have one legend where theirs are the same."""

from __future__ import annotations

from typing import Any

from strutwork.reports.content import Figure, Row
from strutwork.reports.row_legend import Sign, one_legend, signs_of


def line(name: str, colour: str = "#0072b2", **changes: Any) -> dict[str, Any]:
    return {"type": "scatter", "mode": "lines", "name": name, "line": {"color": colour}} | changes


def row(*traces: list[dict[str, Any]]) -> Row:
    return Row(
        tuple(
            Figure(f"f{i}", "Caption.", {"data": some, "layout": {"title": "t"}}, "A plot.")
            for i, some in enumerate(traces)
        )
    )


def test_equal_legends_become_one() -> None:
    dashed = {"color": "#d55e00", "dash": "dash"}
    both = [line("x"), line("y", line=dashed)]
    shown, signs = one_legend(row(both, both))
    assert signs == (Sign("x", "#0072b2", "line"), Sign("y", "#d55e00", "dashed"))
    assert all(f.spec["layout"] == {"title": "t", "showlegend": False} for f in shown.figures)


def test_other_names_or_colours_keep_their_own() -> None:
    pairs = [
        [[line("x"), line("y")], [line("x"), line("z")]],
        [[line("x"), line("y")], [line("x"), line("y", "#009e73")]],
        [[line("x"), line("y")]],
        [[line("x")], [line("x")]],
        [[line("a<br>b"), line("y")], [line("a<br>b"), line("y")]],
    ]
    for some in pairs:
        before = row(*some)
        assert one_legend(before) == (before, ())


def test_what_stands_for_a_trace() -> None:
    traces = [
        {"type": "bar", "name": "share", "marker": {"color": "#56b4e9"}},
        {
            "type": "bar",
            "name": "published",
            "marker": {"color": "#cccccc", "pattern": {"shape": "/"}},
        },
        {"type": "scatter", "mode": "markers", "name": "worst", "marker": {"color": "red"}},
        line("hidden", visible=False),
        line("unlisted", showlegend=False),
        {"type": "heatmap", "name": "map"},
    ]
    assert signs_of({"data": traces, "layout": {}}) == (
        Sign("share", "#56b4e9", "area"),
        Sign("published", "#cccccc", "hatched"),
        Sign("worst", "red", "dot"),
    )
    # a colour for each point has no one sign, and no text of a colour leaves its attribute
    for colour in (["#000000", "#ffffff"], "red; background: url(x)", None):
        traces[2]["marker"] = {"color": colour}
        assert signs_of({"data": traces, "layout": {}}) is None
