"""What takes long is made once for all processes of a test run."""

from __future__ import annotations

import copyreg
import fcntl
import os
import pickle
from collections.abc import Callable
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar

#: Variable that names the folder in which such things lie.
FOLDER = "STRUTWORK_TEST_REPORTS"

T = TypeVar("T")


def _unchanged(found: dict[Any, Any]) -> MappingProxyType[Any, Any]:
    return MappingProxyType(found)


# mappings that nobody changes do not pickle by themselves
copyreg.pickle(MappingProxyType, lambda found: (_unchanged, (dict(found),)))


def folder_of(base: Path) -> Path:
    """Where they lie: the folder of the run, else one that the workers have in common."""
    if "PYTEST_XDIST_WORKER" in os.environ:
        base = base.parent
    return Path(os.environ.get(FOLDER, base))


def once(name: str, folder: Path, make: Callable[[], T]) -> T:
    """What whoever asks first has made."""
    found = folder / f"{name}.pickle"
    with (folder / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not found.exists():
            made = make()
            found.write_bytes(pickle.dumps(made))
    return pickle.loads(found.read_bytes())  # type: ignore[no-any-return]  # noqa: S301 - our own
