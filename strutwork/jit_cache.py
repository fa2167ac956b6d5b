"""Machine code on disk: named by the sources it came from, verified when read, never required.

Numba keeps the code of a function beside the function's file and renews it when that file changes.
It does not see a change of a function that is called from another file, raises where no folder can
be written or the disk is full, and runs what it reads from a damaged file. Here the folder is named
by the sources of all packages with compiled functions, each file ends in a checksum, and whatever
goes wrong costs a compilation and one note.
"""

# mypy: allow-untyped-calls
# since numba types a part of itself only
from __future__ import annotations

import hashlib
import os
import shutil
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO

from numba.core import caching, config

import strutwork
from strutwork.cache_folder import note_once, reason, takes_files, user_cache
from strutwork.source_digest import source_digest

#: Packages with compiled functions, and all that these import.
PACKAGES = (
    "strutwork",
    "strutwork.kinematics",
    "strutwork.meshes",
    "strutwork.msa",
    "strutwork.fea",
)

#: A part of a file that is older than this belongs to a run that was killed, s.
ABANDONED = 3600.0

_SUBJECT = "compiled functions"
_REMEDY = (
    "The results are the same; each run compiles again, which takes seconds to a minute. Set "
    "NUMBA_CACHE_DIR or XDG_CACHE_HOME to a writable folder."
)


def code_folders() -> list[Path]:
    """Folders in which machine code may be kept, the preferred first.

    NUMBA_CACHE_DIR where it is set, the installation's own, the user's cache. Those outside of the
    installation are shared and have one folder per installation.
    """
    own = Path(strutwork.__file__).resolve().parent
    here = hashlib.sha256(os.fsencode(own)).hexdigest()[:16]
    folders = [own / "__pycache__" / "compiled"]
    # numba makes the attributes of this module when it is imported
    chosen: str = vars(config)["CACHE_DIR"]
    if chosen:
        folders.insert(0, Path(chosen).absolute() / f"strutwork-{here}")
    user = user_cache()
    if user is not None:
        folders.append(user / "compiled" / here)
    return folders


@cache
def code_folder() -> Path | None:
    """The folder of the present sources, in the first place that takes files; None: nowhere.

    Code of other sources in that place is removed: their functions are compiled again, should they
    ever come back.
    """
    digest = source_digest(*PACKAGES)[:16]
    for base in code_folders():
        folder = base / digest
        fresh = not os.access(folder, os.F_OK)
        if takes_files(folder):
            if fresh:
                for other in base.iterdir():
                    if other != folder:
                        shutil.rmtree(other, ignore_errors=True)
            _clean(folder)
            return folder
    return None


def _clean(folder: Path) -> None:
    before = time.time() - ABANDONED
    for part in folder.glob("*.tmp.*"):
        try:
            if part.stat().st_mtime < before:
                part.unlink()
        except OSError:  # another process was faster
            continue


def code_cache(function: Callable[..., Any]) -> Any:
    """The cache of a function's machine code, for its numba dispatcher.

    Parameters
    ----------
    function : callable
        The Python function to be compiled.
    """
    if code_folder() is None:
        return _NoCache()
    try:
        return _CodeCache(function)
    except (RuntimeError, OSError) as error:
        # NUMBA_CACHE_LOCATOR_CLASSES may name other places, which fail in their own ways
        return _NoCache(f" ({reason(error)})")


class _NoCache(caching.NullCache):
    """Keeps nothing, and says so when the first function is compiled."""

    def __init__(self, why: str = "") -> None:
        self._why = why

    def load_overload(self, sig: Any, target_context: Any) -> None:  # noqa: ARG002
        places = ", ".join(str(folder.parent) for folder in code_folders())
        note_once(
            _SUBJECT,
            "compiled functions cannot be stored for later runs: nothing can be written in "
            f"{places}{self._why}. {_REMEDY}",
        )


class _Locator(caching._CacheLocator):  # noqa: SLF001 - numba's extension point
    """Gives numba the folder, and names of files by package and line."""

    def __init__(self, function: Callable[..., Any], file: str) -> None:
        self._py_file = file
        self._package = function.__module__.partition(".")[0]
        self._line = function.__code__.co_firstlineno

    def get_cache_path(self) -> str:
        return str(code_folder())

    def get_source_stamp(self) -> str:
        return source_digest(*PACKAGES)

    def get_disambiguator(self) -> str:
        return f"{self._package}-{self._line}"

    @classmethod
    def from_function(cls, py_func: Callable[..., Any], py_file: str) -> _Locator | None:
        return cls(py_func, py_file) if code_folder() is not None else None


class _Place(caching.CompileResultCacheImpl):
    _locator_classes = [_Locator]  # noqa: RUF012 - numba's own attribute


class _Store(caching.IndexDataCacheFile):
    """One file for each signature, named by all that its code depends on; there is no index.

    Numba's index numbers the files, so that two processes may give one number to two signatures.
    """

    def save(self, key: object, data: object) -> None:
        self._save_data(self._file(key), data)

    def load(self, key: object) -> Any:
        """The code kept for `key`; None where there is none.

        Raises
        ------
        ValueError
            The file is damaged.
        """
        name = self._file(key)
        try:
            whole = Path(self._data_path(name)).read_bytes()
        except FileNotFoundError:
            return None
        if whole[-32:] != hashlib.sha256(whole[:-32]).digest():
            raise ValueError("its content does not match its checksum")
        # what follows a pickle's end is not read
        return self._load_data(name)

    def flush(self) -> None:
        """Leave the files: those of the same sources are right."""

    def _file(self, key: object) -> str:
        content = repr((key, self._source_stamp, self._version, sys.version)).encode()
        stem = str(self._index_name).removesuffix(".nbi")
        return f"{stem}.{hashlib.sha256(content).hexdigest()[:24]}.nbc"

    @contextmanager
    def _open_for_write(self, filepath: str) -> Iterator[BinaryIO]:
        body = BytesIO()
        yield body
        whole = body.getvalue()
        with super()._open_for_write(filepath) as file:
            file.write(whole + hashlib.sha256(whole).digest())


class _CodeCache(caching.FunctionCache):
    """Numba's cache of one function, whose every failure is a note."""

    _impl_class = _Place

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        place = self._impl.locator.get_cache_path()
        self._cache_file = _Store(place, self._impl.filename_base, source_digest(*PACKAGES))

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        try:
            return super().load_overload(sig, target_context)
        except Exception as error:  # noqa: BLE001 - whatever a damaged or foreign file leads to
            note_once(
                f"reading {_SUBJECT}",
                f"a compiled function stored in {self.cache_path} cannot be used "
                f"({reason(error)}); it is compiled again.",
            )
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        try:
            super().save_overload(sig, data)
        except OSError as error:
            note_once(
                _SUBJECT,
                f"compiled functions cannot be stored for later runs in {self.cache_path} "
                f"({reason(error)}). {_REMEDY}",
            )
            self.disable()
