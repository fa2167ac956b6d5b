"""The cards of Nastran bulk data that make a mesh; others are passed over."""

from __future__ import annotations

from array import array
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes import limits
from strutwork.meshes.deck_lines import DeckLines
from strutwork.meshes.file_mesh import remedy_for, unusable
from strutwork.meshes.nastran_cards import Card, cards, real, whole
from strutwork.meshes.nastran_systems import Systems
from strutwork.meshes.numbered import Numbered

Array = NDArray[Any]
Ints = NDArray[np.int64]
#: Kinds with and without middle nodes, and Nastran's place of each node of ours.
ELEMENTS = {
    "CTETRA": ("tetra", "tetra10", tuple(range(10))),
    "CHEXA": ("hexahedron", "hexahedron20", (*range(12), *range(16, 20), *range(12, 16))),
    "CTRIA3": ("triangle", "triangle", (0, 1, 2)),
    "CTRIAR": ("triangle", "triangle", (0, 1, 2)),
    "CTRIA6": ("triangle", "triangle6", tuple(range(6))),
    "CQUAD4": ("quad", "quad", (0, 1, 2, 3)),
    "CQUADR": ("quad", "quad", (0, 1, 2, 3)),
    "CQUAD8": ("quad", "quad8", tuple(range(8))),
}
CORNERS = {"tetra": 4, "hexahedron": 8, "triangle": 3, "quad": 4}
REFUSED = {"CPENTA": "wedge", "CPYRAM": "pyramid", "CPYRA": "pyramid"}
SYSTEMS = {f"CORD{n}{s}" for n in "12" for s in "RCS"}
#: Cards that move grid points or make cells in ways that are not read here.
UNREAD = {"CORD3G", "CORD3R", "GRIDG", "GRIDB", "EGRID", "GMCURV", "CHEXCZ", "CPENTCZ", "CIFHEX",
          "CIFPENT", "CHEXAL", "CQUAD", "MESHOPT"}  # fmt: skip
#: A card that is nearly one of these is taken for misspelt.
WORDS = ("GRID", "CTETRA", "CHEXA", "CPENTA", "CORD2R", "CORD1R", "CTRIA3", "CQUAD4", "INCLUDE")
NEAR = {"CTRIA", "CQUAD", "CTRIAX", "CQUADX", "CTRIAX6", "CQUADX4", "CQUADX8", "CTRIAX3", "CORD3G"}


@dataclass
class Cells:
    """Elements of one card name: element, property and nodes, zero where a node is left out.

    Parameters
    ----------
    where : str
        Their first line, for messages.
    rows : array of int
        Element, property and nodes of each, one after another.
    """

    where: str
    rows: array[int] = field(default_factory=lambda: array("q"))


