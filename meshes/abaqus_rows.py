"""Data lines of *ELEMENT, taken one after another: cells with their nodes, others by number."""

from __future__ import annotations

import re
from array import array
from collections.abc import Callable

from strutwork.errors import ModelError
from strutwork.meshes import limits
from strutwork.meshes.abaqus_scope import Elements, Scope
from strutwork.meshes.abaqus_types import NODE_ORDER
from strutwork.meshes.cells import CELL_TYPES
from strutwork.meshes.deck_lines import DeckLines


class CellRows:
    """Rows of cells: each goes on over as many lines as its nodes take.

    Parameters
    ----------
    lines : DeckLines
    scope : Scope
    type_, kind : str
        Abaqus' and those of this package.
    count : callable
        Named with each cell in a message.
    """

    def __init__(
        self, lines: DeckLines, scope: Scope, type_: str, kind: str, count: Callable[[], None]
    ) -> None:
        self.lines, self._count = lines, count
        self.block = Elements(type_, kind, CELL_TYPES[kind].size, lines.where)
        self._pending: list[int] = []
        scope.elements.append(self.block)

    def row(self, text: str) -> None:
        """Take a line.

        Parameters
        ----------
        text : str
            The line without its end; part of an element where that takes several.
        """
        width = self.block.size + 1
        try:
            values = list(map(int, text.rstrip(", \t").split(",")))
            if self._pending or len(values) != width:
                self._pending += values
                if len(self._pending) < width:
                    return
                values, self._pending = self._pending, []
            if len(values) == width:
                self.block.rows.extend(values)
        except (ValueError, OverflowError):
            raise not_read(self.lines, text, "an element: whole numbers") from None
        if len(values) != width:
            raise self.lines.error(
                f"ends element {values[0]} with {len(values) - 1} nodes; "
                f"{self.block.type_} has {self.block.size}",
                "Check the element, or export the mesh again.",
            )
        self._count()

    def numbers(self) -> array[int]:
        """Numbers of the elements."""
        return self.block.rows[:: self.block.size + 1]

    def finish(self) -> None:
        """Check that the last element is whole, and put its nodes in our order."""
        if self._pending:
            raise self.lines.error(
                f"begins elements of which the last, {self._pending[0]}, has "
                f"{len(self._pending) - 1} of {self.block.size} nodes",
                "The file is cut short: export it again.",
                self.block.where,
            )
        if self.block.kind in NODE_ORDER:
            table = self.block.table.copy()
            table[:, 1:] = table[:, 1:][:, list(NODE_ORDER[self.block.kind])]
            self.block.rows = array("q", table.tobytes())


class OtherRows:
    """Rows of points and lines: their numbers alone are kept.

    Parameters
    ----------
    scope : Scope
        Takes the numbers.
    """

    def __init__(self, scope: Scope) -> None:
        self._others = scope.others
        self._first = len(scope.others)
        self._goes_on = False

    def row(self, text: str) -> None:
        """Take a line.

        Parameters
        ----------
        text : str
            The line without its end.
        """
        head = text.split(",", 1)[0].strip()
        if not self._goes_on and re.fullmatch(r"\d{1,18}", head):
            self._others.append(int(head))
        self._goes_on = text.endswith(",")

    def numbers(self) -> array[int]:
        """Numbers of the elements."""
        return self._others[self._first :]

    def finish(self) -> None:
        """Nothing is left to do."""


def counted(lines: DeckLines) -> Callable[[], None]:
    """What counts the cells of a deck, and stops at the limit.

    Parameters
    ----------
    lines : DeckLines
        Names the file where there are too many.
    """
    found = 0

    def one() -> None:
        nonlocal found
        found += 1
        if found > limits.MOST_CELLS:
            limits.check_counts(lines.path, 0, found)

    return one


def not_read(lines: DeckLines, text: str, wanted: str) -> ModelError:
    """The error for a line that is not what its keyword asks for.

    Parameters
    ----------
    lines : DeckLines
        At that line.
    text : str
        The line, of which the beginning is shown.
    wanted : str
        What it should be, as in "an element: whole numbers".
    """
    return lines.error(
        f"holds {text[:60]!r}; it should be {wanted}",
        "Check the line; where the file is cut short or damaged, export it again.",
    )
