"""The commands and their options.

A command imports its work when it runs, so that help and wrong usage answer at once.
"""

from __future__ import annotations

import sys
import warnings
from typing import Annotated

import typer

from strutwork import __version__
from strutwork.names import visible
from strutwork.reports.cli.choices import (
    JointAt,
    Json,
    Loss,
    Objective,
    Pose,
    Preload,
    Ratio,
    Target,
)
from strutwork.reports.cli.ending import CHECKED, OUT_OF_RANGE, guarded
from strutwork.reports.cli.streams import show_every_character
from strutwork.reports.cli.usage import Commands, typed
from strutwork.reports.cli.watch import watched

_HERE = "strutwork.reports.cli"

#: Where each command stands, in the order in which help lists them.
COMMANDS = {
    "machines": f"{_HERE}.app:machines",
    "check": f"{_HERE}.app:check",
    "bearings": f"{_HERE}.bearings_command:bearings",
    "solve": f"{_HERE}.app:solve",
    "map": f"{_HERE}.map_command:map_command",
    "modes": f"{_HERE}.app:modes",
    "frf": f"{_HERE}.frf_command:frf",
    "lobes": f"{_HERE}.lobes_command:lobes",
    "servo": f"{_HERE}.servo_command:servo",
    "calibrate": f"{_HERE}.calibrate_command:calibrate",
    "compare": f"{_HERE}.compare_command:compare",
    "correlate": f"{_HERE}.correlate_command:correlate",
    "tolerance": f"{_HERE}.app:tolerance",
    "scale": f"{_HERE}.app:scale",
    "accuracy": f"{_HERE}.accuracy_command:accuracy",
    "gradient": f"{_HERE}.gradient_command:gradient",
    "move": f"{_HERE}.move_command:move",
    "workspace": f"{_HERE}.workspace_command:workspace",
    "new": f"{_HERE}.new_command:new",
    "reversals": f"{_HERE}.reversals_command:reversals",
    "schema": f"{_HERE}.schema_command:schema",
    "singularities": f"{_HERE}.singularities_command:singularities",
    "trajectory": f"{_HERE}.trajectory_command:trajectory",
    "study": f"{_HERE}.study_command:study",
    "design": f"{_HERE}.design_command:design",
    "report": f"{_HERE}.report_command:report",
}

#: Those that print no tables, and take neither --csv nor --verbose.
SILENT = ("new", "report", "schema")

#: Those whose studies may be computed elsewhere and resumed: --cluster and --keep.
PLACED = ("accuracy", "compare", "design", "map", "scale", "study", "trajectory", "workspace")


class Program(Commands):
    """The program, whose commands are made when they are called or listed."""

    places = COMMANDS
    silent = SILENT
    placed = PLACED


app = typer.Typer(
    name="strutwork",
    cls=Program,
    help="Stiffness, mobility and joint forces of parallel and hybrid machines.",
    epilog="Exit status: 0 success, 1 the model is wrong or cannot be solved, 2 wrong usage, 3 a "
    "result cannot be written, 130 interrupted, 141 the reader of the output has gone.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def main() -> None:
    """Run the program: the console script."""
    show_every_character()
    said: set[str] = set()

    def show(message: Warning | str, *_: object, **__: object) -> None:
        # the steps of one command may warn of the same thing
        if str(message) not in said:
            sys.stderr.write(f"Warning: {visible(str(message), lines=True)}\n")
        said.add(str(message))

    with warnings.catch_warnings():
        warnings.showwarning = show
        # NumPy's words name no part of a model: `guarded` says what the reader can do
        warnings.filterwarnings("error", OUT_OF_RANGE, RuntimeWarning)
        # within other libraries' steps it is no verdict: what they answer is checked by itself
        warnings.filterwarnings("ignore", OUT_OF_RANGE, RuntimeWarning, module=CHECKED)
        with watched():
            sys.exit(guarded(app))


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"strutwork {__version__}")
        raise typer.Exit


@app.callback()
def program(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version."
        ),
    ] = False,
) -> None:
    """Stiffness, mobility and joint forces of parallel and hybrid machines."""


def machines(json: Json = False) -> None:
    """List the machines of the literature, with their papers."""
    from strutwork.reports.cli import machines as work

    work.run(json)


def check(target: Target, pose: Pose = None, joint: JointAt = None, json: Json = False) -> None:
    """Count freedoms and redundant constraints of a machine, and name them."""
    from strutwork.reports.cli import check as work
    from strutwork.reports.cli.subject import subject

    work.run(subject(target, pose, joint), json)


def solve(target: Target, pose: Pose = None, joint: JointAt = None, json: Json = False) -> None:
    """Solve the load cases of a machine, and the stiffness at its tool."""
    from strutwork.reports.cli import solve as work
    from strutwork.reports.cli.subject import subject

    work.run(subject(target, pose, joint), json)


