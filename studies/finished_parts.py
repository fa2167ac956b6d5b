"""Finished parts of a study or design that is written to a file: beside it until it is complete."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import xarray as xr

from strutwork.csv_rows import RowWriter
from strutwork.errors import ModelError
from strutwork.files import write_whole
from strutwork.studies.executor import place

#: What to do about a file that cannot be written over.
OTHER_FILE = "Name another file, or remove this one."


def beside(path: Path) -> Path:
    """Folder of the finished parts of all that is to be written to a file.

    Parameters
    ----------
    path : Path
    """
    return path.with_name(f"{path.name}.parts")


def any_finished(parts: Path) -> bool:
    """Whether there are finished parts: folders alone are none.

    Parameters
    ----------
    parts : Path
        Their folder.
    """
    return any(p.is_file() for p in parts.rglob("*"))


def require_file(out: str | Path | None, *, resume: bool) -> None:
    """Refuse to go on from the finished parts of a result that is written nowhere.

    Parameters
    ----------
    out : str, Path or None
        File of the result.
    resume : bool

    Raises
    ------
    ModelError
        There is no file, nor a folder of `strutwork.studies.executor.computed_on`.
    """
    if resume and out is None and place().folder is None:
        raise ModelError("resume", "goes on from nothing.", "Give the file of the result: out=...")


def require_resumed(parts: Path, what: str, *, resume: bool) -> None:
    """Refuse to compute again what an interrupted run has finished, unless it is gone on from.

    Parameters
    ----------
    parts : Path
        Folder of what is finished.
    what : str
        As "finished parts of this study".
    resume : bool
        Whether it is gone on from.

    Raises
    ------
    ModelError
        There are some, and `resume` is not given.
    """
    if not resume and any_finished(parts):
        raise ModelError(
            str(parts),
            f"holds {what}, which was interrupted.",
            "Give --resume (resume=True) to go on from them, or remove the folder.",
        )


def remove(parts: Path) -> None:
    """Remove finished parts whose result is written, and the folder around them if it is empty.

    Parameters
    ----------
    parts : Path
    """
    shutil.rmtree(parts, ignore_errors=True)
    if parts.parent.is_dir() and not any(parts.parent.iterdir()):
        parts.parent.rmdir()


def result_there(path: Path, read: Callable[[Path], xr.Dataset]) -> xr.Dataset | None:
    """The result that a file holds; None where there is no file.

    Parameters
    ----------
    path : Path
    read : callable
        Reads such a result, or raises ModelError.

    Raises
    ------
    ModelError
        The file holds something else.
    """
    if not path.exists():
        return None
    if path.is_dir() and path.suffix != ".zarr":
        raise ModelError(str(path), "is a folder.", "Name a file.")
    try:
        return read(path)
    except ModelError as error:
        raise ModelError(str(path), f"is there already and {error.problem}", OTHER_FILE) from error


def write_rows(path: Path, heads: Sequence[str], rows: Iterable[Sequence[object]]) -> Path:
    """Write a table as CSV, whole or not at all.

    Parameters
    ----------
    path : Path
    heads : sequence of str
    rows : iterable of sequences of cells

    Raises
    ------
    OutputError
        It cannot be written.
    """

    def write(part: Path) -> None:
        with part.open("w", encoding="utf-8", errors="backslashreplace", newline="") as file:
            writer = RowWriter(file)
            writer.writerow(heads)
            writer.writerows(rows)

    return write_whole(path, write)
