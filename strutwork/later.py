"""Names of a package whose files are read when somebody first asks for them."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from types import ModuleType


def later(
    package: str, files: Mapping[str, str]
) -> tuple[Callable[[str], object], Callable[[], list[str]]]:
    """`__getattr__` and `__dir__` of a package that reads some of its files late.

    A name may be that of its file, as `solve` of `solve.py`: Python would put the file in the
    place of the name once it is read, whoever reads it, and is kept from it.

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
    module = sys.modules[package]
    space = module.__dict__

    class Package(ModuleType):
        def __setattr__(self, name: str, value: object) -> None:
            if isinstance(value, ModuleType) and files.get(name) == name:
                value = getattr(value, name)
            super().__setattr__(name, value)

    if any(name == file for name, file in files.items()):
        module.__class__ = Package

    def get(name: str) -> object:
        if name not in files:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        value: object = getattr(import_module(f"{package}.{files[name]}"), name)
        space[name] = value
        return value

    def names() -> list[str]:
        return sorted({*space, *space["__all__"]})

    return get, names
