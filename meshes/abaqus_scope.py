"""What one part of an Abaqus deck holds: nodes, elements, sets, sections, surfaces."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes.numbered import Numbered

Array = NDArray[Any]
Ints = NDArray[np.int64]
Fail = Callable[[str, str, str], ModelError]


@dataclass
class Elements:
    """A block of elements: `rows` has the number and the nodes of each, one after another.

    Parameters
    ----------
    type_ : str
        As Abaqus names it.
    kind : str
        Of the cells.
    size : int
        Nodes of each.
    where : str
        Its line, for messages.
    rows : array of int
        Number and nodes of each element, one after another.
    """

    type_: str
    kind: str
    size: int
    where: str
    rows: array[int] = field(default_factory=lambda: array("q"))

    @property
    def table(self) -> Ints:
        """Number and nodes of each element, (m, 1 + size)."""
        return np.frombuffer(self.rows, dtype=np.int64).reshape(-1, self.size + 1)


@dataclass
class Piece:
    """One block of a set: numbers, ranges and names of other sets, as they stand.

    Parameters
    ----------
    where : str
        Its line, for messages.
    scope : Scope
        Where it stands.
    numbers : array of int
        Of nodes or elements.
    ranges : list of (int, int, int)
        First, last and step.
    names : list of str
        Of other sets.
    of_elements : bool
        Whether the numbers are of elements whose nodes are meant.
    from_elements : bool
        Whether it came with the elements themselves.
    """

    where: str
    scope: Scope
    numbers: array[int] = field(default_factory=lambda: array("q"))
    ranges: list[tuple[int, int, int]] = field(default_factory=list)
    names: list[str] = field(default_factory=list)
    #: whether the numbers are of elements whose nodes are meant
    of_elements: bool = False
    #: whether it came with the elements themselves, by *ELEMENT, ELSET=
    from_elements: bool = False


@dataclass
class NamedSet:
    """A set: its name as first written, and its blocks.

    Parameters
    ----------
    name : str
        As first written.
    pieces : list of Piece
    internal : bool
        Whether the deck marks it as one that its program made.
    """

    name: str
    pieces: list[Piece] = field(default_factory=list)
    internal: bool = False


@dataclass
class Surface:
    """A surface: its name, its type, and rows of owner, side and place in the file.

    Parameters
    ----------
    name : str
        As first written.
    type_ : str
        `ELEMENT` or `NODE`, in capitals.
    scope : Scope
        Where it stands.
    rows : list of (str, str, str)
        Element or element set, side, place in the file.
    """

    name: str
    type_: str
    scope: Scope
    rows: list[tuple[str, str, str]] = field(default_factory=list)


@dataclass(eq=False)
class Scope:
    """A part, or the assembly, or a deck without parts.

    Names are kept by their capitals: Abaqus does not distinguish `eall` from `EALL`.

    Parameters
    ----------
    name : str
        Empty for a deck without parts.
    node_numbers : array of int
    coordinates : array of float
        x, y, z of each node, in the file's own unit.
    elements : list of Elements
    others : array of int
        Numbers of points and lines, which are no cells.
    node_sets, element_sets : dict of str to NamedSet
        By the name in capitals.
    sections : list of (str, str)
        Element set and line of each section.
    surfaces : dict of str to Surface
        By the name in capitals.
    """

    name: str = ""
    node_numbers: array[int] = field(default_factory=lambda: array("q"))
    coordinates: array[float] = field(default_factory=lambda: array("d"))
    elements: list[Elements] = field(default_factory=list)
    #: numbers of points and lines, which are no cells
    others: array[int] = field(default_factory=lambda: array("q"))
    node_sets: dict[str, NamedSet] = field(default_factory=dict)
    element_sets: dict[str, NamedSet] = field(default_factory=dict)
    sections: list[tuple[str, str]] = field(default_factory=list)
    surfaces: dict[str, Surface] = field(default_factory=dict)

    @property
    def is_empty(self) -> bool:
        """Whether it holds no element."""
        return not self.elements

    def piece(self, sets: dict[str, NamedSet], name: str, piece: Piece, *, internal: bool) -> None:
        """Add a block to the set of that name.

        Parameters
        ----------
        sets : dict of str to NamedSet
            `node_sets` or `element_sets` of this scope.
        name : str
            As written; capitals do not count.
        piece : Piece
            The block.
        internal : bool
            Whether the deck marks the set as one that its program made.
        """
        found = sets.setdefault(name.upper(), NamedSet(name))
        found.internal |= internal
        found.pieces.append(piece)


class Index:
    """Numbers of a scope's nodes and elements.

    Parameters
    ----------
    scope : Scope
        The part, read to its end.
    offset : int
        The first of its nodes in the mesh.
    fail : callable
        Makes the error of a place, a problem and a remedy.
    """

    def __init__(self, scope: Scope, offset: int, fail: Fail) -> None:
        self.scope, self.offset = scope, offset
        self.nodes = Numbered(np.frombuffer(scope.node_numbers, dtype=np.int64))
        self.points = np.frombuffer(scope.coordinates, dtype=float).reshape(-1, 3)
        pairs = self.nodes.twice()
        moved = (self.points[pairs[:, 0]] != self.points[pairs[:, 1]]).any(axis=1)
        if moved.any():
            number = self.nodes.numbers[pairs[moved][0, 0]]
            raise fail("", f"node {number} is given twice, at two places", "Number it anew.")
        solids = [e for e in scope.elements if e.kind[:4] in {"hexa", "tetr"}]
        faces = [e for e in scope.elements if e not in solids]
        self.solids, self.faces = solids, faces
        numbers = [e.table[:, 0] for e in (*solids, *faces)]
        self.solid_count = sum(len(n) for n in numbers[: len(solids)])
        self.cell_count = sum(len(n) for n in numbers)
        own = np.concatenate([*numbers, np.zeros(0, np.int64)])
        twice = Numbered(own).twice()
        if len(twice):
            raise fail("", f"element {own[twice[0, 0]]} is given twice", "Number it anew.")
        others = np.frombuffer(scope.others, dtype=np.int64)
        # cells last: of equal numbers the last counts
        self.elements = Numbered(np.concatenate([others, own]))
        self._others = len(others)
        self._fail = fail

    def connectivity(self) -> Iterator[tuple[Elements, Ints]]:
        """The nodes of each block, (m, size), by their place in the mesh: solids, then faces."""
        for block in (*self.solids, *self.faces):
            table = block.table
            at, known = self.nodes.find(table[:, 1:])
            if not known.all():
                row = int(np.argmin(known.all(axis=1)))
                node = table[row, 1:][~known[row]][0]
                raise self._fail(
                    block.where,
                    f"begins elements of which {table[row, 0]} has the node {node}, "
                    "which the file does not give",
                    "Export the entire mesh again.",
                )
            yield block, at + self.offset

    def cells(self, piece: Piece) -> Ints:
        """Cells of the numbers and ranges of a block, (k,), ascending; solids come before faces.

        Parameters
        ----------
        piece : Piece
            Of an element set.
        """
        at, known = self.elements.find(np.frombuffer(piece.numbers, dtype=np.int64))
        self._check(piece, known, "element")
        found = [at, *(self._range(piece, r, self.elements, "element") for r in piece.ranges)]
        cells = np.concatenate(found) - self._others
        return np.unique(cells[cells >= 0])

    def nodes_of(self, piece: Piece) -> Ints:
        """Nodes of the numbers and ranges of a block, (k,), ascending.

        Parameters
        ----------
        piece : Piece
            Of a node set.
        """
        at, known = self.nodes.find(np.frombuffer(piece.numbers, dtype=np.int64))
        self._check(piece, known, "node")
        found = [at, *(self._range(piece, r, self.nodes, "node") for r in piece.ranges)]
        return np.unique(np.concatenate(found)) + self.offset

    def _range(self, piece: Piece, range_: tuple[int, int, int], all_: Numbered, what: str) -> Ints:
        found = all_.between(*range_)
        if not len(found):
            raise self._fail(
                piece.where,
                f"begins a set that generates {what}s {range_[0]} to "
                f"{range_[1]}; the file gives none of them",
                "Check its numbers.",
            )
        return found

    def _check(self, piece: Piece, known: NDArray[np.bool_], what: str) -> None:
        if not known.all():
            number = piece.numbers[int(np.argmin(known))]
            raise self._fail(
                piece.where,
                f"begins a set with {what} {number}, which the file does not give",
                "Check its numbers, or export the mesh again.",
            )
