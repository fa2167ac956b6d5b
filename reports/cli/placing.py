"""Where the studies of a command are computed, and where their finished parts are kept.

The options are not handed through each command: whatever study runs inside takes them up.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from inspect import Parameter, signature
from pathlib import Path
from typing import Annotated, Any, get_type_hints

import typer

Cluster = Annotated[
    str | None,
    typer.Option(
        "--cluster",
        metavar="ADDRESS",
        help="Compute on a Dask cluster, as in --cluster tcp://10.0.0.1:8786; --cluster local "
        "starts processes here.",
    ),
]
Keep = Annotated[
    str | None,
    typer.Option(
        "--keep",
        metavar="DIR",
        help="Keep finished parts of the work there; the same command goes on from them.",
    ),
]


def placed(command: Callable[..., None]) -> Callable[..., None]:
    """A command with the two options beside its own."""

    @wraps(command)
    def somewhere(
        *args: Any, cluster: str | None = None, keep: str | None = None, **extra: Any
    ) -> None:
        if cluster is None and keep is None:
            command(*args, **extra)
            return
        from strutwork.studies.cluster import Dask
        from strutwork.studies.executor import computed_on

        executor = None if cluster is None else Dask(cluster)
        try:
            with computed_on(executor, None if keep is None else Path(keep)):
                command(*args, **extra)
        finally:
            if executor is not None:
                executor.close()

    own = signature(command)
    hints = get_type_hints(command, include_extras=True)
    added = {"cluster": Cluster, "keep": Keep}
    kinds = [p.replace(annotation=hints[name]) for name, p in own.parameters.items()]
    kinds += [
        Parameter(name, Parameter.KEYWORD_ONLY, default=None, annotation=kind)
        for name, kind in added.items()
    ]
    # what typer reads a command's options from
    somewhere.__signature__ = own.replace(parameters=kinds)  # type: ignore[attr-defined]
    somewhere.__annotations__ = hints | added
    return somewhere
