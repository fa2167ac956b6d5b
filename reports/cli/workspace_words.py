"""How the size of a workspace and places in it are put in words."""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees

from strutwork.reports.numbers import count


def parts_words(safe: Mapping[str, int]) -> str:
    """Capsules and meshes that are there, in words."""
    kinds = ((safe["capsules"], "capsule", "capsules"), (safe["shapes"], "mesh", "meshes"))
    return " and ".join(count(n, one, many) for n, one, many in kinds if n)


def measure_word(unit: str) -> str:
    """Length, area or volume."""
    return {"m": "Length", "m²": "Area", "m³": "Volume"}.get(unit, "Measure")


def unit_words(unit: str) -> tuple[float, str]:
    """Factor and unit of a measure for people."""
    return {"m": (1e3, "mm"), "m²": (1e4, "cm²"), "m³": (1e3, "dm³")}.get(unit, (1.0, unit))


def placed(at: Mapping[str, float]) -> str:
    """Coordinates by direction, in mm and degrees."""
    words = []
    for name, value in at.items():
        turns = name.startswith("r")
        # what is left of rounding is no place
        shown_value = round((degrees(value) if turns else 1e3 * value), 9) + 0.0
        words.append(f"{name} = {shown_value:.5g} {'deg' if turns else 'mm'}")
    return ", ".join(words)
