"""What a user typed: names whole whatever the locale, and wrong usage told without acting on it."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import typer
from typer.core import TyperGroup

from strutwork.names import visible

#: Base of what typer raises for wrong usage, wherever its release keeps it.
USAGE_ERROR: type[Any] = typer.BadParameter.__mro__[1]


class Commands(TyperGroup):
    """The commands; what they say of wrong usage acts on no terminal."""

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
