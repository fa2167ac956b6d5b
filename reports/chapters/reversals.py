"""Where drives turn back as the tool goes over the plane of its workspace."""

from __future__ import annotations

from math import degrees
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.reports.content import Block, Chapter, Column, Fact, Facts, Figure, Table, Text
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.figures.theme import PALETTE, axis, layout, rounded
from strutwork.reports.numbers import share, significant
from strutwork.reports.subject import Subject
from strutwork.reports.survey_words import pose_text
from strutwork.studies.reversal_study import ReversalStudy

Array = NDArray[Any]

KEY = "reversals"
TITLE = "Where do its drives reverse?"

#: Points and drives that the page names.
SHOWN = 12

_CHECK = {True: "yes", False: "no: take more points", None: "not reported"}


def missing(subject: Subject) -> str:
    """Why there is nothing to say; empty where there is."""
    if subject.model.tool is None:
        return "it has no tool: add [tool] with tcp"
    if not subject.model.structure.linkage.driven:
        return "it has no drives: name the driven directions of its joints"
    if subject.model.workspace is None:
        return "the file gives no poses: add [workspace] with ranges of the tool"
    if subject.reversal_plane is None:
        return "its workspace has no plane: name two directions with several points"
    return subject.unreversed


def write(subject: Subject) -> Chapter:
    """Singular points with the index check, lines of a feed, plates, the longest clear path."""
    study = subject.reversals
    plane = subject.reversal_plane
    assert plane is not None  # noqa: S101 - asked in `missing`
    names = tuple(plane)
    found = study.found
    drives = found.field.drives
    still = [drives[k] for k in range(len(drives)) if k not in found.moving]
    text = (
        "A drive that reverses passes through its friction and backlash and leaves a mark on the "
        f"workpiece. The tool moves over {' and '.join(names)} and keeps its other directions as "
        "at home. At a strong point a drive reverses whichever way the tool moves; at a weak one "
        "it does so on some paths only. The strong points minus the weak ones must equal the "
        "turns of the gradient along the border."
    )
    if still:
        text += f" Drives that do not move: {', '.join(still)}."
    blocks: list[Block] = [
        Text(text),
        Facts(tuple(_facts(study, names))),
        _figure(study, names),
        _table(study, names),
    ]
    return Chapter(KEY, TITLE, tuple(blocks), tuple(_files(study, names)))


def _facts(study: ReversalStudy, names: tuple[str, ...]) -> list[Fact]:
    facts = []
    path = study.longest
    if path is not None:
        way = np.abs(path.end - path.start)
        turns = all(n.startswith("r") for n, w in zip(names, way, strict=True) if w > 0)
        size = degrees(path.length) if turns else 1e3 * path.length
        facts.append(
            Fact(
                f"Longest straight path along {names[0]} without a reversal",
                significant(size),
                "deg" if turns else "mm",
                f"from {_place(names, path.start)} to {_place(names, path.end)}",
            )
        )
    facts.append(
        Fact(
            "Plates",
            f"{study.plates}",
            "",
            "parts of the plane in which no two drives' gradients become parallel",
        )
    )
    if study.reach is not None:
        facts.append(
            Fact(
                "Reached without a reversal",
                share(study.reach),
                "",
                "of the reachable points, from the middle one",
            )
        )
    return facts


def _place(names: tuple[str, ...], place: Array) -> str:
    return pose_text({n: float(p) for n, p in zip(names, place, strict=True)})


def _table(study: ReversalStudy, names: tuple[str, ...]) -> Table:
    rows = []
    for drive in study.found.singular:
        at = "; ".join(f"{_place(names, p.place)} ({p.kind})" for p in drive.points[:4])
        rows.append(
            [
                drive.drive,
                f"{drive.strong}",
                f"{drive.weak}",
                f"{len(drive.lines)}",
                f"{len(study.lines.get(drive.drive, ()))}",
                at or "–",
                _CHECK[drive.complete],
            ]
        )
    columns = (
        Column("drive", "", False),
        Column("strong points"),
        Column("weak points"),
        Column("entire lines"),
        Column(f"lines when fed along {names[0]}"),
        Column("points at", "", False),
        Column("agrees with the border", "", False),
    )
    return Table("Where each drive reverses", columns, rows, "reversals.csv")


