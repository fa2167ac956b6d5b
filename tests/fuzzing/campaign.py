"""A campaign: mutants spread over processes, each watched, so that a hang is a fault too."""

from __future__ import annotations

import multiprocessing
import os
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from pathlib import Path

from tests.fuzzing.judge import Fault, commands, tried
from tests.fuzzing.mutations import mutant, seeds

#: Longest time one command may take, s: the report on a sound hexapod one of whose drives stands
#: askew, so that no leg is solved by itself, takes 200 s on one busy core.
PATIENCE = 300.0

TELL_EVERY = 500


@dataclass
class _Worker:
    process: multiprocessing.process.BaseProcess
    link: Connection
    number: int = -1
    command: tuple[str, ...] = ()
    since: float = 0.0


@dataclass(frozen=True)
class Outcome:
    """What a campaign found."""

    mutants: int
    runs: int
    #: Runs that ended in a message and not in a result.
    refused: int
    faults: tuple[Fault, ...]


def campaign(numbers: Iterable[int], workers: int | None = None) -> Outcome:
    """Give every mutant to every command.

    A mutant that kills its process or does not end in `PATIENCE` is a fault; the campaign goes on.
    """
    waiting = iter(numbers)
    count = workers or len(os.sched_getaffinity(0))
    crew = [_started() for _ in range(count)]
    found: list[Fault] = []
    totals = [0, 0, 0]
    try:
        active = [w for w in crew if _next(w, waiting)]
        while active:
            ready = wait([w.link for w in active], timeout=1.0)
            for worker in list(active):
                ended = False
                if worker.link in ready:
                    ended = _heard(worker, found, totals)
                elif time.monotonic() - worker.since > PATIENCE:
                    found.append(Fault(worker.number, worker.command, "does not end"))
                    _restart(worker)
                    ended = True
                if ended and not _next(worker, waiting):
                    active.remove(worker)
    finally:
        for worker in crew:
            worker.process.kill()
    return Outcome(totals[0], totals[1], totals[2], tuple(found))


def _next(worker: _Worker, waiting: Iterator[int]) -> bool:
    """Hand the worker its next mutant; False when there is none."""
    number = next(waiting, None)
    if number is None:
        return False
    worker.number, worker.command, worker.since = number, (), time.monotonic()
    worker.link.send(number)
    return True


def _heard(worker: _Worker, found: list[Fault], totals: list[int]) -> bool:
    """Take one message; True when the mutant is done."""
    try:
        message = worker.link.recv()
    except (EOFError, ConnectionError):
        worker.process.join()
        what = f"its process ended with {worker.process.exitcode}"
        found.append(Fault(worker.number, worker.command, what))
        _restart(worker)
        return True
    worker.since = time.monotonic()
    if isinstance(message, tuple):
        worker.command = message
        totals[1] += 1
        return False
    new, refused = message["faults"], message["refused"]
    found += new
    for fault in new:
        sys.stderr.write(f"{fault}\n")
    totals[0] += 1
    totals[2] += refused
    if totals[0] % TELL_EVERY == 0:
        sys.stderr.write(f"{totals[0]} mutants, {totals[1]} runs, {len(found)} faults\n")
    return True


def _started() -> _Worker:
    # a fresh interpreter: threads of the parent cannot be forked
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    process = context.Process(target=_work, args=(there,), daemon=True)
    process.start()
    there.close()
    return _Worker(process, here)


def _restart(worker: _Worker) -> None:
    worker.process.kill()
    worker.process.join()
    new = _started()
    worker.process, worker.link = new.process, new.link


def _work(link: Connection) -> None:
    """What a process does: take numbers, tell each command before it runs, then its faults."""
    texts = seeds()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        while True:
            number = link.recv()
            model = folder / f"mutant-{number}.toml"
            model.write_text(mutant(number, texts).text, encoding="utf-8", errors="surrogatepass")
            found: list[Fault] = []
            refused = 0
            for command in commands(number, model, folder / f"out-{number}"):
                link.send(command)
                new, answered = tried(number, command)
                found += new
                refused += not answered
            model.unlink()
            link.send({"faults": found, "refused": refused})
