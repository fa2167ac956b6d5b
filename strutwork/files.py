"""Files written whole or not at all."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable
from pathlib import Path

from strutwork.errors import OutputError
from strutwork.staging import staging, sync

_REMEDIES = {
    errno.ENOSPC: "Free some space, or choose a folder on another disk.",
    errno.EDQUOT: "Free some of your quota, or choose a folder on another disk.",
    errno.EFBIG: "Raise the limit on the size of a file (ulimit -f), or write less.",
    errno.EIO: "The disk fails: choose a folder on another one.",
    errno.ENAMETOOLONG: "Choose a shorter name.",
}


def write_error(where: Path | str, error: OSError) -> OutputError:
    """What a failed write is to its reader: where, why, and what to do.

    Parameters
    ----------
    where : Path or str
        The file or folder, as the message names it.
    error : OSError
        What the system raised; its number chooses the remedy.
    """
    why = error.strerror or str(error) or type(error).__name__
    remedy = _REMEDIES.get(error.errno or 0, "Choose a folder you may write to.")
    return OutputError(str(where), f"cannot be written ({why}).", remedy)


def write_whole(path: Path, write: Callable[[Path], object]) -> Path:
    """Let `write` fill a temporary file beside `path`, then put it in place at once.

    The file is on the disk before it gets its name, so that after a power failure there is the
    old file or the new one. The folder is not waited for: the old one may be back then.

    Parameters
    ----------
    path : Path
        The file to make; its folder is made when missing. A link is followed.
    write : callable
        Receives the temporary path, of the same name, and writes everything there.

    Returns
    -------
    Path
        `path`, complete. When `write` fails nothing is left behind and an older file stays.

    Raises
    ------
    OutputError
        The folder cannot be made or written, the disk is full, or `path` is no ordinary file.
    """
    path = Path(path)
    try:
        target = path.resolve()
        if target.exists() and not target.is_file():
            # a device would be replaced by a file, where the rights suffice
            kind = "a folder" if target.is_dir() else "a device or a pipe"
            raise OutputError(
                str(path), f"cannot be written (it is {kind}).", "Name an ordinary file."
            )
        target.parent.mkdir(parents=True, exist_ok=True)
        with staging(target.parent) as folder:
            temporary = folder / target.name
            write(temporary)
            sync(temporary)
            # whatever the library made it, it gets the permissions of an ordinary new file
            mask = os.umask(0)
            os.umask(mask)
            temporary.chmod(0o666 & ~mask)
            temporary.replace(target)
    except OSError as error:
        raise write_error(path, error) from error
    return path


def write_text(path: Path, text: str) -> Path:
    """Write `text` in UTF-8 to `path`, whole or not at all.

    Parameters
    ----------
    path : Path
        The file to make; its folder is made when missing.
    text : str
        Everything that the file shall hold.
    """
    return write_whole(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))
