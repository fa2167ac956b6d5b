"""Ranges of joint coordinates: alike ones together, each by itself behind a line that opens."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from strutwork.reports.alike import DIFFERS, label, pattern, word
from strutwork.reports.content import Block, Cell, Column, Details, Table, Text
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.numbers import significant
from strutwork.reports.pivot import Entry, pivoted

#: A coordinate that moves by less, mm or deg, stands still.
STILL = 1e-6

#: Most members of a group side by side.
MOST_COLUMNS = 8


@dataclass(frozen=True)
class JointRange:
    """What a joint coordinate does over the workspace, mm or deg.

    Parameters
    ----------
    joint, direction : str
    driven : bool
    home, low, high : float
    limits : (float, float) or None
        None where there are none.
    """

    joint: str
    direction: str
    driven: bool
    home: float
    low: float
    high: float
    limits: tuple[float, float] | None

    @property
    def name(self) -> str:
        """As commands take it."""
        return f"{self.joint}:{self.direction}"

    @property
    def unit(self) -> str:
        """Of its numbers."""
        return "deg" if self.direction.startswith("r") else "mm"

    @property
    def kind(self) -> tuple[str, str, bool]:
        """What coordinates alike have in common."""
        return pattern(self.joint), self.direction, self.driven


def range_blocks(ranges: Sequence[JointRange], data: str) -> list[Block]:
    """A table with a row for coordinates alike, and those of each behind a line that opens.

    Parameters
    ----------
    ranges : sequence of JointRange
    data : str
        File that holds each by itself.
    """
    still = [r for r in ranges if r.high - r.low <= STILL]
    groups: dict[tuple[str, str, bool], list[JointRange]] = {}
    for one in sorted(ranges, key=lambda r: not r.driven):
        if one not in still:
            groups.setdefault(one.kind, []).append(one)
    blocks: list[Block] = [_table(list(groups.values()), data)]
    several = [group for group in groups.values() if len(group) > 1]
    if several:
        blocks[:0] = [
            Text(
                "Joints whose names differ only in their numbers stand in one row, with the "
                "least and the largest of all of them."
            )
        ]
    blocks += _each(several, data)
    if still:
        blocks.append(Text(f"These do not move: {_names(still)}."))
    return blocks


def range_file(ranges: Sequence[JointRange], name: str) -> DataFile:
    """Every coordinate by itself as CSV."""
    return csv_file(
        name,
        "home, least and largest value of every joint coordinate over the workspace, mm or deg",
        ["joint", "direction", "driven", "unit", "home", "least", "largest", "low", "high"],
        [
            [
                *(r.joint, r.direction, r.driven, r.unit, r.home, r.low, r.high),
                *((None, None) if r.limits is None else r.limits),
            ]
            for r in ranges
        ],
    )


def _table(groups: Sequence[Sequence[JointRange]], data: str) -> Table:
    rows = []
    for group in groups:
        first = group[0]
        homes = sorted({round(r.home, 6) + 0.0 for r in group})
        limits = {_limits(r) for r in group}
        rows.append(
            [
                _title(group),
                "drive" if first.driven else "passive",
                first.unit,
                _number(homes[0]) if len(homes) == 1 else _span(homes[0], homes[-1]),
                _number(min(r.low for r in group)),
                _number(max(r.high for r in group)),
                limits.pop() if len(limits) == 1 else DIFFERS,
            ]
        )
    columns = (
        Column("joint coordinate", "", False),
        Column("", "", False),
        Column("unit", "", False),
        Column("home"),
        Column("least"),
        Column("largest"),
        Column("limits", "", False),
    )
    return Table("Joint coordinates", columns, rows, data)


def _each(groups: Sequence[Sequence[JointRange]], data: str) -> list[Block]:
    """Least to largest of each member, members side by side; groups of one size in one table."""
    families: dict[tuple[str, ...], list[Sequence[JointRange]]] = {}
    for group in groups:
        if len(group) <= MOST_COLUMNS:
            families.setdefault(tuple(_member(r) for r in group), []).append(group)
    blocks: list[Block] = []
    for members, family in families.items():
        entries = [
            Entry(
                [_title(group), one.unit],
                member,
                # one number above the other: six spans side by side are too wide
                [Cell(_number(one.low), "plain", f"to {_number(one.high)}")],
            )
            for group in family
            for member, one in zip(members, group, strict=True)
        ]
        table = pivoted(
            "Least to largest of each",
            [Column("joint coordinate", "", False), Column("unit", "", False)],
            [Column("")],
            entries,
            data,
        )
        blocks.append(Details(f"Each by itself: {label(members)}", (table,)))
    return blocks


def _title(group: Sequence[JointRange]) -> str:
    if len(group) == 1:
        return group[0].name
    joints = [r.joint for r in group]
    common = word(joints)
    if not common:
        return f"{label(joints)}, {group[0].direction}"
    return f"{common} ({len(group)}), {group[0].direction}"


def _member(one: JointRange) -> str:
    """What tells it from those alike: `leg1` of `leg1/ram`."""
    return one.joint.partition("/")[0]


def _names(ranges: Sequence[JointRange]) -> str:
    found: dict[tuple[str, str, bool], list[JointRange]] = {}
    for one in ranges:
        found.setdefault(one.kind, []).append(one)
    return "; ".join(_title(group) for group in found.values())


def _limits(one: JointRange) -> str:
    return "none" if one.limits is None else _span(*one.limits)


def _number(value: float) -> str:
    return significant(round(value, 6) + 0.0, 4)


def _span(low: float, high: float) -> str:
    return f"{_number(low)} to {_number(high)}"
