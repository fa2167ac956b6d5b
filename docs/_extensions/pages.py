"""What the site makes of pages that are read on the code host as well.

A comment `<!-- site ... -->` is text of the site alone: its tables of contents and cards. A page
with `<!-- shows FILE -->` is that file of the checkout. A link that leaves `docs` leads to the page
of the site that shows the same file.
"""

from __future__ import annotations

import posixpath
import re
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

ROOT = Path(__file__).parents[2]
SITE_ONLY = re.compile(r"^<!-- site\n(.*?)^-->$", re.MULTILINE | re.DOTALL)
SHOWS = re.compile(r"^<!-- shows (\S+) -->$", re.MULTILINE)
FENCED = re.compile(r"^(```|~~~).*?^\1\s*$", re.MULTILINE | re.DOTALL)
#: A table of contents of all pages of a folder.
GLOB = re.compile(r"^```\{toctree\}\n:glob:\n(?:.*\n)*?\n\*\n```\n", re.MULTILINE)
LINK = re.compile(r"\]\((?!\w+:)([^)#\s]+)")

#: Files and folders outside `docs`, and the pages that show them.
ELSEWHERE = {
    "README.md": "docs/index.md",
    "CONTRIBUTING.md": "docs/project/contributing.md",
    "CHANGELOG.md": "docs/project/changelog.md",
    "examples": "docs/reference/examples.rst",
    "examples/machines": "docs/reference/examples.rst",
    "examples/notebooks": "docs/reference/examples.rst",
    "meshes": "docs/reference/api/meshes.rst",
}


def linked(text: str, page: str, source: str) -> str:
    """The text of the file `source`, its links as they lead from `page`, both from the checkout."""
    folder = posixpath.dirname(page)

    def led(link: re.Match[str]) -> str:
        target = posixpath.normpath(posixpath.join(posixpath.dirname(source), link[1]))
        return f"]({posixpath.relpath(ELSEWHERE.get(target, target), folder)}"

    parts = []
    end = 0
    for fence in FENCED.finditer(text):
        parts += [LINK.sub(led, text[end : fence.start()]), fence[0]]
        end = fence.end()
    return "".join([*parts, LINK.sub(led, text[end:])])


def read(app: Sphinx, name: str, source: list[str]) -> None:
    """Change a page as it is read."""
    page = f"docs/{app.env.doc2path(name, base=False)}"
    text = SITE_ONLY.sub(r"\1", source[0])
    if len(list((ROOT / page).parent.glob("*.md"))) == 1:
        # a folder that has no pages yet beside its first one
        text = GLOB.sub("", text)
    shown = SHOWS.search(text)
    if shown is None:
        source[0] = linked(text, page, page)
        return
    app.env.note_dependency(str(ROOT / shown[1]))
    source[0] = linked((ROOT / shown[1]).read_text(encoding="utf-8"), page, shown[1])


def setup(app: Sphinx) -> dict[str, Any]:
    """Change each page before it is parsed."""
    app.connect("source-read", read)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
