"""How large a mesh file and what it holds may be; checked before memory is taken."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from strutwork.errors import ModelError

#: Bytes of a file, with all that it includes, and of what a compressed file unpacks to.
LARGEST_FILE = 500_000_000
LARGEST_CONTENT = 2_000_000_000
MOST_POINTS = 5_000_000
MOST_CELLS = 5_000_000
COARSER = "Mesh coarser, or export one body at a time."


def read_bytes(path: Path, most: int | None = None) -> bytes:
    """The content of an ordinary file.

    Parameters
    ----------
    path : Path
    most : int or None
        The most bytes to read, `LARGEST_FILE` by default.

    Raises
    ------
    ModelError
        No such file; a device, a pipe or a folder; an empty file or one that is too large.
    """
    limit = LARGEST_FILE if most is None else most
    try:
        # a pipe would wait for its writer; without blocking it opens and is told by its mode
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
    except (FileNotFoundError, NotADirectoryError):
        raise ModelError(str(path), "there is no such file.", "Check the path.") from None
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) else str(error)
        raise ModelError(str(path), f"cannot be opened ({why}).", "Check the path.") from None
    try:
        status = os.fstat(handle)
        if not stat.S_ISREG(status.st_mode):
            raise ModelError(str(path), "is not an ordinary file.", "Name a file.")
        if status.st_size == 0:
            raise ModelError(str(path), "the file is empty.", "Export the mesh again.")
        check_size(path, status.st_size, limit)
        with os.fdopen(handle, "rb", closefd=False) as file:
            content = file.read(limit + 1)
    finally:
        os.close(handle)
    check_size(path, len(content), limit)
    return content


def check_size(path: Path | str, size: int, limit: int | None = None) -> None:
    """Refuse a file that is too large, by a ModelError.

    Parameters
    ----------
    path : Path or str
        Named in the error.
    size : int
        Bytes.
    limit : int, optional
        Bytes; default `LARGEST_FILE`.
    """
    limit = LARGEST_FILE if limit is None else limit
    if size > limit:
        raise ModelError(
            str(path),
            f"the file has {size / 1e6:.4g} MB; {limit / 1e6:g} MB is the limit.",
            COARSER,
        )


def check_content(path: Path | str, size: int) -> None:
    """ModelError where a compressed file would unpack to more bytes than the limit.

    Parameters
    ----------
    path : Path or str
        Named in the error.
    size : int
        Bytes that it would unpack to.
    """
    if size > LARGEST_CONTENT:
        raise ModelError(
            str(path),
            f"unpacks to {size / 1e6:.4g} MB; {LARGEST_CONTENT / 1e6:g} MB is the limit.",
            COARSER,
        )


def check_counts(path: Path | str, points: int, cells: int = 0) -> None:
    """ModelError where a mesh has, or claims, more points or cells than the limits.

    Parameters
    ----------
    path : Path or str
        Named in the error.
    points : int
        Number of points.
    cells : int
        Number of cells.
    """
    for count, limit, what in ((points, MOST_POINTS, "points"), (cells, MOST_CELLS, "cells")):
        if count > limit:
            raise ModelError(str(path), f"has {count} {what}; {limit} is the limit.", COARSER)
