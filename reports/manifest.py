"""The manifest of a report: which files of a folder belong to it, and their hashes."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from strutwork import __version__
from strutwork.errors import ModelError
from strutwork.files import write_text

#: Name of the manifest in the folder of a report.
MANIFEST = "report-manifest.json"


@dataclass(frozen=True)
class Entry:
    """A file of a report.

    Parameters
    ----------
    size : int
        In bytes.
    sha256 : str
        Of its content, in hexadecimal digits.
    """

    size: int
    sha256: str


@dataclass(frozen=True)
class Manifest:
    """The files of a report.

    Parameters
    ----------
    files : mapping of str to Entry
        By their names, which have no folder.
    complete : bool
        False while the files are being exchanged, and after that was cut short.
    about : str
        What the report is on; empty where an earlier version wrote it.
    """

    files: Mapping[str, Entry]
    complete: bool = True
    about: str = ""

    def write(self, folder: Path) -> Path:
        """Write it into a folder, whole or not at all."""
        content = {
            "made_by": f"Strutwork {__version__}",
            "about": self.about,
            "complete": self.complete,
            "files": {
                name: {"size": entry.size, "sha256": entry.sha256}
                for name, entry in sorted(self.files.items())
            },
        }
        return write_text(folder / MANIFEST, json.dumps(content, indent=1) + "\n")


def manifest_of(folder: Path, names: Iterable[str], about: str = "") -> Manifest:
    """The manifest of files that lie in a folder."""
    return Manifest({name: _entry(folder / name) for name in names}, about=about)


def read_manifest(folder: Path) -> Manifest | None:
    """The manifest in a folder; None where there is none.

    Raises
    ------
    ModelError
        A damaged manifest, or one that names a file outside its folder.
    """
    path = folder / MANIFEST
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        files = {
            _plain(name): Entry(int(entry["size"]), str(entry["sha256"]))
            for name, entry in content["files"].items()
        }
        return Manifest(files, content["complete"] is True, str(content.get("about", "")))
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise ModelError(
            str(path),
            "is not the manifest of a report, or is damaged.",
            "Choose another folder, or remove the report in this one by hand.",
        ) from error


def verify_report(folder: Path) -> Manifest:
    """Compare a report with its manifest.

    Returns
    -------
    Manifest
        Of the report, all of whose files are there and as they were written.

    Raises
    ------
    ModelError
        No manifest, a report whose writing was cut short, files that are missing or changed.
    """
    found = read_manifest(folder)
    if found is None:
        raise ModelError(str(folder), f"contains no {MANIFEST}.", "Name the folder of a report.")
    if not found.complete:
        raise ModelError(str(folder), "contains an incomplete report.", "Write it again.")
    wrong = [name for name, entry in found.files.items() if not _is(folder / name, entry)]
    if wrong:
        raise ModelError(
            str(folder),
            f"missing or changed since the report was written: {', '.join(wrong)}.",
            "Write the report again.",
        )
    return found


def _is(path: Path, entry: Entry) -> bool:
    try:
        # the size first: a file put there by another may be endless
        return path.is_file() and path.stat().st_size == entry.size and _entry(path) == entry
    except OSError:
        return False


def _entry(path: Path) -> Entry:
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    return Entry(path.stat().st_size, digest)


def _plain(name: Any) -> str:
    """A name without a folder: what a manifest from elsewhere names may be removed."""
    if (
        not isinstance(name, str)
        or name in {"", ".", "..", MANIFEST}
        or any(mark in name for mark in "/\\\0")
    ):
        raise ValueError(name)
    return name
