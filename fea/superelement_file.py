"""Superelements on disk: one file each, named by content, verified when read."""

from __future__ import annotations

import hashlib
import io
import zipfile
from collections.abc import Callable, Iterable, Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.cache_folder import note_once, reason, user_cache
from strutwork.errors import ModelError, StrutworkError
from strutwork.fea.superelement import Superelement
from strutwork.files import write_whole
from strutwork.source_digest import source_digest

Array = NDArray[Any]

#: Largest file that is read.
LARGEST = 8 * 2**30

_ARRAYS = ("positions", "local_stiffness", "local_mass", "shapes", "fixed_frequencies")
_MARK = b"strutwork superelement 2\n"

#: Of files without the limit: a Krylov basis from one counts as accurate to 0 Hz.
_OLD_MARK = b"strutwork superelement 1\n"

#: The code that makes superelements: packages of our own by their sources, others by version.
_OWN = (
    "strutwork",
    "strutwork.kinematics",
    "strutwork.meshes",
    "strutwork.msa",
    "strutwork.fea",
)
_OTHERS = ("numpy", "scipy", "sfepy")


def fingerprint(parts: Iterable[Any]) -> str:
    """Name of a content, and of the code that makes something of it.

    Arrays count by type, shape and bytes, everything else by its `repr`.

    Parameters
    ----------
    parts : iterable
        Arrays and whatever has a `repr` that says all of it.
    """
    digest = hashlib.sha256(source_digest(*_OWN).encode())
    digest.update(repr([version(name) for name in _OTHERS]).encode())
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

    Parameters
    ----------
    element : Superelement
    path : Path

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
        limit=np.array(np.nan if element.limit is None else element.limit),
        **{key: getattr(element, key) for key in _ARRAYS},
    )
    body = archive.getvalue()
    whole = _MARK + hashlib.sha256(body).digest() + body
    write_whole(path, lambda temporary: temporary.write_bytes(whole))


def read_superelement(path: Path) -> Superelement:
    """Read a superelement and verify it.

    A file from before the limit was stored is read without one: a Krylov basis then is accurate
    to 0 Hz, and every solver warns of it. So is a basis of modes that lacks a residual vector.

    Parameters
    ----------
    path : Path

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
    old = whole.startswith(_OLD_MARK)
    if (
        not (old or whole.startswith(_MARK))
        or whole[len(_MARK) :][:32] != hashlib.sha256(body).digest()
    ):
        raise ModelError(
            part,
            "is damaged or not a superelement: its content does not match its checksum.",
            "Delete it; it is made again when next needed.",
        )
    try:
        with np.load(io.BytesIO(body), allow_pickle=False) as data:
            limit = np.nan if old else float(data["limit"])
            if old and len(data["fixed_frequencies"]) and not _complete(data):
                limit = 0.0
            return Superelement(
                name=str(data["name"]),
                nodes=tuple(str(n) for n in data["nodes"]),
                solver=str(data["solver"]),
                limit=None if np.isnan(limit) else limit,
                **{key: data[key] for key in _ARRAYS},
            )
    except (KeyError, ValueError, zipfile.BadZipFile) as error:
        raise ModelError(
            part, "was written by another version.", "Delete it; it is made again."
        ) from error


def _complete(data: Mapping[str, Array]) -> bool:
    """Whether a stored basis of modes has a residual vector for every interface freedom."""
    monitors = sum(str(n).startswith(f"{data['name']}/") for n in data["nodes"])
    interfaces = len(data["nodes"]) - monitors
    return 6 * monitors >= len(data["fixed_frequencies"]) + 6 * interfaces


def cache_folder() -> Path | None:
    """Where superelements are kept: `superelements` in `user_cache`; None where that is nowhere."""
    user = user_cache()
    return None if user is None else user / "superelements"


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
        Once a process each: a stored file cannot be read or is damaged; the folder cannot be
        written. The result is good.
    """
    folder = cache_folder() if folder is None else folder
    if folder is None:
        _note_not_kept("there is no home folder")
        return make()
    path = folder / f"{fingerprint(content)}.superelement"
    stored = _stored(path)
    if stored is not None:
        return stored
    element = make()
    try:
        write_superelement(element, path)
    except (StrutworkError, OSError) as error:
        why = error.problem if isinstance(error, StrutworkError) else f"{reason(error)}."
        _note_not_kept(f"{folder} {why.rstrip('.')}")
    return element


def _stored(path: Path) -> Superelement | None:
    """What is stored, if it is there and whole."""
    try:
        path.lstat()
    except OSError:
        # where there is one that cannot be reached, storing fails too and says why
        return None
    try:
        return read_superelement(path)
    except ModelError as error:
        note_once(str(path), f"{error.part}: {error.problem} It is made again.")
        return None


def _note_not_kept(why: str) -> None:
    note_once(
        f"superelements: {why}",
        f"superelements cannot be stored for later runs: {why}. The results are the same; each "
        "run reduces the solids again. Set XDG_CACHE_HOME to a writable folder.",
    )
