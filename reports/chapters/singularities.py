"""How far it is from a singularity, and where its singular poses lie."""

from __future__ import annotations

import re
from math import degrees
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.lost_motion import Lost
from strutwork.kinematics.singularity_curves import SingularPlane
from strutwork.reports.content import Block, Chapter, Column, Figure, Table, Text
from strutwork.reports.data_files import DataFile
from strutwork.reports.figures.curves import heat
from strutwork.reports.numbers import MINUS, significant
from strutwork.reports.singularity_words import (
    curves_csv,
    distance_csv,
    kind_words,
    lost_words,
)
from strutwork.reports.subject import Subject
from strutwork.reports.survey_words import pose_text

KEY = "singularities"
TITLE = "How far is it from a singularity?"

#: Curves that the table names.
SHOWN = 12

#: Colours of curves inside and of borders of reach.
INSIDE, BORDER = "#d55e00", "#ffffff"


def missing(subject: Subject) -> str:
    """Why there is nothing to say; empty where there is."""
    if subject.model.tool is None:
        return "it has no tool: add [tool] with tcp"
    if not subject.model.structure.linkage.driven:
        return "it has no drives: name the driven directions of its joints"
    return subject.unsingular


def write(subject: Subject) -> Chapter:
    """Distance at home, and curves in a plane of two directions of the workspace."""
    here, plane = subject.singular_distance, subject.singular_plane
    distance = here.distance
    rows = [
        ["the tool can move although the drives are held (type 2)", _one(distance.parallel)],
        ["drives can move while the tool stands still (type 1)", _one(distance.serial)],
        ["the joints alone lose a constraint", _one(distance.passive)],
    ]
    columns = (Column("singularity", "", False), Column("distance at home"))
    blocks: list[Block] = [
        Text(
            "Least singular values of the constraint rows, with "
            f"{significant(1e3 * distance.length)} mm counting as one radian; zero where the "
            "machine is singular."
        ),
        Table("Distance from singularities at home", columns, rows),
    ]
    if here.kind is not None:
        blocks.append(Text(f"Home itself is singular: {here.kind.meaning}."))
    if plane is None:
        return Chapter(KEY, TITLE, tuple(blocks))
    others = tuple(d for d in subject.wide_directions if d not in plane.names)
    blocks += [_figure(plane, others), *_found(plane)]
    files = (
        _file("singularities.csv", "curves of singular poses", curves_csv(plane)),
        _file("singularities-distance.csv", "distance from singularities", distance_csv(plane)),
    )
    return Chapter(KEY, TITLE, tuple(blocks), files)


def _file(name: str, what: str, text: str) -> DataFile:
    return DataFile(name, what, lambda path: path.write_text(text, encoding="utf-8"))


def _one(values: NDArray[Any]) -> str:
    return significant(float(np.ravel(values)[0]))


def _lost(lost: Lost | None) -> str:
    """What is lost, with the signs of a page."""
    return re.sub(r"(?<!\w)-(?=\d)", MINUS, lost_words(lost, ""))


def _found(plane: SingularPlane) -> list[Block]:
    inner = [c for c in plane.curves if not c.border]
    rows = [
        [
            kind_words(c.kind),
            c.kind.meaning,
            pose_text(dict(c.at.parameters)),
            _lost(c.at.lost),
        ]
        for c in inner[:SHOWN]
    ]
    rows += [
        [kind_words(p.kind), p.kind.meaning, pose_text(dict(p.parameters)), _lost(p.lost)]
        for p in plane.points[:SHOWN]
    ]
    if not rows:
        return [Text("No singular pose lies inside the reachable part of this plane.")]
    columns = (
        Column("kind", "", False),
        Column("what it means", "", False),
        Column("nearest to home at", "", False),
        Column("what is lost there", "", False),
    )
    title = "Singular poses in this plane, curve by curve"
    return [Table(title, columns, rows, "singularities.csv")]


def _figure(plane: SingularPlane, others: tuple[str, ...]) -> Figure:
    x, y = (
        np.degrees(v) if n.startswith("r") else 1e3 * v
        for n, v in zip(plane.names, plane.axes, strict=True)
    )
    titles = [f"{n} ({'deg' if n.startswith('r') else 'mm'})" for n in plane.names]
    values = np.fmin(plane.parallel, plane.serial)
    spec = heat(x, y, values, (titles[0], titles[1], "distance from the nearest singularity"))
    for curve in plane.curves:
        scale = [degrees(1.0) if n.startswith("r") else 1e3 for n in plane.names]
        points = curve.points * scale
        ring = np.concatenate([points, points[:1]]) if curve.closed else points
        name = "border of reach" if curve.border else f"singular: {kind_words(curve.kind)}"
        spec["data"].append(
            {
                "type": "scatter",
                "mode": "lines",
                "name": name,
                "legendgroup": name,
                "showlegend": not any(d.get("name") == name for d in spec["data"]),
                "x": ring[:, 0].tolist(),
                "y": ring[:, 1].tolist(),
                "line": {
                    "color": "#55606e" if curve.border else INSIDE,
                    "width": 3,
                    "dash": "dot" if curve.border else "solid",
                },
                "hovertemplate": name + "<extra></extra>",
            }
        )
    reached = int(plane.reach.sum())
    caption = (
        f"Distance from the nearest singularity over {' and '.join(plane.names)}, the other "
        f"directions at home; {reached} of {plane.reach.size} poses are reached. Each point of a "
        "curve is refined to rounding error."
    )
    if not plane.changes:
        caption += " It is the same everywhere on this plane."
    if others:
        caption += (
            f" The workspace also extends along {' and '.join(others)}: strutwork singularities "
            "--plane shows other planes."
        )
    return Figure(
        "singular-plane",
        caption,
        spec,
        f"Map of the distance from singularities over {' and '.join(plane.names)}, with curves of "
        "singular poses and the border of reach.",
        "singularities-distance.csv",
        460,
    )
