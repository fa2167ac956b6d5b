"""What a command does with a mutant, and what of it is a fault."""

from __future__ import annotations

import contextlib
import io
import json
import random
import re
import sys
import traceback
import warnings
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from unittest import mock

import typer

from strutwork.errors import CacheWarning, ModelWarning, PoseWarning, UnverifiedWarning
from strutwork.overconstraint.influence import UndeterminedWarning
from strutwork.overconstraint.sources import ToleranceWarning
from strutwork.reports.cli import app as program
from strutwork.reports.cli.ending import WRONG

#: What every mutant is given to.
QUICK = ("check", "solve", "modes", "frf", "tolerance")

#: One mutant in so many is given to `report` too, which takes longer than all others together.
REPORT_EVERY = 50

#: One mutant in so many is moved, or asked over its workspace.
MOVED_EVERY = 3

#: One mutant in so many comes with a command on a machine of the catalogue.
MACHINES_EVERY = 40

NO_NUMBER = re.compile(r"(?<![\w\"'<.-])[-−+]?(nan|inf|infinity)(?![\w\"'>])", re.IGNORECASE)

#: Exit status of wrong usage.
USAGE = 2


@dataclass(frozen=True)
class Fault:
    """A command that did what no command may do."""

    number: int
    command: tuple[str, ...]
    what: str

    def __str__(self) -> str:
        return f"mutant {self.number}, {' '.join(self.command)}: {self.what}"


def commands(number: int, model: Path, folder: Path) -> list[tuple[str, ...]]:
    """The commands a mutant is given to, some with odd options."""
    rng = random.Random(f"commands {number}")  # noqa: S311 - the same commands every time
    odd = ("0", "-1", "1e300", "1e-300", "nan", "inf", "1e5", "x", "3")
    file = str(model)
    port = rng.choice(("TCP:x", "TCP:rz", "tip:z", "B:y", "C:z", "A:x", "x", ":", "TCP:w"))
    plain = [
        ("check", file),
        ("solve", file),
        ("modes", file, "-n", rng.choice(("1", "3", "10"))),
        ("frf", file, "--input", port, "--lines", "20"),
        ("tolerance", file, "--samples", rng.choice(("0", "200"))),
    ]
    if rng.random() < 0.2:
        plain[2] += rng.choice((("--modal-ratio", rng.choice(odd)), ("--preload", "cutting")))
    if rng.random() < 0.3:
        plain[3] += ("--from", rng.choice(odd), "--to", rng.choice(odd))
    if rng.random() < 0.1:
        plain[4] += rng.choice((("--allocate", "uniform"), ("--limit", f"force={rng.choice(odd)}")))
    if number % 3:
        plain = [(*c, "--json") for c in plain]
    if number % MOVED_EVERY == 0:
        plain.append(_moved(rng, file))
    if number % REPORT_EVERY == 0:
        plain.append(("report", file, "-o", str(folder / "report")))
    if number % MACHINES_EVERY == 0:
        plain.append(_of_a_machine(rng, odd))
    return plain


def _moved(rng: random.Random, file: str) -> tuple[str, ...]:
    """A command that moves a mutant, which may have no tool and no freedom."""
    pose = rng.choice(("x=1mm", "z=5mm,rx=2deg", "rz=nan", "y=1e30", "x=1mm,x=2mm", "w=3", "z"))
    grid = rng.choice(("x=0mm..5mm:3", "z=0.6..0.7:2", "rx=0deg..2deg:2", "x=1..0", "z=0..1e300:2"))
    return rng.choice(
        (
            ("move", file, "--pose", pose),
            ("move", file),
            ("map", file, "--over", grid),
            ("accuracy", file, "--pose", pose, "--drive-error", "5um"),
            ("singularities", file, "--pose", pose),
        )
    )


