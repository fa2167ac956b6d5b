"""Reports use the words of the field: no text of theirs has a word that only its authors know."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FILES = [p for folder in ("reports", "papers") for p in sorted((ROOT / folder).rglob("*.py"))]

#: A word, and what to write instead.
WORDS = {
    r"houses?": "package, project",
    r"rooms?": "package, module",
    r"ours": "computed, assumed",
    r"told": "reported, stated",
    r"(?:the|a|an|its|our|whose) whole(?! number)": "entire, complete, all of",
    r"our|we|us": "the passive with its reason",
    r"(?:times|points|poses|cells|mm|m|N|rad|deg|steps|samples) a (?:second|minute|turn)": "per",
    r"(?:one|two|three|line|figure|row) (?:a|an) (?:pose|axis|joint|leg|machine|line)": "per",
    r"(?:one|spring|bearings|width|threads?) (?:a|an) (?:pin|strut|length|processor|column)": "per",
    r"(?:give|gives|giving) way": "deform, is the most compliant",
    r"turns? back": "reverse",
    r"(?:is|are) (?:not )?looked at|looked for": "checked, searched",
    r"(?:not )?at hand": "available",
    r"in sight|in view": "chosen to match",
    r"times as large as (?:they are|it is)": "times their true size",
    r"drag to turn": "drag to rotate",
    r"differ by their numbers alone": "differ only in their numbers",
    r"pushed at": "under a force at",
    r"(?<!is )asked for": "requested",
    r"anew": "again",
}

#: Texts that are no prose of the reports: names of traces, and what a document says itself.
KEYS = {"room", "the whole workspace"}


def literals(path: Path) -> Iterator[tuple[int, str]]:
    """Strings of a module that a reader may see: no docstrings."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    docstrings = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, kinds) and node.body and isinstance(node.body[0], ast.Expr)
    }
    for node in ast.walk(tree):
        if not (isinstance(node, ast.Constant) and isinstance(node.value, str)):
            continue
        if id(node) not in docstrings and node.value not in KEYS:
            yield node.lineno, node.value


def private_words(text: str) -> list[str]:
    return [
        f"{match[0]!r} (instead: {instead}): {text.strip()}"
        for word, instead in WORDS.items()
        for match in re.finditer(rf"\b(?:{word})\b", text, re.IGNORECASE)
        # plotly's key, and a country's short name in a citation
        if match[0] != "US"
    ]


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_no_text_has_a_private_word(path: Path) -> None:
    found = [f"line {n}: {said}" for n, text in literals(path) for said in private_words(text)]
    assert found == []


@pytest.mark.parametrize(
    "line",
    [
        "The value is ours.",
        "not told",
        "over the whole workspace",
        "our choice",
        "one line a pose",
        "the bars give way most",
        "A drive turns back.",
        "Collisions are not looked at.",
        "drawn 500 times as large as they are",
        "Drag to turn, scroll to zoom.",
        "Pushed at the tool it is softest.",
    ],
)
def test_private_words_are_seen(line: str) -> None:
    assert private_words(line)
