"""Assembly forces of one structure: at worst, in distribution, and by cause."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.reports.alike import grouped, word
from strutwork.reports.alike import label as names
from strutwork.reports.chapters.overconstraint import (
    UNITS,
    governing,
    label,
    loaded,
    main_cause,
    pose,
    shown,
)
from strutwork.reports.content import Block, Cell, Column, Figure, Row, Table, Text, Tone
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.figures.charts import stacked_shares
from strutwork.reports.figures.curves import histogram
from strutwork.reports.figures.force_bars import ForceBars, force_bars
from strutwork.reports.figures.theme import PALETTE
from strutwork.reports.long_tables import LONGEST
from strutwork.reports.numbers import significant
from strutwork.reports.part_groups import REST, told_apart
from strutwork.studies.tolerance_result import ToleranceStudy

#: Kinds of force in the order of charts, with colour and hatching.
STYLES = (("radial force", PALETTE[0], ""), ("axial force", PALETTE[4], "/"))

#: Quantiles of tables.
SHOWN = (0.95, 0.99)

#: Joints in one chart at most: the most loaded.
MOST = 24

#: Tolerances told apart in one chart at most.
CAUSES = 10

#: A rest of this many percent is left out.
LITTLE = 0.05

#: A limit is marked in a distribution when it lies within this many worst cases.
FAR = 1.5


@dataclass(frozen=True)
class Published:
    """Printed numbers beside our bars, by joint and kind of force, N."""

    name: str
    values: Mapping[tuple[str, str], float]


def force_blocks(
    study: ToleranceStudy, key: str, published: Published | None = None
) -> tuple[list[Block], list[DataFile]]:
    """Worst-case forces as bars with limits, and as a table with quantiles and causes."""
    blocks: list[Block] = []
    figure = _force_figure(study, key, published)
    if figure is not None:
        blocks.append(figure)
    blocks.append(_force_table(study, key))
    return blocks, [_force_file(study, key)]


def _joints(study: ToleranceStudy) -> list[str]:
    """Joints that carry a force, the most loaded where there are many, in the order they stand."""
    most: dict[str, float] = {}
    for i in loaded(study):
        quantity = study.quantities[i]
        if quantity.unit == "N" and quantity.joint is not None:
            most[quantity.joint] = max(most.get(quantity.joint, 0.0), float(study.largest[i]))
    kept = set(sorted(most, key=lambda j: -most[j])[:MOST])
    return [j for j in most if j in kept]


def _by_joint(
    study: ToleranceStudy, joints: Sequence[str], kind: str, values: NDArray[Any]
) -> NDArray[Any]:
    """Values of one kind of force, not a number where a joint has none, (n,)."""
    at = {(q.joint, q.kind): float(v) for q, v in zip(study.quantities, values, strict=True)}
    return np.array([at.get((j, kind), np.nan) for j in joints])


def _force_figure(study: ToleranceStudy, key: str, published: Published | None) -> Figure | None:
    joints = _joints(study)
    if not joints:
        return None
    limits = {
        kind: 1e-3 * np.where(np.isfinite(found), found, np.nan)
        for kind, *_ in STYLES
        for found in [_by_joint(study, joints, kind, study.limit)]
    }
    values = {float(v) for some in limits.values() for v in some if np.isfinite(v)}
    same = len(values) == 1
    bars = []
    for kind, colour, pattern in STYLES:
        found = 1e-3 * np.nan_to_num(_by_joint(study, joints, kind, study.largest))
        if not np.any(found):
            continue
        printed = None
        if published is not None:
            printed = 1e-3 * np.array([published.values.get((j, kind), np.nan) for j in joints])
        bars.append(
            ForceBars(
                f"worst case, {kind}",
                found,
                colour,
                pattern,
                printed,
                f"{published.name}, {kind}" if published else "",
                None if same else limits[kind],
            )
        )
    across = {f"limit {significant(v)} kN": v for v in values} if same else {}
    words = " The dashed line is the limit." if across else ""
    if published is not None:
        words += " White markers are the published numbers."
    return Figure(
        f"forces-{key}",
        f"{study.title}: worst-case force of each joint.{words}",
        force_bars(joints, bars, "force (kN)", across),
        f"Bars of the worst-case radial and axial force of each joint of {study.title}, with "
        "limits.",
        f"{key}-forces.csv",
        460,
    )


def _force_table(study: ToleranceStudy, key: str) -> Table:
    found = study.distribution
    poses = len(study.poses) > 1
    limited = bool(np.any(np.isfinite(study.limit)))
    units = {study.quantities[i].unit for i in loaded(study)}
    mixed = len(units) > 1
    unit = "" if mixed or not units else UNITS[next(iter(units))][0]
    columns = [Column("joint", "", False), Column("", "", False)]
    columns += [Column("unit", "", False)] if mixed else []
    columns.append(Column("worst case", unit))
    shares = [s for s in SHOWN if found is not None and s in found.shares]
    columns += [Column(f"{100 * s:g} % below", unit) for s in shares]
    common = {float(v) for v in study.limit[loaded(study)]}
    each = limited and len(common) > 1
    columns += [Column("limit", unit)] if each else []
    columns += [Column("share of limit")] if limited else []
    columns.append(Column("largest contributor", "", False))
    if poses:
        columns.append(Column("worst pose", "", False))
    top = governing(study)
    top_unit = "N" if top is None else study.quantities[top].unit
    rows: list[tuple[int, str, list[str | Cell]]] = []
    for i in loaded(study):
        q = study.quantities[i]
        text = shown(float(study.largest[i]), q.unit)
        row: list[str | Cell] = [
            q.kind.removesuffix(" force"),
            *([UNITS[q.unit][0]] if mixed else []),
            text,
        ]
        if found is not None:
            row += [
                shown(float(found.values.quantiles[i, found.shares.index(s)]), q.unit)
                for s in shares
            ]
        if limited:
            if np.isfinite(study.limit[i]):
                use = float(study.utilisation[i])
                tone: Tone = "good" if use <= 0.8 else "fair" if use <= 1 else "poor"
                row += [shown(float(study.limit[i]), q.unit)] if each else []
                row.append(Cell(f"{100 * use:.0f} %", tone))
            else:
                row += ["none", ""] if each else [""]
        row.append(main_cause(study, i))
        if poses:
            row.append(pose(study, int(study.worst_pose[i])))
        rows.append((i, q.joint or "", row))
    caption = f"{study.title}: forces that the tolerances can lock in"
    if limited and not each:
        caption += f", limit {shown(common.pop(), top_unit)} {UNITS[top_unit][0]} each"
    if found is not None and poses:
        caption += f"; quantiles at {pose(study, study.governing)}"
    return Table(caption, columns, _same(rows, study, top), f"{key}-forces.csv")


def _same(
    rows: Sequence[tuple[int, str, list[str | Cell]]], study: ToleranceStudy, top: int | None
) -> list[list[str | Cell]]:
    """Rows of joints that say the same as one; the largest first where they are many."""
    found: dict[tuple[str, ...], list[tuple[int, str, list[str | Cell]]]] = {}
    for row in rows:
        key = tuple(c.text if isinstance(c, Cell) else c for c in row[2])
        found.setdefault(key, []).append(row)
    groups = list(found.values())
    if len(groups) > LONGEST:
        groups.sort(key=lambda some: -float(study.largest[some[0][0]]))
    return [
        [
            names([joint for _, joint, _ in some]),
            f"{some[0][2][0]}{', governs' if any(i == top for i, *_ in some) else ''}",
            *some[0][2][1:],
        ]
        for some in groups
    ]


def _force_file(study: ToleranceStudy, key: str) -> DataFile:
    found = study.distribution
    shares = () if found is None else found.shares
    heads = [part for s in shares for part in (f"q{s:g}", f"q{s:g}_low", f"q{s:g}_high")]
    rows = []
    for i, q in enumerate(study.quantities):
        row: list[Any] = [q.joint or "tool", q.kind, " ".join(q.directions), q.unit]
        row.append(float(study.largest[i]))
        if found is not None:
            spread = found.values
            for n in range(len(shares)):
                row += [float(a[i, n]) for a in (spread.quantiles, spread.low, spread.high)]
        limit = float(study.limit[i])
        row += [limit, float(study.utilisation[i])] if np.isfinite(limit) else [None, None]
        row += [study.contributor(i) or "", study.poses[int(study.worst_pose[i])]]
        rows.append(row)
    return csv_file(
        f"{key}-forces.csv",
        "worst-case forces and places of the tool with quantiles, limits and causes, SI",
        [
            "joint",
            "kind",
            "directions",
            "unit",
            "worst_case",
            *heads,
            "limit",
            "utilisation",
            "contributor",
            "worst_pose",
        ],
        rows,
    )


def spread_blocks(study: ToleranceStudy, key: str) -> tuple[list[Block], list[DataFile]]:
    """Histograms of the governing radial and axial force, the worst case marked."""
    found = study.distribution
    picked = [i for kind, *_ in STYLES if (i := governing(study, kind)) is not None]
    if found is None or not picked:
        return [], []
    file = f"{key}-histograms.csv"
    figures, rows = [], []
    for i in picked:
        q, spread = study.quantities[i], found.values
        quantiles = {
            f"{100 * s:g} %": 1e-3 * float(spread.quantiles[i, n])
            for n, s in enumerate(found.shares)
            if s in (0.5, 0.95, 0.99)
        }
        edges, counts = spread.edges[i], spread.counts[i]
        slug, limit = q.kind.replace(" ", "-"), float(study.limit[i])
        figures.append(
            Figure(
                f"spread-{key}-{slug}",
                f"{label(q)}: {found.samples:,} assemblies; black: the exact worst case.",
                histogram(
                    1e-3 * edges,
                    counts,
                    1e-3 * float(spread.worst[i]),
                    quantiles,
                    f"{q.kind} (kN)",
                    # a limit far beyond would leave most of the plot empty
                    1e-3 * limit if limit <= FAR * float(spread.worst[i]) else None,
                ),
                f"Histogram and cumulative share of the {label(q)}, with quantiles and the worst "
                "case.",
                file,
                400,
            )
        )
        rows += [
            [label(q), float(a), float(b), int(c)]
            for a, b, c in zip(edges[:-1], edges[1:], counts, strict=True)
        ]
    i = picked[0]
    spread = found.values
    reach = 100 * float(spread.largest[i] / spread.worst[i])
    distributions = sorted({t.distribution for t in study.tolerances})
    where = f" at {pose(study, study.governing)}" if len(study.poses) > 1 else ""
    text = (
        f"{found.samples:,} assemblies{where}, {METHODS.get(found.method, found.method)}; each "
        f"deviation lies {' or '.join(_FALLS[d] for d in distributions)}. The largest sampled "
        f"{label(study.quantities[i])} is {reach:.1f} % of the exact worst case, which no sample "
        "can exceed. The data file gives the quantiles with their confidence intervals "
        f"({found.confidence})."
    )
    blocks: list[Block] = [Text(text), Row(tuple(figures), 380)]
    if found.utilisation is not None:
        use = found.utilisation
        over = ", ".join(
            f"{100 * s:g} % of the assemblies stay below {100 * float(v):.0f} %"
            for s, v in zip(found.shares, use.quantiles, strict=True)
        )
        blocks.append(Text(f"The largest share of a limit in any joint of an assembly: {over}."))
    content = csv_file(file, "histograms of sampled forces, N", _HISTOGRAM, rows)
    return blocks, [content]


METHODS = {"monte_carlo": "Monte Carlo", "quasi_monte_carlo": "quasi-Monte Carlo"}

_HISTOGRAM = ("quantity", "from_N", "to_N", "samples")

_FALLS = {
    "surface": "anywhere on the surface of its zone",
    "uniform": "anywhere in its zone",
    "normal": (
        "about the middle of its zone, normally distributed with its limit at three standard "
        "deviations"
    ),
}


def cause_blocks(study: ToleranceStudy, key: str) -> tuple[list[Block], list[DataFile]]:
    """Share of each tolerance in each worst-case force."""
    joints = set(_joints(study))
    some = [
        i
        for i in loaded(study)
        if study.quantities[i].unit == "N" and study.quantities[i].joint in joints
    ]
    if not some:
        return [], []
    names = [t.name for t in study.tolerances]
    shares = {n: 100 * study.shares[some, t] for t, n in enumerate(names)}
    if len(names) > CAUSES:
        shares = _alike(shares)
    chart = told_apart(shares, CAUSES)
    if float(np.max(chart.get(REST, 0.0))) <= LITTLE:
        chart.pop(REST, None)
    picked = [study.quantities[i] for i in some]
    categories = [f"{q.joint}, {q.kind.removesuffix(' force')}" for q in picked]
    file = f"{key}-shares.csv"
    figure = Figure(
        f"shares-{key}",
        f"{study.title}: contribution of each tolerance to each worst-case force.",
        stacked_shares(categories, chart, "share"),
        "Stacked bars: share of each tolerance in the worst case of each force.",
        file,
        150 + 24 * len(some),
    )
    rows = [
        [label(q), *(float(v) if study.largest[i] else None for v in study.shares[i])]
        for i, q in enumerate(study.quantities)
    ]
    what = "share of each tolerance in each worst case"
    return [figure], [csv_file(file, what, ["quantity", *names], rows)]


def _alike(shares: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """Shares of tolerances whose names differ by their numbers alone, added up."""
    return {
        word(group.names) or group.label: np.sum([shares[name] for name in group.names], axis=0)
        for group in grouped(dict.fromkeys(shares, ()))
    }
