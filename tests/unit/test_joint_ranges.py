"""Ranges of joint coordinates: alike ones in one row, each by itself below."""

from __future__ import annotations

from pathlib import Path

from strutwork.reports.content import Cell, Details, Table, Text
from strutwork.reports.joint_ranges import JointRange, range_blocks, range_file


def ranges() -> list[JointRange]:
    found = []
    for k in range(1, 7):
        leg = f"leg{k}"
        found += [
            JointRange(f"{leg}/hinge", "rz", False, 30.0 * (-1) ** k, -40.0 - k, 40.0, None),
            JointRange(f"{leg}/ram", "z", True, 600.0, 500.0 - k, 800.0 + k, (480.0, 900.0)),
            JointRange(f"{leg}/pin", "rx", False, 0.0, 0.0, 0.0, None),
        ]
    return found


def test_joints_alike_are_one_row() -> None:
    (table,) = (b for b in range_blocks(ranges(), "ranges.csv") if isinstance(b, Table))
    assert [[c.text for c in row] for row in table.cells] == [
        ["ram of the legs (6), z", "drive", "mm", "600.0", "494.0", "806.0", "480.0 to 900.0"],
        [
            *("hinge of the legs (6), rz", "passive", "deg", "−30.00 to 30.00"),
            *("−46.00", "40.00", "none"),
        ],
    ]


def test_each_leg_is_a_column_and_what_stands_still_a_sentence() -> None:
    blocks = range_blocks(ranges(), "ranges.csv")
    (more,) = (b for b in blocks if isinstance(b, Details))
    (table,) = more.items
    assert isinstance(table, Table)
    assert [c.title for c in table.columns[2:]] == [f"leg{k}" for k in range(1, 7)]
    assert table.cells[0][2] == Cell("499.0", "plain", "to 801.0")
    last = blocks[-1]
    assert isinstance(last, Text)
    assert last.text == "These do not move: pin of the legs (6), rx."


def test_the_file_has_every_coordinate(tmp_path: Path) -> None:
    range_file(ranges(), "ranges.csv").write(tmp_path / "ranges.csv")
    lines = (tmp_path / "ranges.csv").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 1 + 18
    assert lines[2].split(",")[:4] == ["leg1/ram", "z", "True", "mm"]
    assert lines[2].split(",")[-2:] == ["480.0", "900.0"]


def test_a_joint_by_itself_keeps_its_name() -> None:
    joint = JointRange("slide", "x", True, 0.0, -1.0, 1.0, None)
    (table,) = range_blocks([joint], "ranges.csv")
    assert isinstance(table, Table)
    assert table.cells[0][0].text == "slide:x"
