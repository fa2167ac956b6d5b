"""Beams, joints, springs and masses from the tables of a model file."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Joint
from strutwork.kinematics.joint import JOINT_TYPES
from strutwork.machines.model import Damping, ModelWarning
from strutwork.machines.model_schema import (
    BodyTable,
    BoxTable,
    DampingByDirection,
    Displacement,
    JointTable,
    MaterialTable,
    ModelTable,
    RectangleTable,
    RodTable,
    SectionTable,
    StiffnessTable,
    TubeTable,
)
from strutwork.msa import Beam, Material, PointMass, Section, Spring, box, rectangle, rod, tube
from strutwork.names import choices

#: Poisson's ratio and shear modulus may disagree by this share without a warning.
SHEAR_TOLERANCE = 0.01


def by_direction(
    table: StiffnessTable | DampingByDirection | Displacement,
) -> dict[str, float]:
    """The directions that a table names, in order, with their values in SI.

    Parameters
    ----------
    table : StiffnessTable, DampingByDirection or Displacement
    """
    named = {direction: getattr(table, direction) for direction in DIRECTIONS}
    return {direction: value for direction, value in named.items() if value is not None}


def unknown(part: str, kind: str, name: str, known: Mapping[str, object]) -> ModelError:
    """The error for a name that stands for nothing.

    Parameters
    ----------
    part : str
        What names it.
    kind : str
        What it should be: "joint", "node".
    name : str
    known : mapping of str
        Names that exist; the remedy lists them.
    """
    remedy = choices("Known", name, known, 8) if known else f"The file defines no {kind}."
    return ModelError(part, f'names the unknown {kind} "{name}".', remedy)


def beams_of(tables: ModelTable) -> tuple[Beam, ...]:
    """All beams, with their materials and sections.

    Parameters
    ----------
    tables : ModelTable

    Raises
    ------
    ModelError
        An unknown material or section, or a wrong property.
    """
    materials = {name: material_of(name, table) for name, table in tables.materials.items()}
    sections = {name: section_of(name, table) for name, table in tables.sections.items()}
    beams = []
    for t in tables.beams:
        part = f"beam {t.name}"
        if t.material not in materials:
            raise unknown(part, "material", t.material, materials)
        if t.section not in sections:
            raise unknown(part, "section", t.section, sections)
        beams.append(
            Beam(
                name=t.name,
                nodes=(t.from_, t.to),
                material=materials[t.material],
                section=sections[t.section],
                orientation=t.orientation,
                shear=t.shear,
                elements=t.elements,
                offsets=(t.offset_from, t.offset_to),
            )
        )
    return tuple(beams)


def material_of(name: str, table: MaterialTable) -> Material:
    """A material; where both are given, the shear modulus counts, not Poisson's ratio.

    Parameters
    ----------
    name : str
    table : MaterialTable

    Raises
    ------
    ModelError
        Neither Poisson's ratio nor the shear modulus.

    Warns
    -----
    ModelWarning
        The two differ by more than 1 %.
    """
    e, nu, g = table.youngs_modulus, table.poissons_ratio, table.shear_modulus
    if g is None:
        if nu is None:
            raise ModelError(
                f"material {name}",
                "has neither poissons_ratio nor shear_modulus.",
                "Give one of the two.",
            )
        return Material.isotropic(e, nu, table.density, table.loss_factor, name)
    if nu is not None:
        implied = e / (2.0 * (1.0 + nu))
        if abs(implied - g) > SHEAR_TOLERANCE * g:
            warnings.warn(
                f"material {name}: poissons_ratio {nu:g} gives a shear modulus of {implied:.4g} "
                f"Pa, but shear_modulus is {g:.4g} Pa; the shear modulus is used.",
                ModelWarning,
                stacklevel=2,
            )
    return Material(e, g, table.density, table.loss_factor, name)


def section_of(name: str, table: SectionTable) -> Section:
    """A section of any shape.

    Parameters
    ----------
    name : str
    table : RodTable, TubeTable, RectangleTable, BoxTable or PropertiesTable

    Raises
    ------
    ModelError
        Sizes that leave no material, or one shear area without the other.
    """
    if isinstance(table, RodTable):
        return rod(table.diameter, name)
    if isinstance(table, TubeTable):
        return tube(table.outer_diameter, table.inner_diameter, name)
    if isinstance(table, RectangleTable):
        return rectangle(table.width_y, table.height_z, name)
    if isinstance(table, BoxTable):
        return box(table.width_y, table.height_z, table.thickness, name)
    areas = table.shear_area_y, table.shear_area_z
    if (areas[0] is None) != (areas[1] is None):
        raise ModelError(
            f"section {name}", "has one shear area without the other.", "Give both or none."
        )
    shear = None if areas[0] is None or areas[1] is None else (areas[0], areas[1])
    return Section(table.area, table.Iy, table.Iz, table.J, None, shear, name)


@dataclass(frozen=True)
class Borne:
    """What a bearing makes of the stiffness of a joint.

    Parameters
    ----------
    name : str
        Of the bearing's entry.
    stiffness : mapping of direction to float
        N/m and N·m/rad.
    matrix : (6, 6) nested tuples or None
        In place of it, N/m, N and N·m.
    """

    name: str
    stiffness: Mapping[str, float]
    matrix: tuple[tuple[float, ...], ...] | None


def joint_of(
    table: JointTable,
    borne: Borne | None = None,
    matrix: tuple[tuple[float, ...], ...] | None = None,
) -> Joint:
    """A joint of the file.

    Parameters
    ----------
    table : JointTable
    borne : Borne, optional
        Where the table names a bearing.
    matrix : (6, 6) nested tuples, optional
        Stiffness of its flexure in joint axes, N/m, N and N·m/rad.

    Raises
    ------
    ModelError
        A direction driven twice, or what `Joint` refuses.
    """
    if len(set(table.driven)) < len(table.driven):
        raise ModelError(
            f"joint {table.name}", "drives one direction twice.", "Name each direction once."
        )
    given = table.matrix if matrix is None else matrix
    return Joint(
        name=table.name,
        type=table.type,
        between=table.between,
        stiffness=by_direction(table.stiffness) if borne is None else borne.stiffness,
        damping=by_direction(table.damping),
        driven=table.driven,
        limits=_limits(table),
        matrix=given if borne is None else borne.matrix,
        pitch=table.pitch,
        bearing="" if borne is None else borne.name,
    )


def _limits(table: JointTable) -> dict[str, tuple[float, float]]:
    part = f"joint {table.name}"
    named = {d: getattr(table.limits, d) for d in DIRECTIONS}
    found = {d: span for d, span in named.items() if span is not None}
    for direction, (low, high) in found.items():
        if not low < high:
            raise ModelError(
                part,
                f"limits of {direction} are {low:g} and {high:g}.",
                "Give the lower one first.",
            )
        held = {*JOINT_TYPES[table.type], *by_direction(table.stiffness)} - set(table.driven)
        if direction in held or table.matrix is not None or table.flexure is not None:
            raise ModelError(
                part,
                f"has limits in {direction}, in which it does not move.",
                "Limit a direction that is free or driven.",
            )
    return found


def springs_of(tables: ModelTable) -> tuple[Spring, ...]:
    """All springs; one without a name is called by its nodes.

    Parameters
    ----------
    tables : ModelTable

    Raises
    ------
    ModelError
        Both or neither of `node` and `between`, or what `Spring` refuses.
    """
    taken = {t.name for t in tables.beams} | {t.name for t in tables.springs}
    springs = []
    for i, t in enumerate(tables.springs):
        if (t.node is None) == (t.between is None):
            found = "neither node nor between" if t.node is None else "both node and between"
            raise ModelError(
                f"springs[{i}]", f"has {found}.", "Give node for a spring to ground, else between."
            )
        nodes = t.between if t.between is not None else (t.node or "",)
        name = t.name or "-".join(nodes)
        if t.name is None:
            count = 2
            while name in taken:
                name = f"{'-'.join(nodes)} {count}"
                count += 1
            taken.add(name)
        springs.append(Spring(name, nodes, by_direction(t.stiffness)))
    return tuple(springs)


def masses_of(tables: ModelTable) -> tuple[PointMass, ...]:
    """Masses at nodes, and those of rigid bodies, carried by their first node.

    Parameters
    ----------
    tables : ModelTable
    """
    zero = ((0.0,) * 3,) * 3
    masses = [PointMass(t.node, t.mass, t.inertia or zero) for t in tables.masses]
    for body in tables.bodies:
        if body.mass is None:
            if body.center_of_mass is not None or body.inertia is not None:
                raise ModelError(
                    f"body {body.name}",
                    "has a centre of mass or an inertia but no mass.",
                    "Give its mass.",
                )
            continue
        first = np.asarray(tables.nodes[body.nodes[0]])
        x, y, z = (float(v) for v in _center(tables, body) - first)
        masses.append(PointMass(body.nodes[0], body.mass, body.inertia or zero, (x, y, z)))
    return tuple(masses)


def _center(tables: ModelTable, body: BodyTable) -> NDArray[np.float64]:
    if body.center_of_mass is not None:
        return np.array(body.center_of_mass)
    return np.asarray(np.mean([tables.nodes[n] for n in body.nodes], axis=0))


def damping_of(tables: ModelTable) -> Damping | None:
    """Damping of the whole structure.

    Parameters
    ----------
    tables : ModelTable

    Raises
    ------
    ModelError
        None of its kinds, or several.
    """
    table = tables.damping
    if table is None:
        return None
    given = [name for name in type(table).model_fields if getattr(table, name) is not None]
    if len(given) != 1:
        found = " and ".join(given) if given else "nothing"
        raise ModelError(
            "damping",
            f"has {found}.",
            "Give exactly one of modal_ratio, loss_factor and rayleigh.",
        )
    rayleigh = None if table.rayleigh is None else (table.rayleigh.alpha, table.rayleigh.beta)
    return Damping(table.modal_ratio, table.loss_factor, rayleigh)
