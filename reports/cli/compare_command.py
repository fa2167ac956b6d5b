"""The options of `strutwork compare`, and universal files under the command's earlier meaning."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from strutwork.errors import ModelError
from strutwork.reports.cli.choices import JointAt, Json, Loss, Pose, Ratio, targets
from strutwork.reports.cli.correlate_command import DOUBLET, LEAST, WINDOW
from strutwork.reports.cli.usage import typed

#: Endings of universal files.
UNIVERSAL = frozenset({".uff", ".unv", ".bunv", ".ufb"})

#: Difference from which two numbers are marked, percent, as `strutwork.reports.designs.result`.
MARKED = 5.0

_MACHINE = "A model file, or a machine: NAME or NAME:VARIANT."


def compare(
    a: Annotated[
        str,
        typer.Argument(metavar="A", help=_MACHINE, autocompletion=targets),
    ],
    b: Annotated[
        str,
        typer.Argument(metavar="B", help=_MACHINE, autocompletion=targets),
    ],
    pose: Pose = None,
    joint: JointAt = None,
    around: Annotated[
        list[str] | None,
        typer.Option(
            callback=typed,
            metavar="DIR=LOW..HIGH:N,...",
            help="Poses relative to the home of each machine, as in --around x=-20mm..20mm:5; by "
            "default those that both workspaces contain.",
        ),
    ] = None,
    threshold: Annotated[
        float, typer.Option(min=0.0, help="Difference from which numbers are marked, percent.")
    ] = MARKED,
    modal_ratio: Ratio = None,
    loss_factor: Loss = None,
    html: Annotated[
        str | None,
        typer.Option(metavar="FILE", help="Write the comparison there as one page."),
    ] = None,
    window: Annotated[float, typer.Option(hidden=True)] = WINDOW,
    least: Annotated[float, typer.Option(hidden=True)] = LEAST,
    doublet: Annotated[float, typer.Option(hidden=True)] = DOUBLET,
    unit: Annotated[list[str] | None, typer.Option(hidden=True)] = None,
    json: Json = False,
) -> None:
    """Compare two machines, question by question, with the differences marked.

    Universal files (UFF) are compared by `strutwork correlate`.
    """
    files = [name for name in (a, b) if is_universal(name)]
    if len(files) == 2:
        from strutwork.reports.cli import correlate as earlier
        from strutwork.reports.cli.output import tell

        tell(
            "Note: computed and measured universal files are compared by `strutwork correlate`; "
            "`strutwork compare` is for two machines."
        )
        earlier.run(a, b, window=window, least=least, doublet=doublet, units=unit or (), json=json)
        return
    if files:
        raise ModelError(
            files[0],
            "is a universal file (UFF), not a machine.",
            "Write the computed modes as one too (strutwork modes -o DIR), and compare the two "
            "with `strutwork correlate COMPUTED MEASURED`.",
        )
    from strutwork.reports.cli import compare as work
    from strutwork.reports.cli.subject import where

    work.run(
        (a, b),
        where(pose, joint),
        around,
        threshold,
        html,
        modal_ratio=modal_ratio,
        loss_factor=loss_factor,
        json=json,
    )


def is_universal(name: str) -> bool:
    """Whether a name is that of a universal file, by its ending or its first line.

    Parameters
    ----------
    name : str
        As typed.
    """
    path = Path(name)
    if path.suffix.lower() in UNIVERSAL:
        return True
    try:
        if path.suffix == ".toml" or not path.is_file():
            return False
        with path.open("rb") as stream:
            return stream.read(80).strip().startswith(b"-1")
    except (OSError, ValueError):
        # whoever reads the machine says what is wrong with the name
        return False
