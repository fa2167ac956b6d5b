"""Arguments and options that several commands share, and the words that options take."""

from __future__ import annotations

from enum import StrEnum
from itertools import islice
from pathlib import Path
from typing import Annotated

import typer

from strutwork.reports.cli.usage import typed

#: Entries of a folder that a shell's completion looks at.
MOST = 1000


class Objective(StrEnum):
    """What an allocation of tolerances aims at."""

    UNIFORM = "uniform"
    COST = "cost"


class Ranges(StrEnum):
    """Joints whose ranges a pose must keep."""

    ALL = "all"
    REVOLUTE = "revolute"
    NONE = "none"


def targets(incomplete: str) -> list[str]:
    """What a shell offers for a machine: those of the literature, model files and folders.

    Parameters
    ----------
    incomplete : str
        What was typed.
    """
    from strutwork.machines.catalogue import CATALOGUE

    folder, _, start = incomplete.rpartition("/")
    inside = Path(folder or ("/" if incomplete.startswith("/") else "."))
    lead = incomplete[: len(incomplete) - len(start)]
    try:
        beside = sorted(
            lead + entry.name + ("/" if entry.is_dir() else "")
            for entry in islice(inside.iterdir(), MOST)
            if entry.name.startswith(start)
            and (entry.suffix == ".toml" or entry.is_dir())
            and not entry.name.startswith(".")
        )
    except OSError:
        beside = []
    return [name for name in CATALOGUE if name.startswith(incomplete)] + beside


Json = Annotated[
    bool, typer.Option("--json", help="Print one JSON object, in SI units, and nothing else.")
]

Target = Annotated[
    str,
    typer.Argument(
        metavar="FILE_OR_MACHINE",
        help="A model file, or a machine: NAME or NAME:VARIANT.",
        autocompletion=targets,
    ),
]
Pose = Annotated[
    list[str] | None,
    typer.Option(
        "--pose",
        callback=typed,
        metavar="DIR=VALUE,...",
        help="Pose of the tool, as in --pose x=20mm,rz=5deg: x, y, z of the tool centre point, "
        "and its rotation vector from home. Directions not named stay at home where "
        "possible.",
    ),
]
JointAt = Annotated[
    list[str] | None,
    typer.Option(
        "--joint",
        callback=typed,
        metavar="JOINT:DIR=VALUE",
        help="A joint coordinate, driven or not, as in --joint ram1:z=310mm. Repeatable.",
    ),
]
Ratio = Annotated[
    float | None,
    typer.Option(
        "--modal-ratio", help="Damping ratio of every mode, instead of the file's damping."
    ),
]
Loss = Annotated[
    float | None,
    typer.Option("--loss-factor", help="Structural loss factor, instead of the file's damping."),
]

Preload = Annotated[
    str | None,
    typer.Option(
        "--preload",
        callback=typed,
        metavar="CASE",
        help="Load case under which it vibrates, instead of the file's preload.",
    ),
]

Over = Annotated[
    list[str] | None,
    typer.Option(
        "--over",
        callback=typed,
        metavar="DIR=LOW..HIGH:N,...",
        help="Also over poses of the tool, as in --over x=-100mm..100mm:5, or --over "
        "workspace for those of the file.",
    ),
]
Workers = Annotated[
    int | None,
    typer.Option("--workers", min=1, help="Number of threads; one per processor by default."),
]
