"""What `papers` adds to a machine, named as data and found when it is asked for."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from strutwork.errors import ModelError

#: Where all that compares with a document lies.
ROOM = "strutwork.papers."


def resolve(reference: str) -> Any:
    """The function that a catalogue's entry names.

    `papers` stands on the highest floor: nothing below imports it, and a machine's entry says in
    words what it adds.

    Parameters
    ----------
    reference : str
        `MODULE:NAME`, the module in `strutwork.papers`.

    Raises
    ------
    ModelError
        Text of another shape, another package, or a name that is not there.
    """
    module, mark, name = reference.partition(":")
    if not (mark and name and module.startswith(ROOM)):
        raise ModelError(
            f'reference "{reference}"',
            f"does not name a part of {ROOM.rstrip('.')}.",
            f"Write it as {ROOM}PAPER.MODULE:NAME.",
        )
    try:
        return getattr(import_module(module), name)
    except (ModuleNotFoundError, AttributeError) as error:
        raise ModelError(
            f'reference "{reference}"', f"leads nowhere: {error}.", "Correct the entry."
        ) from error
