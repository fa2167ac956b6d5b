"""The gallery's pages, one for each example: `python -m tests.docs.gallery [NAME ...]`.

Its pictures are drawn by `python -m tests.docs.pictures`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from tests.docs.examples import EXAMPLES, Example
from tests.docs.markdown import ROOT
from tests.docs.running import run_line

GALLERY = ROOT / "docs" / "gallery"


def output(example: Example) -> list[str]:
    """The lines of the output that the example wants shown, dots for what is between."""
    run = run_line(example.command, ROOT)
    assert run.returncode == 0, run.stderr
    lines, found = run.stdout.splitlines(), []
    for text in example.shown:
        start = found[-1] + 1 if found else 0
        found.append(next(i for i in range(start, len(lines)) if text in lines[i]))
    kept, last = [], -1
    for i in found:
        kept += ["..."] * (i > last + 1) + [lines[i].rstrip()]
        last = i
    return kept + ["..."] * (last < len(lines) - 1)


def page(example: Example, printed: Sequence[str]) -> str:
    """Its page, with these lines as the command's output."""
    console = "\n".join(printed)
    return f"""# {example.title}

<!-- written by python -m tests.docs.gallery, from the head of {example.path} -->

![{example.title}, drawn by Strutwork](../images/{example.picture}.png)

{example.words}

```console
$ {example.command}
{console}
```

The file: [{example.path}](../../{example.path}).
"""


def printed_on(text: str) -> list[str]:
    """The command's output as a page has it."""
    return text.partition("```console\n")[2].partition("```")[0].splitlines()[1:]


def main(names: Sequence[str]) -> None:
    """Write the pages of these names, or all, and take away those whose example is gone."""
    GALLERY.mkdir(exist_ok=True)
    for old in GALLERY.glob("[0-9]*.md"):
        if old.stem not in {example.name for example in EXAMPLES}:
            old.unlink()
    for example in EXAMPLES:
        if not names or example.name in names:
            text = page(example, output(example))
            (GALLERY / f"{example.name}.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
