"""Numbers of a .msh section one after another, from text or binary."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError

Array = NDArray[Any]


class Values:
    """A cursor over the numbers of a file.

    Parameters
    ----------
    path : Path
        For messages.
    content : bytes
    position : int
        Where the section's numbers begin.
    binary : bool
    order : str
        `<` or `>`: the byte order of binary numbers.
    """

    def __init__(self, path: Path, content: bytes, position: int, *, binary: bool, order: str):
        self.path, self.content, self.position = path, content, position
        self.binary, self.order = binary, order
        self._text: Array | None = None
        self._at = 0
        self.section = ""

    def open_text(self, name: str) -> None:
        """Take the numbers of the section in which the cursor stands; text alone.

        Parameters
        ----------
        name : str
            Of the section, without its `$`.
        """
        self.section = name
        self._text, self._at = None, 0
        if self.binary:
            return
        end = self.content.find(b"$End" + name.encode(), self.position)
        if end < 0:
            raise self.cut()
        body = self.content[self.position : end]
        self.position = end
        try:
            with warnings.catch_warnings():
                # text that is no number ends the reading with a warning
                warnings.simplefilter("error")
                self._text = np.fromstring(body.decode("ascii"), sep=" ")
        except (DeprecationWarning, ValueError, UnicodeDecodeError):
            raise ModelError(
                str(self.path),
                f"${name} contains an entry that is not a number{self._first_wrong(body)}.",
                "The file is cut short or damaged: export it again.",
            ) from None

    def take(self, count: int, kind: str = "i") -> Array:
        """The next numbers, (count,).

        Parameters
        ----------
        count : int
            How many.
        kind : str
            `i` int, `d` double, `u` unsigned of 8 bytes, `U` of 4.
        """
        if count < 0:
            raise self.cut()
        if self._text is not None:
            found = self._text[self._at : self._at + count]
            if len(found) < count:
                raise self.cut()
            self._at += count
            return found if kind == "d" else self.whole(found)
        type_ = np.dtype(self.order + {"i": "i4", "d": "f8", "u": "u8", "U": "u4"}[kind])
        return self.records(np.dtype([("x", type_)]), count)["x"].astype(
            float if kind == "d" else np.int64
        )

    def records(self, type_: np.dtype[Any], count: int) -> Array:
        """Binary records, (count,); none is made before the file is known to hold them.

        Parameters
        ----------
        type_ : dtype
            Of one record, with its byte order.
        count : int
            How many.
        """
        size = type_.itemsize * count
        if count < 0 or self.position + size > len(self.content):
            raise self.cut()
        found = np.frombuffer(self.content, type_, count, self.position)
        self.position += size
        return found

    def whole(self, values: Array) -> Array:
        """Numbers of a text as whole ones, in the same shape; ModelError where they are none.

        Parameters
        ----------
        values : any shape
            As the text has them, no unit.
        """
        # beyond 2**53 a float is no exact number; NaN fails the comparison too
        fits = (np.abs(values) < 2.0**53) & (values == np.round(values))
        if not fits.all():
            raise ModelError(
                str(self.path),
                f"${self.section} holds {values[~fits].flat[0]:g} where a whole number belongs.",
                "The file is cut short or damaged: export it again.",
            )
        return values.astype(np.int64)

    def left(self) -> Array:
        """All numbers of a text section that are left, (n,)."""
        if self._text is None:
            raise self.cut()
        found = self._text[self._at :]
        self._at = len(self._text)
        return found

    def close(self) -> None:
        """Go past the end of the section; ModelError where numbers are left over."""
        if self._text is not None and self._at < len(self._text):
            raise ModelError(
                str(self.path),
                f"${self.section} has {len(self._text) - self._at} numbers more than it counts.",
                "Export the mesh again.",
            )
        tail = self.content[self.position : self.position + 200].lstrip()
        if not tail.startswith(b"$End" + self.section.encode()):
            raise self.cut()

    def cut(self) -> ModelError:
        """The error for a section that ends too soon."""
        return ModelError(
            str(self.path),
            f"ends before $End{self.section}: it is cut short or damaged.",
            "Export the mesh again.",
        )

    def _first_wrong(self, body: bytes) -> str:
        before = self.content[: self.position - len(body)].count(b"\n")
        for number, line in enumerate(body.split(b"\n"), start=before + 1):
            for word in line.split():
                try:
                    float(word)
                except ValueError:
                    return f", line {number}: {word[:40].decode('ascii', 'replace')!r}"
        return ""
