"""What executors cost and gain, and a stiffness map that is streamed to disk.

Run `python -m benchmarks.executor_speed`; with `--write` its table goes to
docs/performance-studies.md. `--stream 10000000` streams so many poses alone and says its memory.
"""

from __future__ import annotations

import os
import resource
import shutil
import tempfile
import time
from pathlib import Path

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
from strutwork.studies.streaming import stream_stiffness_map

DOCUMENT = DOCUMENTS / "performance-studies.md"

#: Load of other work, of a processor, below which the overhead is held to its bound.
QUIET = 0.3
#: Candidates at each point, and points of a lattice of fineness one.
ROLLS, POINTS = 24, 3.17


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
    """Seconds of a stiffness map of the proposed machine, after one that prepares."""
    machine = Proposed3PPRS()
    stiffness_map(machine, hemisphere(machine, lattice=3), executor=executor)
    points = hemisphere(machine, lattice=lattice)
    begun = time.perf_counter()
    stiffness_map(machine, points, executor=executor)
    return time.perf_counter() - begun


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


def table(*, smallest: bool) -> str:
    """The page."""
    seconds, chunks, lattice, poses = (0.02, 4, 3, 2000) if smallest else (0.5, 20, 20, 250_000)
    load = os.getloadavg()[0]
    one, two = Dask(workers=1), Dask(workers=2)
    folder = Path(tempfile.mkdtemp())
    try:
        thread_cost, dask_cost = waits(seconds, chunks, Threads(1)), waits(seconds, chunks, one)
        alone = map_seconds(lattice, Threads(1))
        threads = alone / map_seconds(lattice, Threads(2))
        dask = map_seconds(lattice, one) / map_seconds(lattice, two)
        kept = store_rate(folder / "chunks")
        streamed, took, size = stream(poses, folder)
    finally:
        one.close()
        two.close()
        shutil.rmtree(folder, ignore_errors=True)
    if not smallest:
        # what others do on the machine is no cost of an executor
        if load < QUIET:
            require(thread_cost < 0.05 and dask_cost < 0.05, "an executor costs 5 % or more")
        require(peak() < 1.0, "a streamed map takes 1 GB or more")
    costs = f"overhead at chunks of {seconds:g} s"
    disk = f"{took:.0f} s, {size / 1e6:.0f} MB on disk, {peak():.2f} GB of memory at most"
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
            f"| streamed stiffness map of {streamed:,} poses | {disk} | < 1 GB |",
            "",
            "Repeat it on a machine that does nothing else: `python -m benchmarks.executor_speed`.",
            "`--stream 10000000` streams ten million poses alone.",
        ]
    )


def main() -> None:
    """Print the page, or write it."""
    options = parser(__doc__, DOCUMENT)
    options.add_argument("--stream", type=int, metavar="POSES")
    chosen = parsed(options)
    if chosen.stream:
        folder = Path(tempfile.mkdtemp())
        try:
            poses, took, size = stream(chosen.stream, folder)
        finally:
            shutil.rmtree(folder, ignore_errors=True)
        print(
            f"{poses:,} poses, {took:.0f} s, {size / 1e6:.0f} MB on disk, {peak():.2f} GB at most"
        )
        return
    text = table(smallest=chosen.smallest)
    # the page's second part is that of benchmarks.variant_speed
    kept = DOCUMENT.read_text("utf-8").partition("\n## Variants")
    shown(text.rstrip("\n") + "\n" + kept[1] + kept[2], DOCUMENT, chosen)


if __name__ == "__main__":
    one_thread(main)
