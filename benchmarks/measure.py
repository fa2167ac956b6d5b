"""What the benchmarks share: rates, agreements, and the options of their programs."""

from __future__ import annotations

import argparse
import os
import platform
import statistics
import sys
import time
from collections.abc import Callable, Sequence
from importlib.util import find_spec
from pathlib import Path

import numpy as np

#: The pages with the tables.
DOCUMENTS = Path(__file__).resolve().parent.parent / "docs"


def rate(task: Callable[[], object], poses: int, rounds: int = 5) -> float:
    """Median poses per second of processor time over some rounds, after one that does not count.

    Processor time, of all threads together: what else runs on the machine hardly matters.
    """
    return _rate(task, poses, rounds, time.process_time)


def wall_rate(task: Callable[[], object], poses: int, rounds: int = 5) -> float:
    """As `rate`, by the clock on the wall: for what runs on several threads."""
    return _rate(task, poses, rounds, time.perf_counter)


def _rate(task: Callable[[], object], poses: int, rounds: int, clock: Callable[[], float]) -> float:
    task()
    if "--smallest" in sys.argv:
        # agreements are checked, and nobody reads the rates
        rounds = 1
    seconds = []
    for _ in range(rounds):
        start = clock()
        task()
        seconds.append(clock() - start)
    return poses / max(statistics.median(seconds), 1e-9)


def machine_line() -> str:
    """What the figures were taken on."""
    return (
        f"Machine: {platform.machine()}, {os.cpu_count()} cores, "
        f"Python {platform.python_version()}, NumPy {np.__version__}."
    )


def installed(module: str, program: str) -> bool:
    """Whether a peer can be imported; says on standard error that it is left out."""
    if find_spec(module) is not None:
        return True
    left_out(program)
    return False


def left_out(program: str) -> None:
    """Say that a peer is left out."""
    sys.stderr.write(f"{program} is not installed: its row is left out.\n")


def require(right: bool, what: str) -> None:
    """Stop the benchmark where something it shows is not as promised.

    Raises
    ------
    RuntimeError
        States it.
    """
    if not right:
        raise RuntimeError(what)


def parser(description: str | None, document: Path) -> argparse.ArgumentParser:
    """Options that every benchmark has."""
    result = argparse.ArgumentParser(description=description)
    result.add_argument(
        "--smallest", action="store_true", help="seconds: agreements are checked, ratios are not"
    )
    result.add_argument("--write", action="store_true", help=f"write docs/{document.name}")
    return result


def parsed(options: argparse.ArgumentParser) -> argparse.Namespace:
    """The arguments; a table of the smallest size is refused before anything is measured."""
    arguments = options.parse_args()
    if arguments.smallest and arguments.write:
        options.error("--smallest is a check; its figures are not written")
    return arguments


def shown(text: str, document: Path, arguments: argparse.Namespace) -> None:
    """Print a page, and write it where that was asked."""
    sys.stdout.write(text)
    if arguments.write:
        from strutwork.files import write_text  # noqa: PLC0415 - only when asked

        write_text(document, text)


def one_thread(main: Callable[[], None]) -> None:
    """Run a benchmark with one BLAS thread, which stacks of small systems want."""
    from threadpoolctl import threadpool_limits  # noqa: PLC0415 - before any BLAS call

    with threadpool_limits(1, user_api="blas"):
        main()


def joined(lines: Sequence[str]) -> str:
    """A page from its lines."""
    return "\n".join([*lines, ""])
