"""Nastran bulk data as cards: small, large and free fields, continuations, includes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from strutwork.meshes.deck_lines import DeckLines

BEGIN = re.compile(r"\s*BEGIN[\s,]+BULK\b", re.IGNORECASE)
SUPER = re.compile(r"\s*BEGIN\s+(SUPER|BULK\s+\w+\s*=)", re.IGNORECASE)
INCLUDE = re.compile(r"\s*INCLUDE\b\s*(.*)$", re.IGNORECASE)
#: Statements before the bulk data, where no BEGIN BULK parts them from it.
CONTROL = re.compile(
    r"(SOL|CEND|ID|TIME|DIAG|INIT|ASSIGN|NASTRAN|SUBCASE|TITLE|SUBTITLE|LABEL|ECHO|SPC|LOAD|METHOD|"
    r"DISPLACEMENT|STRESS|ANALYSIS|SET|SUBTITLE)\b(\s+[^,]*|\s*=.*|)$",
    re.IGNORECASE,
)
EXPONENT = re.compile(r"([-+]?[\d.]+)([dD][-+]?|[-+])(\d+)$")


class Card(NamedTuple):
    """A card of the bulk data.

    Parameters
    ----------
    name : str
        In capitals, without the `*` of large fields.
    fields : list of str
        From the second on, blanks around them taken off.
    where : str
        Its place in the file.
    """

    name: str
    fields: list[str]
    where: str


def cards(lines: DeckLines, comments: list[str]) -> Iterator[Card]:
    """The cards of the bulk data.

    Parameters
    ----------
    lines : DeckLines
    comments : list of str
        Takes the comment lines before the first card.

    Raises
    ------
    ModelError
        A continuation without its card, a line of more than ten fields, data of superelements.
    """
    name = where = label = ""
    fields: list[str] = []
    begun = not has_begin(lines)
    for line in _included(lines):
        if line.startswith("$"):
            if not name:
                comments.append(line)
            continue
        if SUPER.match(line):
            raise lines.error("begins the data of a superelement", "Write one bulk data section.")
        if not begun or BEGIN.match(line):
            begun = begun or bool(BEGIN.match(line))
            continue
        text = line.split("$", 1)[0].rstrip()
        if not text.strip():
            continue
        head, found, next_label, large = _fields(lines, text)
        if head[:1] in {"+", "*", ""}:
            _check_follows(lines, name, head, label)
        else:
            if name:
                yield Card(name, fields, where)
            if head == "ENDDATA":
                return
            name, fields, where = head, [], lines.where
            if not _is_card(lines, name, text):
                name = ""
                continue
        fields += found
        # a short line ends with blank fields where another goes on
        fields += [""] * (-len(fields) % (4 if large else 8))
        label = next_label
    if name:
        yield Card(name, fields, where)


def _is_card(lines: DeckLines, name: str, text: str) -> bool:
    """Whether a line begins a card; ModelError where it is no statement before the cards."""
    if re.match(r"[A-Z][A-Z0-9]*$", name):
        return True
    if CONTROL.match(text.strip()):
        return False
    raise lines.error(
        f"holds {text[:60]!r}, which is not a card", "Check the line, or export it again."
    )


def _check_follows(lines: DeckLines, name: str, head: str, label: str) -> None:
    """ModelError where a continuation has no card before it, or another one."""
    if not name:
        raise lines.error("goes on with no card before it", "Check the line above it.")
    own = head[1:].strip()
    if own and label and own != label:
        raise lines.error(
            f"goes on with {head!r}, which is not the card before it",
            "Put each continuation after its card.",
        )


def has_begin(lines: DeckLines) -> bool:
    """Whether the file itself has BEGIN BULK.

    Parameters
    ----------
    lines : DeckLines
        At the beginning of the file.
    """
    return any(BEGIN.match(line) for line in lines.peek())


def _included(lines: DeckLines) -> Iterator[str]:
    """Lines, with those of included files in their place."""
    pending = ""
    for line in lines:
        text = line.split("$", 1)[0] if pending else line
        if pending:
            pending += text.strip()
        elif match := INCLUDE.match(line.split("$", 1)[0]):
            pending = match[1].strip()
        else:
            yield line
            continue
        quote = pending[:1]
        if quote in {"'", '"'} and pending.count(quote) < 2:
            continue
        lines.include(pending.strip().strip("'\""))
        pending = ""


def _fields(lines: DeckLines, text: str) -> tuple[str, list[str], str, bool]:
    """First field, data fields, the mark of what goes on, and whether fields are large."""
    if "," in text:
        found = [f.strip() for f in text.split(",")]
        head = found[0].upper()
        large = head.endswith("*") or head.startswith("*")
        most = 4 if large else 8
        data, rest = found[1 : most + 1], found[most + 1 :]
        if len([r for r in rest if r]) > 1 or (rest and rest[0] and rest[0][0] not in "+*"):
            raise lines.error(f"has more than {most} fields", "Let the line go on in another one.")
        label = rest[0] if rest else ""
        if data and data[-1][:1] == "+" and not re.match(r"\+[\d.]", data[-1]):
            label = data.pop()
    else:
        text = text.expandtabs(8)
        head = text[:8].strip().upper()
        large = head.endswith("*") or head.startswith("*")
        width, most = (16, 4) if large else (8, 8)
        body = text[8:72]
        data = [body[i : i + width].strip() for i in range(0, len(body), width)][:most]
        label = text[72:80].strip()
    if head != "*" and not head.startswith("*"):
        head = head.rstrip("*").rstrip()
    return head, data, label[1:].strip() if label[:1] in {"+", "*"} else label, large


def whole(text: str) -> int:
    """A whole number; blank is zero. ValueError where it is none.

    Parameters
    ----------
    text : str
        The field without blanks around it.
    """
    return int(text) if text else 0


def real(text: str) -> float:
    """A real number as Nastran has it: `1.5`, `1.5-3`, `1.D+2`; blank is zero.

    Parameters
    ----------
    text : str
        The field without blanks around it; ValueError where it is no number.
    """
    if not text:
        return 0.0
    try:
        return float(text)
    except ValueError:
        match = EXPONENT.match(text)
        if match is None:
            raise
        return float(f"{match[1]}E{match[2].strip('dD')}{match[3]}")
