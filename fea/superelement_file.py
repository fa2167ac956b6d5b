"""Superelements on disk: one file each, named by content, verified when read."""

from __future__ import annotations

import hashlib
import io
import os
import warnings
import zipfile
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fea.superelement import Superelement
from strutwork import __version__
from strutwork.errors import ModelError
from strutwork.files import write_whole

Array = NDArray[Any]

#: Largest file that is read.
LARGEST = 8 * 2**30

_ARRAYS = ("positions", "local_stiffness", "local_mass", "shapes", "fixed_frequencies")
_MARK = b"strutwork superelement 1\n"


class CacheWarning(UserWarning):
    """A stored superelement that could not be used and was made anew."""


def fingerprint(parts: Iterable[Any]) -> str:
    """Name of a content: arrays by type, shape and bytes, everything else by its `repr`."""
    digest = hashlib.sha256(__version__.encode())
    for part in parts:
        if isinstance(part, np.ndarray):
            digest.update(f"{part.dtype.str}{part.shape}".encode())
            digest.update(np.ascontiguousarray(part).tobytes())
        else:
            digest.update(repr(part).encode())
        digest.update(b"\0")
    return digest.hexdigest()


def write_superelement(element: Superelement, path: Path) -> None:
    """Write a superelement, whole or not at all.

    A mark, the SHA-256 of the rest, and a NumPy archive.

    Raises
    ------
    ModelError
        A folder that cannot be written.
    """
    archive = io.BytesIO()
    np.savez(
        archive,
        name=np.array(element.name),
        nodes=np.array(element.nodes),
        solver=np.array(element.solver),
        **{key: getattr(element, key) for key in _ARRAYS},
    )
    body = archive.getvalue()
    whole = _MARK + hashlib.sha256(body).digest() + body
    write_whole(path, lambda temporary: temporary.write_bytes(whole))


def read_superelement(path: Path) -> Superelement:
    """Read a superelement and verify it.

    Raises
    ------
    ModelError
        No such file, another kind of file, or a damaged one.
    """
    part = f"superelement file {path.name}"
    try:
        if path.stat().st_size > LARGEST:
            raise ModelError(part, "is larger than 8 GiB.", "Retain fewer modes or delete it.")
        whole = path.read_bytes()
    except OSError as error:
        raise ModelError(part, f"cannot be read ({error.strerror}).", "Check its name.") from error
    body = whole[len(_MARK) + 32 :]
    if not whole.startswith(_MARK) or whole[len(_MARK) :][:32] != hashlib.sha256(body).digest():
        raise ModelError(
            part,
            "is damaged or no superelement: its content does not match its checksum.",
            "Delete it; it is made anew when next needed.",
        )
    try:
        with np.load(io.BytesIO(body), allow_pickle=False) as data:
            return Superelement(
                name=str(data["name"]),
                nodes=tuple(str(n) for n in data["nodes"]),
                solver=str(data["solver"]),
                **{key: data[key] for key in _ARRAYS},
            )
    except (KeyError, ValueError, zipfile.BadZipFile) as error:
        raise ModelError(
            part, "was written by another version.", "Delete it; it is made anew."
        ) from error


def cache_folder() -> Path:
    """Where superelements are kept: `$XDG_CACHE_HOME/strutwork`, else `~/.cache/strutwork`."""
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "strutwork" / "superelements"


def cached_superelement(
    content: Iterable[Any], make: Callable[[], Superelement], folder: Path | None = None
) -> Superelement:
    """The superelement of a content, from disk where it is, else made and stored.

    Parameters
    ----------
    content : iterable
        All that it depends on.
    make : callable
    folder : Path, optional
        Default: `cache_folder`.

    Returns
    -------
    Superelement

    Warns
    -----
    CacheWarning
        A stored file was damaged, or the folder cannot be written; the result is good.
    """
    path = (folder or cache_folder()) / f"{fingerprint(content)}.superelement"
    if path.exists():
        try:
            return read_superelement(path)
        except ModelError as error:
            warnings.warn(f"{error.part}: {error.problem} It is made anew.", CacheWarning, 2)
    element = make()
    try:
        write_superelement(element, path)
    except ModelError as error:
        warnings.warn(f"superelement {element.name} was not stored: {error}", CacheWarning, 2)
    return element
