"""The code that a stored result was made with, as one number."""

from __future__ import annotations

import hashlib
from functools import cache
from importlib.util import find_spec
from pathlib import Path


@cache
def source_digest(*packages: str) -> str:
    """SHA-256 over the Python sources of packages, with their names; read once per process.

    Of `strutwork` itself the modules count, not the packages in it, which are named apart.

    Parameters
    ----------
    *packages : str
        Packages that can be imported. Where one comes without sources it counts with its name
        only.

    Returns
    -------
    str
        Hexadecimal.

    Raises
    ------
    ModuleNotFoundError
        There is no such package.
    """
    digest = hashlib.sha256()
    for package in packages:
        spec = find_spec(package)
        if spec is None:
            raise ModuleNotFoundError(f"no package {package}", name=package)
        digest.update(f"{package}\0".encode())
        for place in map(Path, spec.submodule_search_locations or ()):
            for path in sorted(place.glob("*.py" if package == "strutwork" else "**/*.py")):
                content = path.read_bytes()
                # with its length, so that no content passes for the name of a next file
                digest.update(f"{path.relative_to(place)}\0{len(content)}\0".encode())
                digest.update(content)
    return digest.hexdigest()
