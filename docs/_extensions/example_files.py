"""The page of examples: every file of the folder, with what it says of itself."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

ROOT = Path(__file__).parents[2]


def title_of(file: Path) -> str:
    """The title of a model file, or the name of another."""
    if file.suffix == ".toml":
        return str(tomllib.loads(file.read_text(encoding="utf-8")).get("title", file.stem))
    return file.stem


def listing(folder: str) -> list[str]:
    """ReStructuredText of the files of one folder of the checkout."""
    lines: list[str] = []
    for file in sorted((ROOT / folder).glob("*.*")):
        # counted from the folder of the page
        path = f"../../{file.relative_to(ROOT).as_posix()}"
        language = {".toml": "toml", ".py": "python"}.get(file.suffix, "text")
        lines += [
            f".. dropdown:: {file.name}: {title_of(file)}",
            "",
            f"   :download:`{file.name} <{path}>`",
            "",
            f"   .. literalinclude:: {path}",
            f"      :language: {language}",
            "",
        ]
    return lines


class ExampleFiles(SphinxDirective):
    """`example-files` with a folder of the checkout."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Parse the list."""
        return self.parse_text_to_nodes("\n".join(listing(self.arguments[0])))


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive."""
    app.add_directive("example-files", ExampleFiles)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
