"""Chunks that fail: what is said of each, and how a study ends that misses some."""

from __future__ import annotations

import traceback
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

from strutwork.errors import ClusterError, OutputError, StrutworkError, StudyError, StudyWarning
from strutwork.files import write_text
from strutwork.memory import out_of_memory
from strutwork.studies.chunks import Arrays, ChunkStore

#: Chunks that fail before any is finished: then the next ones would fail as well.
HOPELESS = 8
#: Failures that a message names; the file has them all.
NAMED = 3


class Range(Protocol):
    """A chunk's range of items."""

    @property
    def start(self) -> int:
        """First item."""

    @property
    def stop(self) -> int:
        """Behind the last item."""


@dataclass(frozen=True)
class Failed:
    """What became of a chunk that has no result.

    Parameters
    ----------
    error : Exception
    trace : str
        Of the process in which it was raised.
    """

    error: Exception
    trace: str = ""

    @classmethod
    def of(cls, error: Exception) -> Failed:
        """What an exception leaves.

        Parameters
        ----------
        error : Exception
        """
        return cls(error, "".join(traceback.format_exception(error)))

    @classmethod
    def vanished(cls) -> Failed:
        """A kept chunk that somebody removed or damaged meanwhile."""
        return cls(OutputError("kept chunk", "was removed or damaged meanwhile.", "Run again."))

    @property
    def words(self) -> str:
        """The error on one line."""
        if isinstance(self.error, StrutworkError):
            return f"{self.error.part}: {self.error.problem}"
        text = " ".join(str(self.error).split())
        return f"{type(self.error).__name__}: {text}" if text else type(self.error).__name__


@dataclass(frozen=True)
class Guarded:
    """A function of a chunk that returns what went wrong in place of raising it.

    Parameters
    ----------
    function : callable
        Arrays of a chunk.
    """

    function: Callable[[Any], Arrays]

    def __call__(self, chunk: Any) -> Arrays | Failed:
        """Arrays of a chunk, or how it failed."""
        try:
            return self.function(chunk)
        except MemoryError as error:
            return Failed.of(out_of_memory(error))
        except Exception as error:  # noqa: BLE001 - whatever it is, it is reported with its poses
            return Failed.of(error)


@dataclass
class Failures:
    """The failures of a run, in the order of its chunks.

    Parameters
    ----------
    store : ChunkStore or None
        Where finished chunks are kept.
    chunks : int
        Of the study.
    inputs : callable or None
        What a chunk is of, in words.
    poses : int
        Per item.
    finished : int
        Chunks that were computed in this run.
    """

    store: ChunkStore | None
    chunks: int
    inputs: Callable[[Any], str] | None
    poses: int
    finished: int = 0
    _each: list[tuple[str, Failed]] = field(default_factory=list)

    def __bool__(self) -> bool:
        return bool(self._each)

    @property
    def hopeless(self) -> bool:
        """Whether the next chunks would fail as well."""
        return not self.finished and len(self._each) >= HOPELESS

    def add(self, chunk: Range, failed: Failed) -> None:
        """Take note of a chunk that failed, and say so.

        Parameters
        ----------
        chunk : Chunk
        failed : Failed

        Raises
        ------
        StrutworkError
            Nothing of the study is kept, or its model is wrong from the first chunk on.
        """
        words = f"poses {chunk.start * self.poses} to {chunk.stop * self.poses - 1}"
        if self.inputs is not None:
            words += f" ({self.inputs(chunk)})"
        self._each.append((words, failed))
        if self.store is None:
            # numbers out of range have a message of the program's own
            if isinstance(failed.error, StrutworkError | ArithmeticError | Warning):
                failed.error.add_note(f"at {words}, counted from zero")
                raise failed.error
            raise StudyError(
                words,
                f"{failed.words}.",
                "Give a folder: then the other chunks are computed and kept.",
            ) from failed.error
        warnings.warn(f"{words}: {failed.words}; the rest goes on.", StudyWarning, stacklevel=4)
        if self.hopeless:
            self.require_none()

    def left(self) -> str:
        """What of the study is kept, and how to go on."""
        if self.store is None:
            return "Nothing is kept: give the study a folder to go on from."
        count = sum(self.store.path(number).exists() for number in range(self.chunks))
        folder = self.store.path(0).parent
        return (
            f"{count} of {self.chunks} chunks are kept in {folder}; the same study with the same "
            "folder goes on from them."
        )

    def require_none(self) -> None:
        """Nothing, where every chunk has a result.

        Raises
        ------
        StudyError
            Names the first poses that failed, the file that has all of them, and how to go on.
        """
        if not self._each or self.store is None:
            return
        some = "; ".join(f"{words}: {failed.words}" for words, failed in self._each[:NAMED])
        more = len(self._each) - NAMED
        some += f"; and {more} more" if more > 0 else ""
        report = self._written(self.store.path(0).parent / "failures.txt")
        raise StudyError(
            f"{len(self._each)} of {self.chunks} chunks",
            f"could not be computed: {some}. {report} says where each failed.",
            self.left(),
        ) from self._each[0][1].error

    def _written(self, path: Path) -> Path:
        return write_text(path, "\n".join(f"{w}\n{f.words}\n{f.trace}" for w, f in self._each))

    def explained(self, error: ClusterError) -> ClusterError:
        """An error that ended the run, with what is kept.

        Parameters
        ----------
        error : ClusterError
        """
        return ClusterError(error.part, error.problem, f"{error.remedy} {self.left()}")
