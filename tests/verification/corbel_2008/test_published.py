"""Tables I and II of Corbel et al. 2008, and every statement with the test that holds it.

The citation stands in `test_actuation.py`.
"""

from __future__ import annotations

from math import isnan
from pathlib import Path

import pytest

from strutwork.machines import CATALOGUE
from strutwork.papers.corbel_2008.actuation import study_actuation
from strutwork.papers.corbel_2008.machine_chapters import table_1_rows, table_2_rows, text_rows
from strutwork.papers.corbel_2008.measuring import study_measuring
from strutwork.papers.corbel_2008.published import TABLES
from strutwork.papers.corbel_2008.statements import statements
from strutwork.papers.statements import Statement

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def said() -> tuple[Statement, ...]:
    return statements(study_actuation(), study_measuring())


def test_the_machines_have_the_printed_dimensions() -> None:
    for row in (*table_1_rows(), *table_2_rows()):
        assert row.computed == pytest.approx(row.published, rel=1e-12), row.quantity
        # a dimension that is taken is no prediction
        assert row.status == "calibrated"
    assert {r.quantity: r.status for r in text_rows()} == {
        "side of the workspace": "calibrated",
        "delta R for L = 800 mm": "predicted",
        "shortest leg": "calibrated",
        "longest leg": "calibrated",
    }
    for table in TABLES.values():
        names = [(value.row, value.quantity) for value in table]
        assert len(set(names)) == len(names)
        assert {row for row, _ in names} <= set(CATALOGUE)


def test_what_is_not_legible_has_no_number(said: tuple[Statement, ...]) -> None:
    lost = [s for s in said if isinstance(s.computed, float) and isnan(s.computed)]
    assert {s.what.partition(" ")[0] for s in lost} == {"another", "distance"}
    assert {s.status for s in said if "lost" in str(s.published)} == {"not reproducible"}
    assert all(s.reason for s in said if s.status != "predicted")


def test_every_statement_is_held_by_a_test_that_is_there(said: tuple[Statement, ...]) -> None:
    for one in said:
        file, _, name = one.test.partition("::")
        assert f"def {name}(" in (ROOT / file).read_text(encoding="utf-8"), one.test


def test_numbers_of_the_statements(said: tuple[Statement, ...]) -> None:
    """The texts carry the numbers that the tests of the studies hold."""
    text = "\n".join(f"{s.what}: {s.computed} {s.reason}" for s in said)
    for part in ("2.4591 at L = 800", "2.7112 at best for L = 700", "2.1245 for 1000 mm"):
        assert part in text
    # of the sign of eq. 6: 8.28 as the test of it, 4.83 as ours
    for part in (
        "would be 8.28 and not 4.83",
        "could be 426 mm, amplification 6.11 for 6.82",
        "6.044 times at the plate",
    ):
        assert part in text
