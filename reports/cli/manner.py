"""How a command speaks to its reader: briefly or at length, in tables or as CSV.

Every command that prints tables takes the two options; they are kept here and not handed through
each command, since only what prints asks for them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from inspect import Parameter, signature
from typing import Annotated, Any, get_type_hints

import typer


@dataclass
class Manner:
    """The manner of the command that runs.

    Parameters
    ----------
    csv : bool
        Tables alone, as CSV.
    verbose : bool
        Also what is left out of a short answer.
    """

    csv: bool = False
    verbose: bool = False

    @property
    def whole(self) -> bool:
        """Whether nothing is left out."""
        return self.csv or self.verbose


#: Of the command that runs; set by its options each time, so that none is left of an earlier one.
MANNER = Manner()

Csv = Annotated[bool, typer.Option("--csv", help="Print only the tables, as CSV.")]
Verbose = Annotated[
    bool,
    typer.Option("--verbose", "-v", help="Also print what the short answer omits."),
]


def speaking(command: Callable[..., None]) -> Callable[..., None]:
    """A command with the two options beside its own."""

    @wraps(command)
    def spoken(*args: Any, csv: bool = False, verbose: bool = False, **extra: Any) -> None:
        MANNER.csv, MANNER.verbose = csv, verbose
        command(*args, **extra)

    own = signature(command)
    hints = get_type_hints(command, include_extras=True)
    added = {"csv": Csv, "verbose": Verbose}
    kinds = [p.replace(annotation=hints[name]) for name, p in own.parameters.items()]
    kinds += [
        Parameter(name, Parameter.KEYWORD_ONLY, default=False, annotation=kind)
        for name, kind in added.items()
    ]
    # what typer reads a command's options from
    spoken.__signature__ = own.replace(parameters=kinds)  # type: ignore[attr-defined]
    spoken.__annotations__ = hints | added
    return spoken
