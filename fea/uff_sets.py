"""A universal file cut into its data sets, and their records read by columns."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.uff_columns import MOST, Columns

Array = NDArray[Any]

#: A line that opens or closes a data set. Only a whole line counts: a record may end in -1.
DELIMITER = re.compile(rb"(?:\A|(?<=[\r\n])) {4}-1[ \t]*(?=[\r\n]|\Z)")

#: What may stand between the numbers of a binary set and the line that closes it.
_CLOSING = re.compile(rb"[\r\n]{0,4} {4}-1[ \t]*(?=[\r\n]|\Z)")

_TYPE = re.compile(rb"[ \t]*(\d{1,6})[ \t]*([bB]?)([^\r\n]*)(?:\r\n|\r|\n|\Z)")

_LINE_END = re.compile(rb"\r\n|\r|\n")

#: Lines of a binary function before its numbers, and numbers a line of it by ordinate type.
HEADER_LINES = 11
_WIDTH = {2: (4, 1), 4: (8, 1), 5: (4, 2), 6: (8, 2)}


@dataclass(frozen=True)
class DataSet:
    """One data set as it stands in the file.

    Parameters
    ----------
    part : str
        File, place and type, for messages.
    kind : int
    binary : bool
    fields : str
        Rest of the line that names the type.
    content : bytes
        Everything between that line and the closing one.
    line : int
        Number of the first line of `content` in the file.
    """

    part: str
    kind: int
    binary: bool
    fields: str
    content: bytes
    line: int

    def __repr__(self) -> str:
        return f"<DataSet {self.kind}{'b' * self.binary}: {len(self.content)} bytes>"


def data_sets(data: bytes, name: str) -> tuple[tuple[DataSet, ...], tuple[str, ...]]:
    """Cut a universal file into its data sets.

    Parameters
    ----------
    data : bytes
    name : str
        Of the file, for messages.

    Returns
    -------
    sets : tuple of DataSet
    notes : tuple of str
        What stands outside of them.

    Raises
    ------
    ModelError
        A data set that is not closed, or names no type.
    """
    found: list[DataSet] = []
    outside = 0
    at, line = 0, 1
    while (opening := DELIMITER.search(data, at)) is not None:
        outside += bool(data[at : opening.start()].strip())
        line += _lines_in(data, at, opening.end())
        start = _after_line(data, opening.end())
        part = f"{name}, data set {len(found) + 1}"
        head = _TYPE.match(data, start)
        if head is None:
            if not data[start:].strip():
                raise _open(name, "")
            raise ModelError(
                part,
                f"names no type in line {line + 1}.",
                "Export the file again, or remove the lines of this data set.",
            )
        kind, binary = int(head[1]), bool(head[2])
        part = f"{part} (type {kind})"
        first = line + 2
        if binary:
            end, at = _binary_end(data, head, part)
        else:
            closing = DELIMITER.search(data, head.end())
            if closing is None:
                raise _open(name, f" (type {kind})")
            end, at = closing.start(), closing.end()
        found.append(DataSet(part, kind, binary, _text(head[3]), data[head.end() : end], first))
        line += _lines_in(data, opening.end(), at)
    outside += bool(data[at:].strip())
    notes = ("lines outside of data sets",) if outside and found else ()
    return tuple(found), notes


def _lines_in(data: bytes, start: int, end: int) -> int:
    return data.count(b"\n", start, end) or data.count(b"\r", start, end)


def _after_line(data: bytes, at: int) -> int:
    ending = _LINE_END.match(data, at)
    return ending.end() if ending else at


def _open(name: str, kind: str) -> ModelError:
    return ModelError(
        name,
        f"is cut short: its last data set{kind} is not closed.",
        "Copy or export it again.",
    )


def _binary_end(data: bytes, head: re.Match[bytes], part: str) -> tuple[int, int]:
    """End of the numbers of a binary set and of its closing line.

    Bytes of numbers may look like a closing line: their count decides, by the header of the
    function or, failing that, by the field that counts them, which many programs fill wrongly.
    """
    start = head.end()
    lines: list[bytes] = []
    for _ in range(HEADER_LINES):
        ending = _LINE_END.search(data, start)
        if ending is None:
            raise _open(part.partition(", data set")[0], f" (type {int(head[1])})")
        lines.append(
            data[head.end() : ending.start()] if not lines else data[start : ending.start()]
        )
        start = ending.end()
    form = Columns(part, _text(lines[6]), 0).numbers([10, 10, 10])
    sizes = []
    if len(form) == 3 and int(form[0]) in _WIDTH and 0 <= form[1] < MOST:
        width, values = _WIDTH[int(form[0])]
        lines_of = int(form[1])
        if form[2] == 0:
            sizes += [lines_of * width * (values + 1), lines_of * (4 + width * values)]
        else:
            sizes.append(lines_of * width * values)
    counted = Columns(part, _text(head[3]), 0).numbers([6, 6, 12, 12])
    sizes += [int(counted[3])] if len(counted) > 3 and counted[3] > 0 else []
    for size in sizes:
        closing = _CLOSING.match(data, start + size)
        if closing is not None:
            return start + size, closing.end()
    if DELIMITER.search(data, start) is None:
        raise _open(part.partition(", data set")[0], f" (type {int(head[1])})")
    raise ModelError(
        part,
        f"is cut short or damaged: after the {sizes[0] if sizes else 0} bytes of numbers that its "
        "header counts there is no line of    -1.",
        "Copy it as a binary file, or export its functions as text (58).",
    )


def _text(raw: bytes) -> str:
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        return raw.decode("latin-1")


class Records:
    """The lines of a data set, one after the other.

    Parameters
    ----------
    source : DataSet
    """

    def __init__(self, source: DataSet) -> None:
        self.part = source.part
        self._lines = [_text(raw) for raw in _LINE_END.split(source.content)]
        self._first = source.line
        self._at = 0
        while self._lines and not self._lines[-1].strip():
            self._lines.pop()

    def __bool__(self) -> bool:
        return self._at < len(self._lines)

    def next(self) -> Columns:
        """The next line.

        Raises
        ------
        ModelError
            There is none.
        """
        if not self:
            raise ModelError(
                self.part,
                f"cannot be read: it is cut short after line {self._first + self._at - 1}.",
                "Export the file again.",
            )
        self._at += 1
        return Columns(self.part, self._lines[self._at - 1], self._first + self._at - 1)

    def skip(self, count: int) -> None:
        """Pass over lines that are not needed.

        Parameters
        ----------
        count : int
        """
        for _ in range(count):
            self.next()

    def numbers(self, count: int, width: int) -> list[float]:
        """So many numbers from as many lines of 80 characters at most as they fill.

        Parameters
        ----------
        count : int
            How many numbers.
        width : int
            Characters of each.
        """
        found: list[float] = []
        widths = [width] * (80 // width)
        while len(found) < count:
            record = self.next()
            found += record.numbers(widths)
            if not record.text.strip():
                break
        if len(found) != count:
            raise ModelError(
                self.part,
                f"cannot be read: line {self._first + self._at - 1} ends {len(found)} numbers "
                f"where {count} belong.",
                "Export the file again.",
            )
        return found

    def rest(self) -> Iterator[Columns]:
        """The lines that are left."""
        while self:
            yield self.next()


def head_and_body(source: DataSet, count: int) -> tuple[list[Columns], bytes]:
    """The first lines of a data set, and what follows them as it is.

    Parameters
    ----------
    source : DataSet
    count : int
        How many first lines.

    Raises
    ------
    ModelError
        Fewer lines.
    """
    lines, at = [], 0
    for i in range(count):
        ending = _LINE_END.search(source.content, at)
        if ending is None:
            raise ModelError(
                source.part,
                f"cannot be read: it is cut short after line {source.line + i - 1}.",
                "Export the file again.",
            )
        lines.append(
            Columns(source.part, _text(source.content[at : ending.start()]), source.line + i)
        )
        at = ending.end()
    return lines, source.content[at:]


def numbers_of(body: bytes, source: DataSet, widths: Sequence[int], count: int) -> Array:
    """Numbers of a block of text, (count,).

    Parameters
    ----------
    body : bytes
    source : DataSet
        For messages.
    widths : sequence of int
        Columns of a line.
    count : int
        So many are there; the last line may be filled up with zeros.
    """
    tokens = body.split()
    if len(tokens) >= count and max(map(len, tokens), default=0) <= max(widths):
        try:
            found = np.array(tokens, dtype=float)
        except ValueError:
            pass
        else:
            return found[:count] if _filled_up(found, count, len(widths)) else found
    values: list[float] = []
    for i, raw in enumerate(_LINE_END.split(body)):
        values += Columns(source.part, _text(raw), source.line + HEADER_LINES + i).numbers(widths)
    found = np.array(values)
    return found[:count] if _filled_up(found, count, len(widths)) else found


def _filled_up(found: Array, count: int, columns: int) -> bool:
    return count < len(found) < count + columns and not np.any(found[count:])
