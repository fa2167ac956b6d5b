"""Names of a package whose files are read when somebody first asks for them."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from importlib import import_module


def later(
    package: str, files: Mapping[str, str]
) -> tuple[Callable[[str], object], Callable[[], list[str]]]:
    """`__getattr__` and `__dir__` of a package that reads some of its files late.

    A public name must not be the name of its file: Python puts the file itself in the place of
    such a name once it is read.

    Parameters
    ----------
    package : str
        Its `__name__`.
    files : mapping of str to str
        The file, without its ending, in which each name stands.

    Returns
    -------
    tuple of two callables
        Both for the package's own namespace.
    """
    space = sys.modules[package].__dict__

    def get(name: str) -> object:
        if name not in files:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        value: object = getattr(import_module(f"{package}.{files[name]}"), name)
        space[name] = value
        return value

    def names() -> list[str]:
        return sorted({*space, *space["__all__"]})

    return get, names
