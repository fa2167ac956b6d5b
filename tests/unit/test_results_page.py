"""The page of all published results: made from files, and whole as it is committed."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest

from strutwork.errors import ModelError
from strutwork.papers.results_page import STATUSES, main
from strutwork.papers.statements import Statement, statements_file

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "published-results.md"


def row(*said: object) -> Statement:
    return Statement(*said, test="tests/t.py::test_it")  # type: ignore[arg-type, misc]


def test_numbers_and_words_stand_beside_each_other(tmp_path: Path) -> None:
    said = (
        row("Table 1", "Kx | blocked", "N/um", 2.0, 2.1, "calibrated", "fitted"),
        row("section 2", "ways", "", "four", "sixteen", "not reproducible", ""),
        row("section 3", "nothing of ours", "mm", 3.0, float("nan"), "predicted", "fitted"),
    )
    folder = tmp_path / "one"
    folder.mkdir()
    file = statements_file("a-2000", said)
    file.write(folder / file.name)
    main([str(tmp_path), str(tmp_path / "page.md")])
    text = (tmp_path / "page.md").read_text(encoding="utf-8")
    assert "| [a-2000](#a-2000) | 3 | 1 | 1 | 1 |" in text
    assert (
        "| Table 1 | Kx \\| blocked | 2\u00a0N/µm | 2.10\u00a0N/µm | +5.0 % | calibrated | 1 | T1 |"
        in text
    )
    assert "| section 2 | ways | four | sixteen | – | not reproducible |  | T1 |" in text
    assert "| section 3 | nothing of ours | 3\u00a0mm | – | – | predicted | 1 | T1 |" in text
    assert text.count("1. fitted") == 1
    assert "- T1: `tests/t.py::test_it`" in text


def test_a_folder_without_statements(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"strutwork report --all"):
        main([str(tmp_path), str(tmp_path / "page.md")])


def test_the_committed_page_is_whole() -> None:
    text = PAGE.read_text(encoding="utf-8")
    head, *documents = re.split(r"^## ", text, flags=re.MULTILINE)
    assert len(documents) == 5
    for document in documents:
        key = document.split("\n", 1)[0]
        rows = [re.split(r"(?<!\\)\|", s) for s in document.splitlines() if s.startswith("| ")][2:]
        counts = Counter(r[6].strip() for r in rows)
        assert set(counts) <= set(STATUSES)
        shown = " | ".join(str(counts[k]) for k in STATUSES)
        assert f"| [{key}](#{key}) | {len(rows)} | {shown} |" in head
    for path, function in re.findall(r"^- T\d+: `(.*?)::(.*?)`$", text, re.MULTILINE):
        assert re.search(
            rf"^def {function}\(", (ROOT / path).read_text(encoding="utf-8"), re.MULTILINE
        )
