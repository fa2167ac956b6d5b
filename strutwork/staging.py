"""Folders in which files are made before they are put in place, and what killed runs left there.

A staging folder is locked while its process lives. The lock goes with the process, however it
ends, so that whoever gets the lock of such a folder knows that nobody needs it any more; process
numbers would not say so across containers and hosts.
"""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

if sys.platform != "win32":
    import fcntl

#: How the name of every staging folder begins.
PREFIX = ".strutwork-staging-"

_cleaned: set[Path] = set()


@contextmanager
def staging(folder: Path) -> Iterator[Path]:
    """A new empty folder in `folder`, locked and gone afterwards.

    What killed runs left in `folder` is removed once per process.

    Parameters
    ----------
    folder : Path
        Where the new folder is made; exists already.

    Raises
    ------
    OSError
        `folder` cannot be written.
    """
    place = folder.resolve()
    if place not in _cleaned:
        _cleaned.add(place)
        clean(place)
    made, handle = _locked(place)
    try:
        yield made
    finally:
        # a folder that will not go is the next run's to clean, and hides no other error
        shutil.rmtree(made, ignore_errors=True)
        if handle is not None:
            os.close(handle)


def clean(folder: Path) -> int:
    """Remove the staging folders in `folder` that no living process holds; their number.

    Parameters
    ----------
    folder : Path
        Where staging folders are looked for; a missing one has none.
    """
    found = 0
    with suppress(OSError):
        for left in folder.glob(f"{PREFIX}*"):
            handle = _lock(left, wait=False)
            if handle is None:
                continue
            shutil.rmtree(left, ignore_errors=True)
            found += 1
            os.close(handle)
    return found


def sync(path: Path) -> None:
    """Let a file or a folder reach the disk.

    Parameters
    ----------
    path : Path
        A file or a folder, which on Windows is left alone.
    """
    if sys.platform == "win32" and path.is_dir():
        return
    handle = os.open(path, os.O_RDWR if path.is_file() else os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _locked(folder: Path) -> tuple[Path, int | None]:
    while True:
        made = Path(tempfile.mkdtemp(prefix=PREFIX, dir=folder))
        handle = _lock(made, wait=True)
        # another process may have cleaned it away before the lock
        if made.exists():
            return made, handle
        if handle is not None:
            os.close(handle)


def _lock(folder: Path, *, wait: bool) -> int | None:
    """An open, locked folder; None where another holds it or nothing can be locked."""
    if sys.platform == "win32":
        return None
    try:
        handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    except OSError:
        return None
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except OSError:
        os.close(handle)
        return None
    return handle
