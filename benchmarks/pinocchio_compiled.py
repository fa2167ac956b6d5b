"""The legs of `pinocchio_peer` in C++ on Pinocchio's headers, all poses in one call."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.pinocchio_peer import CLOSED, MOST, Answer, answer, branches, targets
from strutwork.kinematics import Motion, Poses

Array = NDArray[Any]

SOURCE = Path(__file__).with_name("pinocchio_legs.cpp")
#: As Pinocchio's own build sets them: it has more kinds of joints than Boost expects.
DEFINED = (
    "NDEBUG",
    "BOOST_MPL_LIMIT_LIST_SIZE=30",
    "BOOST_MPL_LIMIT_VECTOR_SIZE=30",
    "BOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
    "BOOST_FUSION_INVOKE_MAX_ARITY=12",
)


def missing() -> str:
    """What the compilation lacks; empty where it lacks nothing."""
    if shutil.which(_compiler()) is None:
        return f"the compiler {_compiler()}"
    return "" if _eigen() else "the headers of Eigen"


def compiled(folder: Path) -> Path:
    """Compile the legs into a folder, which takes minutes, and return the library.

    Raises
    ------
    RuntimeError
        The compiler's complaint.
    """
    library = folder / "legs.so"
    headers = [str(_prefix() / "include"), *map(str, _eigen())]
    command = [_compiler(), "-std=c++17", "-O3", "-march=native", "-fPIC", "-shared"]
    command += [f"-D{name}" for name in DEFINED]
    command += [part for path in headers for part in ("-isystem", path)]
    done = subprocess.run(
        [*command, str(SOURCE), "-o", str(library)], capture_output=True, text=True, check=False
    )
    if done.returncode:
        message = f"{SOURCE.name} is not compiled:\n{done.stderr[:2000]}"
        raise RuntimeError(message)
    return library


class CompiledLegs:
    """The legs of a machine in Pinocchio, all poses in one call."""

    def __init__(self, motion: Motion, library: Path) -> None:
        self.motion, self.legs = motion, branches(motion)
        self._library = ctypes.CDLL(str(library))
        made, legs = self._library.legs_make, self.legs
        made.restype = ctypes.c_void_p
        kinds, places, ends, driven = map(
            np.ascontiguousarray, (legs.kinds, legs.places, legs.ends, legs.driven)
        )
        self._handle = ctypes.c_void_p(
            made(len(ends), _at(kinds), _at(places), _at(ends), len(driven), _at(driven))
        )

    def __del__(self) -> None:
        """Free what the library holds."""
        self._library.legs_free(self._handle)

    def survey(self, poses: Poses, length: float) -> Answer:
        """Drives, Jacobian, joint ranges and margin of poses, (p,)."""
        wanted = targets(self.legs, poses)
        count, drives = len(wanted), len(self.legs.driven)
        q, rates = np.empty((count, len(self.legs.kinds))), np.empty((count, drives, 6))
        closed = np.empty(count, dtype=np.uint8)
        self._library.legs_solve(
            self._handle,
            ctypes.c_int64(count),
            _at(wanted),
            _at(np.ascontiguousarray(poses.position)),
            ctypes.c_double(CLOSED),
            MOST,
            _at(q),
            _at(rates),
            _at(closed),
        )
        return answer(self.motion, self.legs, q, rates, closed.astype(bool), length)


def _at(array: Array) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)


def _compiler() -> str:
    return os.environ.get("CXX", "g++")


def _prefix() -> Path:
    """Where the wheels of Pinocchio keep what is not Python: .../cmeel.prefix."""
    found = find_spec("pinocchio")
    if found is None or found.origin is None:
        message = "Pinocchio is not installed"
        raise RuntimeError(message)
    return Path(found.origin).resolve().parents[4]


def _eigen() -> list[Path]:
    places = (_prefix() / "include" / "eigen3", Path("/usr/include/eigen3"))
    return [place for place in places if (place / "Eigen" / "Core").is_file()][:1]
