"""Running a study chunk by chunk: on an executor, with progress, resumed from disk."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from strutwork.studies.chunks import Arrays, ChunkStore
from strutwork.studies.executor import Executor, default_executor
from strutwork.studies.progress import Progress, silent


@dataclass(frozen=True)
class Chunk:
    """A range of a study's items.

    Parameters
    ----------
    number : int
        Counts from zero.
    start, stop : int
        Items of the chunk.
    """

    number: int
    start: int
    stop: int

    @property
    def items(self) -> slice:
        """The items as a slice."""
        return slice(self.start, self.stop)


@dataclass(frozen=True)
class Run:
    """How a study is run; nothing in it changes the result.

    Parameters
    ----------
    workers : int or None
        Threads, where no executor is given; None for one per processor.
    executor : Executor or None
    folder : Path or None
        Where finished chunks are kept and looked for; None keeps nothing.
    progress : callable or None
        Called with how many poses are done, and of how many.
    """

    workers: int | None = None
    executor: Executor | None = None
    folder: Path | None = None
    progress: Progress | None = None

    def chunks(
        self,
        function: Callable[[Chunk], Arrays],
        items: int,
        size: int,
        key: Callable[[], str],
        poses_per_item: int = 1,
    ) -> Iterator[tuple[Chunk, Arrays]]:
        """Every chunk with its result, in order.

        Parameters
        ----------
        function : callable
            Arrays of a chunk; called in several threads.
        items : int
            Number of items of the study.
        size : int
            Items in a chunk.
        key : callable
            Gives the hash of the study's inputs; called only when a folder is given.
        poses_per_item : int
            What progress counts.
        """
        parts = [
            Chunk(number, start, min(start + size, items))
            for number, start in enumerate(range(0, items, size))
        ]
        store = ChunkStore(Path(self.folder), key()) if self.folder is not None else None

        def job(chunk: Chunk) -> Arrays:
            if store is None:
                return function(chunk)
            kept = store.read(chunk.number)
            if kept is None:
                kept = function(chunk)
                store.write(chunk.number, kept)
            return kept

        executor = self.executor or default_executor(self.workers)
        progress = self.progress or silent
        progress(0, items * poses_per_item)
        for chunk, arrays in zip(parts, executor.map(job, parts), strict=True):
            progress(chunk.stop * poses_per_item, items * poses_per_item)
            yield chunk, arrays


def fill(whole: Arrays, chunk: Chunk, part: Arrays, items: int) -> None:
    """Put a chunk's arrays in their place; `whole` is allocated by its first chunk.

    Filling in place holds every number once, where a list of parts would hold it twice.

    Parameters
    ----------
    whole : dict of str to (items, ...)
        Filled in place, any unit.
    chunk : Chunk
    part : dict of str to (k, ...)
        Arrays of the k items of the chunk, any unit.
    items : int
        Of the whole study.
    """
    for name, values in part.items():
        if name not in whole:
            whole[name] = np.empty((items, *values.shape[1:]), dtype=values.dtype)
        whole[name][chunk.items] = values
