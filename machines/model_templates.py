"""Model files to start from: one of each common architecture."""

from __future__ import annotations

import re
from importlib.resources import files
from importlib.resources.abc import Traversable

from strutwork.errors import ModelError

_TITLE = re.compile(r'^title = ".*"$', re.MULTILINE)


def template_names() -> tuple[str, ...]:
    """Names of the templates."""
    found = (p.name for p in _folder().iterdir())
    return tuple(sorted(name.removesuffix(".toml") for name in found if name.endswith(".toml")))


def template(name: str, title: str | None = None) -> str:
    """Text of a model file.

    Parameters
    ----------
    name : str
        One of `template_names`, in letters of any case.
    title : str, optional
        In place of its own.

    Raises
    ------
    ModelError
        No such template.
    """
    known = {n.casefold(): n for n in template_names()}
    if name.casefold() not in known:
        raise ModelError(
            "template", f'"{name}" is not known.', "Choose one of: " + ", ".join(template_names())
        )
    text = (_folder() / f"{known[name.casefold()]}.toml").read_text(encoding="utf-8")
    if title is None:
        return text
    # a title may hold any character that a TOML string takes
    quoted = title.replace("\\", "\\\\").replace('"', '\\"')
    return _TITLE.sub(lambda _: f'title = "{quoted}"', text, count=1)


def _folder() -> Traversable:
    return files("strutwork.machines") / "templates"
