"""The pages use the words of the field: none that only this project's authors understand."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
#: Pages that are written from data of the documents, whose reasons are edited there.
GENERATED = {"published-results.md", "validation.md"}
PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    *(p for p in sorted((ROOT / "docs").rglob("*.md")) if p.name not in GENERATED),
    *sorted((ROOT / "docs").rglob("*.rst")),
]
#: A word, what to write instead, and what may stand around it.
WORDS: dict[str, tuple[str, str]] = {
    r"houses?": ("package, project", r"in-house"),
    r"rooms?": ("package, module", r"headroom|room temperature"),
    r"ours": ("computed, assumed, of Strutwork", ""),
    r"told": ("reported, stated, given", r"not told"),
    r"floors?": (
        "level; of a dependency: oldest version",
        r"floors\.txt|shop floor|the floor below",
    ),
    r"the found": ("the result", ""),
    r"odd(?= )": ("unusual", r"odd number|is odd"),
    r"(?:the|a|an|its|our|whose) whole(?! number)": ("entire, complete, all of", ""),
    r"our|we|us": ("Strutwork, or the passive with its reason", r"US\b|us\b(?=\")"),
    r"a (?:second|minute|metre|hour)(?= (?:on|for|with|of processor))": ("per", ""),
    r"thousands? of \w+ a second": ("per second", ""),
    r"freedoms": ("degrees of freedom", ""),
    r"giv(?:es?|ing) way": ("is (the most) compliant, deforms", ""),
    r"mend(?:s|ed|ing)?": ("correct, repair", "recommend"),
    r"(?:is|are) said": ("is stated", ""),
    r"look(?:s|ed|ing)? over": ("covers, studies", ""),
    r"of the literature": ("from the literature", ""),
    r"(?:turns?|turned|turning) back": ("reverses", ""),
    r"(?:goes|gone|went) on": ("continues", ""),
    r"in (?:the )?place of": ("instead of, replaces", ""),
    r"(?:rests?|rested) on": ("depends on", "the rest"),
    r"stands? (?:in|beside|for)": ("replaces, is beside, denotes", "stands? in line"),
    r"comes? of": ("results from", ""),
    r"taken for": ("assumed to be, mistaken for", "mistaken for"),
    r"for (?:it|them)sel(?:f|ves)": ("separately, independently", "speaks? for"),
    r"anew": ("again", ""),
    r"wholly": ("entirely", ""),
    r"passed over": ("ignored", ""),
    r"nowhere": ("not ... anywhere", ""),
    r"softest": ("most compliant", ""),
}


def prose(page: Path) -> str:
    """The text of a page without its code, whose lines stay where they are."""
    text = page.read_text(encoding="utf-8")

    def blank(match: re.Match[str]) -> str:
        return "\n" * match[0].count("\n")

    text = re.sub(r"^(```|~~~).*?^\1\s*$", blank, text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"<!--.*?-->", blank, text, flags=re.DOTALL)
    text = re.sub(r"``?[^`\n]*``?|\]\([^)]*\)", "``", text)
    # what is quoted is said by others
    return re.sub(r"\"[^\"\n]*\"", '""', text)


def private_words(text: str) -> list[str]:
    """Each line with a private word, and what to write instead."""
    found = []
    for number, line in enumerate(text.splitlines(), 1):
        for word, (instead, allowed) in WORDS.items():
            for match in re.finditer(rf"\b(?:{word})\b", line, re.IGNORECASE):
                around = line[max(0, match.start() - 14) : match.end() + 14]
                if not (allowed and re.search(allowed, around, re.IGNORECASE)):
                    found.append(f"{number}: {match[0]!r} (instead: {instead}): {line.strip()}")
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_a_page_has_no_private_words(page: Path) -> None:
    assert private_words(prose(page)) == []


@pytest.mark.parametrize(
    "line",
    [
        "The rooms stay importable.",
        "The value is ours, and the limit is told.",
        "It moves over the whole workspace.",
        "thousands of poses a second",
        "We chose a stiffness.",
        "with odd options",
        "It has six freedoms, and the rod gives way most.",
        "Beside it stands what a machine of the literature has in place of it.",
        "A drive that turns back goes on.",
    ],
)
def test_private_words_are_seen(line: str) -> None:
    assert private_words(line)


@pytest.mark.parametrize(
    "line",
    [
        "An odd number of points, and a whole number of cells.",
        "Poses that are found are counted; headroom is left.",
        "a table on two rails, in a second step",
        "The rest on the bed has three degrees of freedom; it was recommended in the place.",
    ],
)
def test_plain_words_are_not(line: str) -> None:
    assert private_words(line) == []
