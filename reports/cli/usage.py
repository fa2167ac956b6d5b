"""What a user typed: names whole whatever the locale, and wrong usage told without acting on it."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from typing import Any, ClassVar

import typer
from typer.core import TyperGroup

from strutwork.names import visible
from strutwork.reports.cli.manner import speaking
from strutwork.reports.cli.placing import placed

#: Base of what typer raises for wrong usage, wherever its release keeps it.
USAGE_ERROR: type[Any] = typer.BadParameter.__mro__[1]


class Made(Mapping[str, Any]):
    """Commands by name, each made when it is first asked for: typer takes milliseconds for one.

    Parameters
    ----------
    places : mapping of name to str
        Where each stands, "MODULE:FUNCTION".
    silent : collection of str
        Those that print no tables.
    elsewhere : collection of str
        Those whose studies may be computed elsewhere.
    """

    def __init__(
        self, places: Mapping[str, str], silent: Collection[str], elsewhere: Collection[str]
    ) -> None:
        self._places, self._silent, self._elsewhere = places, silent, elsewhere
        self._made: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Any:
        if name not in self._made:
            module, _, function = self._places[name].partition(":")
            work = getattr(import_module(module), function)
            if name in self._elsewhere:
                work = placed(work)
            one = typer.Typer(add_completion=False)
            one.command(name)(work if name in self._silent else speaking(work))
            self._made[name] = typer.main.get_command(one)
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)


class Commands(TyperGroup):
    """The commands; what they say of wrong usage acts on no terminal."""

    #: Where each command is, those that print no tables, and those that may run elsewhere.
    places: ClassVar[Mapping[str, str]] = {}
    silent: ClassVar[Collection[str]] = ()
    placed: ClassVar[Collection[str]] = ()

    def __init__(self, *args: Any, **extra: Any) -> None:
        super().__init__(*args, **extra)
        self.commands: Any = Made(self.places, self.silent, self.placed)

    def make_context(self, *args: Any, **extra: Any) -> Any:
        """Read the options before the command."""
        with _shown_whole():
            return super().make_context(*args, **extra)

    def invoke(self, *args: Any) -> Any:
        """Read the options of a command and run it."""
        with _shown_whole():
            return super().invoke(*args)


@contextmanager
def _shown_whole() -> Iterator[None]:
    try:
        yield
    except USAGE_ERROR as error:
        error.message = visible(error.message)
        raise


def typed(value: str | list[str] | None) -> str | list[str] | None:
    """Names as they were typed: a locale of ASCII hands over their UTF-8 byte by byte."""
    if isinstance(value, list):
        return [str(typed(one)) for one in value]
    if value is None or value.isascii():
        return value
    try:
        value.encode()
    except UnicodeEncodeError:
        return os.fsencode(value).decode("utf-8", "surrogateescape")
    return value
