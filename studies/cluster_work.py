"""What runs on the workers of a cluster."""

from __future__ import annotations

import platform
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from importlib.metadata import version
from typing import Any

from threadpoolctl import threadpool_limits

import strutwork
from strutwork.errors import ClusterError
from strutwork.source_digest import source_digest

#: Packages of Strutwork that take part in a study.
_CODE = ("", ".kinematics", ".meshes", ".msa", ".fea", ".overconstraint", ".machines", ".studies")
#: Libraries that decide the last digits of numbers.
_LIBRARIES = ("numpy", "scipy", "numba", "llvmlite")


@dataclass(frozen=True)
class Identity:
    """What a process computes with.

    Parameters
    ----------
    code : str
        Version and hash of Strutwork, and Python's version without its last number: what is
        pickled by one is read by another of the same.
    libraries : mapping of name to version
    """

    code: str
    libraries: Mapping[str, str]


@cache
def identity() -> Identity:
    """That of this process."""
    digest = source_digest(*(f"strutwork{name}" for name in _CODE))[:12]
    python = ".".join(platform.python_version_tuple()[:2])
    code = f"strutwork {strutwork.__version__} ({digest}) on Python {python}"
    return Identity(code, {name: version(name) for name in _LIBRARIES})


def pickled(function: Callable[..., Any]) -> bytes:
    """A function with all that it refers to.

    Parameters
    ----------
    function : callable

    Raises
    ------
    ClusterError
        Something in it exists in this process alone.
    """
    import cloudpickle  # noqa: PLC0415 - comes with Dask

    try:
        return bytes(cloudpickle.dumps(function))
    except Exception as error:
        raise ClusterError(
            "study",
            f"cannot be sent to workers ({type(error).__name__}: {error}).",
            "Compute it on threads, or keep files, locks and the like out of machine and answers.",
        ) from error


@dataclass(frozen=True, eq=False)
class _Bytes:
    """Bytes that count as equal: the digest beside them says what they are."""

    content: bytes

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Bytes)

    def __hash__(self) -> int:
        return 0


@lru_cache(maxsize=2)
def _loaded(digest: str, payload: _Bytes) -> Callable[[Any], Any]:  # noqa: ARG001 - the cache's key
    import cloudpickle  # noqa: PLC0415 - comes with Dask

    function: Callable[[Any], Any] = cloudpickle.loads(payload.content)
    return function


def compute(digest: str, payload: bytes, chunk: Any, code: str) -> Any:
    """The result of a chunk, in a worker.

    Parameters
    ----------
    digest : str
        Of the payload.
    payload : bytes
        The function, as of `pickled`; read once per process.
    chunk : Chunk
    code : str
        Of the process that asks; a worker that came later is held to it as well.

    Raises
    ------
    ClusterError
        This worker has another Strutwork or Python.
    """
    if identity().code != code:
        raise ClusterError(
            "worker",
            f"has another Strutwork or Python: {identity().code}; the study has {code}.",
            "Install the same there, and start the workers again.",
        )
    function = _loaded(digest, _Bytes(payload))
    # stacks of small matrices lose by more threads
    with threadpool_limits(limits=1):
        return function(chunk)
