"""Questions answered by processes beside this one, a processor each.

Much of a search runs in Python, which threads of one process cannot do at the same time.
Processes are forked: they have the machine and all compiled code at once, and a program that asks
for a report needs no guard around its main part. Where a system has no fork, and on a single
processor, nothing is done beside.
"""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from multiprocessing.connection import Connection, wait
from typing import Any

from threadpoolctl import threadpool_limits

from strutwork.reports.answers import Outcome, outcome_of

#: Questions by their names; those of a group need one another and are asked in this order.
Group = Mapping[str, Callable[[], Any]]

#: Time between two looks at what is done, s.
LOOK = 0.5


def processors() -> int:
    """How many processes may work at the same time."""
    if sys.platform == "win32" or "fork" not in multiprocessing.get_all_start_methods():
        return 1
    # a worker of someone's pool may have no processes of its own
    if multiprocessing.current_process().daemon:
        return 1
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else 1


class Beside:
    """Processes that answer groups of questions, in the order of the groups.

    Parameters
    ----------
    groups : sequence of mappings
        Each question keeps its answer itself, where it is to outlive the program.
    workers : int
    """

    def __init__(self, groups: Sequence[Group], workers: int) -> None:
        self.found: dict[str, Outcome] = {}
        self.asked = [name for group in groups for name in group]
        self._open: list[Connection] = []
        self._processes: list[Any] = []
        context = multiprocessing.get_context("fork")
        turn = context.Value("i", 0)
        for _ in range(min(workers, len(groups))):
            ear, mouth = context.Pipe(duplex=False)
            process = context.Process(
                target=_work, args=(groups, turn, mouth, os.getpid()), daemon=True
            )
            with warnings.catch_warnings():
                # the threads of this process are watches: they hold no lock that a child needs
                warnings.simplefilter("ignore", DeprecationWarning)
                process.start()
            mouth.close()
            self._open.append(ear)
            self._processes.append(process)

    def look(self, patience: float = 0.0) -> None:
        """Take what is done."""
        for ear in wait(self._open, patience) if self._open else ():
            assert isinstance(ear, Connection)  # noqa: S101 - all are
            try:
                name, outcome = pickle.loads(ear.recv_bytes())  # noqa: S301 - our own process
                self.found[name] = outcome
            except (EOFError, OSError):
                self._open.remove(ear)
                ear.close()

    def get(self, name: str, meanwhile: Callable[[], object]) -> Outcome | None:
        """Wait for an answer; None where no process will give it any more."""
        while name not in self.found and self._open and name in self.asked:
            self.look(LOOK)
            meanwhile()
        return self.found.get(name)

    def end(self) -> None:
        """End all processes, whatever they do."""
        for ear in self._open:
            ear.close()
        self._open.clear()
        for process in self._processes:
            process.terminate()
            process.join()


def _work(
    groups: Sequence[Group],
    turn: Any,
    mouth: Connection,
    parent: int,
) -> None:
    # Ctrl-C ends it without a word; the parent's wake-up is not its own
    signal.set_wakeup_fd(-1)
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    threading.Thread(target=_guard, args=(parent,), daemon=True).start()
    with threadpool_limits(limits=1):
        while True:
            with turn.get_lock():
                number = turn.value
                turn.value += 1
            if number >= len(groups):
                return
            for name, find in groups[number].items():
                outcome = outcome_of(find)
                try:
                    mouth.send_bytes(pickle.dumps((name, outcome)))
                except (AttributeError, TypeError, pickle.PicklingError):
                    # an answer that cannot be passed on is found again where it is needed
                    continue
                except OSError:
                    return


def _guard(parent: int) -> None:
    """End with the parent, however it ended."""
    while os.getppid() == parent:
        time.sleep(1.0)
    os._exit(1)
