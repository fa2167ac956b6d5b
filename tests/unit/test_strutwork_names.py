"""Names written out: nothing hidden is left, nothing shown is changed."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from strutwork.csv_rows import RowWriter, csv_cell, csv_name
from strutwork.errors import ModelError
from strutwork.names import is_hidden, visible


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("\x1b[2J\x1b]0;PWN\x07tip", r"\x1b[2J\x1b]0;PWN\x07tip"),
        ("\x9b31m", r"\x9b31m"),
        ("a\u202eb\u2066c", r"a\u202eb\u2066c"),
        ("\udcff.toml", r"\xff.toml"),
        ("a\r\n\tb", r"a\r\n\tb"),
        ("\U000e0041", r"\U000e0041"),
        ("Grübler 東京 N/µm", "Grübler 東京 N/µm"),
        # Persian and a sign of several people keep what joins them
        ("می\u200cشود 👩\u200d🔧", "می\u200cشود 👩\u200d🔧"),
        ("a\u00a0b\u202fc", "a\u00a0b\u202fc"),
    ],
)
def test_hidden_characters_are_written_out(name: str, shown: str) -> None:
    assert visible(name) == shown


@given(st.text(st.characters()))
def test_what_is_shown_holds_nothing_hidden_and_encodes(name: str) -> None:
    shown = visible(name)
    shown.encode()
    assert not any(map(is_hidden, shown))
    assert visible(shown) == shown


def test_an_error_is_text_without_hidden_characters() -> None:
    error = ModelError("a\x1b[2J\nb", "holds \x9b.", "Do\nthis\u202e.")
    assert str(error) == "a\\x1b[2J\\nb: holds \\x9b.\nDo\nthis\\u202e."
    # what it was raised with stays for programs
    assert error.part == "a\x1b[2J\nb"


@pytest.mark.parametrize("name", ["=1", "+A1", "-A1", "@x", "\tx", "\rx", "＝1", "'x", "-"])  # noqa: RUF001
def test_formulas_are_marked(name: str) -> None:
    assert csv_cell(name) == "'" + name


@pytest.mark.parametrize("cell", ["-1.5e-09", "+3", "-.5", "leg1", "", -1.5, 3, None, True])
def test_numbers_and_other_names_stay(cell: object) -> None:
    assert csv_cell(cell) is cell


@given(st.lists(st.text(st.characters(exclude_categories=["Cs"])), min_size=1, max_size=4))
@settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_names_come_back_from_a_file(tmp_path: Path, names: list[str]) -> None:
    path = tmp_path / "names.csv"
    with path.open("w", encoding="utf-8", newline="") as file:
        RowWriter(file).writerow(names)
    with path.open(encoding="utf-8", newline="") as file:
        (row,) = csv.reader(file)
    assert [csv_name(cell) for cell in row] == names
    assert len({csv_cell(n) for n in names}) == len(set(names))
