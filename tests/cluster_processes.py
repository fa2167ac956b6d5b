"""A scheduler and workers of Dask as processes of their own, to be killed by tests."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).parents[1]
#: What a test machine may take to start a process, s.
STARTS = 120.0


@dataclass
class Cluster:
    """Processes of a cluster."""

    folder: Path
    scheduler: subprocess.Popen[bytes]
    address: str
    workers: list[subprocess.Popen[bytes]] = field(default_factory=list)

    def add_worker(self) -> subprocess.Popen[bytes]:
        """Start one with a thread, and no nanny that would start it again."""
        made = _started("worker", self.address, "--nthreads", "1", "--no-nanny", "--no-dashboard")
        self.workers.append(made)
        return made

    def end(self) -> None:
        for process in (*self.workers, self.scheduler):
            if process.poll() is None:
                process.send_signal(signal.SIGKILL)
            process.wait()


def _started(*arguments: str, **more: str) -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        [sys.executable, "-m", "dask", *arguments],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT), **more},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


@contextmanager
def cluster(folder: Path, workers: int, deaths: int = 3) -> Iterator[Cluster]:
    """A scheduler that answers, and workers that may still be starting.

    A chunk may end `deaths` workers before it is given up with the next one.
    """
    stated = folder / "scheduler.json"
    scheduler = _started(
        "scheduler", "--port", "0", "--host", "127.0.0.1", "--no-dashboard",
        "--scheduler-file", str(stated),
        DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES=str(deaths),
    )  # fmt: skip
    made = Cluster(folder, scheduler, "")
    try:
        end = time.monotonic() + STARTS
        while not (stated.exists() and stated.read_text(encoding="utf-8").rstrip().endswith("}")):
            assert scheduler.poll() is None, "the scheduler ended"
            assert time.monotonic() < end, "the scheduler does not start"
            time.sleep(0.1)
        made.address = str(json.loads(stated.read_text(encoding="utf-8"))["address"])
        for _ in range(workers):
            made.add_worker()
        yield made
    finally:
        made.end()
