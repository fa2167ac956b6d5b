"""Dimensions along which gradients are taken: a number of a machine, or several together."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from strutwork.errors import ModelError
from strutwork.machines.model_numbers import Whole
from strutwork.names import visible
from strutwork.studies.parametric import Parametric

#: Between paths that move together.
TOGETHER = "+"

#: First parts of the paths that say nothing of a machine's body: loads, ranges, grids.
_ASIDE = frozenset(
    {
        *("gravity", "loads", "line_loads", "settlements", "misfits", "tolerances", "workspace"),
        *("force_limits", "drives", "home", "damping", "limits", "task", "title", "preload"),
        "process",
    }
)

#: Last parts of paths that are ranges and no dimension.
_NO_DIMENSION = frozenset({"low", "high", "from", "to"})


@dataclass(frozen=True)
class Dimension:
    """One number of a machine, or several that move by the same step.

    Parameters
    ----------
    name : str
        Its path; paths that move together have a plus between them.
    numbers : mapping of path to float
        What they are, each in `unit`, which may be any unit.
    unit : str
        SI; empty for a pure number.
    meaning : str
    """

    name: str
    numbers: Mapping[str, float]
    unit: str = ""
    meaning: str = ""

    @property
    def value(self) -> float:
        """The number, or the mean of those that move together, SI."""
        return sum(self.numbers.values()) / len(self.numbers)

    def moved(self, step: float) -> dict[str, float]:
        """Its numbers moved by a step, SI.

        Parameters
        ----------
        step : float
            In the parameter's unit.
        """
        return {path: value + step for path, value in self.numbers.items()}

    @classmethod
    def of(cls, machine: Parametric, name: str) -> Dimension:
        """The parameter of a path; with a star or a plus several numbers that move together.

        Parameters
        ----------
        machine : Parametric
        name : str
            As `joints.ball*.stiffness.z`, or `nodes.base1.y+nodes.foot1.y`.

        Raises
        ------
        ModelError
            A path that names no number (the message offers the nearest), numbers of different
            units.
        """
        found = {n.path: n for part in name.split(TOGETHER) for n in machine.matching(part.strip())}
        units = {n.unit for n in found.values()}
        if len(units) > 1:
            raise ModelError(
                visible(name),
                f"moves numbers of different units together: {', '.join(sorted(units))}.",
                "Join numbers of one unit.",
            )
        first = next(iter(found.values()))
        return cls(name, {p: n.value for p, n in found.items()}, first.unit, first.meaning)


def dimensions(machine: Parametric) -> tuple[Dimension, ...]:
    """The parameters of a machine that a designer changes: sizes, materials, stiffnesses, masses.

    Left out are places of single nodes and directions of axes, which belong to their joints'
    partners, loads, ranges, numbers that are zero, and what would mesh and reduce a solid anew.

    Parameters
    ----------
    machine : Parametric
    """
    return tuple(_chosen(machine, machine.paths))


def _chosen(machine: Parametric, paths: Iterable[str]) -> Iterable[Dimension]:
    of_file = any(path.startswith("nodes.") for path in paths)
    # a solid is meshed and reduced anew for every number of its own
    slow = {"solids", "materials"} if machine.model().solids else {"solids"}
    for path in paths:
        number = machine.paths[path]
        head = re.split(r"[.\[]", path)[0]
        last = path.rpartition(".")[2]
        counted = isinstance(number.kind, Whole)
        if head in _ASIDE | slow or last in _NO_DIMENSION or counted or not number.value:
            continue
        if of_file and (head == "nodes" or (not number.unit and "poissons_ratio" not in last)):
            continue
        if of_file and any(p in path for p in (".axis.", ".inertia.", ".limits.", ".center_")):
            continue
        yield Dimension(path, {path: number.value}, number.unit, number.meaning)
