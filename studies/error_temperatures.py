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
from strutwork.studies.error_solid_heat import SolidField, solid_heat


def parts_of(model: Model, material: str) -> tuple[str, ...]:
    """Beams and solids made of a material.

    Parameters
    ----------
    model : Model
    material : str

    Raises
    ------
    ModelError
        No part is made of it, or a solid of it and of another one.
    """
    made: dict[str, tuple[str, ...]] = {b.name: (b.material.name,) for b in model.structure.beams}
    made |= {s.name: tuple(s.materials) for s in model.solids}
    for part, materials in made.items():
        if material in materials and len(materials) > 1:
            raise ModelError(
                "temperatures",
                f"name the material {material}, of which {part} is made only in part.",
                f'Name parts: part = "{part}" heats all of it.',
            )
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
    heat: SolidField | None = None,
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
    heat : SolidField, optional
        Of solids, where their temperature is not one number.
    **given
        Other fields of `Temperature`.

    Raises
    ------
    ModelError
        An unknown part, one without a coefficient, or a field that does not suit a part.
    """
    known = expandable(system_of(model.placed))
    solids = {s.name: s for s in model.solids}
    made = {b.name: b.material.name for b in model.structure.beams}
    found, heated = [], []
    for part in parts:
        if part not in known:
            raise ModelError(
                "temperatures", f'names the unknown part "{part}".', choices("Parts", part, known)
            )
        if part in solids:
            if any(given.get("gradient", ())):
                raise ModelError(
                    f"temperature of {part}",
                    "has a gradient across a beam, and it is a solid.",
                    'Give gradient = ["0 K/m", "0 K/m", "3 K/m"], along the global axes.',
                )
            alphas = {
                m: _coefficient(part, m, expansion, coefficients) for m in solids[part].materials
            }
            field = heat or SolidField(given.get("change", 0.0))
            heated.append(solid_heat(solids[part], field, alphas))
            alpha = next(iter(alphas.values()))
        else:
            if heat is not None:
                raise ModelError(
                    f"temperature of {part}",
                    "varies as in a solid, and it is none.",
                    "Give gradient, profile and surfaces to solids; a beam has gradient_y and "
                    "gradient_z.",
                )
            alpha = _coefficient(part, made.get(part), expansion, coefficients)
        found.append((part, alpha))
    return Temperature(parts=tuple(found), solids=tuple(heated), **given)


def _coefficient(
    part: str, material: str | None, given: float | None, known: Mapping[str, float]
) -> float:
    """Of a material of a part, 1/K; that of the entry where there is one."""
    value = given if given is not None else known.get(material or "")
    if value is None:
        of = f"its material {material} has" if material else "it has"
        raise ModelError(
            f"temperature of {part}",
            f"changes, and {of} no coefficient of expansion.",
            f'Add it to [expansion], as in {material or "steel"} = "11.5 um/m/K", or give the '
            "entry its own expansion.",
        )
    return float(value)
