"""Flexures of a model file: joints whose stiffness follows from their sizes."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from math import pi
from typing import TYPE_CHECKING, Any

from strutwork.errors import ModelError
from strutwork.machines.model import ModelWarning
from strutwork.machines.model_parts import material_of, unknown

if TYPE_CHECKING:
    from strutwork.flexures import Flexure
    from strutwork.machines.model_flexure_schema import AnyFlexureTable
    from strutwork.machines.model_schema import JointTable, ModelTable
    from strutwork.msa import Material

#: A joint's stiffness as six rows.
Rows = tuple[tuple[float, ...], ...]


def flexures_of(tables: ModelTable) -> dict[str, Flexure]:
    """All flexures by name, with their materials.

    Parameters
    ----------
    tables : ModelTable

    Raises
    ------
    ModelError
        An unknown material, or sizes that make no flexure.

    Warns
    -----
    ModelWarning
        Sizes outside the range of the formulas.
    """
    found: dict[str, Flexure] = {}
    for name, table in tables.flexures.items():
        if table.material not in tables.materials:
            raise unknown(f"flexure {name}", "material", table.material, tables.materials)
        material = material_of(table.material, tables.materials[table.material])
        flexure = found[name] = _flexure(name, table, material)
        for doubt in flexure.doubts:
            warnings.warn(f"flexure {name}: {doubt}", ModelWarning, stacklevel=3)
    return found


def joint_flexures(tables: ModelTable, flexures: Mapping[str, Flexure]) -> dict[str, Flexure]:
    """The flexure of each joint that has one, by the joint's name.

    Parameters
    ----------
    tables : ModelTable
    flexures : mapping of name to Flexure
        As `flexures_of`.

    Raises
    ------
    ModelError
        An unknown flexure, a joint of another type, or one that has a stiffness or a bearing too.
    """
    found: dict[str, Flexure] = {}
    for table in tables.joints:
        if table.flexure is None:
            continue
        part = f"joint {table.name}"
        if table.flexure not in flexures:
            raise unknown(part, "flexure", table.flexure, flexures)
        if table.bearing is not None:
            raise ModelError(part, "has a flexure and a bearing.", "Keep one of the two.")
        if table.type != "bushing":
            raise ModelError(
                part,
                f"is {table.type} and has a flexure, which is elastic in all directions.",
                'Use type = "bushing".',
            )
        if table.matrix is not None or table.stiffness.model_fields_set:
            raise ModelError(
                part,
                "has a flexure beside a stiffness of its own.",
                "Keep one of the two; the flexure's sizes give its stiffness.",
            )
        found[table.name] = flexures[table.flexure]
    return found


def stiffness_rows(table: JointTable, flexures: Mapping[str, Flexure]) -> Rows | None:
    """Stiffness of a joint's flexure in joint axes, (6, 6); its own matrix without one.

    Parameters
    ----------
    table : JointTable
    flexures : mapping of joint name to Flexure
        As `joint_flexures`, N/m, N and N·m/rad.
    """
    if table.name not in flexures:
        return table.matrix
    return tuple(tuple(row) for row in flexures[table.name].stiffness.tolist())


def _flexure(name: str, table: AnyFlexureTable, material: Material) -> Flexure:
    # only files with flexures wait for what computes them
    from strutwork.flexures import (  # noqa: PLC0415
        CircularNotch,
        CrossSpring,
        EllipticNotch,
        Leaf,
    )
    from strutwork.machines.model_flexure_schema import (  # noqa: PLC0415
        CircularNotchTable,
        EllipticNotchTable,
        LeafTable,
    )

    first = (name, material, table.thickness, table.width)
    common: dict[str, Any] = {
        "bending": table.bending,
        "allowable_stress": table.allowable_stress,
        "stress_concentration": table.stress_concentration,
    }
    if isinstance(table, CircularNotchTable):
        return CircularNotch(*first, table.radius, height=table.height, **common)
    if isinstance(table, EllipticNotchTable):
        axes = (table.semi_axis_x, table.semi_axis_y)
        return EllipticNotch(*first, *axes, height=table.height, **common)
    if isinstance(table, LeafTable):
        return Leaf(*first, table.length, **common)
    return CrossSpring(
        *first,
        table.length,
        angle=pi / 2 if table.angle is None else table.angle,
        crossing=table.crossing,
        leaves=table.leaves,
        spacing=table.spacing,
        **common,
    )
