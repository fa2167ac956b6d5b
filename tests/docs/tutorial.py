"""A tutorial is one way from an empty folder to its end: its cells are run in their order.

A fenced block whose first line is a comment with nothing but the name of a file (`# head.toml`) is
written to that file, behind what stands there already. Commands run in the same folder, the Python
blocks are one session in it, and a text block is what the Python block before it prints. What
`<!-- notebook: EXPRESSION -->` says is shown in the notebook alone. A block after `<!-- slow -->`
is left out of the quick run.
"""

from __future__ import annotations

import contextlib
import re
import sys
from dataclasses import dataclass
from pathlib import Path

from tests.docs.markdown import ROOT
from tests.docs.running import hold_console, matches, run_python

TUTORIALS = sorted((ROOT / "docs" / "tutorials").glob("[0-9]*.md"))

FENCE = re.compile(
    r"(?P<slow><!-- slow -->\n+)?^```(?P<language>\w+)\n(?P<text>.*?)^```\n"
    r"|^<!-- notebook: (?P<shown>.*?) -->\n",
    re.MULTILINE | re.DOTALL,
)
NAMED = re.compile(r"# ([\w-]+\.\w+)\n")


@dataclass(frozen=True)
class Cell:
    """Words, or something to run; `file` is what a block is written to."""

    kind: str
    text: str
    line: int = 0
    slow: bool = False
    file: str = ""


def cells(page: Path) -> list[Cell]:
    """Everything on a page, in its order."""
    text = page.read_text(encoding="utf-8")
    made, end = [], 0
    for match in FENCE.finditer(text):
        made.append(Cell("words", text[end : match.start()]))
        end = match.end()
        line = text.count("\n", 0, match.start()) + 2
        if match["shown"]:
            made.append(Cell("shown", match["shown"], line))
            continue
        named = NAMED.match(match["text"])
        made.append(
            Cell(
                "file" if named else match["language"],
                match["text"][named.end() :] if named else match["text"],
                line,
                bool(match["slow"]),
                named[1] if named else "",
            )
        )
    made.append(Cell("words", text[end:]))
    return [c for c in made if c.kind != "words" or c.text.strip()]


class Session:
    """One reader who follows a page in a folder of their own."""

    def __init__(self, page: Path, folder: Path) -> None:
        self.page, self.folder = page, folder
        self.names: dict[str, object] = {"__name__": "__main__"}
        self._printed = ""

    def follow(self, *, slow: bool) -> dict[str, object]:
        """Run the page, in the folder; what its Python session knows at the end."""
        sys.path.insert(0, str(self.folder))
        known = set(sys.modules)
        try:
            with contextlib.chdir(self.folder):
                for cell in cells(self.page):
                    if slow or not cell.slow:
                        self._do(cell)
        finally:
            sys.path.remove(str(self.folder))
            for name in set(sys.modules) - known:
                # a module that the page wrote is not the one of the next page
                if getattr(sys.modules[name], "__file__", "") == str(self.folder / f"{name}.py"):
                    del sys.modules[name]
        assert self._printed == "", f"{self.page.name} does not show what its last block printed"
        return self.names

    def _do(self, cell: Cell) -> None:
        where = f"{self.page.name}:{cell.line}"
        if cell.kind == "file":
            with (self.folder / cell.file).open("a", encoding="utf-8") as file:
                file.write(cell.text)
        elif cell.kind == "python":
            assert self._printed == "", f"{where}: what was printed before is not shown"
            self._printed = run_python(cell.text, self.page, cell.line, self.names)
        elif cell.kind == "shown":
            shown = eval(cell.text, self.names)  # noqa: S307 - our own pages
            assert shown._repr_html_(), f"{where}: {cell.text} shows nothing in a notebook"
        elif cell.kind == "text" and self._printed:
            assert matches(cell.text, self._printed), (
                f"{where} says\n{cell.text}but got\n{self._printed}"
            )
            self._printed = ""
        elif cell.kind == "console":
            hold_console(cell.text, self.folder, where)
