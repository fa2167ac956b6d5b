"""A library of force coefficients, as data that a user may extend."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from strutwork.cutting.coefficients import ForceCoefficients
from strutwork.errors import ModelError
from strutwork.units import LINE_LOAD, PRESSURE, quantity

LIBRARY = Path(__file__).with_name("data") / "materials.toml"

#: A larger file is refused, bytes.
MAX_BYTES = 10_000_000

_KEYS = {
    "tangential": PRESSURE,
    "radial": PRESSURE,
    "axial": PRESSURE,
    "edge_tangential": LINE_LOAD,
    "edge_radial": LINE_LOAD,
    "edge_axial": LINE_LOAD,
}
_TEXTS = ("tool", "source")


def material_library(path: str | Path | None = None) -> Mapping[str, ForceCoefficients]:
    """Force coefficients by name, from the library of the package or from a file.

    Parameters
    ----------
    path : str, Path or None
        A TOML file with a table per material: `tangential`, `radial` and `axial` as pressures,
        `edge_tangential` and so on as forces per length, all with their unit, and `source`, which
        names where they come from. None for the library of the package.

    Raises
    ------
    ModelError
        The file cannot be read, an entry is no table, has no source, no tangential coefficient or
        an unknown key.
    UnitError
        A coefficient with a unit of another dimension.
    """
    file = LIBRARY if path is None else Path(path)
    try:
        if file.stat().st_size > MAX_BYTES:
            raise ModelError(str(file), "is larger than 10 MB.", "Name a file of materials.")
        entries = tomllib.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise ModelError(
            str(file), f"cannot be read ({error}).", "Name a TOML file with a table per material."
        ) from None
    return MappingProxyType({name: _entry(name, entry) for name, entry in entries.items()})


def material(name: str, path: str | Path | None = None) -> ForceCoefficients:
    """Force coefficients of one material.

    Parameters
    ----------
    name : str
    path : str, Path or None
        As `material_library`.

    Raises
    ------
    ModelError
        There is none of that name, or as `material_library`.
    """
    library = material_library(path)
    if name not in library:
        raise ModelError(
            f'material "{name}"', "is not in the library.", f"It has: {', '.join(library)}."
        )
    return library[name]


def _entry(name: str, entry: object) -> ForceCoefficients:
    part = f'material "{name}"'
    if not isinstance(entry, dict):
        raise ModelError(part, "is no table.", f"Write [{name}] and its coefficients below it.")
    unknown = [key for key in entry if key not in _KEYS and key not in _TEXTS]
    if unknown:
        known = ", ".join([*_KEYS, *_TEXTS])
        raise ModelError(part, f'has the unknown key "{unknown[0]}".', f"Keys are: {known}.")
    source = entry.get("source")
    if not (isinstance(source, str) and source.strip()):
        raise ModelError(part, "has no source.", "Say where its coefficients come from.")
    if "tangential" not in entry:
        raise ModelError(
            part, "has no tangential coefficient.", 'Give it, as in tangential = "600 MPa".'
        )
    numbers = {
        key: quantity(entry[key], dimension, f"{part}, {key}")
        for key, dimension in _KEYS.items()
        if key in entry
    }
    return ForceCoefficients(**numbers, name=name, source=source)
