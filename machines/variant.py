"""One of several models of a machine."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from strutwork.machines.catalogue import Machine


@dataclass(frozen=True)
class Variant:
    """One model of a machine.

    Parameters
    ----------
    name : str
    description : str
        What sets it apart from the others.
    factory : callable
        Makes the machine.
    around_home : mapping of direction to (float, int), optional
        As its entry's, where it moves in other directions.
    report : str
        As its entry's, where a document has chapters for this model; empty where its report is that
        of any machine.
    """

    name: str
    description: str
    factory: Callable[[], Machine]
    around_home: Mapping[str, tuple[float, int]] | None = None
    report: str = ""