def _of_a_machine(rng: random.Random, odd: tuple[str, ...]) -> tuple[str, ...]:
    """A command that takes a machine's name, with odd options."""
    value = rng.choice(odd)
    machine = rng.choice(("mit-ss1", "hexel-hexapod", "prototype-3ppprs", "no-such-machine"))
    return rng.choice(
        (
            ("scale", "mit-ss1", "--to", value),
            ("scale", "mit-ss1", "--from", value),
            ("scale", "mit-ss1", "--width-ratio", value),
            ("scale", "mit-ss1", "--tilt", value),
            ("scale", "mit-ss1", "--lengths", value),
            ("map", machine, "--lattice", rng.choice(("1", value)[: 1 + (value != "1e5")])),
            ("map", machine, "--lattice", "1", "--rolls", rng.choice(("1", "0", "x", "-1"))),
            ("frf", machine, "--input", "TCP:x", "--from", "0", "--to", value),
            ("modes", machine, "-n", value),
        )
    )


#: What the program itself warns of, in words for its user.
OURS = (
    CacheWarning,
    ModelWarning,
    PoseWarning,
    ToleranceWarning,
    UndeterminedWarning,
    UnverifiedWarning,
)


@cache
def _built() -> object:
    """The program as it answers, built once: to read all its options takes as long as the work."""
    return typer.main.get_command(program.app)


def faults(number: int, command: tuple[str, ...]) -> list[Fault]:
    """Run one command in this process and say what is wrong with what it did."""
    return tried(number, command)[0]


def tried(number: int, command: tuple[str, ...]) -> tuple[list[Fault], bool]:
    """Run one command in this process: what is wrong with it, and whether it gave a result."""
    out, err = io.StringIO(), io.StringIO()
    found: list[str] = []
    status: object = 0
    before, sys.argv = sys.argv, ["strutwork", *command]
    try:
        with (
            warnings.catch_warnings(),
            contextlib.redirect_stdout(out),
            contextlib.redirect_stderr(err),
        ):
            # whatever NumPy or another library would tell the user is a fault, with its place
            warnings.simplefilter("error")
            for quiet in (DeprecationWarning, PendingDeprecationWarning, ResourceWarning):
                warnings.simplefilter("ignore", quiet)
            for ours in OURS:
                warnings.simplefilter("default", ours)
            with mock.patch.object(program, "app", _built()):
                program.main()
    except SystemExit as end:
        status = end.code or 0
    except BaseException as error:  # noqa: BLE001 - whatever escapes is what is looked for
        frames = traceback.extract_tb(error.__traceback__)[-4:]
        places = " < ".join(f"{Path(f.filename).name}:{f.lineno}" for f in reversed(frames))
        found.append(f"{type(error).__name__}: {str(error)[:200]} ({places})")
    finally:
        sys.argv = before
    if not found:
        found = judged(status, out.getvalue(), err.getvalue(), as_json="--json" in command)
    if _named(command[1]):
        found = [what for what in found if not what.startswith("prints")]
    return [Fault(number, command, what) for what in found], status == 0


def _named(file: str) -> bool:
    """Whether a name or a text of the file looks like a number that is not finite."""
    try:
        text = Path(file).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return False
    return any(NO_NUMBER.search(line.replace('"', " ")) for line in text.splitlines())


def judged(status: object, out: str, err: str, *, as_json: bool) -> list[str]:
    """What is wrong with how a command ended."""
    if status not in {0, WRONG, USAGE}:
        return [f"exit status {status}"]
    if "Traceback" in err:
        return ["a traceback on standard error"]
    if status:
        found = [] if not out else [f"a result with status {status}: {out[:80]}"]
        said, _, remedy = err.rpartition("Error: ")[2].strip().partition("\n")
        if status == WRONG and not (said and remedy):
            found.append(f"names no remedy: {err[-200:]!r}")
        if status == USAGE and "Error" not in err:
            found.append(f"does not say what is wrong: {err[-80:]!r}")
        return found
    if not as_json:
        return [f"prints {hit[0]}: {_around(out, hit)}" for hit in NO_NUMBER.finditer(out)][:1]
    bad: list[str] = []
    try:
        json.loads(out, parse_constant=bad.append)
    except ValueError:
        return [f"no JSON: {out[:80]}"]
    return [f"JSON holds {bad[0]}"] if bad else []


def _around(text: str, hit: re.Match[str]) -> str:
    return " ".join(text[max(hit.start() - 60, 0) : hit.end() + 30].split())
