"""Other ways in which the machine can be put together with its drives where they stand."""

from __future__ import annotations

from math import degrees
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS
from strutwork.reports.content import (
    Block,
    Chapter,
    Column,
    Details,
    Fact,
    Facts,
    Figure,
    Row,
    Table,
    Text,
)
from strutwork.reports.data_files import csv_file
from strutwork.reports.figures.theme import PALETTE, layout
from strutwork.reports.long_tables import LONGEST
from strutwork.reports.numbers import MINUS, significant
from strutwork.reports.subject import Subject
from strutwork.studies.machine_modes import MachineModes

Array = NDArray[Any]

KEY = "assembly-modes"
TITLE = "In which other ways can it be assembled?"

#: Modes that are drawn.
DRAWN = 16


def missing(subject: Subject) -> str:
    """Why there is nothing to say; empty where there is."""
    if subject.model.tool is None:
        return "it has no tool: add [tool] with tcp"
    if not subject.model.structure.linkage.driven:
        return "it has no drives: name the driven directions of its joints"
    return subject.unassembled


def write(subject: Subject) -> Chapter:
    """All modes at home, each with where it puts the tool, and drawn."""
    modes = subject.modes
    task = subject.model.motion.task_of(modes.tool)
    blocks: list[Block] = [Text(_text(modes)), Facts(tuple(_facts(modes)))]
    if len(modes) > 1:
        table = _table(task)
        more = Details(f"The {len(modes)} places of the tool in numbers", (table,))
        blocks += [_figures(modes, task), table if len(modes) <= LONGEST else more]
    file = csv_file(
        "assembly-modes.csv",
        "position of the tool, m, and its rotation vector from home, rad, in every assembly mode",
        ["mode", *(f"{d}_{'rad' if d.startswith('r') else 'm'}" for d in DIRECTIONS)],
        [[k + 1, *row] for k, row in enumerate(task.tolist())],
    )
    return Chapter(KEY, TITLE, tuple(blocks), (file,))


def _text(modes: MachineModes) -> str:
    if len(modes) > 1:
        text = (
            "With its drives held at home, the joints allow these poses of the tool; the first "
            "is the machine's own. Unless it is taken apart, the machine passes from one to "
            "another only through a singularity (type 2). "
        )
    else:
        text = (
            "With its drives held at home, "
            f"{'the joints allow' if modes.every else 'the search found'} no pose of the tool "
            "other than the machine's own. "
        )
    if modes.every:
        text += (
            "Each of the platform's three ball joints then moves on a circle, and an elimination "
            f"finds all {modes.ways} ways to place them at their distances; those with real "
            "angles are poses."
        )
    else:
        text += (
            f"The search began at {modes.starts} starting points, of which {modes.ways} "
            "converged; there may be other modes."
        )
    if modes.moves:
        text += " Bodies can still move with the drives held: one mode then represents a family."
    return text + " Collisions between links or bodies are not checked."


def _facts(modes: MachineModes) -> list[Fact]:
    facts = [
        Fact(
            "Assembly modes",
            f"{len(modes)}",
            "",
            "all there are" if modes.every else "by search; there may be others",
        )
    ]
    if np.isfinite(modes.apart):
        facts.append(
            Fact(
                "Nearest other mode",
                significant(degrees(modes.apart)),
                "deg",
                "largest rotation of a leg about its hinge from home",
            )
        )
    return facts


def _table(task: Array) -> Table:
    factors = np.array([1e3] * 3 + [degrees(1.0)] * 3)
    rows = []
    for k, row in enumerate(task):
        name = "1, the machine's own" if k == 0 else f"{k + 1}"
        rows.append([name, *(significant(round(float(v), 6) + 0.0, 4) for v in row * factors)])
    columns = (
        Column("mode", "", False),
        *(Column(d, "deg" if d.startswith("r") else "mm") for d in DIRECTIONS),
    )
    return Table(
        "Position of the tool in every mode, and its rotation vector from home",
        columns,
        rows,
        "assembly-modes.csv",
    )


def _place(row: Array) -> str:
    """Place of the tool and its turn, what is not zero, in whole mm and degrees."""
    turned = [f"{d} {round(degrees(v)) + 0}°" for d, v in zip(DIRECTIONS[3:], row[3:], strict=True)]
    placed = [f"{d} {round(1e3 * v) + 0}" for d, v in zip(DIRECTIONS[:3], row[:3], strict=True)]
    words = ", ".join(w for w in turned if not w.endswith(" 0°"))
    text = ", ".join(placed) + " mm" + (f"; {words}" if words else "")
    return text.replace("-", MINUS)


#: A view that tells the three axes apart: right, up.
_VIEW = np.array([[0.77, 0.64, 0.0], [-0.26, 0.31, 0.91]])


def _figures(modes: MachineModes, task: Array) -> Row:
    every = 1e3 * np.concatenate([line for lines in modes.lines for line in lines]) @ _VIEW.T
    middle = 0.5 * (every.max(axis=0) + every.min(axis=0))
    half = 0.55 * float(np.ptp(every, axis=0).max())
    return Row(
        tuple(
            Figure(
                f"assembly-mode-{k + 1}",
                f"Mode {k + 1}{', the machine as it is' if k == 0 else ''}: {_place(row)}.",
                _sketch(lines, modes.tool.position[k], middle, half, k == 0),
                f"Lines of the bodies in assembly mode {k + 1}, seen obliquely.",
                "assembly-modes.csv",
                210,
            )
            for k, (lines, row) in enumerate(zip(modes.lines[:DRAWN], task, strict=False))
        ),
        width=200,
    )


def _sketch(
    lines: tuple[Array, ...], tool: Array, middle: Array, half: float, own: bool
) -> dict[str, Any]:
    """Lines seen from aside: of many modes, pictures that turn would be too much for a browser."""
    traces: list[dict[str, Any]] = []
    for line in lines:
        x, y = (1e3 * line @ _VIEW.T).T
        traces.append(
            {
                "type": "scatter",
                "mode": "lines",
                "line": {"color": PALETTE[1] if own else PALETTE[0], "width": 3},
                "hoverinfo": "skip",
                "showlegend": False,
                "x": np.round(x, 3).tolist(),
                "y": np.round(y, 3).tolist(),
            }
        )
    x, y = 1e3 * _VIEW @ tool
    named = zip("xyz", tool, strict=True)
    place = ", ".join(f"{axis} {significant(1e3 * float(v))}" for axis, v in named)
    traces.append(
        {
            "type": "scatter",
            "mode": "markers",
            "marker": {"size": 8, "color": "#1b2430"},
            "hovertemplate": f"tool: {place} mm<extra></extra>",
            "showlegend": False,
            "x": [round(float(x), 3)],
            "y": [round(float(y), 3)],
        }
    )
    axes = [
        {
            "range": [float(middle[k] - half), float(middle[k] + half)],
            "visible": False,
            **({"scaleanchor": "x"} if k else {}),
        }
        for k in (0, 1)
    ]
    return {
        "data": traces,
        "layout": layout(margin={"l": 0, "r": 0, "t": 0, "b": 0}, xaxis=axes[0], yaxis=axes[1]),
    }
