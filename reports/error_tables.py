"""The error sheet and the errors along an axis as rows of numbers, SI."""

from __future__ import annotations

from typing import Any

import numpy as np

from strutwork.kinematics import DIRECTIONS
from strutwork.studies.error_answer import AxisErrors
from strutwork.studies.error_inputs import unit_of
from strutwork.studies.error_sheet import ErrorSheet


def sheet_heads() -> list[str]:
    """Heads of `sheet_rows`, with units."""
    parts = ("known", "plus or minus", "95 % within")
    return ["cause", "part", *(f"{what} {d}, {unit_of(d)}" for what in parts for d in DIRECTIONS)]


def sheet_rows(sheet: ErrorSheet) -> list[list[Any]]:
    """One row a part, a cause and the total: known, ± and 95 % of six directions, m and rad."""
    rows = [
        *((r.cause, r.part, ErrorSheet((r,))) for r in sheet.rows),
        *((cause, "all", sheet.of(cause)) for cause in sheet.causes),
        ("all", "all", sheet),
    ]
    return [
        [cause, part, *map(float, np.concatenate([one.mean, one.half_range, one.within()]))]
        for cause, part, one in rows
    ]


def axis_heads(one: AxisErrors) -> list[str]:
    """Heads of `axis_rows`, with units."""
    heads = [f"{n}, {unit_of(d)}" for n, d in zip(one.names, DIRECTIONS, strict=True)]
    return [f"{one.axis}, {unit_of(one.axis)}", *heads, *(f"plus or minus {h}" for h in heads)]


def axis_rows(one: AxisErrors) -> list[list[Any]]:
    """One row a position: the six errors and their ±, m and rad."""
    return [
        [float(v) for v in (at, *known, *half)]
        for at, known, half in zip(one.positions, one.errors, one.half_range, strict=True)
    ]
