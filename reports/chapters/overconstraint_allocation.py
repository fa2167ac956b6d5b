"""Which tolerances keep every force within its limit."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from strutwork.overconstraint import Allocation, Tolerance
from strutwork.reports.chapters.overconstraint import size_text, size_value
from strutwork.reports.content import Block, Cell, Column, Figure, Points, Table, Tone
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.figures.charts import Bars, grouped
from strutwork.reports.figures.theme import PALETTE
from strutwork.reports.numbers import significant

#: Sizes of a tolerance that reaches no limited force are left as they are.
UNTOUCHED = 1e-9

#: A tolerance loosened by more than this is as good as none.
MANY = 100


def allocation_blocks(
    tolerances: tuple[Tolerance, ...], found: Mapping[str, Allocation], key: str, limits: str
) -> tuple[list[Block], list[DataFile]]:
    """Allocated sizes beside the given ones.

    Parameters
    ----------
    tolerances : tuple of Tolerance
        As given.
    found : mapping of words to Allocation
        One or more objectives.
    key : str
    limits : str
        What the limits are, for the caption.
    """
    file = f"{key}-allocation.csv"
    columns = [Column("tolerance", "", False), Column("given")]
    for words in found:
        columns += [Column("size", "", True, words), Column("of the given", "", True, words)]
    rows: list[list[str | Cell]] = []
    for t, tolerance in enumerate(tolerances):
        row: list[str | Cell] = [tolerance.name, size_text(tolerance)]
        for allocation in found.values():
            scale = float(allocation.scale[t])
            tone: Tone = "poor" if scale < 1 - UNTOUCHED else "good"
            row += [
                size_value(tolerance, float(allocation.sizes[t])),
                Cell(_times(scale), tone),
            ]
        rows.append(row)
    points = []
    for words, allocation in found.items():
        most = float(np.max(allocation.utilisation))
        gap = "" if allocation.gap is None else f" Gap {allocation.gap:.1g}."
        points.append(
            f"{words}: {allocation.method}; {allocation.optimality}.{gap} Largest share of a "
            f"limit {100 * most:.2f} %; limited by {_active(allocation)}."
        )
    bars = [
        Bars(words, allocation.scale, PALETTE[i], ("", "/")[i % 2])
        for i, (words, allocation) in enumerate(found.items())
    ]
    names = [t.name for t in tolerances]
    blocks: list[Block] = [
        Figure(
            f"allocation-{key}",
            (
                "Ratio of the allocated to the given size of each tolerance; above one, the "
                "tolerance may be loosened."
            ),
            grouped(names, bars, "allocated / given size"),
            "Bars of the ratio of the allocated to the given size of each tolerance.",
            file,
            400,
        ),
        Table(f"Largest tolerances that meet {limits}", columns, rows, file),
        Points(tuple(points)),
    ]
    heads = ["tolerance", "given"]
    heads += [f"{what} ({words})" for words in found for what in ("size", "scale")]
    content = [
        [
            t.name,
            float(next(iter(found.values())).sizes[i] / next(iter(found.values())).scale[i]),
            *(float(v[i]) for a in found.values() for v in (a.sizes, a.scale)),
        ]
        for i, t in enumerate(tolerances)
    ]
    what = "allocated tolerances, m or rad, and their ratio to the given ones"
    return blocks, [csv_file(file, what, heads, content)]


def _times(scale: float) -> str:
    """A ratio of sizes; far beyond any use its digits say nothing."""
    return f"over {MANY} ×" if scale > MANY else f"{significant(scale)} ×"


def _active(allocation: Allocation) -> str:
    names = list(dict.fromkeys(allocation.active))
    more = f" and {len(names) - 3} more" if len(names) > 3 else ""
    return ", ".join(names[:3]) + more if names else "the tolerances' own bounds only"
