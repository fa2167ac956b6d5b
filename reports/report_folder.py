"""The files of a report put into their folder as one set.

A new folder is made beside its place and renamed. In a folder that exists, which may be the
current one, a link or hold files of the user, the files are exchanged one by one behind the page:
the old page goes first and the new one comes last, so that a page never stands beside data of
another report.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from strutwork.errors import OutputError
from strutwork.files import write_error
from strutwork.names import visible
from strutwork.reports.manifest import MANIFEST, Manifest, manifest_of, read_manifest
from strutwork.staging import clean, staging, sync

#: Name of the page in the folder of a report.
PAGE = "report.html"


def require_ours(folder: Path, names: Iterable[str], about: str = "") -> Manifest:
    """Refuse a folder in which files would be replaced that no report on the same subject wrote.

    Parameters
    ----------
    folder : Path
    names : iterable of str
        Files that would be written.
    about : str
        What the new report is on; empty: whatever the earlier one was on.

    Returns
    -------
    Manifest
        Of the earlier report in the folder; empty where there is none.

    Raises
    ------
    ModelError
        A damaged manifest.
    OutputError
        Not a folder, files of these names that the manifest does not name, or a report on
        something else.
    """
    if folder.exists() and not folder.is_dir():
        raise OutputError(
            str(folder), "cannot be written (it is not a folder).", "Choose the name of a folder."
        )
    found = read_manifest(folder) or Manifest({})
    if about and found.about and found.about != about:
        raise OutputError(
            str(folder),
            f'contains the report on "{visible(found.about)}", but this is on "{visible(about)}".',
            "Choose another folder, or remove that report.",
        )
    foreign = [
        name
        for name in names
        if (name not in found.files and _is_there(folder / name)) or (folder / name).is_dir()
    ]
    if foreign:
        raise OutputError(
            str(folder),
            f"contains files that no {MANIFEST} lists and that would be replaced: "
            f"{', '.join(foreign)}.",
            "Choose another folder, or move these files away.",
        )
    return found


def write_set(
    folder: Path, writers: Mapping[str, Callable[[Path], object]], about: str = ""
) -> None:
    """Write files, their manifest and the page into a folder.

    Parameters
    ----------
    folder : Path
        Made when missing. What its manifest names and `writers` does not is removed.
    writers : mapping of str to callable
        What writes each file, by its name; the page is among them. They write in this order.
    about : str
        What the report is on: it replaces no report on anything else.

    Raises
    ------
    OutputError
        Files in the way, a folder that cannot be written, a full disk. An earlier report is
        complete then, unless the disk failed while files were exchanged.
    """
    try:
        place = folder.resolve()
        old = require_ours(place, writers, about)
        new = not place.exists()
        if new:
            place.parent.mkdir(parents=True, exist_ok=True)
        # what a killed run left in the folder, or beside it when it was making it
        clean(place)
        clean(place.parent)
        with staging(place.parent if new else place) as made:
            # a name of its own: the staging folder is private, an ordinary folder is not
            staged = made / "report"
            staged.mkdir()
            for name, write in writers.items():
                write(staged / name)
                sync(staged / name)
            manifest = manifest_of(staged, writers, about)
            if new:
                manifest.write(staged)
                sync(staged)
                staged.rename(place)
            else:
                _exchange(staged, place, old, manifest)
    except OSError as error:
        raise write_error(folder, error) from error


def _exchange(staged: Path, folder: Path, old: Manifest, new: Manifest) -> None:
    # also after a power failure the old page is gone before its data are
    (folder / PAGE).unlink(missing_ok=True)
    sync(folder)
    # names all that may lie there from here on, so that the next run knows them as ours
    Manifest({**old.files, **new.files}, complete=False, about=new.about).write(folder)
    for name in old.files:
        if name not in new.files:
            _remove(folder / name)
    for name in new.files:
        if name != PAGE:
            (staged / name).replace(folder / name)
    new.write(folder)
    sync(folder)
    (staged / PAGE).replace(folder / PAGE)
    sync(folder)


def _remove(path: Path) -> None:
    """Remove a file or a link; a folder of that name is none of ours."""
    if not path.is_dir() or path.is_symlink():
        path.unlink(missing_ok=True)


def _is_there(path: Path) -> bool:
    return path.exists() or path.is_symlink()
