"""Files that a model file names: beside it or below."""

from __future__ import annotations

import stat
from pathlib import Path, PurePosixPath, PureWindowsPath

from strutwork.errors import ModelError

#: Larger files of parts are refused, bytes.
MAX_PART = 500_000_000


def part_file(name: str, folder: Path, field: str) -> Path:
    """Path of a file that a model file names: beside it or below.

    A model file may come from elsewhere; it reaches nothing that does not lie with it.

    Parameters
    ----------
    name : str
        As the model file writes it.
    folder : Path
        That of the model file.
    field : str
        For messages.

    Raises
    ------
    ModelError
        An absolute name or one that leads upwards; no ordinary file; a file that is too large.
    """
    pure = (PurePosixPath(name), PureWindowsPath(name))
    if any(p.is_absolute() or p.drive or ".." in p.parts for p in pure):
        raise ModelError(
            field,
            f'"{name}" leads out of the folder of the model file.',
            "Put the file, or a link to it, beside the model file or below it.",
        )
    path = folder / name
    try:
        status = path.stat()
    except (OSError, ValueError):
        raise ModelError(
            field, f'there is no file "{name}" beside the model file.', "Check its name."
        ) from None
    if not stat.S_ISREG(status.st_mode):
        raise ModelError(field, f'"{name}" is not an ordinary file.', "Name a file.")
    if status.st_size > MAX_PART:
        raise ModelError(
            field,
            f'"{name}" has {status.st_size / 1e6:.0f} MB, more than {MAX_PART / 1e6:.0f} MB.',
            "Mesh it coarser.",
        )
    return path
