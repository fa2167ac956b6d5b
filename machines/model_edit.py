"""The text of a model file with other numbers; its comments and its order stay.

tomlkit keeps comments, but gathers the tables of an array that stand apart, as joints between
beams do. So the text is cut at the headings of its tables, and each piece is edited alone.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from strutwork.errors import ModelError
from strutwork.machines.model_numbers import Steps

#: A line that may be the heading of a table.
_HEADING = re.compile(r"^[ \t]*\[.*$", re.MULTILINE)


@dataclass
class _Piece:
    """A table of the file.

    Parameters
    ----------
    steps : tuple of str and int
        Where its keys stand in the file.
    heading, body : str
    """

    steps: Steps
    heading: str
    body: str


def edited_text(text: str, values: Mapping[tuple[Steps, ...], float], remark: str) -> str:
    """The text with some numbers replaced, each in SI.

    Parameters
    ----------
    text : str
        Of a model file that can be read.
    values : mapping of places to float
        Of each number where it stands (`strutwork.machines.model_numbers.Number.places`), in the
        SI unit of its field, any unit.
    remark : str
        Comment behind each line that has a new number.

    Returns
    -------
    str

    Raises
    ------
    ModelError
        A number does not stand where it is said to.
    """
    pieces = _pieces(text)
    for places, value in values.items():
        for steps in places:
            _replace(pieces, steps, float(value), remark)
    return "".join(piece.heading + piece.body for piece in pieces)


def _pieces(text: str) -> list[_Piece]:
    found = [_Piece((), "", "")]
    counts: dict[Steps, int] = {}
    start = 0
    for match in _HEADING.finditer(text):
        # within an array or a text of several lines this is no heading: what precedes is not closed
        if not _reads(text[start : match.start()]):
            continue
        head = match[0] if match[0].endswith("\n") else match[0] + "\n"
        if not _reads(head):
            continue
        found[-1].body = text[start : match.start()]
        end = min(match.end() + 1, len(text))
        found.append(_Piece(_steps(match[0], counts), text[match.start() : end], ""))
        start = end
    found[-1].body = text[start:]
    return found


def _reads(text: str) -> bool:
    try:
        tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return False
    return True


def _steps(heading: str, counts: dict[Steps, int]) -> Steps:
    """Where the keys below a heading stand; `counts` knows the arrays of tables so far."""
    tables: Any = tomllib.loads(heading)
    steps: Steps = ()
    while tables:
        ((name, inner),) = tables.items()
        steps = (*steps, name)
        last = isinstance(inner, list)
        if last:
            counts[steps] = counts.get(steps, -1) + 1
            inner = inner[0]
        if steps in counts:
            steps = (*steps, counts[steps])
        tables = inner
    return steps


def _replace(pieces: list[_Piece], steps: Steps, value: float, remark: str) -> None:
    # the table that comes nearest to the number; keys with dots may stand in one further up
    nearest = [p for p in pieces if _begins(steps, p.steps)]
    for piece in sorted(nearest, key=lambda p: -len(p.steps)):
        changed = _edited(piece.body, steps[len(piece.steps) :], value, remark)
        if changed is not None:
            piece.body = changed
            return
    raise ModelError(
        ".".join(map(str, steps)), "is not in the text of the model file.", "Change it by hand."
    )


def _begins(steps: Steps, start: Steps) -> bool:
    same = (a == b or str(a).rstrip("_") == b for a, b in zip(steps, start, strict=False))
    return len(start) < len(steps) and all(same)


def _edited(body: str, steps: Steps, value: float, remark: str) -> str | None:
    """The keys of a table with one number replaced; None where it is not among them."""
    # a library for few commands
    import tomlkit  # noqa: PLC0415

    document = tomlkit.parse(body)
    at: Any = document
    line: tuple[Any, str] | None = None
    key: str | int | None = None
    for depth, step in enumerate(steps):
        key = _key(at, step)
        if key is None:
            return None
        if line is None and not isinstance(at[key], tomlkit.items.Table):
            line = (at, str(key))
        if depth == len(steps) - 2 and step == steps[-1] and isinstance(at[key], int | float):
            # three numbers are the diagonal of a matrix
            break
        if depth < len(steps) - 1:
            at = at[key]
    old = at[key]
    new = tomlkit.item(value)
    if getattr(old, "trivia", None) is not None:
        # what stood behind the number stays there
        new.trivia.comment_ws, new.trivia.comment = old.trivia.comment_ws, old.trivia.comment
        new.trivia.trail = old.trivia.trail
    at[key] = new
    if line is not None:
        item = line[0][line[1]]
        said = item.trivia.comment.lstrip("# ").rstrip()
        if remark not in said:
            item.comment(f"{remark}; {said}" if said else remark)
    return tomlkit.dumps(document)


def _key(at: Any, step: str | int) -> str | int | None:
    """A step as the file spells it: fields named like words of Python have a mark behind."""
    if isinstance(step, int):
        return step if isinstance(at, list) and step < len(at) else None
    return next((n for n in (step, step.rstrip("_")) if hasattr(at, "keys") and n in at), None)
