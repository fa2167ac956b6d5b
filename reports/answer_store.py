"""Answers kept on disk, so that a second report of the same machine asks nothing twice.

They lie in the user's own cache folder, beside the code that Numba compiled, which is run: who can
write there can run what they like as this user in any case. A folder of another owner, or one that
is open to others, is not read.
"""

from __future__ import annotations

import hashlib
import json
import os
import pickle
import shutil
import stat
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from strutwork.cache_folder import note_once, reason, user_cache
from strutwork.errors import OutputError, StrutworkError
from strutwork.files import write_whole
from strutwork.machines.model import Model
from strutwork.reports.answers import Outcome
from strutwork.source_digest import source_digest
from strutwork.studies.description import plain, versions

#: Packages whose code decides what a report says.
CODE = tuple(
    f"strutwork.{name}"
    for name in (
        *("kinematics", "meshes", "msa", "fea", "overconstraint", "flexures", "machines"),
        *("studies", "reports", "papers"),
    )
)

#: Largest answer that is kept, and largest size of all, bytes.
LARGEST = 2**28
ROOM = 2**30

_MARK = b"strutwork answer 1\n"

#: What reading an answer that another version wrote may end with.
_FOREIGN = (
    *(AttributeError, EOFError, ImportError, IndexError, KeyError, TypeError, ValueError),
    pickle.UnpicklingError,
)


def key_of(content: Mapping[str, Any]) -> str:
    """Hash of plain values, of the package's code and of the versions it calculates with."""
    whole = {
        "content": content,
        "versions": versions(),
        "code": source_digest("strutwork", *CODE),
    }
    return hashlib.sha256(json.dumps(whole, sort_keys=True).encode()).hexdigest()


def model_key(model: Model) -> str:
    """Hash of a model in its configuration, and of the code that answers for it.

    Raises
    ------
    ModelError
        It holds something that cannot be written down.
    """
    return key_of({"model": plain(model, "model")})


def answers_folder() -> Path | None:
    """Where answers are kept: `answers` in `user_cache`; None where that is nowhere."""
    user = user_cache()
    return None if user is None else user / "answers"


@dataclass(frozen=True)
class AnswerStore:
    """The answers about one machine.

    Parameters
    ----------
    folder : Path
        Of all answers.
    key : str
        Hash of everything that the answers depend on.
    fresh : bool
        Whether what lies there is left unread and written anew.
    """

    folder: Path
    key: str
    fresh: bool = False

    def path(self, name: str) -> Path:
        """File of an answer."""
        return self.folder / self.key[:40] / f"{name}.answer"

    def has(self, name: str) -> bool:
        """Whether an answer lies there."""
        return not self.fresh and self.path(name).is_file()

    def read(self, name: str) -> Outcome | None:
        """An answer of an earlier run; None where there is none, or a damaged one."""
        path = self.path(name)
        if not self.has(name) or not _private(self.folder):
            return None
        try:
            if path.stat().st_size > LARGEST:
                return None
            content = path.read_bytes()
        except OSError:
            return None
        body = content[len(_MARK) + 32 :]
        head = _MARK + hashlib.sha256(body).digest()
        if not content.startswith(head):
            note_once("damaged answer", f"{path} is damaged; its answer is computed again.")
            return None
        try:
            found = pickle.loads(body)  # noqa: S301 - our own file, in our own folder
        except _FOREIGN:
            return None
        with suppress(OSError):
            # what was asked for last goes last
            os.utime(path.parent)
        return found if isinstance(found, Outcome) else None

    def write(self, name: str, outcome: Outcome) -> bool:
        """Keep an answer, or an error that the machine itself is the reason of.

        Returns
        -------
        bool
            Whether it is kept: what cannot be is found again in the next run.

        Warns
        -----
        CacheWarning
            Once a process: the folder cannot be written.
        """
        if outcome.error is not None and not isinstance(outcome.error, StrutworkError):
            return False
        try:
            body = pickle.dumps(outcome)
        except (AttributeError, TypeError, pickle.PicklingError):
            return False
        if len(body) > LARGEST:
            return False
        whole = _MARK + hashlib.sha256(body).digest() + body
        try:
            self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            if not _private(self.folder):
                note_once(
                    "answers",
                    f"{self.folder} is accessible to other users: results are not stored for "
                    "later runs. Remove it, or restrict it (chmod 700).",
                )
                return False
            write_whole(self.path(name), lambda path: path.write_bytes(whole))
        except (OSError, OutputError) as error:
            cause = error.__cause__ if isinstance(error, OutputError) else error
            why = reason(cause if isinstance(cause, Exception) else error)
            note_once("answers", f"results are not stored for later runs ({self.folder}: {why}).")
            return False
        make_room(self.folder, self.path(name).parent)
        return True


def make_room(folder: Path, kept: Path, limit: int = ROOM) -> None:
    """Remove the answers that were asked for longest ago until all take less than `limit` bytes.

    Parameters
    ----------
    folder : Path
    kept : Path
        The folder in it that stays.
    limit : int
    """
    with suppress(OSError):
        sizes = {
            one: sum(f.stat().st_size for f in one.iterdir() if f.is_file())
            for one in folder.iterdir()
            if one.is_dir() and not one.is_symlink()
        }
        left = sum(sizes.values())
        for one in sorted(sizes, key=lambda p: p.stat().st_mtime):
            if left <= limit:
                return
            if one != kept:
                shutil.rmtree(one, ignore_errors=True)
                left -= sizes[one]


def _private(folder: Path) -> bool:
    """Whether a folder is this user's, and nobody else gets into it."""
    if not hasattr(os, "getuid"):
        return True
    try:
        found = folder.stat()
    except OSError:
        return False
    return found.st_uid == os.getuid() and not found.st_mode & (stat.S_IRWXG | stat.S_IRWXO)
