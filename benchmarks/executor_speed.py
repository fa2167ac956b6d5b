"""What executors cost and gain, and a stiffness map that is streamed to disk.

Run `python -m benchmarks.executor_speed`; with `--write` its table goes to
docs/performance-studies.md. `--write --stream 10000000` has ten million poses in the table;
`--stream` alone streams so many poses, without the rest, and says its memory.
"""

from __future__ import annotations

import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from threading import Event, Thread

import numpy as np

from benchmarks.measure import (
    DOCUMENTS,
    joined,
    machine_line,
    one_thread,
    parsed,
    parser,
    require,
    shown,
)
from strutwork.machines import Proposed3PPRS
from strutwork.studies import hemisphere, stiffness_map
from strutwork.studies.chunks import Arrays, ChunkStore
from strutwork.studies.cluster import Dask
from strutwork.studies.executor import Executor, Threads
from strutwork.studies.run import Chunk, Run
from strutwork.studies.stiffness_map import map_function
from strutwork.studies.streaming import stream_stiffness_map

DOCUMENT = DOCUMENTS / "performance-studies.md"

#: Threads of the study that is killed.
WORKERS = 2
#: Load of other work, of a processor, below which the overhead is held to its bound.
QUIET = 0.3
#: Candidates at each point, and points of a lattice of fineness one.
ROLLS, POINTS = 24, 3.17
#: Points in a chunk that is looked at for Python's lock, and what counts as waiting for it, s.
LOOKS, LATE = 340, 5e-4


def waits(seconds: float, chunks: int, executor: Executor) -> float:
    """Share of the time that an executor adds to chunks that only wait, on one worker."""

    def work(chunk: Chunk) -> Arrays:
        time.sleep(seconds)
        return {"pose": np.zeros((chunk.stop - chunk.start, 36))}

    def run(chunks: int) -> float:
        begun = time.perf_counter()
        list(Run(executor=executor).chunks(work, 1000 * chunks, 1000, lambda: ""))
        return time.perf_counter() - begun

    run(2)
    return run(chunks) / (seconds * chunks) - 1.0


def map_seconds(lattice: int, executor: Executor) -> float:
    """Seconds of a stiffness map of the proposed machine, the less of two after one more."""
    machine = Proposed3PPRS()
    points = hemisphere(machine, lattice=lattice)
    found = []
    for _ in range(3):
        begun = time.perf_counter()
        stiffness_map(machine, points, executor=executor)
        found.append(time.perf_counter() - begun)
    return min(found[1:])


def lock_share(lattice: int) -> float:
    """Share of a map's chunks during which Python's global lock is held.

    A second thread wakes at random moments and counts how often it waits for the lock. Other work
    on the machine delays it as well: how often it is late beside singular values, which are
    computed without the lock, is taken off. Both are measured in turn. It remains an upper bound,
    for a thread that is suspended by other work keeps the lock.
    """
    machine = Proposed3PPRS()
    asked = map_function(machine, hemisphere(machine, lattice=lattice))
    chunk = Chunk(0, 0, min(len(asked.points), LOOKS))
    stack = np.random.default_rng(0).random((1000, 18, 18))
    tasks = (lambda: np.linalg.svd(stack), lambda: asked(chunk))
    for task in tasks:
        task()
    length, turns = (0.1, 1) if lattice < 10 else (0.5, 8)
    late: list[list[bool]] = [[], []]
    for turn in range(2 * turns):
        late[turn % 2] += _late(tasks[turn % 2], length)
    free, used = (float(np.mean(each)) for each in late)
    return max(0.0, (used - free) / max(1.0 - free, 0.1))


def _late(task: Callable[[], object], length: float) -> list[bool]:
    """Whether a thread woke late, each time, while a task was repeated for some seconds."""
    random = np.random.default_rng(0)
    done = Event()
    late: list[bool] = []

    def look() -> None:
        while not done.is_set():
            asleep = float(random.uniform(2e-4, 1e-3))
            begun = time.perf_counter()
            time.sleep(asleep)
            late.append(time.perf_counter() - begun - asleep > LATE)

    looking = Thread(target=look)
    looking.start()
    try:
        begun = time.perf_counter()
        while time.perf_counter() - begun < length:
            task()
    finally:
        done.set()
        looking.join()
    return late


@dataclass(frozen=True)
class Noted:
    """A chunk that waits, and leaves a file in a folder when it begins."""

    folder: Path
    seconds: float

    def __call__(self, chunk: Chunk) -> Arrays:
        """Its pose numbers."""
        (self.folder / f"{chunk.number} {time.time_ns()}").touch()
        time.sleep(self.seconds)
        return {"pose": np.arange(chunk.start, chunk.stop)}


def kept_run(folder: Path, chunks: int, seconds: float, workers: int) -> None:
    """Chunks that wait, on threads; finished ones are kept."""
    begun = folder / "begun"
    begun.mkdir(exist_ok=True)
    run = Run(workers, folder=folder / "kept")
    list(run.chunks(Noted(begun, seconds), 10 * chunks, 10, lambda: "k" * 64))


def computed_again(folder: Path, chunks: int, seconds: float, workers: int) -> int:
    """Chunks that a study computes twice whose process is killed at half of its way."""
    killed = get_context("spawn").Process(target=kept_run, args=(folder, chunks, seconds, workers))
    killed.start()
    while killed.is_alive() and len(list((folder / "begun").glob("*"))) < chunks // 2:
        time.sleep(seconds / 10)
    killed.kill()
    killed.join()
    kept_run(folder, chunks, seconds, workers)
    return len(list((folder / "begun").iterdir())) - chunks


