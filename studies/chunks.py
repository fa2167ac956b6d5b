"""Finished chunks kept on disk, so that an interrupted study goes on where it stopped."""

from __future__ import annotations

import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.files import write_whole

Arrays = dict[str, NDArray[Any]]

_KEY = "study_key"


@dataclass(frozen=True)
class ChunkStore:
    """A folder of finished chunks of one study.

    Parameters
    ----------
    folder : Path
        May hold the chunks of several studies; each has a folder of its own in it.
    key : str
        Hash of everything the results depend on; see `strutwork.studies.description.study_key`.
    """

    folder: Path
    key: str

    def path(self, number: int) -> Path:
        """File of a chunk.

        Parameters
        ----------
        number : int
            Of the chunk, counted from zero.
        """
        return Path(self.folder) / self.key[:16] / f"chunk-{number:06d}.npz"

    def write(self, number: int, arrays: Mapping[str, NDArray[Any]]) -> Path:
        """Keep a finished chunk; the file is there whole or not at all.

        Parameters
        ----------
        number : int
            Of the chunk, counted from zero.
        arrays : mapping of str to (...)
            Numbers or text, any shape, any unit.

        Raises
        ------
        TypeError
            An array of Python objects, which could be pickled only.
        """
        for name, array in arrays.items():
            if array.dtype.hasobject:
                raise TypeError(f"chunk {number}: {name} holds Python objects, not numbers or text")
        content: dict[str, Any] = {_KEY: np.array(self.key), **arrays}
        return write_whole(self.path(number), lambda path: np.savez(path, **content))

    def read(self, number: int) -> Arrays | None:
        """A finished chunk; None where there is none, or where its file is damaged.

        A damaged file is one that is cut off, fails its checksum or belongs to another study.

        Parameters
        ----------
        number : int
            Of the chunk, counted from zero.
        """
        try:
            with (
                self.path(number).open("rb") as stream,
                np.load(stream, allow_pickle=False) as file,
            ):
                arrays = {name: file[name] for name in file.files}
        except (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile, zlib.error):
            return None
        key = arrays.pop(_KEY, None)
        return arrays if key is not None and str(key) == self.key else None
