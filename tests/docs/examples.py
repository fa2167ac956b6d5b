"""What an example says about itself at its head, from which its page of the gallery is made.

The comment at the head of a model file, or the docstring of a program, begins with what it shows.
Then come, each on a line of its own, `$ COMMAND` to be run in the checkout, `> TEXT` for every line
of its output that is to be shown (the first one that holds the text), and `plot: case = NAME` or
`plot: mode = NUMBER` for a picture of a load case or a mode.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.docs.markdown import ROOT

FOLDER = ROOT / "examples"

#: What a machine without a command of its own is asked, and what of it is shown.
ASKED = ("strutwork solve {path}", ("│ x    │ N/µm", "│ y    │ N/µm", "│ z    │ N/µm"))

#: Programs are drawn by the machine that they are about.
MACHINES = {"07_scale_mit_ss1": "mit-ss1"}


@dataclass(frozen=True)
class Example:
    """A file among the examples, as its head has it."""

    file: Path
    number: int
    title: str
    words: str
    command: str
    shown: tuple[str, ...]
    plot: dict[str, Any]

    @property
    def name(self) -> str:
        """Name of its page, number first."""
        return f"{self.number:02d}-{re.sub(r'^[0-9]+_', '', self.file.stem).replace('_', '-')}"

    @property
    def picture(self) -> str:
        """Name of its picture."""
        return f"gallery-{self.name}"

    @property
    def path(self) -> str:
        """The file in the checkout."""
        return self.file.relative_to(ROOT).as_posix()

    @property
    def drawn(self) -> str:
        """The machine or the file that its picture is of."""
        return MACHINES.get(self.file.stem, str(self.file))


def _head(file: Path) -> str:
    text = file.read_text(encoding="utf-8")
    if file.suffix == ".py":
        return ast.get_docstring(ast.parse(text)) or ""
    lines = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.removeprefix("#").removeprefix(" "))
    return "\n".join(lines)


def _title(file: Path) -> str:
    if file.suffix == ".py":
        return _head(file).partition("\n")[0].rstrip(".")
    found = re.search(r'^title = "(.*)"$', file.read_text(encoding="utf-8"), re.MULTILINE)
    assert found, f"{file.name} has no title"
    return found[1]


def _example(file: Path, number: int) -> Example:
    lines = _head(file).splitlines()
    if file.suffix == ".py":
        lines = lines[1:]
    said = [line for line in lines if not re.match(r"[$>] |plot: ", line)]
    commands = [line[2:] for line in lines if line.startswith("$ ")]
    shown = tuple(line[2:] for line in lines if line.startswith("> "))
    drawn = dict(line[6:].split(" = ") for line in lines if line.startswith("plot: "))
    command, kept = (commands[0], shown) if commands else ASKED
    return Example(
        file,
        number,
        _title(file),
        "\n".join(said).strip(),
        command.format(path=file.relative_to(ROOT).as_posix()),
        kept,
        {key: int(value) if key == "mode" else value for key, value in drawn.items()},
    )


def _all() -> tuple[Example, ...]:
    numbered = sorted(p for p in FOLDER.glob("[0-9]*") if p.suffix in {".toml", ".py"})
    first = [_example(file, int(file.name[:2])) for file in numbered]
    last = first[-1].number
    machines = sorted((FOLDER / "machines").glob("*.toml"))
    return (*first, *(_example(file, last + i) for i, file in enumerate(machines, 1)))


EXAMPLES = _all()
