"""One line of a universal file, read by its columns."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from strutwork.errors import ModelError

#: Fortran leaves the E out of an exponent of three digits.
_BARE_EXPONENT = re.compile(r"(?<=[\d.])(?=[+-]\d{2,3}\Z)")

#: Whole numbers beyond this are none of a universal file.
MOST = 10**12


@dataclass(frozen=True)
class Columns:
    """One record: a line of fixed columns.

    Parameters
    ----------
    part : str
    text : str
    line : int
        Its number in the file.
    """

    part: str
    text: str
    line: int

    def numbers(self, widths: Sequence[int]) -> list[float]:
        """Numbers of the leading columns; empty ones are zero, missing ones are left out.

        Columns that no number crosses are read as columns; else the line is taken as numbers
        between blanks, which is how some programs write.

        Parameters
        ----------
        widths : sequence of int
            Characters of each column.
        """
        return [number(t, self.part, self.line) if t else 0.0 for t in self._cut(widths)]

    def whole(self, widths: Sequence[int], least: int = 1) -> list[int]:
        """As `numbers`, whole numbers only.

        Parameters
        ----------
        widths : sequence of int
            Characters of each column.
        least : int
            How many there must be.

        Raises
        ------
        ModelError
            Fewer than `least`, or one that is not whole.
        """
        found = self.numbers(widths)
        if len(found) < least or not all(abs(v) < MOST and v == int(v) for v in found):
            raise ModelError(
                self.part,
                f"cannot be read: line {self.line} should hold {least} whole numbers, and is "
                f'"{self.text.strip()[:60]}".',
                "Export the file again.",
            )
        return [int(v) for v in found]

    def _cut(self, widths: Sequence[int]) -> list[str]:
        text = self.text.rstrip()
        ends = np.cumsum(widths).tolist()
        pieces = [text[e - w : e] for w, e in zip(widths, ends, strict=True) if e - w < len(text)]
        tokens = text.split()
        crossed = any(
            e < len(text) and not text[e - 1].isspace() and not text[e].isspace() for e in ends
        )
        several = any(len(piece.split()) > 1 for piece in pieces)
        if not (crossed or several) or any(len(t) > max(widths) for t in tokens):
            return [piece.strip() for piece in pieces]
        return tokens[: len(widths)]


def number(text: str, part: str, line: int) -> float:
    """A number as Fortran writes it, with E, D or no letter before its exponent.

    Parameters
    ----------
    text : str
    part : str
        For messages.
    line : int
        Its number in the file, for messages.

    Raises
    ------
    ModelError
        No number.
    """
    plain = text.strip().upper().replace("D", "E")
    if "E" not in plain:
        plain = _BARE_EXPONENT.sub("E", plain)
    try:
        # Python reads 1_0 as ten
        return float(plain.replace("_", "x"))
    except ValueError:
        raise ModelError(
            part,
            f'cannot be read: "{text.strip()[:40]}" in line {line} is not a number.',
            "Export the file again.",
        ) from None