def stream(poses: int, folder: Path) -> tuple[int, float, float]:
    """Poses, seconds, and bytes on disk of a streamed map."""
    machine = Proposed3PPRS()
    lattice = max(1, round((poses / ROLLS / POINTS) ** 0.5))
    begun = time.perf_counter()
    points = hemisphere(machine, lattice=lattice)
    path = folder / "map.zarr"
    stream_stiffness_map(machine, path, points, run=Run())
    size = sum(p.stat().st_size for p in path.rglob("*") if p.is_file())
    return len(points) * ROLLS, time.perf_counter() - begun, float(size)


def streamed(poses: int) -> str:
    """What a process of its own says of a streamed map, whose memory is the stream's alone."""
    command = [sys.executable, "-m", "benchmarks.executor_speed", "--stream", str(poses)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=DOCUMENTS.parent)
    return done.stdout.strip()


def peak() -> float:
    """Largest resident memory of this process so far, GB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9


def store_rate(folder: Path) -> float:
    """Seconds to keep a chunk of 2048 compliances and read it back."""
    store = ChunkStore(folder, "k" * 64)
    arrays = {"compliance": np.random.default_rng(1).random((2048, 6, 6))}
    begun = time.perf_counter()
    for number in range(20):
        store.write(number, arrays)
        store.read(number)
    return (time.perf_counter() - begun) / 20


def table(poses: int, *, smallest: bool) -> str:
    """The page, with a streamed map of so many poses."""
    seconds, chunks, lattice = (0.02, 4, 3) if smallest else (0.5, 20, 100)
    load = os.getloadavg()[0]
    points = hemisphere(Proposed3PPRS(), lattice=lattice)
    one, two = Dask(workers=1), Dask(workers=2)
    folder = Path(tempfile.mkdtemp())
    try:
        thread_cost, dask_cost = waits(seconds, chunks, Threads(1)), waits(seconds, chunks, one)
        alone = map_seconds(lattice, Threads(1))
        threads = alone / map_seconds(lattice, Threads(2))
        dask = map_seconds(lattice, one) / map_seconds(lattice, two)
        kept = store_rate(folder / "chunks")
        held = lock_share(min(lattice, 28))
        again = computed_again(folder, 4 * chunks, seconds / 5, WORKERS)
    finally:
        one.close()
        two.close()
        shutil.rmtree(folder, ignore_errors=True)
    said = streamed(poses)
    memory = float(re.findall(r"([\d.]+) GB", said)[-1])
    if not smallest:
        # what others do on the machine is no cost of an executor
        if load < QUIET:
            require(thread_cost < 0.05 and dask_cost < 0.05, "an executor costs 5 % or more")
            require(min(threads, dask) > 1.7, "a second worker brings less than 1.7 times")
        require(memory < 1.0, f"a streamed map takes {memory:.2f} GB")
    require(again <= WORKERS, f"{again} chunks are computed again by {WORKERS} workers")
    costs = f"overhead at chunks of {seconds:g} s"
    lost = f"chunks that {WORKERS} workers compute again after their process is killed"
    return joined(
        [
            "# Studies: what executors cost",
            "",
            f"{machine_line()} Load of other work meanwhile: {load:.1f}.",
            "Ratios of a machine that does other work are indicative.",
            "",
            "| what | result | asked |",
            "| --- | --- | --- |",
            f"| {costs}, a thread | {100 * thread_cost:.1f} % | < 5 % |",
            f"| {costs}, a Dask worker | {100 * dask_cost:.1f} % | < 5 % |",
            f"| two threads beside one | {threads:.2f} | 1.8 |",
            f"| two local Dask workers beside one | {dask:.2f} | 1.8 |",
            f"| keeping a chunk of 2048 compliances, and reading it | {1e3 * kept:.1f} ms | |",
            f"| share of a chunk that holds Python's global lock, at most | {100 * held:.0f} % | |",
            f"| {lost} | {again} | {WORKERS}, one a worker |",
            f"| streamed stiffness map | {said} | < 1 GB |",
            "",
            f"The ratios are of a stiffness map of {len(points) * ROLLS:,} poses, by the clock.",
            "The share of the lock is counted by a thread that wakes at random moments, less what",
            "other work delays it. On a machine that does nothing else,",
            "`python -m benchmarks.executor_speed --write --stream 10000000` repeats the page with",
            "ten million poses, which takes a quarter of an hour; without `--stream` it streams a",
            "quarter of a million, and without `--write` `--stream` streams alone.",
        ]
    )


def main() -> None:
    """Print the page, or write it."""
    options = parser(__doc__, DOCUMENT)
    options.add_argument("--stream", type=int, metavar="POSES")
    chosen = parsed(options)
    if chosen.stream and not chosen.write:
        folder = Path(tempfile.mkdtemp())
        try:
            poses, took, size = stream(chosen.stream, folder)
        finally:
            shutil.rmtree(folder, ignore_errors=True)
        print(
            f"{poses:,} poses, {took:.0f} s, {size / 1e6:.0f} MB on disk, "
            f"{peak():.2f} GB of memory at most"
        )
        return
    poses = 2000 if chosen.smallest else chosen.stream or 250_000
    shown(table(poses, smallest=chosen.smallest), DOCUMENT, chosen)


if __name__ == "__main__":
    one_thread(main)
