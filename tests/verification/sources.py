"""What the files of verification cases say of themselves."""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass, replace
from pathlib import Path

FOLDER = Path(__file__).parent
ROOT = FOLDER.parents[1]
#: Complaints of users are cases of this project, not from outside.
OWN = ("complaints", "test_users_complaints.py")


@dataclass(frozen=True)
class Case:
    """A file of tests.

    Parameters
    ----------
    path : str
        From the checkout.
    title : str
        First sentence of its docstring.
    source : str
        The documents of its BibTeX entries; empty where there is none.
    tests : tuple of str
        Names of its tests, in order.
    limits : str
        What the case does not show: the paragraph of its docstring that begins with "Limits:";
        empty where there is none.
    """

    path: str
    title: str
    source: str
    tests: tuple[str, ...]
    limits: str = ""


def _field(entry: str, name: str) -> str:
    found = re.search(rf"\b{name}\s*=\s*(?:\{{((?:[^{{}}]|\{{[^{{}}]*\}})*)\}}|(\w+))", entry)
    text = (found[1] or found[2]) if found else ""
    accents = {
        '\\"o': "ö",
        '\\"u': "ü",
        '\\"a': "ä",
        "\\'e": "é",
        "{'e}": "é",
        "\\&": "&",
        "--": "–",
    }
    for code, letter in accents.items():
        text = text.replace(code, letter)
    return " ".join(re.sub(r"[{}]", "", text).split())


def citation(text: str) -> str:
    """The BibTeX entries of a docstring in one line."""
    found = []
    for match in re.finditer(r"^@\w+\{.*?^\s*\}", text, re.MULTILINE | re.DOTALL):
        entry = match[0]
        authors = _field(entry, "author").replace(" and others", " et al.").replace(" and ", "; ")
        parts = [f"{authors}: {_field(entry, 'title')}" if authors else _field(entry, "title")]
        where = ("journal", "booktitle", "publisher", "institution", "school", "note", "year")
        parts.extend(_field(entry, name) for name in where)
        found.append(", ".join(part for part in parts if part))
    return "; ".join(found)


def cases() -> list[Case]:
    """All files, by folder and name."""
    result = []
    for file in sorted(FOLDER.rglob("test_*.py")):
        if set(OWN) & set(file.relative_to(FOLDER).parts):
            continue
        tree = ast.parse(file.read_text(encoding="utf-8"))
        text = ast.get_docstring(tree) or file.stem
        tests = [
            node.name
            for node in tree.body
            if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")
        ]
        title = " ".join(text.partition("\n\n")[0].split()).rstrip(".")
        path = file.relative_to(ROOT).as_posix()
        limits = re.search(r"^Limits: (.*?)(?=\n\n|\Z)", text, re.MULTILINE | re.DOTALL)
        said = " ".join(limits[1].split()) if limits else ""
        result.append(Case(path, title, citation(text), tuple(tests), said))
    # a file without an entry has the source of its folder
    folders = {Path(c.path).parent: c.source for c in reversed(result) if c.source}
    shared = [c.title for c in result]
    return [
        replace(
            c,
            source=c.source or folders.get(Path(c.path).parent, ""),
            title=c.title
            if shared.count(c.title) == 1
            else f"{c.title} ({Path(c.path).parent.name})",
        )
        for c in result
    ]
