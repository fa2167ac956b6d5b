"""A machine whose numbers can be changed by their path."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, is_dataclass
from difflib import get_close_matches
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any, Protocol

from strutwork.errors import ModelError
from strutwork.machines.load import load, machine_model
from strutwork.machines.machine_numbers import changed_machine, machine_numbers
from strutwork.machines.model import Model
from strutwork.machines.model_builder import build_model
from strutwork.machines.model_file import checked_tables, parse_tables, read_tables
from strutwork.machines.model_numbers import Number, Steps, changed_tables, model_numbers
from strutwork.machines.model_rebuild import rebuilt_model
from strutwork.machines.model_schema import ModelTable
from strutwork.machines.naming import is_machine, named_machine
from strutwork.msa.variant_of import share_where_same
from strutwork.names import listed, matches, visible
from strutwork.stages import stage

#: Paths that a message offers at most.
OFFERED = 12


class Origin(Protocol):
    """What a machine is made from."""

    @property
    def model(self) -> Model:
        """The machine as it is stated."""

    @property
    def numbers(self) -> Mapping[str, Number]:
        """Its numbers by path."""

    def changed(self, values: Mapping[Steps, float]) -> Model:
        """The machine with other numbers.

        Parameters
        ----------
        values : mapping of steps to float
            In the SI unit of each, any unit.
        """

    @property
    def content(self) -> object:
        """Everything that it is made from, for a hash."""


@dataclass(frozen=True)
class Tables:
    """The tables of a model file.

    Parameters
    ----------
    tables : ModelTable
    folder : Path
        Where names of solids' and shapes' files begin.
    name : str
        For messages.
    """

    tables: ModelTable
    folder: Path = Path()
    name: str = "model"

    @cached_property
    def model(self) -> Model:
        """Built once: what a change leaves alone is taken from it."""
        with stage(f"builds the model of {self.name}"):
            return build_model(self.tables, self.folder)

    @cached_property
    def numbers(self) -> Mapping[str, Number]:
        """Those that the file states."""
        return MappingProxyType(model_numbers(self.tables))

    def changed(self, values: Mapping[Steps, float]) -> Model:
        """Without reading the text again; without closing the joints again where nothing moved.

        Parameters
        ----------
        values : mapping of steps to float
            In the SI unit of each, any unit.
        """
        after = changed_tables(self.tables, values)
        return rebuilt_model(self.model, self.tables, after, self.folder)

    @property
    def content(self) -> object:
        """The tables."""
        return self.tables.model_dump(mode="json")

    def __reduce__(self) -> tuple[Any, ...]:
        return _tables, (self.tables, self.folder, self.name, self.__dict__.get("model"))


def _tables(tables: ModelTable, folder: Path, name: str, model: Model | None) -> Tables:
    made = Tables(tables, folder, name)
    if model is not None:
        # what another process built needs no building here
        made.__dict__["model"] = model
    return made


@dataclass(frozen=True)
class Fields:
    """A machine that is a frozen dataclass.

    Parameters
    ----------
    machine : dataclass
        As the catalogue has them.
    title : str
    around_home : mapping of direction to (float, int)
        So far to either side of home, m or rad, in so many points.
    """

    machine: Any
    title: str
    around_home: Mapping[str, tuple[float, int]]

    @cached_property
    def model(self) -> Model:
        """The machine at home."""
        return machine_model(self.machine, self.title, self.around_home)

    @cached_property
    def numbers(self) -> Mapping[str, Number]:
        """Those of its fields."""
        return MappingProxyType(machine_numbers(self.machine))

    def changed(self, values: Mapping[Steps, float]) -> Model:
        """Made and placed anew.

        Parameters
        ----------
        values : mapping of steps to float
            In the SI unit of each, any unit.
        """
        made = changed_machine(self.machine, values)
        model = machine_model(made, self.title, self.around_home)
        share_where_same(model.structure, self.model.structure)
        return model

    @property
    def content(self) -> object:
        """Its class and fields."""
        kind = type(self.machine)
        return [f"{kind.__module__}.{kind.__qualname__}", self.machine, dict(self.around_home)]

    def __reduce__(self) -> tuple[Any, ...]:
        return Fields, (self.machine, self.title, dict(self.around_home))


@dataclass(frozen=True)
class Parametric:
    """A machine whose numbers can be changed by their path; made by `Parametric.of`.

    Parameters
    ----------
    origin : Origin
    source : str
        The name or file it came from; empty for tables or a machine in Python.

    Examples
    --------
    >>> machine = Parametric.of("examples/machines/6-ups.toml")
    >>> machine.paths["sections.ram.diameter"].value
    0.05
    >>> thick = machine.model({"sections.ram.diameter": "60 mm", "joints.ball*.stiffness.z": 5e8})
    >>> thick.structure.beams[1].section.outline
    (0.06, 0.06)
    """

    origin: Origin
    source: str = ""

    @classmethod
    def of(cls, source: object) -> Parametric:
        """A machine from what states its numbers.

        Parameters
        ----------
        source : str, Path, mapping, ModelTable or dataclass
            The path of a model file, its text or its tables, `NAME` or `NAME:VARIANT` of the
            catalogue, what `strutwork.load` returned, or a machine that is a frozen dataclass with
            `linkage`, `structure`, `home` and `place`.

        Raises
        ------
        ModelError
            No such machine or file, a wrong model, or a model that has no numbers of its own.
        """
        if isinstance(source, Parametric):
            return source
        if isinstance(source, ModelTable):
            return cls(_checked(Tables(source)))
        if isinstance(source, Mapping):
            return cls(_checked(Tables(checked_tables(dict(source)))))
        if isinstance(source, Model):
            return cls._of_model(source)
        if isinstance(source, str | Path):
            return cls._of_name(source)
        if is_dataclass(source) and not isinstance(source, type) and hasattr(source, "place"):
            return cls(_checked(Fields(source, type(source).__name__, {})))
        raise ModelError(
            "machine",
            f"is a {type(source).__name__}, which states no numbers.",
            "Give a model file, a name of the catalogue, or a machine that is a dataclass.",
        )

    @classmethod
    def _of_name(cls, source: str | Path) -> Parametric:
        text = str(source)
        if isinstance(source, str) and "\n" in text:
            return cls(_checked(Tables(parse_tables(text))))
        if not text.endswith(".toml") and is_machine(text):
            named = named_machine(text)
            return cls(Fields(named.machine, named.title, named.around_home), text)
        if not text.endswith(".toml") and not Path(text).exists():
            # its message says what there is
            load(text)
        return cls(_checked(Tables(read_tables(source), Path(text).parent, text)), text)

    @classmethod
    def _of_model(cls, source: Model) -> Parametric:
        name = getattr(source, "source", "")
        if not name:
            raise ModelError(
                source.title or "model",
                "was changed or moved since it was read, so that its file does not describe it.",
                "Give its file or its name.",
            )
        return cls._of_name(name)

    def __repr__(self) -> str:
        return f"<Parametric {self.title!r}: {len(self.paths)} numbers>"

    @property
    def title(self) -> str:
        """What the machine is called."""
        return self.origin.model.title or self.source or "machine"

    @property
    def paths(self) -> Mapping[str, Number]:
        """Every number that can be changed, by its path."""
        return self.origin.numbers

    def matching(self, path: str) -> tuple[Number, ...]:
        """The numbers that a path names: one, or several where a star stands for any characters.

        Parameters
        ----------
        path : str

        Raises
        ------
        ModelError
            There is none (the message names the nearest), or several of different units.
        """
        if path in self.paths:
            return (self.paths[path],)
        if "*" in path:
            found = tuple(n for p, n in self.paths.items() if matches(p, path))
            kinds = {n.unit for n in found}
            if len(kinds) > 1:
                two = [next(n.path for n in found if n.unit == unit) for unit in sorted(kinds)[:2]]
                raise ModelError(
                    path,
                    f"names numbers of different units, as {listed([visible(p) for p in two])}.",
                    "Name those of one unit.",
                )
            if found:
                return found
        raise ModelError(path, "names no number of the machine.", self._offer(path))

    def _offer(self, path: str) -> str:
        known = list(self.paths)
        near = get_close_matches(path, known, 3, 0.7)
        words = f"Did you mean {_or([visible(p) for p in near])}? " if near else ""
        # what there is where the path still was right
        stem = path
        while stem and not any(p.startswith((f"{stem}.", f"{stem}[")) for p in known):
            stem = stem.rpartition(".")[0]
        if not stem:
            heads = dict.fromkeys(re.split(r"[.\[]", p)[0] for p in known)
            every = "`strutwork study MACHINE --paths` lists all."
            return f"{words}Paths begin with {_some(list(heads))} {every}"
        return f"{words}There are {_some([p for p in known if p.startswith(stem)])}"

    def values(self, paths: Iterable[str]) -> dict[str, float]:
        """The numbers as the machine states them, SI.

        Parameters
        ----------
        paths : iterable of str
            With a star: all that match.

        Raises
        ------
        ModelError
            As `matching`.
        """
        return {n.path: n.value for path in paths for n in self.matching(path)}

    def read(self, values: Mapping[str, float | str]) -> dict[str, float]:
        """Each single number that is changed, SI, checked against the range of its field.

        Parameters
        ----------
        values : mapping of path to float or str
            SI, or text with its unit.

        Raises
        ------
        ModelError
            As `matching`; a number that two paths name; a value out of range.
        UnitError
            A value of another dimension.
        """
        found: dict[str, float] = {}
        of: dict[str, str] = {}
        for path, value in values.items():
            for number in self.matching(path):
                if number.path in found:
                    raise ModelError(
                        number.path,
                        f"is named by {visible(of[number.path])} and by {visible(path)}.",
                        "Name each number once.",
                    )
                found[number.path], of[number.path] = number.read(value), path
        return found

    def model(self, values: Mapping[str, float | str] | None = None) -> Model:
        """The machine with other numbers.

        Sections, materials, stiffnesses, masses, loads and tolerances change in a millisecond.
        Where nodes or axes change, the joints are closed anew, which takes longer.

        Parameters
        ----------
        values : mapping of path to float or str, optional
            SI, or text with its unit; what is not named stays.

        Returns
        -------
        Model
            At home.

        Raises
        ------
        ModelError
            As `read`; sizes that do not fit one another; joints that do not close.
        """
        read = self.read(values or {})
        if not read:
            return self.origin.model
        paths = self.paths
        return self.origin.changed({s: v for p, v in read.items() for s in paths[p].places})

    __call__ = model


def _checked(origin: Any) -> Any:
    """What is wrong whatever the numbers comes now."""
    _ = origin.model
    return origin


def _or(words: Sequence[str]) -> str:
    quoted = [f'"{w}"' for w in words]
    return " or ".join([", ".join(quoted[:-1]), quoted[-1]] if len(quoted) > 1 else quoted)


def _some(words: Sequence[str]) -> str:
    shown = ", ".join(visible(w) for w in words[:OFFERED])
    return f"{shown} …" if len(words) > OFFERED else f"{shown}."
