"""Every tutorial goes from an empty folder to its end, and prints what its page says."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.docs.tutorial import TUTORIALS, Session, cells


def test_there_are_tutorials() -> None:
    assert [page.stem for page in TUTORIALS] == [
        "01-three-rps",
        "02-gantry-on-granite",
        "03-hexapod-with-bearings",
        "04-hammer-test",
    ]


@pytest.mark.parametrize("page", TUTORIALS, ids=lambda page: page.stem)
def test_a_tutorial_runs_from_an_empty_folder(page: Path, tmp_path: Path) -> None:
    Session(page, tmp_path).follow(slow=False)


@pytest.mark.slow
@pytest.mark.parametrize(
    "page",
    [page for page in TUTORIALS if any(c.slow for c in cells(page))],
    ids=lambda page: page.stem,
)
def test_a_tutorial_runs_with_its_long_commands(page: Path, tmp_path: Path) -> None:
    Session(page, tmp_path).follow(slow=True)