def modes(
    target: Target,
    count: Annotated[
        int,
        typer.Option(
            "--count",
            "-n",
            min=1,
            help="Number of elastic modes; rigid-body modes come first, in addition.",
        ),
    ] = 10,
    pose: Pose = None,
    joint: JointAt = None,
    out: Annotated[
        str | None,
        typer.Option(
            "--out", "-o", metavar="DIR", help="Write them to this folder as a universal file."
        ),
    ] = None,
    modal_ratio: Ratio = None,
    loss_factor: Loss = None,
    preload: Preload = None,
    json: Json = False,
) -> None:
    """Find the lowest natural frequencies, with their shapes and damping ratios."""
    from strutwork.reports.cli import modes as work
    from strutwork.reports.cli.subject import where

    work.run(
        target,
        count,
        out,
        at=where(pose, joint),
        modal_ratio=modal_ratio,
        loss_factor=loss_factor,
        preload=preload,
        json=json,
    )


def tolerance(
    target: Target,
    pose: Pose = None,
    joint: JointAt = None,
    limit: Annotated[
        list[str] | None,
        typer.Option(
            callback=typed,
            metavar="[JOINT:]KIND=VALUE",
            help=(
                "A force limit in addition to the file's, as in --limit radial_force=2kN. "
                "Repeatable."
            ),
        ),
    ] = None,
    allocation: Annotated[
        Objective | None,
        typer.Option("--allocate", help="Find the largest tolerances that meet all limits."),
    ] = None,
    quantile: Annotated[
        float | None,
        typer.Option(
            min=0.0,
            max=1.0,
            help="Share of the assemblies that must meet the limits; all by default.",
        ),
    ] = None,
    samples: Annotated[
        int, typer.Option(min=0, max=100_000_000, help="Number of assemblies sampled; 0 for none.")
    ] = 100_000,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the random numbers.")] = 2002,
    quasi: Annotated[
        bool, typer.Option("--quasi", help="Use scrambled Sobol' points instead of random ones.")
    ] = False,
    out: Annotated[
        str | None,
        typer.Option(
            "--out", "-o", metavar="DIR", help="Write them to this folder as NetCDF and CSV."
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Find the forces that tolerances lock in, at worst and in distribution."""
    if quantile is not None and allocation is None:
        raise typer.BadParameter("--quantile belongs to --allocate.")
    from strutwork.reports.cli import tolerance as work
    from strutwork.reports.cli.subject import where
    from strutwork.studies.tolerance_study import StudyOptions

    options = StudyOptions(
        samples=samples,
        seed=seed,
        method="quasi_monte_carlo" if quasi else "monte_carlo",
        objective=None if allocation is None else allocation.value,
        quantile=quantile,
    )
    work.run(target, limit or (), options, out, at=where(pose, joint), json=json)


def scale(
    machine: Annotated[
        str,
        typer.Argument(
            metavar="FILE_OR_MACHINE", help="A model file, or a machine: NAME or NAME:VARIANT."
        ),
    ],
    pose: Pose = None,
    joint: JointAt = None,
    low: Annotated[
        float | None,
        typer.Option(
            "--from",
            help="Smallest size relative to its own, 0.25 by default; where its document "
            "studies the size, the quantity varied there, such as the shortest struts in "
            "m.",
        ),
    ] = None,
    high: Annotated[
        float | None,
        typer.Option("--to", help="Largest size, 4 by default, or as with --from."),
    ] = None,
    lengths: Annotated[
        int | None,
        typer.Option(
            min=2,
            max=10_000,
            help="Number of sizes: 9 by default, 30 where a document has a study.",
        ),
    ] = None,
    width_ratio: Annotated[
        float, typer.Option(help="Ratio of the width of a strut to its length.")
    ] = 0.2,
    tilt: Annotated[
        str, typer.Option(metavar="ANGLE", help="Parallelism of the axes: half-angle of the cone.")
    ] = "300 um/m",
    out: Annotated[
        str | None,
        typer.Option(
            "--out", "-o", metavar="DIR", help="Write them to this folder as NetCDF and CSV."
        ),
    ] = None,
    granite: Annotated[
        bool,
        typer.Option(
            "--granite", help="Include the granite as a solid in stiffness and frequencies."
        ),
    ] = False,
    json: Json = False,
) -> None:
    """Show what the size of a machine does to its stiffness and frequencies.

    Where its document studies its size, to locked-in forces too: --width-ratio, --tilt and
    --granite are of this.
    """
    from strutwork.machines.load import load_heavy
    from strutwork.reports.cli import scale as work
    from strutwork.reports.cli.subject import where

    at = where(pose, joint)
    if not (at.home and work.is_studied(machine)):
        from strutwork.reports.cli import scale_any

        scale_any.run(at.put(load_heavy(machine)), machine, (low, high), lengths, out, json=json)
        return
    study = work.study_of(machine)
    span = (0.1 if low is None else low, 3.0 if high is None else high)
    count = 30 if lengths is None else lengths
    study(machine, span, count, width_ratio, tilt, out, granite=granite, json=json)