class BulkData:
    """The bulk data of a file.

    Parameters
    ----------
    path : Path

    Raises
    ------
    ModelError
        What is not understood, with its line.
    """

    def __init__(self, path: Path) -> None:
        self.lines = DeckLines(path)
        self.comments: list[str] = []
        self.systems = Systems(self.lines)
        self.cells: dict[str, Cells] = {}
        self._numbers, self._places = array("q"), array("d")
        self._in_system = array("q")
        self._default: str = ""
        self._count = 0
        self.last = ""
        for card in cards(self.lines, self.comments):
            self.last = card.where
            try:
                self._take(card)
            except (ValueError, OverflowError):
                raise self.lines.error(
                    f"holds a {card.name} card with a field that is not a number: "
                    f"{', '.join(card.fields)[:80]!r}",
                    "Check the card; where the file is cut short or damaged, export it again.",
                    card.where,
                ) from None
        self.grids = Numbered(np.frombuffer(self._numbers, dtype=np.int64))
        self.points = self._global()

    def _take(self, card: Card) -> None:
        name = card.name
        if name == "GRID":
            fields = (*card.fields, "", "", "", "", "")
            self._numbers.append(int(fields[0]))
            self._in_system.append(whole(fields[1] or self._default))
            self._places.extend((real(fields[2]), real(fields[3]), real(fields[4])))
            if len(self._numbers) > limits.MOST_POINTS:
                limits.check_counts(self.lines.path, len(self._numbers))
        elif name in ELEMENTS:
            self._element(card)
        elif name in SYSTEMS:
            self.systems.add(card)
        elif name == "GRDSET":
            self._default = (*card.fields, "", "")[1]
            if len(self._numbers):
                # the default counts wherever the card stands
                self._in_system = array("q", [s or whole(self._default) for s in self._in_system])
        elif name in REFUSED:
            raise self.lines.error(
                f"holds a {name}, which is {unusable(REFUSED[name])} and cannot be used",
                remedy_for(REFUSED[name]),
                card.where,
            )
        elif name in UNREAD:
            raise self.lines.error(
                f"holds a {name} card, which is not read",
                "Export the mesh with plain cards.",
                card.where,
            )
        elif name not in NEAR and (near := get_close_matches(name, WORDS, n=1, cutoff=0.8)):
            raise self.lines.error(
                f"holds the card {name}", f"If {near[0]} is meant, write so.", card.where
            )

    def _element(self, card: Card) -> None:
        plain, _, order = ELEMENTS[card.name]
        fields = card.fields
        count = len(order)
        nodes = [whole(f) for f in fields[2 : 2 + count]]
        corners = CORNERS[plain]
        if len(nodes) < corners or not all(nodes[:corners]):
            raise self.lines.error(
                f"holds a {card.name} with {sum(n > 0 for n in nodes[:corners])} of {corners} "
                "corners",
                "The file is cut short or damaged: export it again.",
                card.where,
            )
        if card.name in {"CTETRA", "CHEXA"} and any(fields[2 + count :]):
            raise self.lines.error(
                f"holds a {card.name} of more than {count} grid points",
                "Check the card.",
                card.where,
            )
        nodes += [0] * (count - len(nodes))
        cells = self.cells.setdefault(card.name, Cells(card.where))
        cells.rows.extend((int(fields[0]), whole(fields[1]) or int(fields[0]), *nodes))
        self._count += 1
        if self._count > limits.MOST_CELLS:
            limits.check_counts(self.lines.path, 0, self._count)

    def _global(self) -> Array:
        places = np.frombuffer(self._places, dtype=float).reshape(-1, 3)
        systems = np.frombuffer(self._in_system, dtype=np.int64)
        points = self.systems.to_global(self.grids, systems, places)
        pairs = self.grids.twice()
        moved = (points[pairs[:, 0]] != points[pairs[:, 1]]).any(axis=1)
        if moved.any():
            number = self.grids.numbers[pairs[moved][0, 0]]
            raise ModelError(
                str(self.lines.path),
                f"grid point {number} is given twice, at two places.",
                "Number it anew.",
            )
        return points

    def tables(self) -> list[tuple[str, Ints, Ints]]:
        """Kind, property (m,) and nodes (m, k) of each block; -1 where a middle node lacks.

        Elements without any middle node become linear.
        """
        found = []
        numbers = [np.zeros(0, np.int64)]
        for name, cells in self.cells.items():
            plain, full, order = ELEMENTS[name]
            table = np.frombuffer(cells.rows, dtype=np.int64).reshape(-1, 2 + len(order))
            numbers.append(table[:, 0])
            given = table[:, 2:]
            at, known = self.grids.find(given)
            lost = ~known & (given != 0)
            if lost.any():
                row = int(np.argmax(lost.any(axis=1)))
                raise ModelError(
                    str(self.lines.path),
                    f"element {table[row, 0]} ({name}) has the grid point "
                    f"{given[row][lost[row]][0]}, which the file does not give.",
                    "Export the entire mesh again.",
                )
            nodes = np.where(known, at, -1)[:, list(order)]
            corners = CORNERS[plain]
            curved = (nodes[:, corners:] >= 0).any(axis=1)
            for kind, chosen, width in ((plain, ~curved, corners), (full, curved, len(order))):
                if chosen.any():
                    found.append((kind, table[chosen, 1], nodes[chosen, :width]))
        own = np.concatenate(numbers)
        twice = Numbered(own).twice()
        if len(twice):
            raise ModelError(
                str(self.lines.path),
                f"element {own[twice[0, 0]]} is given twice.",
                "Number it anew.",
            )
        return found
