"""Nodes (15, 2411), lines (2412, 82) and names (2467) of universal files."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.uff_axes import CARTESIAN, GLOBAL, Axes, axes_of, systems_18, systems_2420
from strutwork.fea.uff_sets import DataSet, Records
from strutwork.units import LONGEST

Array = NDArray[Any]

#: Elements whose records hold a line of beam data before their nodes.
_BEAMS = (11, 21, 22, 23, 24)

#: Entity type of a node in a group.
_NODE = 7

#: Two places of one node differ when they are further apart than this share of its distance.
_SAME = 1e-6


@dataclass
class Geometry:
    """Geometry of a file while it is read, by node numbers.

    Parameters
    ----------
    places : dict of int to (3,)
        Global, m.
    systems : dict of int to Axes
    motion_in : dict of int to int
        Number of the system in which a node's motion is written.
    lines : list of (int, int)
        For drawing.
    names : dict of int to str
    notes : list of str
        What was assumed or changed, in words.
    """

    places: dict[int, Array] = field(default_factory=dict)
    systems: dict[int, Axes] = field(default_factory=dict)
    motion_in: dict[int, int] = field(default_factory=dict)
    lines: list[tuple[int, int]] = field(default_factory=list)
    names: dict[int, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def add_systems(self, source: DataSet, length: float) -> None:
        """Coordinate systems of 2420 or 18.

        Parameters
        ----------
        source : DataSet
        length : float
            The file's units of length in one metre, no unit.
        """
        read = systems_18 if source.kind == 18 else systems_2420
        self.systems |= read(source, length)

    def add_nodes(self, source: DataSet, length: float) -> None:
        """Nodes of 2411, whose places are global, or of 15, whose places are in their system.

        Parameters
        ----------
        source : DataSet
        length : float
            The file's units of length in one metre, no unit.
        """
        records = Records(source)
        while records:
            if source.kind == 15:
                entry = records.next()
                head = entry.numbers([10] * 4 + [13] * 3)
                if len(head) != 7:
                    raise ModelError(
                        source.part,
                        f"is cut short: line {entry.line} does not contain a node and its place.",
                        "Export the file again.",
                    )
                number, defined_in, moves_in = entry.whole([10] * 4, 4)[:3]
                place = np.array(head[4:])
            else:
                number, defined_in, moves_in = records.next().whole([10] * 4, 3)[:3]
                place = np.array(records.numbers(3, 25))
            if not np.all(np.isfinite(place)):
                raise ModelError(
                    source.part,
                    f"contains a number that is not finite (NaN or infinity) at node {number}.",
                    "Repair the geometry or omit it.",
                )
            with np.errstate(over="ignore"):
                place = place / length
            if source.kind == 15:
                place = self._global(place, defined_in, f"{source.part}, node {number}")
            if not np.all(np.abs(place) <= LONGEST):
                raise ModelError(
                    source.part,
                    f"has a place further away than {LONGEST:g} m at node {number}.",
                    "Correct it, or the unit of lengths.",
                )
            self._place(number, place)
            self.motion_in[number] = moves_in

    def _global(self, place: Array, number: int, part: str) -> Array:
        axes = axes_of(number, self.systems, part)
        if axes is None:
            return place
        if axes.kind != CARTESIAN:
            raise ModelError(
                part,
                "has a place in a system that is not Cartesian, which is not read.",
                "Export the nodes as data set 2411.",
            )
        return np.asarray(axes.origin + place @ axes.rows)

    def _place(self, number: int, place: Array) -> None:
        before = self.places.get(number)
        if before is not None:
            apart, far = np.linalg.norm(place - before), np.linalg.norm(place)
            if apart > _SAME * far:
                self.notes.append("a node that has two places: the last is used")
        self.places[number] = place

    def turned(self, number: int, part: str) -> Array | None:
        """Directions in which the motion of a node is written, (3, 3); None for global ones.

        Parameters
        ----------
        number : int
            Of the node.
        part : str
            For messages.

        Raises
        ------
        ModelError
            A system that the file does not hold, or that is not read.
        """
        moves_in = self.motion_in.get(number, 0)
        if moves_in in GLOBAL and moves_in not in self.systems:
            return None
        part = f"{part}, node {number}"
        axes = axes_of(moves_in, self.systems, part)
        if axes is None:
            return None
        found = axes.at(self.places.get(number), part)
        return None if np.allclose(found, np.eye(3), atol=1e-12) else found

    def add_elements(self, source: DataSet) -> None:
        """Elements of 2412 as lines between their nodes, closed from three nodes on.

        Parameters
        ----------
        source : DataSet
        """
        records = Records(source)
        while records:
            head = records.next().whole([10] * 6, 6)
            if head[1] in _BEAMS:
                records.skip(1)
            nodes: list[int] = []
            while len(nodes) < head[5]:
                nodes += records.next().whole([10] * 8)
            self._line(nodes)
            if len(nodes) > 2:
                self.lines.append((nodes[-1], nodes[0]))

    def add_trace(self, source: DataSet) -> None:
        """A trace line of data set 82: zero lifts the pen.

        Parameters
        ----------
        source : DataSet
        """
        records = Records(source)
        count = records.next().whole([10] * 3, 2)[1]
        records.skip(1)
        nodes: list[int] = []
        while len(nodes) < count:
            nodes += records.next().whole([10] * 8)
        run: list[int] = []
        for node in [*nodes, 0]:
            if node:
                run.append(node)
            else:
                self._line(run)
                run = []

    def _line(self, nodes: list[int]) -> None:
        self.lines += [(a, b) for a, b in pairwise(nodes) if a != b]

    def add_groups(self, source: DataSet) -> None:
        """Groups of one node each are names.

        Parameters
        ----------
        source : DataSet
            Data set 2467.
        """
        records = Records(source)
        while records:
            count = records.next().whole([10] * 8, 8)[7]
            name = records.next().text[:40].strip()
            entities: list[int] = []
            while len(entities) < 4 * count:
                entities += records.next().whole([10] * 8, 4)
            if count == 1 and entities[0] == _NODE:
                self.names[entities[1]] = name
        if len(set(self.names.values())) < len(self.names) or "" in self.names.values():
            # groups that do not name nodes one by one are no names
            self.names.clear()

    def name(self, number: int) -> str:
        """Name of a node: that of its group, else its number.

        Parameters
        ----------
        number : int
        """
        return self.names.get(number, str(number))
