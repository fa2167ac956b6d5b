"""Abaqus and CalculiX decks line by line: keywords that make the mesh; others are passed over."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path

from strutwork.errors import ModelError
from strutwork.meshes import limits
from strutwork.meshes.abaqus_rows import CellRows, OtherRows, counted, not_read
from strutwork.meshes.abaqus_scope import NamedSet, Piece, Scope, Surface
from strutwork.meshes.abaqus_system import System
from strutwork.meshes.abaqus_types import kind_of
from strutwork.meshes.cells import CELL_TYPES
from strutwork.meshes.deck_lines import DeckLines
from strutwork.meshes.file_mesh import remedy_for, unusable

Row = Callable[[str], None]
#: Keywords that make or move nodes and elements in ways that are not read here.
REFUSED = {
    "NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SUBMODEL", "IMPERFECTION", "ADJUST",
    "SUBSTRUCTUREGENERATE", "INCLUDEENCRYPTED", "SYMMETRICMODELGENERATION", "EMBEDDEDMESH",
}  # fmt: skip
#: A keyword that is nearly one of these is taken for misspelt.
MESH_WORDS = ("NODE", "ELEMENT", "NSET", "ELSET", "SURFACE", "INCLUDE", "PART", "INSTANCE")


@dataclass
class Instance:
    """A part placed in the assembly.

    Parameters
    ----------
    name, part : str
        As first written.
    where : str
        Its line, for messages.
    rows : list of list of float
        Numbers of the lines that move it: a translation, then an axis by two points, in the file's
        own unit, and an angle, deg.
    has_mesh : bool
        Whether it has nodes or elements of its own.
    """

    name: str
    part: str
    where: str
    rows: list[list[float]] = field(default_factory=list)
    has_mesh: bool = False


class Deck:
    """A deck, read.

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
        self.root, self.assembly = Scope(), Scope("assembly")
        self.parts: dict[str, Scope] = {}
        self.instances: list[Instance] = []
        self._scope = self.root
        self._system = System()
        self._row: Row | None = None
        self._end: Callable[[], None] | None = None
        self._nodes = 0
        self._count = counted(self.lines)
        self._started = False
        #: The first line, which may count what follows.
        self.first_line = ""
        self._read()

    def fail(self, where: str, problem: str, remedy: str) -> ModelError:
        """An error at a line, or about the whole file where `where` is empty.

        Parameters
        ----------
        where : str
            The line, as `DeckLines.where` names it; empty for the whole file.
        problem : str
            What is wrong there, without a full stop.
        remedy : str
            What to do about it.
        """
        if where:
            return self.lines.error(problem, remedy, where)
        return ModelError(str(self.lines.path), f"{problem}.", remedy)

    def _read(self) -> None:
        pending = ""
        for line in self.lines:
            text = line.strip()
            self.first_line = self.first_line or text
            if not text or text.startswith("**"):
                continue
            if pending:
                # a keyword that ends with a comma goes on, unless data follow
                if "=" in text or not re.match(r"[-+.\d*]", text):
                    pending += text
                    if not text.endswith(","):
                        self._keyword(pending)
                        pending = ""
                    continue
                self._keyword(pending)
                pending = ""
            if text.startswith("*"):
                if text.endswith(","):
                    pending = text
                else:
                    self._keyword(text)
            elif self._row is not None:
                self._row(text)
            elif not self._started:
                raise self.lines.error(
                    f"contains {text[:60]!r} before the first keyword",
                    "The file is not a deck of Abaqus or CalculiX: export it as .inp.",
                )
        if pending:
            self._keyword(pending)
        self._close()

    def _close(self) -> None:
        if self._end is not None:
            self._end()
        self._row = self._end = None

    def _keyword(self, text: str) -> None:
        self._close()
        self._started = True
        fields = split(text[1:])
        name = re.sub(r"\s+", "", fields[0]).upper()
        options = {}
        for given in fields[1:]:
            key, _, value = given.partition("=")
            options[re.sub(r"\s+", "", key).upper()] = value.strip().strip('"')
        begin = getattr(self, f"_on_{name.lower()}", None) if name.isalpha() else None
        if begin is not None:
            begin(options)
        elif name in REFUSED:
            raise self.lines.error(
                f"holds *{fields[0].strip()}, which changes the mesh and is not read",
                "Let the program write all nodes and elements out, and export the deck again.",
            )
        elif near := get_close_matches(name, MESH_WORDS, n=1, cutoff=0.8):
            raise self.lines.error(
                f"holds the keyword *{fields[0].strip()}", f"If *{near[0]} is meant, write so."
            )

    def _on_node(self, options: dict[str, str]) -> None:
        scope, system = self._scope, self._system
        kind = options.get("SYSTEM", "R").upper() or "R"
        if kind not in {"R", "C"}:
            raise self.lines.error(
                f"gives nodes in the system {kind!r}", "Give them in rectangular coordinates."
            )
        if self.instances and scope is not self.assembly:
            self.instances[-1].has_mesh = True
        numbers, places = scope.node_numbers, scope.coordinates
        first = len(numbers)

        def row(text: str) -> None:
            fields = text.split(",")
            try:
                numbers.append(int(fields[0]))
                places.extend([real(f) for f in (*fields[1:4], "", "", "")[:3]])
            except (ValueError, OverflowError):
                raise not_read(
                    self.lines, text, "a node: its number and three coordinates"
                ) from None
            self._nodes += 1
            if self._nodes > limits.MOST_POINTS:
                limits.check_counts(self.lines.path, self._nodes)

        def end() -> None:
            if kind == "C" or not system.is_global:
                places[3 * first :] = system.to_global(places[3 * first :], kind == "C")
            if options.get("NSET"):
                piece = Piece(where, scope, numbers[first:])
                scope.piece(scope.node_sets, options["NSET"], piece, internal=False)

        where = self.lines.where
        self._begin(row, end, options)

    def _on_element(self, options: dict[str, str]) -> None:
        scope, where, type_ = self._scope, self.lines.where, options.get("TYPE", "")
        kind = kind_of(type_)
        if kind is None or (kind and kind not in CELL_TYPES):
            what = unusable(kind) if kind else "unknown here"
            raise self.lines.error(
                f"begins elements of type {type_!r}, which is {what} and cannot be used",
                remedy_for(kind or ""),
            )
        if self.instances and scope is not self.assembly:
            self.instances[-1].has_mesh = True
        rows: CellRows | OtherRows = (
            CellRows(self.lines, scope, type_, kind, self._count) if kind else OtherRows(scope)
        )

        def end() -> None:
            rows.finish()
            if options.get("ELSET") and len(rows.numbers()):
                piece = Piece(where, scope, rows.numbers(), from_elements=True)
                scope.piece(scope.element_sets, options["ELSET"], piece, internal=False)

        self._begin(rows.row, end, options)

    def _on_nset(self, options: dict[str, str]) -> None:
        self._set(options, "NSET", self._scope.node_sets)

    def _on_elset(self, options: dict[str, str]) -> None:
        self._set(options, "ELSET", self._scope.element_sets)

    def _set(self, options: dict[str, str], key: str, sets: dict[str, NamedSet]) -> None:
        name = options.get(key, "")
        if not name:
            raise self.lines.error(f"begins a set without {key}=NAME", "Name the set.")
        scope = self._scope
        piece = Piece(self.lines.where, self._placed(options.get("INSTANCE", "")))
        scope.piece(sets, name, piece, internal="INTERNAL" in options)
        if key == "NSET" and options.get("ELSET"):
            piece.of_elements = True
            piece.names.append(options["ELSET"])
        generates = "GENERATE" in options

        def row(text: str) -> None:
            fields = [f.strip().strip('"') for f in text.split(",")]
            if generates:
                piece.ranges.append(self._range(text, fields))
                return
            for given in fields:
                if re.fullmatch(r"\d{1,18}", given):
                    piece.numbers.append(int(given))
                elif given:
                    piece.names.append(given)

        self._begin(row, None, options)

    def _range(self, text: str, fields: list[str]) -> tuple[int, int, int]:
        try:
            values = [int(f) for f in fields if f]
            first, last, step = (*values, 1) if len(values) == 2 else values
        except ValueError:
            raise not_read(self.lines, text, "first, last and step of a range") from None
        if step < 1 or last < first:
            raise not_read(self.lines, text, "an ascending range")
        return first, last, step

    def _on_surface(self, options: dict[str, str]) -> None:
        type_ = options.get("TYPE", "").upper() or "ELEMENT"
        name = options.get("NAME", "")
        if type_ not in {"ELEMENT", "NODE"}:
            return
        if "COMBINE" in options or "CROP" in options:
            raise self.lines.error(
                f"makes the surface {name!r} of others", "Let the program write its faces out."
            )
        surface = self._scope.surfaces.setdefault(name.upper(), Surface(name, type_, self._scope))

        def row(text: str) -> None:
            fields = [f.strip().strip('"') for f in text.split(",")]
            side = fields[1] if len(fields) > 1 else ""
            if fields[0]:
                surface.rows.append((fields[0], side.upper(), self.lines.where))

        self._begin(row, None, options)

    def _on_solidsection(self, options: dict[str, str]) -> None:
        if name := options.get("ELSET", ""):
            self._scope.sections.append((name, self.lines.where))

    def _on_part(self, options: dict[str, str]) -> None:
        name = options.get("NAME", "")
        if name.upper() in self.parts:
            raise self.lines.error(f"begins a second part {name!r}", "Rename one of them.")
        self._scope = self.parts[name.upper()] = Scope(name)
        self._system = System()

    def _on_endpart(self, options: dict[str, str]) -> None:
        del options
        self._scope = self.root

    def _on_assembly(self, options: dict[str, str]) -> None:
        del options
        self._scope = self.assembly

    def _on_endassembly(self, options: dict[str, str]) -> None:
        del options
        self._scope = self.root

    def _on_instance(self, options: dict[str, str]) -> None:
        part = options.get("PART", "")
        if part.upper() not in self.parts:
            raise self.lines.error(
                f"places an instance of the part {part!r}, which the file does not give",
                "Export the part and its instance into one deck.",
            )
        instance = Instance(options.get("NAME", ""), part, self.lines.where)
        self.instances.append(instance)
        self._scope = self.parts[part.upper()]

        def row(text: str) -> None:
            try:
                instance.rows.append([real(f) for f in text.split(",") if f.strip()])
            except ValueError:
                raise not_read(self.lines, text, "a translation or a rotation") from None

        self._begin(row, None, options)

    def _on_endinstance(self, options: dict[str, str]) -> None:
        del options
        self._scope = self.assembly

    def _placed(self, instance: str) -> Scope:
        """The scope that numbers of a set belong to."""
        for known in self.instances:
            if instance and known.name.upper() == instance.upper():
                return self.parts[known.part.upper()]
        if instance:
            raise self.lines.error(
                f"names the instance {instance!r}, which the file does not give", "Check its name."
            )
        return self._scope

    def _on_system(self, options: dict[str, str]) -> None:
        rows: list[list[float]] = []

        def row(text: str) -> None:
            try:
                rows.append([real(f) for f in text.split(",")])
            except ValueError:
                raise not_read(self.lines, text, "points of a coordinate system") from None

        where = self.lines.where

        def end() -> None:
            try:
                self._system = System.through(rows)
            except ValueError as error:
                raise self.fail(where, f"begins a system {error}", "Check its points.") from None

        self._begin(row, end, options)

    def _on_include(self, options: dict[str, str]) -> None:
        self.lines.include(options.get("INPUT", ""))

    def _begin(self, row: Row, end: Callable[[], None] | None, options: dict[str, str]) -> None:
        """Take the data lines that follow, or those of the file that INPUT names."""
        self._row, self._end = row, end
        if options.get("INPUT"):
            self.lines.include(options["INPUT"])


def real(text: str) -> float:
    """A number as decks have it: `1.5`, `1.D-3`, or nothing for zero.

    Parameters
    ----------
    text : str
        The field, blanks around it allowed; ValueError where it is no number.
    """
    text = text.strip()
    try:
        return float(text) if text else 0.0
    except ValueError:
        return float(re.sub(r"[dD]", "E", text))


def split(text: str) -> list[str]:
    """The fields of a keyword line: commas in quotes do not part.

    Parameters
    ----------
    text : str
        The line without its end.
    """
    return re.findall(r'(?:"[^"]*"|[^,"])+', text) or [""]
