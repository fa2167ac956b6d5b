"""Executors: where the chunks of a study are computed."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, TypeVar

from threadpoolctl import threadpool_limits

from strutwork.errors import ModelError

C = TypeVar("C")
R = TypeVar("R")


class Executor(Protocol):
    """Computes a function on many chunks.

    One method, so that a pool of threads, of processes or of machines can stand behind it.
    """

    def map(
        self,
        function: Callable[[C], R],
        chunks: Iterable[C],
        keep: Callable[[C, R], object] | None = None,
        lost: Callable[[Exception], R] | None = None,
    ) -> Iterator[R]:
        """Results in the order of the chunks, as they become ready.

        Leaving the iterator early cancels what has not begun. An error of the function is
        raised where its result would have been.

        Parameters
        ----------
        function : callable
            From a chunk to its result.
        chunks : iterable
        keep : callable, optional
            Called in this process with each chunk and its result, as soon as it is ready and in
            any order, from any thread.
        lost : callable, optional
            Makes the result of a chunk that ends each worker that takes it; else that is an error.
        """


@dataclass(frozen=True)
class Threads:
    """Threads of this process.

    The heavy parts of a chunk run outside Python's lock. Each thread works with one BLAS
    thread: stacks of small matrices lose by more.

    Parameters
    ----------
    workers : int

    Raises
    ------
    ModelError
        Less than one worker.
    """

    workers: int

    def __post_init__(self) -> None:
        if self.workers < 1:
            raise ModelError("executor", f"has {self.workers} workers.", "Give at least one.")

    def map(
        self,
        function: Callable[[C], R],
        chunks: Iterable[C],
        keep: Callable[[C, R], object] | None = None,
        lost: Callable[[Exception], R] | None = None,  # noqa: ARG002 - a thread is not lost
    ) -> Iterator[R]:
        """Results in the order of the chunks; at most two chunks per worker are under way.

        Parameters
        ----------
        function : callable
            From a chunk to its result; called in several threads.
        chunks : iterable
        keep, lost : callable, optional
            As `Executor`; `keep` is called in the thread that computed the result.
        """

        def job(chunk: C) -> R:
            found = function(chunk)
            if keep is not None:
                keep(chunk, found)
            return found

        pool = ThreadPoolExecutor(self.workers, thread_name_prefix="study")
        waiting: deque[Future[R]] = deque()
        with threadpool_limits(limits=1):
            try:
                for chunk in chunks:
                    waiting.append(pool.submit(job, chunk))
                    # results wait in memory: do not run ahead of the reader without bound
                    if len(waiting) >= 2 * self.workers:
                        yield waiting.popleft().result()
                while waiting:
                    yield waiting.popleft().result()
            finally:
                pool.shutdown(wait=True, cancel_futures=True)


@dataclass(frozen=True)
class Place:
    """Where studies are computed and kept that are given neither an executor nor a folder.

    Parameters
    ----------
    executor : Executor or None
    folder : Path or None
    """

    executor: Executor | None = None
    folder: Path | None = None


_HERE = Place()
_PLACE: ContextVar[Place] = ContextVar("place", default=_HERE)


def place() -> Place:
    """That of the innermost `computed_on`."""
    return _PLACE.get()


@contextmanager
def computed_on(executor: Executor | None = None, folder: Path | None = None) -> Iterator[None]:
    """Compute every study inside on an executor, and keep its finished chunks in a folder.

    Parameters
    ----------
    executor : Executor, optional
        As `strutwork.studies.cluster.Dask`; threads where it is None.
    folder : Path, optional
    """
    token = _PLACE.set(Place(executor, folder))
    try:
        yield
    finally:
        _PLACE.reset(token)


def default_executor(workers: int | None = None) -> Executor:
    """That of `computed_on`, else threads: as many as given, or one per processor at hand.

    Parameters
    ----------
    workers : int, optional
    """
    chosen = place().executor
    if chosen is not None:
        return chosen
    return Threads(len(os.sched_getaffinity(0)) if workers is None else workers)
