"""Long tables turned, parted and shortened."""

from __future__ import annotations

import pytest

from strutwork.errors import ModelError
from strutwork.reports.content import Cell, Chapter, Column, Details, Page, Table
from strutwork.reports.long_tables import LONGEST, parted, shortened
from strutwork.reports.page import render
from strutwork.reports.pivot import Entry, pivoted

HEADS = [Column("quantity", "", False)]
VALUES = [Column("published", "N"), Column("computed", "N")]


def texts(table: Table) -> list[list[str]]:
    return [[cell.text for cell in row] for row in table.cells]


def long_table(rows: int, groups: int = 1) -> Table:
    lines = [[f"row {k}", f"group {k * groups // rows}"] for k in range(rows)]
    return Table("Long", [Column("", "", False), Column("group", "", False)], lines, "long.csv")


def test_groups_stand_side_by_side_in_the_order_of_their_first() -> None:
    entries = [
        Entry(["force"], "B", ["1", Cell("2", "good")]),
        Entry(["force"], "A", ["3", "4"]),
        Entry(["moment"], "A", ["5", "6"]),
    ]
    table = pivoted("Forces", HEADS, VALUES, entries, "forces.csv")
    assert table.groups == [("", 1), ("B", 2), ("A", 2)]
    assert [c.label for c in table.columns][1:3] == ["B, published (N)", "B, computed (N)"]
    # what is missing stays empty, and tones stay with their numbers
    assert texts(table) == [["force", "1", "2", "3", "4"], ["moment", "", "", "5", "6"]]
    assert table.cells[0][2].tone == "good"
    assert table.data == "forces.csv"


def test_two_numbers_for_one_place_are_refused() -> None:
    entry = Entry(["force"], "A", ["1", "2"])
    with pytest.raises(ModelError, match='two entries for "force" of "A"'):
        pivoted("Forces", HEADS, VALUES, [entry, entry])
    with pytest.raises(ModelError, match="1 and 1 cells for 1 and 2 columns"):
        pivoted("Forces", HEADS, VALUES, [Entry(["force"], "A", ["1"])])


def test_rows_of_a_group_stay_together() -> None:
    tables = parted(long_table(15, 3), 1)
    assert [len(t.rows) for t in tables] == [10, 5]
    assert [t.caption for t in tables] == ["Long: group 0 and group 1", "Long: group 2"]
    # a column that says the same in every row is in the caption
    assert [len(t.columns) for t in tables] == [2, 1]
    assert texts(tables[1])[0] == ["row 10"]
    assert parted(long_table(LONGEST), 1) == (long_table(LONGEST),)


def test_no_row_is_lost_where_a_table_is_shortened() -> None:
    table = long_table(20)
    head, more = shortened(table, kept=1)
    assert isinstance(head, Table)
    assert isinstance(more, Details)
    (rest,) = more.items
    assert isinstance(rest, Table)
    assert len(head.rows) == LONGEST
    # a sum stays at the end of what lies open
    assert head.rows[-1] == table.rows[-1]
    assert [*head.rows[:-1], *rest.rows, head.rows[-1]] == table.rows
    assert head.data == rest.data == "long.csv"
    assert head.caption == table.caption != rest.caption


def test_a_page_shortens_every_table() -> None:
    chapters = tuple(Chapter(f"c{n}", "", (long_table(n),)) for n in (1, LONGEST + 1))
    html = render(Page("t", "s", chapters, "f"))
    assert html.count('<details class="more">') == 1
    assert "1 further row: Long" in html
    assert html.count("<tbody>") == 3
