"""Numbers of a calibration in the units in which engineers read them."""

from __future__ import annotations

from math import degrees

from strutwork.studies.calibration_result import Agreement, Found

_READ = {
    "m": ("mm", 1e3),
    "rad": ("deg", degrees(1.0)),
    "Pa": ("GPa", 1e-9),
    "N/m": ("N/µm", 1e-6),
    "N*m/rad": ("kN·m/rad", 1e-3),
    "N m/rad": ("kN·m/rad", 1e-3),
    "": ("", 1.0),
}


def read_number(unit: str) -> tuple[str, float]:
    """The unit in which a number is read, and its factor from SI."""
    return _READ.get(unit, (unit.replace("*", "·"), 1.0))


def interval_words(found: Found, digits: int = 4) -> str:
    """The 95 % interval without its unit; "none" where nothing determines the number."""
    if found.interval is None:
        return "none"
    factor = read_number(found.unit)[1]
    low, high = found.interval
    return f"{low * factor:.{digits}g} to {high * factor:.{digits}g}"


def verdict_words(found: Found) -> str:
    """The verdict, and that what was known before takes part."""
    if found.verdict == "not identifiable" and found.prior:
        return "not identifiable (prior)"
    return found.verdict


def agreement_unit(agreement: Agreement, index: int) -> tuple[str, float]:
    """The unit in which a measured value is read, and its factor from SI."""
    if agreement.kind != "deflections":
        return agreement.unit, 1.0
    turns = agreement.labels[index].rpartition(":")[2].startswith("r")
    return ("µrad", 1e6) if turns else ("µm", 1e6)
