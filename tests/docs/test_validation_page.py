"""The page of verification cases names every case that the tests hold."""

from __future__ import annotations

import re

import pytest

from tests.docs.markdown import ROOT
from tests.verification.page import page, said
from tests.verification.recorder import Recorder
from tests.verification.sources import FOLDER, cases

PAGE = ROOT / "docs" / "validation.md"


def test_the_page_holds_every_case_with_its_source_and_all_its_tests() -> None:
    # python -m tests.verification.page writes it
    sections = dict(
        re.findall(
            r"^## (.*?)\n(.*?)(?=^## |\Z)", PAGE.read_text("utf-8"), re.MULTILINE | re.DOTALL
        )
    )
    assert list(sections) == [case.title for case in cases()]
    for case in cases():
        text = sections[case.title]
        assert f"Tests: `{case.path}`" in text
        assert case.source in text
        assert [test for test in case.tests if said(test) not in text] == []


def test_most_cases_name_a_document() -> None:
    found = [case.path for case in cases() if not case.source]
    # closed forms and other programs are sources of another kind
    assert len(found) < len(cases()) / 4


def test_comparisons_are_noted_with_their_tolerance_and_reason() -> None:
    recorder = Recorder()
    file = FOLDER / "macneal_harder_1985" / "test_beams.py"
    assert (
        pytest.main([str(file), "-q", "-p", "no:xdist", "-p", "no:cacheprovider"], [recorder]) == 0
    )
    rows = recorder.rows(file.relative_to(ROOT).as_posix())
    straight = next(row for row in rows if row.test == "test_straight_beam")
    assert straight.count == 6
    assert "half of the last" in straight.reason
    assert all(row.share <= 1 for row in rows)
    twist = next(row for row in rows if row.quantity == "twist")
    assert (twist.expected, twist.tolerance) == (0.0341, 5e-05)
    assert twist.computed == pytest.approx(0.034109, abs=1e-6)
    text = page(recorder, {file.relative_to(ROOT).as_posix()})
    assert "| `twist` | 0.0341 | 0.034109 | ± 5e-05 | three digits of the later editions |" in text
