"""What a study was made of: names, parameters, versions, and a hash of it all."""

from __future__ import annotations

import hashlib
import inspect
import json
import platform
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
import scipy
import xarray as xr
from numpy.typing import NDArray

import strutwork
from strutwork.errors import ModelError
from strutwork.machines import CATALOGUE, Machine, ThreeLegs, VibratingLegs
from strutwork.source_digest import source_digest

#: Packages whose code decides a study's numbers.
_CODE = (
    "strutwork",
    "strutwork.kinematics",
    "strutwork.meshes",
    "strutwork.msa",
    "strutwork.fea",
    "strutwork.machines",
    "strutwork.studies",
)


def machine_name(machine: Machine) -> str:
    """Name in the catalogue, or the class's own.

    Parameters
    ----------
    machine : Machine
    """
    if isinstance(machine, VibratingLegs):
        return machine_name(machine.base)
    for entry in CATALOGUE.values():
        if entry.factory is type(machine):
            return entry.name
    return type(machine).__name__


def joint_model(machine: Machine) -> str:
    """Which joints the machine's structure has, in words.

    Parameters
    ----------
    machine : Machine
    """
    if isinstance(machine, VibratingLegs):
        return joint_model(machine.base)
    if isinstance(machine, ThreeLegs):
        if machine.platform_joint == "clamped":
            return "apparent: last links clamped in the platform, as the paper's tables suggest"
        return "true spherical joints"
    return "as built: every joint with its own free directions"


def parameters(machine: Machine) -> dict[str, Any]:
    """Fields of the machine as plain numbers and words, SI.

    Parameters
    ----------
    machine : Machine

    Raises
    ------
    ModelError
        The machine is not a dataclass, or a field holds something that cannot be written down.
    """
    if not is_dataclass(machine) or isinstance(machine, type):
        raise ModelError(
            f"machine {type(machine).__name__}",
            "does not state its parameters.",
            "Make its class a dataclass: a study records its inputs.",
        )
    return {f.name: plain(getattr(machine, f.name), f.name) for f in fields(machine)}


def plain(value: object, part: str = "value") -> Any:
    """Numbers, words, lists and tables only; arrays become lists, functions their names.

    Parameters
    ----------
    value : object
    part : str
        What it is, for the error.

    Raises
    ------
    ModelError
        Something else; names `part`.
    """
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    if is_dataclass(value) and not isinstance(value, type):
        return {f.name: plain(getattr(value, f.name), f"{part}.{f.name}") for f in fields(value)}
    if isinstance(value, Mapping):
        return {str(k): plain(v, f"{part}.{k}") for k, v in value.items()}
    if isinstance(value, Sequence | frozenset | set):
        items = sorted(value, key=str) if isinstance(value, frozenset | set) else value
        return [plain(v, part) for v in items]
    if inspect.ismethod(value):
        owner = plain(value.__self__, part)
        return {"method": f"{value.__module__}.{value.__qualname__}", "of": owner}
    if isinstance(value, partial):
        given = {"of": value.func, "arguments": value.args, "named": value.keywords}
        return {"partial": plain(given, part)}
    if inspect.isfunction(value):
        kept = inspect.getclosurevars(value).nonlocals
        return {"function": f"{value.__module__}.{value.__qualname__}", **plain(kept, part)}
    raise ModelError(
        part,
        f"is a {type(value).__name__}, which cannot be written down.",
        "Use numbers, strings, arrays, functions and dataclasses.",
    )


def versions() -> dict[str, str]:
    """Versions of the program and of what it calculates with."""
    return {
        "strutwork": strutwork.__version__,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "xarray": xr.__version__,
    }


@cache
def _code_hash(machine_type: type) -> str:
    """Hash of the code that computes a study of a machine, its own module included."""
    files = set()
    for kind in machine_type.__mro__:
        try:
            files.add(Path(inspect.getfile(kind)).resolve())
        except (TypeError, OSError):
            continue
    digest = hashlib.sha256(source_digest(*_CODE).encode())
    for path in sorted(files):
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def study_key(
    study: str, machine: Machine, settings: Mapping[str, Any], *arrays: NDArray[Any]
) -> str:
    """Hash of everything a study's numbers depend on, the code included.

    Parameters
    ----------
    study : str
        Which study.
    machine : Machine
    settings : mapping
        Plain values.
    *arrays : (...)
        Poses and the like, any unit; type, shape and bytes count.

    Returns
    -------
    str
        Hexadecimal SHA-256.
    """
    content = {
        "study": study,
        "class": f"{type(machine).__module__}.{type(machine).__qualname__}",
        "parameters": parameters(machine),
        "settings": plain(settings),
        "versions": versions(),
        "code": _code_hash(type(machine)),
    }
    digest = hashlib.sha256(json.dumps(content, sort_keys=True).encode())
    for array in arrays:
        digest.update(f"{array.dtype}{array.shape}".encode())
        digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()


def content_key(study: str, *inputs: object) -> str:
    """Hash of a study that is made of no named machine, the code included.

    Parameters
    ----------
    study : str
        Which study.
    *inputs : dataclasses, mappings, arrays and plain values
        Everything that its numbers depend on.
    """
    content = {
        "study": study,
        "inputs": [plain(value) for value in inputs],
        "versions": versions(),
        "code": source_digest(*_CODE),
    }
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def attributes(study: str, machine: Machine) -> dict[str, str]:
    """Global attributes of a study's dataset.

    Parameters
    ----------
    study : str
        Which study.
    machine : Machine
    """
    return {
        "title": f"{study} of {machine_name(machine)}",
        "Conventions": "CF-1.11",
        "source": f"strutwork {strutwork.__version__}",
        "machine": machine_name(machine),
        "parameters": json.dumps(parameters(machine)),
        "joint_model": joint_model(machine),
        "versions": json.dumps(versions()),
    }
