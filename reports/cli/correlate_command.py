"""The options of `strutwork correlate`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import Json

#: Pairing of modes: shared with the earlier name of the command.
WINDOW, LEAST, DOUBLET = 0.3, 0.5, 0.01


def correlate(
    computed: Annotated[str, typer.Argument(metavar="COMPUTED", help="A universal file (UFF).")],
    measured: Annotated[str, typer.Argument(metavar="MEASURED", help="A universal file (UFF).")],
    window: Annotated[
        float, typer.Option(help="Largest difference of a pair, as a share of the frequency.")
    ] = WINDOW,
    least: Annotated[float, typer.Option(help="Least MAC of a pair.")] = LEAST,
    doublet: Annotated[
        float,
        typer.Option(help="Neighbouring modes within this share of the frequency are one span."),
    ] = DOUBLET,
    unit: Annotated[
        list[str] | None,
        typer.Option(
            metavar="LABEL=UNIT",
            help='Unit of an unknown axis label, as in --unit "EU=mm/s^2". Repeatable.',
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Compare computed modes and responses with measured ones."""
    from strutwork.reports.cli import correlate as work

    work.run(
        computed,
        measured,
        window=window,
        least=least,
        doublet=doublet,
        units=unit or (),
        json=json,
    )
