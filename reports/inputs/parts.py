"""Materials, sections and beams of a model."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import fields
from typing import TypeVar

import numpy as np

from strutwork.machines.model import Model
from strutwork.msa import Material, Section
from strutwork.reports.content import Column
from strutwork.reports.inputs.echo import NONE, Echo, number

T = TypeVar("T", Material, Section)


def used_materials(model: Model) -> dict[str, Material]:
    """Every material of a beam or solid, by its name; of one name with other values, each."""
    found = [beam.material for beam in model.structure.beams]
    found += [material for solid in model.solids for material in solid.made_of]
    return _by_name(found)


def materials(model: Model) -> Echo:
    """Elasticity, density and damping of every material that a part is made of."""
    found = used_materials(model)
    # of flexures neither density nor loss factor count, so other chapters need not know these
    found |= {f.material.name: f.material for f in model.flexures.values()}
    columns = (
        Column("material", "", False),
        Column("Young's modulus", "GPa"),
        Column("shear modulus", "GPa"),
        Column("Poisson's ratio"),
        Column("density", "kg/m³"),
        Column("loss factor"),
    )
    shown = {
        name: [
            number(m.youngs_modulus, 1e-9),
            number(m.shear_modulus, 1e-9),
            number(m.poissons_ratio, digits=3),
            number(m.density),
            number(m.loss_factor),
        ]
        for name, m in found.items()
    }
    exact = {
        name: [m.youngs_modulus, m.shear_modulus, m.poissons_ratio, m.density, m.loss_factor]
        for name, m in found.items()
    }
    heads = (
        "material",
        "youngs_modulus_Pa",
        "shear_modulus_Pa",
        "poissons_ratio",
        "density_kg_per_m3",
        "loss_factor",
    )
    return Echo("materials", "Materials", columns, shown, heads, exact)


def sections(model: Model) -> Echo:
    """Dimensions and properties of every section of a beam."""
    found = _by_name([beam.section for beam in model.structure.beams])
    columns = (
        Column("section", "", False),
        Column("shape", "", False),
        Column("dimensions", "mm", False),
        Column("area A", "cm²"),
        Column("Iy", "cm⁴", group="second moments of area"),
        Column("Iz", "cm⁴", group="second moments of area"),
        Column("torsion constant J", "cm⁴"),
    )
    shown = {
        name: [
            NONE if s.shape == "properties" else s.shape,
            ", ".join(f"{what} {number(size, 1e3)}" for what, size in s.dimensions) or NONE,
            number(s.area, 1e4),
            number(s.second_moment_y, 1e8),
            number(s.second_moment_z, 1e8),
            number(s.torsion_constant, 1e8),
        ]
        for name, s in found.items()
    }
    exact = {
        name: [
            s.shape,
            "; ".join(f"{what} {size!r} m" for what, size in s.dimensions),
            s.area,
            s.second_moment_y,
            s.second_moment_z,
            s.torsion_constant,
            *(s.shear_areas or (None, None)),
        ]
        for name, s in found.items()
    }
    heads = (
        "section",
        "shape",
        "dimensions",
        "area_m2",
        "second_moment_y_m4",
        "second_moment_z_m4",
        "torsion_constant_m4",
        "shear_area_y_m2",
        "shear_area_z_m2",
    )
    return Echo("sections", "Sections of the beams", columns, shown, heads, exact)


def beams(model: Model) -> Echo:
    """What every beam is made of, and how it is divided."""
    structure, positions = model.structure, model.placed.positions
    index = structure.mesh_index
    lengths = {}
    for beam in structure.beams:
        first, second = (positions[index[node]] for node in beam.nodes)
        ends = np.asarray(second) + beam.offsets[1] - np.asarray(first) - beam.offsets[0]
        lengths[beam.name] = float(np.linalg.norm(ends))
    columns = (
        Column("beam", "", False),
        Column("material", "", False),
        Column("section", "", False),
        Column("length at home", "mm"),
        Column("elements"),
        Column("shear", "", False),
    )
    shown = {
        b.name: [
            b.material.name,
            b.section.name,
            number(lengths[b.name], 1e3),
            str(b.elements),
            "included (Timoshenko)"
            if _shears(b.section, shear=b.shear)
            else "neglected (Euler-Bernoulli)",
        ]
        for b in structure.beams
    }
    exact = {
        b.name: [
            *b.nodes,
            b.material.name,
            b.section.name,
            lengths[b.name],
            b.elements,
            _shears(b.section, shear=b.shear),
            b.mass,
        ]
        for b in structure.beams
    }
    heads = ("beam", "from", "to", "material", "section", "length_m", "elements", "shear", "mass")
    return Echo("beams", "Beams", columns, shown, heads, exact, loose=(2,))


def _shears(section: Section, *, shear: bool) -> bool:
    return shear and (section.shear_areas is not None or section.shear_coefficients is not None)


def _by_name(found: Sequence[T]) -> dict[str, T]:
    """Each once by its name; where one name stands for several, all but the first with a number."""
    named: dict[str, T] = {}
    for one in found:
        for name in _names(one.name):
            if name not in named or _same(named[name], one):
                named.setdefault(name, one)
                break
    return named


def _same(one: object, other: object) -> bool:
    """Whether all plain numbers agree; functions of one section are made anew for each beam."""
    return all(
        getattr(one, f.name) == getattr(other, f.name)
        for f in fields(one)  # type: ignore[arg-type]
        if not callable(getattr(one, f.name))
    )


def _names(name: str) -> Iterator[str]:
    yield name
    number = 2
    while True:
        yield f"{name} ({number})"
        number += 1
