"""The tutorials as notebooks: `python -m tests.docs.notebooks`, into examples/notebooks.

A file of a page becomes a cell that writes it, a command one that calls it, and what a page shows
as printed is left out, since the notebook prints it itself. No outputs are stored.
"""

from __future__ import annotations

import re
from pathlib import Path

import nbformat
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from tests.docs.markdown import ROOT
from tests.docs.running import steps
from tests.docs.tutorial import TUTORIALS, Cell, cells

NOTEBOOKS = ROOT / "examples" / "notebooks"

#: Plotly's own choice in a kernel leaves nothing in an exported page.
DRAWINGS = """\
import plotly.io

# drawings stay in a page to which the notebook is exported
plotly.io.renderers.default = "plotly_mimetype+notebook\""""

#: What is said of a page's blocks alone.
OF_PAGES = re.compile(
    r"A block that begins with the name of a file .*?follow a `\$`\.\n", re.DOTALL
)
PICTURE = re.compile(r"^!\[.*?\]\(.*?\)\n", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\((?!https?:|#)([^)#]*)(#[^)]*)?\)")


def _linked(words: str, page: Path) -> str:
    """Words whose links lead from the notebooks to where they lead from the page."""

    def moved(match: re.Match[str]) -> str:
        target = (page.parent / match[1]).resolve()
        if target in TUTORIALS:
            return f"]({target.stem}.ipynb)"
        return f"](../../{target.relative_to(ROOT).as_posix()}{match[2] or ''})"

    return LINK.sub(moved, words)


def _sources(page: Path) -> list[tuple[str, str]]:
    written: set[str] = set()
    begin = f"%mkdir -p {page.stem}\n%cd {page.stem}\n%env COLUMNS=100"
    made = [("code", begin), ("code", DRAWINGS)]
    for cell in cells(page):
        if cell.kind == "words":
            words = PICTURE.sub("", OF_PAGES.sub("", cell.text))
            made.append(("markdown", re.sub(r"\n{3,}", "\n\n", _linked(words, page)).strip()))
        elif cell.kind in {"python", "shown"}:
            made.append(("code", cell.text.strip()))
        elif cell.kind == "console":
            commands = "\n".join(command for command, _ in steps(cell.text))
            # without a terminal: no bars that are drawn again and again, and a failure is one
            made.append(("code", f"%%bash -e\n{commands}"))
        elif cell.kind == "file":
            made.append(("code", _writing(cell, again=cell.file in written)))
            written.add(cell.file)
    return [(kind, text) for kind, text in made if text]


def _writing(cell: Cell, *, again: bool) -> str:
    return f"%%writefile {'-a ' if again else ''}{cell.file}\n{cell.text.rstrip()}\n"


def notebook(page: Path) -> str:
    """Text of the notebook of a tutorial."""
    make = {"markdown": new_markdown_cell, "code": new_code_cell}
    made = new_notebook(
        cells=[make[kind](text, id=f"cell-{i}") for i, (kind, text) in enumerate(_sources(page))],
        metadata={
            "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}
        },
    )
    nbformat.validate(made)
    return nbformat.writes(made) + "\n"


def main() -> None:
    """Write all notebooks."""
    NOTEBOOKS.mkdir(exist_ok=True)
    for page in TUTORIALS:
        (NOTEBOOKS / f"{page.stem}.ipynb").write_text(notebook(page), encoding="utf-8")


if __name__ == "__main__":
    main()
