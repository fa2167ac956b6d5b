"""Every example of the README and the docs runs and prints what the page says.

The Python blocks of a page are one program; a text block after one is what it prints. In a
console block the lines after `$ strutwork …` are what the command prints on standard output.
`...` stands for anything. A block after `<!-- slow -->` runs with the slow tests.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.docs.markdown import ROOT, Block, blocks, named
from tests.docs.running import hold_console, matches, run_python
from tests.docs.tutorial import TUTORIALS

PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
# the others are a way to be gone from its beginning: tests/docs/test_tutorials.py
LOOSE = [page for page in PAGES if page not in TUTORIALS]


def programs() -> list[Path]:
    return [page for page in LOOSE if any(b.language == "python" for b in blocks(page))]


def consoles() -> list[Block]:
    found = [block for page in LOOSE for block in blocks(page)]
    return [block for block in found if block.language == "console"]


@pytest.fixture
def workplace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder in which the examples are at hand, as a reader of the checkout has them."""
    (tmp_path / "examples").symlink_to(ROOT / "examples", target_is_directory=True)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.usefixtures("workplace")
@pytest.mark.parametrize("page", programs(), ids=named)
def test_python_blocks_run_and_print_what_the_page_says(page: Path) -> None:
    names: dict[str, object] = {"__name__": "__main__"}
    printed = ""
    for block in blocks(page):
        if block.language == "python":
            assert printed == "", f"{block}: the page does not show what was printed before"
            printed = run_python(block.text, page, block.line, names)
        elif block.language == "text" and printed:
            assert matches(block.text, printed), f"{block} says\n{block.text}but got\n{printed}"
            printed = ""
    assert printed == "", "the page does not show what its last block printed"


@pytest.mark.parametrize(
    "block",
    [pytest.param(b, marks=pytest.mark.slow if b.slow else (), id=str(b)) for b in consoles()],
)
def test_commands_run_and_print_what_the_page_says(block: Block, workplace: Path) -> None:
    hold_console(block.text, workplace, block)


def test_pages_link_to_what_exists() -> None:
    fenced = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
    links = [
        (page, target)
        for page in PAGES
        for target in re.findall(
            r"\]\(([^)#\s]+)[^)]*\)", fenced.sub("", page.read_text(encoding="utf-8"))
        )
        if "://" not in target
    ]
    broken = [
        f"{page.name}: {target}" for page, target in links if not (page.parent / target).exists()
    ]
    assert broken == []
