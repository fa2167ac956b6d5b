"""The mesh that an Abaqus deck describes: its sets resolved, its surfaces as faces."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes.abaqus_deck import Deck
from strutwork.meshes.abaqus_scope import Index, NamedSet, Piece, Scope, Surface
from strutwork.meshes.abaqus_system import placed
from strutwork.meshes.abaqus_types import FACE_ORDER
from strutwork.meshes.cells import CELL_TYPES
from strutwork.meshes.file_mesh import Block, FileMesh
from strutwork.meshes.rows import row_groups

Array = NDArray[Any]
Ints = NDArray[np.int64]
MERGE = (
    "A solid is one body: merge the instances into one part (in Abaqus: Assembly, Merge/Cut), "
    "or export a deck of each."
)


class DeckModel:
    """The mesh of a deck.

    Parameters
    ----------
    deck : Deck

    Raises
    ------
    ModelError
        Several parts, nodes or elements that are named and not given, sets that hold themselves.
    """

    def __init__(self, deck: Deck) -> None:
        self.deck = deck
        scope, points = _one_part(deck)
        self.main = Index(scope, 0, deck.fail)
        # reference points of the assembly come after the part's nodes
        self.assembly = Index(deck.assembly, len(points), deck.fail)
        self._indices = {scope: self.main, deck.assembly: self.assembly}
        self.points = np.concatenate([points, self.assembly.points])
        blocks = list(self.main.connectivity())
        count = len(self.main.solids)
        self.solids: list[Block] = [(e.kind, nodes) for e, nodes in blocks[:count]]
        self.faces: list[Block] = [(e.kind, nodes) for e, nodes in blocks[count:]]
        self._outer: tuple[Ints, Ints] | None = None

    def file_mesh(self) -> FileMesh:
        """Everything that the deck holds."""
        scopes = (self.main.scope, self.deck.assembly)
        sections: dict[str, Ints] = {}
        sets: dict[str, Ints] = {}
        helpers: dict[str, Ints] = {}
        faces: dict[str, list[Block]] = {}
        used = {
            row[0].upper()
            for s in scopes
            for surface in s.surfaces.values()
            for row in surface.rows
        }
        chosen = {name.upper() for s in scopes for name, _ in s.sections}
        for scope in scopes:
            for name, where in scope.sections:
                solid = self._solid(self._named(scope, name, where, ()))
                if len(solid):
                    sections[self._label(scope, name)] = solid
            for key, found in scope.element_sets.items():
                cells = self.cells(scope, found, ())
                solid = self._solid(cells)
                plain = any(p.from_elements for p in found.pieces) or key not in used
                helps = found.internal or key.startswith("_") or not plain
                if len(solid) and key not in chosen:
                    (helpers if helps else sets)[found.name] = solid
                own = list(self._faces_of(cells[cells >= self.main.solid_count]))
                if own:
                    faces.setdefault(found.name, []).extend(own)
        node_sets = {
            found.name: self.nodes(scope, found, ())
            for scope in scopes
            for found in scope.node_sets.values()
        }
        for scope in scopes:
            for surface in scope.surfaces.values():
                if surface.type_ == "NODE":
                    node_sets.setdefault(surface.name, self._cloud(surface))
                else:
                    # a surface has the last word on a name
                    faces[surface.name] = list(self._surface(surface))
        return FileMesh(self.points, self.solids, sets, sections, helpers, faces, node_sets)

    def cells(self, scope: Scope, found: NamedSet, open_: tuple[str, ...]) -> Ints:
        """Cells of an element set and of the sets that it names, (k,), ascending.

        Parameters
        ----------
        scope : Scope
            Where the set stands.
        found : NamedSet
            The set.
        open_ : tuple of str
            Names of the sets that are being resolved, which it may not name.
        """
        parts = []
        for piece in found.pieces:
            index = self._index(piece)
            parts.append(index.cells(piece) if index is self.main else np.zeros(0, np.int64))
            inner = (*open_, found.name)
            parts += [self._entry(piece, scope, name, inner, "element") for name in piece.names]
        return np.unique(np.concatenate(parts))

    def nodes(self, scope: Scope, found: NamedSet, open_: tuple[str, ...]) -> Ints:
        """Nodes of a node set and of the sets that it names, (k,), ascending.

        Parameters
        ----------
        scope : Scope
            Where the set stands.
        found : NamedSet
            The set.
        open_ : tuple of str
            Names of the sets that are being resolved, which it may not name.
        """
        parts = []
        for piece in found.pieces:
            if piece.of_elements:
                cells = self._named(piece.scope, piece.names[0], piece.where, ())
                parts.append(self._nodes_of(cells))
                continue
            parts.append(self._index(piece).nodes_of(piece))
            inner = (*open_, found.name)
            parts += [self._entry(piece, scope, name, inner, "node") for name in piece.names]
        return np.unique(np.concatenate(parts))

    def _entry(
        self, piece: Piece, scope: Scope, name: str, open_: tuple[str, ...], what: str
    ) -> Ints:
        """What a name in a set stands for: another set, or a number of an instance."""
        if name.upper() in {n.upper() for n in open_}:
            raise self.deck.fail(
                piece.where, f"begins a set that holds itself by {name!r}", "Name other sets in it."
            )
        home, label = self._instance_of(name)
        if label.isdigit() and home is not None:
            single = Piece(piece.where, home)
            single.numbers.append(int(label))
            index = self._index(single)
            return index.nodes_of(single) if what == "node" else index.cells(single)
        for place in dict.fromkeys((home or piece.scope, scope, self.main.scope)):
            sets = place.node_sets if what == "node" else place.element_sets
            if label.upper() in sets:
                inner = sets[label.upper()]
                method = self.nodes if what == "node" else self.cells
                return method(place, inner, open_)
        raise self.deck.fail(
            piece.where,
            f"begins a set that names {name!r}, which is not among the {what} sets of the file",
            "Check the name.",
        )

    def _named(self, scope: Scope, name: str, where: str, open_: tuple[str, ...]) -> Ints:
        """Cells of the element set of a name."""
        home, label = self._instance_of(name)
        for place in dict.fromkeys((home or scope, scope, self.main.scope)):
            if label.upper() in place.element_sets:
                return self.cells(place, place.element_sets[label.upper()], open_)
        raise self.deck.fail(
            where,
            f"names the element set {name!r}, which the file does not give",
            "Check its name.",
        )

    def _instance_of(self, name: str) -> tuple[Scope | None, str]:
        """The scope and the rest of `INSTANCE.NAME`."""
        for instance in self.deck.instances:
            if name.upper().startswith(instance.name.upper() + "."):
                return self.deck.parts[instance.part.upper()], name[len(instance.name) + 1 :]
        return None, name

    def _index(self, piece: Piece) -> Index:
        found = self._indices.get(piece.scope)
        if found is None:
            raise self.deck.fail(
                piece.where, "begins a set outside of the part", "Check its place."
            )
        return found

    def _label(self, scope: Scope, name: str) -> str:
        found = scope.element_sets.get(name.upper())
        return found.name if found else name

    def _solid(self, cells: Ints) -> Ints:
        return cells[cells < self.main.solid_count]

    def _faces_of(self, cells: Ints) -> Iterator[Block]:
        """Shell elements among the cells, as faces."""
        first = self.main.solid_count
        for kind, nodes in self.faces:
            own = cells[(cells >= first) & (cells < first + len(nodes))] - first
            if len(own):
                yield kind, nodes[own]
            first += len(nodes)

    def _nodes_of(self, cells: Ints) -> Ints:
        found, first = [np.zeros(0, np.int64)], 0
        for _, nodes in (*self.solids, *self.faces):
            own = cells[(cells >= first) & (cells < first + len(nodes))] - first
            found.append(nodes[own].ravel())
            first += len(nodes)
        return np.unique(np.concatenate(found))

    def _cloud(self, surface: Surface) -> Ints:
        found = [np.zeros(0, np.int64)]
        for owner, _, where in surface.rows:
            piece = Piece(where, surface.scope)
            if owner.isdigit():
                piece.numbers.append(int(owner))
            else:
                piece.names.append(owner)
            found.append(self.nodes(surface.scope, NamedSet("", [piece]), ()))
        return np.unique(np.concatenate(found))

    def _surface(self, surface: Surface) -> Iterator[Block]:
        """The faces of a surface."""
        single: dict[str, Piece] = {}
        rows: list[tuple[Ints, str, str]] = []
        for owner, side, where in surface.rows:
            if owner.isdigit():
                # numbers are looked up together: there may be very many
                piece = single.setdefault(side, Piece(where, surface.scope))
                piece.numbers.append(int(owner))
            else:
                rows.append((self._named(surface.scope, owner, where, ()), side, where))
        rows += [(self._index(p).cells(p), side, p.where) for side, p in single.items()]
        for cells, side, where in rows:
            yield from self._side(cells, side, where)

    def _side(self, cells: Ints, side: str, where: str) -> Iterator[Block]:
        if side in {"SPOS", "SNEG", ""}:
            yield from self._faces_of(cells)
            if side:
                return
            yield from self._exposed(self._solid(cells))
            return
        if not (side[:1] == "S" and side[1:].isdigit()):
            raise self.deck.fail(where, f"names the side {side!r}", "Use S1 to S6, SPOS or SNEG.")
        first = 0
        for kind, nodes in self.solids:
            own = cells[(cells >= first) & (cells < first + len(nodes))] - first
            first += len(nodes)
            if not len(own):
                continue
            type_ = CELL_TYPES[kind]
            order = FACE_ORDER[type_.linear_kind]
            number = int(side[1:])
            if not 1 <= number <= len(order):
                raise self.deck.fail(
                    where, f"names the side {side} of a {kind}", f"It has S1 to S{len(order)}."
                )
            yield type_.face_kind, nodes[own][:, type_.faces[order[number - 1]]]

    def _exposed(self, cells: Ints) -> Iterator[Block]:
        """Faces of the cells that no other cell of the mesh has."""
        if not len(cells):
            return
        first = 0
        corners: dict[int, list[Ints]] = {}
        for kind, nodes in self.solids:
            type_ = CELL_TYPES[kind]
            faces = nodes[:, np.array(type_.corner_faces)]
            corners.setdefault(faces.shape[2], []).append(faces.reshape(-1, faces.shape[2]))
        alone = {}
        for width, rows in corners.items():
            group = row_groups(np.concatenate(rows))[1]
            alone[width] = np.bincount(group)[group] == 1
        start = dict.fromkeys(alone, 0)
        for kind, nodes in self.solids:
            type_ = CELL_TYPES[kind]
            width = np.array(type_.corner_faces).shape[1]
            count = len(nodes) * len(type_.corner_faces)
            own = alone[width][start[width] : start[width] + count].reshape(len(nodes), -1)
            start[width] += count
            chosen = np.zeros(len(nodes), dtype=bool)
            chosen[cells[(cells >= first) & (cells < first + len(nodes))] - first] = True
            first += len(nodes)
            yield type_.face_kind, nodes[:, type_.faces][own & chosen[:, None]]


def _one_part(deck: Deck) -> tuple[Scope, Array]:
    """The only part that has elements, and its nodes where its instance puts them."""
    used = deck.instances
    if not used:
        full = [s for s in (deck.root, *deck.parts.values(), deck.assembly) if not s.is_empty]
        if len(full) > 1:
            names = ", ".join(repr(s.name) for s in full if s.name)
            raise ModelError(
                str(deck.lines.path), f"has elements in {len(full)} parts ({names}).", MERGE
            )
        scope = full[0] if full else deck.root
        return scope, np.frombuffer(scope.coordinates, dtype=float).reshape(-1, 3)
    if not deck.assembly.is_empty or not deck.root.is_empty:
        raise ModelError(
            str(deck.lines.path), "has elements in the assembly beside those of its parts.", MERGE
        )
    full_ = [i for i in used if not deck.parts[i.part.upper()].is_empty]
    if len(full_) > 1:
        names = ", ".join(repr(i.name) for i in full_[:4]) + (", …" if len(full_) > 4 else "")
        raise ModelError(
            str(deck.lines.path),
            f"has {len(full_)} instances of parts in its assembly ({names}).",
            MERGE,
        )
    instance = (full_ or used)[0]
    scope = deck.parts[instance.part.upper()]
    points = np.frombuffer(scope.coordinates, dtype=float).reshape(-1, 3)
    if instance.rows and instance.has_mesh:
        raise deck.fail(
            instance.where,
            "begins an instance that is placed and contains its own mesh",
            "Make the mesh on the part (in Abaqus: Make Dependent).",
        )
    try:
        return scope, placed(points, instance.rows)
    except ValueError as error:
        raise deck.fail(instance.where, str(error), "Check the lines of the instance.") from None
