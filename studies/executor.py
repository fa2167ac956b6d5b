"""Executors: where the chunks of a study are computed."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from typing import Protocol, TypeVar

from threadpoolctl import threadpool_limits

from strutwork.errors import ModelError

C = TypeVar("C")
R = TypeVar("R")


class Executor(Protocol):
    """Computes a function on many chunks.

    One method, so that a pool of threads, of processes or of machines can stand behind it.
    """

    def map(self, function: Callable[[C], R], chunks: Iterable[C]) -> Iterator[R]:
        """Results in the order of the chunks, as they become ready.

        Leaving the iterator early cancels what has not begun. An error of the function is
        raised where its result would have been.

        Parameters
        ----------
        function : callable
            From a chunk to its result.
        chunks : iterable
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

    def map(self, function: Callable[[C], R], chunks: Iterable[C]) -> Iterator[R]:
        """Results in the order of the chunks; at most two chunks per worker are under way.

        Parameters
        ----------
        function : callable
            From a chunk to its result; called in several threads.
        chunks : iterable
        """
        pool = ThreadPoolExecutor(self.workers, thread_name_prefix="study")
        waiting: deque[Future[R]] = deque()
        with threadpool_limits(limits=1):
            try:
                for chunk in chunks:
                    waiting.append(pool.submit(function, chunk))
                    # results wait in memory: do not run ahead of the reader without bound
                    if len(waiting) >= 2 * self.workers:
                        yield waiting.popleft().result()
                while waiting:
                    yield waiting.popleft().result()
            finally:
                pool.shutdown(wait=True, cancel_futures=True)


def default_executor(workers: int | None = None) -> Executor:
    """Threads: the given number, or one for each processor that this process may use.

    Parameters
    ----------
    workers : int, optional
    """
    return Threads(len(os.sched_getaffinity(0)) if workers is None else workers)