def _figure(study: ReversalStudy, names: tuple[str, ...]) -> Figure:
    scale = np.array([degrees(1.0) if n.startswith("r") else 1e3 for n in names])
    titles = [f"{n} ({'deg' if n.startswith('r') else 'mm'})" for n in names]
    drives = list(study.found.field.drives)
    traces: list[dict[str, Any]] = []

    def line(name: str, points: Array, colour: str, **style: Any) -> None:
        shown = points * scale
        traces.append(
            {
                "type": "scatter",
                "mode": "lines",
                "name": name,
                "legendgroup": name,
                "showlegend": not any(t["name"] == name for t in traces),
                "x": rounded(shown[:, 0]),
                "y": rounded(shown[:, 1]),
                "line": {"color": colour, "width": 2, **style},
                "hovertemplate": name + "<extra></extra>",
            }
        )

    for drive, lines in study.lines.items():
        number = drives.index(drive)
        # drives of a symmetric machine turn back on the same line
        dash = ("solid", "dash", "dot")[number % 3]
        for points in lines:
            line(f"{drive} reverses", points, PALETTE[number % len(PALETTE)], dash=dash)
    path = study.longest
    if path is not None:
        line("longest clear path", np.array([path.start, path.end]), "#1b2430", dash="dash")
    for kind, symbol in (("strong", "circle"), ("weak", "x")):
        places = np.array(
            [p.place for d in study.found.singular for p in d.points if p.kind == kind]
        ).reshape(-1, 2)
        if len(places):
            shown = places * scale
            traces.append(
                {
                    "type": "scatter",
                    "mode": "markers",
                    "name": f"{kind} point",
                    "x": rounded(shown[:, 0]),
                    "y": rounded(shown[:, 1]),
                    "marker": {"symbol": symbol, "size": 9, "color": "#d55e00"},
                    "hovertemplate": "%{x:.4g}, %{y:.4g}<extra>" + kind + "</extra>",
                }
            )
    patch = study.found.patch
    ranges = [
        (np.array([v[0], v[-1]]) * factor).tolist()
        for v, factor in zip((patch.u, patch.v), scale, strict=True)
    ]
    spec = {
        "data": traces,
        "layout": layout(
            xaxis=axis(titles[0], range=ranges[0]), yaxis=axis(titles[1], range=ranges[1])
        ),
    }
    caption = (
        f"Lines on which a feed along {names[0]} makes a drive reverse, points at which a drive "
        "reverses whichever way the tool moves, and the longest straight path along it without a "
        "reversal."
    )
    if not study.lines or not any(study.lines.values()):
        caption += f" No drive reverses when the tool is fed along {names[0]}."
    return Figure(
        "reversal-plane",
        caption,
        spec,
        f"Reversal lines and points over {' and '.join(names)}.",
        "reversals.csv",
        460,
    )


def _files(study: ReversalStudy, names: tuple[str, ...]) -> list[DataFile]:
    rows: list[list[Any]] = []
    for drive in study.found.singular:
        rows += [[drive.drive, p.kind, 0, *p.place.tolist()] for p in drive.points]
        for number, points in enumerate(drive.lines, 1):
            rows += [[drive.drive, "entire line", number, *p.tolist()] for p in points]
    for name, lines in study.lines.items():
        for number, points in enumerate(lines, 1):
            rows += [
                [name, f"line of a feed along {names[0]}", number, *p.tolist()] for p in points
            ]
    units = ["rad" if n.startswith("r") else "m" for n in names]
    heads = [f"{n}_{u}" for n, u in zip(names, units, strict=True)]
    return [
        csv_file(
            "reversals.csv",
            "points and lines at which drives reverse",
            ["drive", "what", "line", *heads],
            rows,
        )
    ]
