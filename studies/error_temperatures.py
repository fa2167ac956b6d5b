"""Temperatures of parts, with the coefficients of expansion of their materials."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from strutwork.errors import ModelError
from strutwork.machines.model import Model
from strutwork.msa.assembly import system_of
from strutwork.msa.thermal_loads import expandable
from strutwork.names import choices
from strutwork.studies.error_inputs import Temperature


def parts_of(model: Model, material: str) -> tuple[str, ...]:
    """Beams and solids made of a material.

    Parameters
    ----------
    model : Model
    material : str

    Raises
    ------
    ModelError
        No part is made of it.
    """
    made: dict[str, tuple[str, ...]] = {b.name: (b.material.name,) for b in model.structure.beams}
    made |= {s.name: tuple(s.materials) for s in model.solids}
    found = tuple(part for part, materials in made.items() if material in materials)
    if not found:
        known = {m for materials in made.values() for m in materials}
        raise ModelError(
            "temperatures",
            f'names the material "{material}", of which no part is made.',
            choices("Materials", material, sorted(known)),
        )
    return found


def temperature_of(
    model: Model,
    parts: Sequence[str],
    expansion: float | None,
    coefficients: Mapping[str, float],
    **given: Any,
) -> Temperature:
    """A temperature of parts with their coefficients of expansion.

    Parameters
    ----------
    model : Model
    parts : sequence of str
    expansion : float or None
        Of all of them, 1/K; by their materials where it is None.
    coefficients : mapping of material to float
        1/K.
    **given
        Other fields of `Temperature`.

    Raises
    ------
    ModelError
        An unknown part, or one without a coefficient.
    """
    known = expandable(system_of(model.placed))
    made: dict[str, tuple[str, ...]] = {b.name: (b.material.name,) for b in model.structure.beams}
    made |= {s.name: s.materials for s in model.solids}
    found = []
    for part in parts:
        if part not in known:
            raise ModelError(
                "temperatures", f'names the unknown part "{part}".', choices("Parts", part, known)
            )
        alpha = expansion
        if alpha is None:
            materials = made.get(part, ())
            values = {coefficients.get(m) for m in materials}
            if len(values) != 1 or None in values:
                of = f"its material {', '.join(materials)} has" if materials else "it has"
                raise ModelError(
                    f"temperature of {part}",
                    f"changes, and {of} no one coefficient of expansion.",
                    'Add it to [expansion], as in steel = "11.5 um/m/K", or give the entry its '
                    "own expansion.",
                )
            alpha = values.pop()
        found.append((part, float(alpha or 0.0)))
    return Temperature(parts=tuple(found), **given)
