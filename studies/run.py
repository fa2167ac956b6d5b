"""Running a study chunk by chunk: on an executor, with progress, resumed from disk."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from strutwork.errors import ClusterError, StudyWarning
from strutwork.studies.chunks import Arrays, ChunkStore
from strutwork.studies.executor import Executor, default_executor, place
from strutwork.studies.failures import Failed, Failures, Guarded
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


def chunks_of(items: int, size: int) -> list[Chunk]:
    """All items in chunks of one size, the last one shorter.

    Parameters
    ----------
    items, size : int
    """
    return [
        Chunk(number, start, min(start + size, items))
        for number, start in enumerate(range(0, items, size))
    ]


@dataclass(frozen=True)
class Run:
    """How a study is run; nothing in it changes the result.

    What is not given is that of `strutwork.studies.executor.computed_on`.

    Parameters
    ----------
    workers : int or None
        Threads, where no executor is given; None for one per processor.
    executor : Executor or None
    folder : Path or None
        Where finished chunks are kept and looked for; None keeps nothing.
    progress : callable or None
        Called with how many poses are done, and of how many; those of kept chunks come first.
    inputs : callable or None
        What a chunk is of, in words, for the report of its failure; default its poses' numbers.
    keeps : bool
        Whether finished chunks may be kept.
    """

    workers: int | None = None
    executor: Executor | None = None
    folder: Path | None = None
    progress: Progress | None = None
    inputs: Callable[[Chunk], str] | None = None
    keeps: bool = True

    @property
    def unkept(self) -> Run:
        """The same, keeping nothing, whatever the folder of `computed_on`."""
        return replace(self, folder=None, keeps=False)

    @property
    def kept_in(self) -> Path | None:
        """Folder of the finished chunks."""
        if not self.keeps:
            return None
        folder = self.folder if self.folder is not None else place().folder
        return None if folder is None else Path(folder)

    def in_folder(self, folder: Path) -> Run:
        """The same, with its finished chunks elsewhere.

        Parameters
        ----------
        folder : Path
        """
        return replace(self, folder=folder)

    @property
    def bounded(self) -> bool:
        """Whether nothing but this process computes, and nothing of it would be kept."""
        return self.kept_in is None and self.executor is None and place().executor is None

    def chunks(
        self,
        function: Callable[[Chunk], Arrays],
        items: int,
        size: int,
        key: Callable[[], str],
        poses_per_item: int = 1,
        *,
        first: int = 0,
    ) -> Iterator[tuple[Chunk, Arrays]]:
        """Every chunk with its result, in order.

        A chunk that fails does not end those of a study that is kept in a folder: the others are
        computed, and an error then names what is missing.

        Parameters
        ----------
        function : callable
            Arrays of a chunk; called in several threads, or sent to other processes.
        items : int
            Number of items of the study.
        size : int
            Items in a chunk.
        key : callable
            Gives the hash of the study's inputs; called only when a folder is given.
        poses_per_item : int
            What progress counts.
        first : int
            Chunk to begin with; those before it are done and kept elsewhere.

        Raises
        ------
        StrutworkError
            What a chunk raised, where nothing is kept.
        StudyError
            Chunks failed; names the poses, the folder of the others, and how to go on.
        ClusterError
            The executor went away; names the folder as well.
        """
        parts = chunks_of(items, size)[first:]
        folder = self.kept_in
        store = ChunkStore(folder, key()) if folder is not None else None
        state = _State(store, parts, self.inputs, poses_per_item)
        executor = self.executor or default_executor(self.workers)
        progress = self.progress or silent
        total = items * poses_per_item
        asked = sum(c.stop - c.start for c in parts if not state.seems_kept(c))
        done = total - asked * poses_per_item
        progress(done, total)
        results = executor.map(Guarded(function), state.missing(), state.keep, Failed.of)
        try:
            for chunk in parts:
                found = state.kept(chunk)
                if found is None:
                    found = next(results)
                    if not state.seems_kept(chunk):
                        done += (chunk.stop - chunk.start) * poses_per_item
                        progress(done, total)
                if isinstance(found, Failed):
                    state.failures.add(chunk, found)
                elif not state.failures:
                    yield chunk, found
        except KeyboardInterrupt:
            if store is not None:
                warnings.warn(f"interrupted: {state.failures.left()}", StudyWarning, stacklevel=2)
            raise
        except ClusterError as error:
            raise state.failures.explained(error) from error
        finally:
            close = getattr(results, "close", None)
            if close is not None:
                close()
        state.failures.require_none()


@dataclass
class _State:
    """Which chunks of a run are kept, and which are asked of the executor."""

    store: ChunkStore | None
    parts: list[Chunk]
    inputs: Callable[[Chunk], str] | None
    poses: int
    _there: dict[int, bool] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.failures = Failures(self.store, len(self.parts), self.inputs, self.poses)
        self._seen = (
            set()
            if self.store is None
            else {c.number for c in self.parts if self.store.path(c.number).exists()}
        )

    def seems_kept(self, chunk: Chunk) -> bool:
        """Whether there was a file of it at the beginning, sound or not."""
        return chunk.number in self._seen

    def _decided(self, chunk: Chunk) -> bool:
        # decided once, so that a chunk is asked of the executor or read, never both
        if chunk.number not in self._there:
            sound = (
                self.store is not None
                and self.seems_kept(chunk)
                and self.store.read(chunk.number) is not None
            )
            self._there[chunk.number] = sound
        return self._there[chunk.number]

    def missing(self) -> Iterator[Chunk]:
        """Chunks to be computed."""
        for chunk in self.parts:
            if not self._decided(chunk) and not self.failures.hopeless:
                yield chunk

    def kept(self, chunk: Chunk) -> Arrays | Failed | None:
        """The result of a chunk that need not be computed."""
        if self._decided(chunk) and self.store is not None:
            found = self.store.read(chunk.number)
            return found if found is not None else Failed.vanished()
        return None

    def keep(self, chunk: Chunk, found: Arrays | Failed) -> None:
        if isinstance(found, Failed):
            return
        self.failures.finished += 1
        if self.store is not None:
            self.store.write(chunk.number, found)


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
