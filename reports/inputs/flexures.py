"""Flexures of a model: the sizes that give joints their stiffness."""

from __future__ import annotations

from math import degrees

import numpy as np

from strutwork.flexures import CrossSpring, Flexure
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.model import Model
from strutwork.reports.content import Column
from strutwork.reports.inputs.echo import NONE, Echo, number


def flexures(model: Model) -> Echo:
    """Shape, sizes, stiffness and stroke of every joint that is a flexure."""
    columns = (
        Column("joint", "", False),
        Column("flexure", "", False),
        Column("shape", "", False),
        Column("material", "", False),
        Column("dimensions", "mm", False),
        Column("bends as a", "", False),
        Column("stiffness about z, others free", "N·m/rad"),
        Column("allowable stress", "MPa"),
        Column("stroke about z", "mrad"),
    )
    shown, exact = {}, {}
    for joint, f in model.flexures.items():
        bends = "plate" if f.plate else "beam"
        turning = 1.0 / float(f.compliance[5, 5])
        shown[joint] = [
            f.name,
            f.shape.replace("_", " "),
            f.material.name,
            ", ".join(f"{what} {number(size, 1e3)}" for what, size in _sizes(f)) + _pivot(f),
            bends,
            number(turning),
            number(f.allowable_stress, 1e-6),
            NONE if f.stroke is None else number(float(f.stroke[5]), 1e3),
        ]
        exact[joint] = [
            f.name,
            f.shape,
            f.material.name,
            "; ".join(f"{what} {size!r} m" for what, size in _sizes(f)) + _pivot(f),
            bends,
            f.allowable_stress,
            *f.stiffness[np.triu_indices(6)].tolist(),
        ]
    pairs = zip(*np.triu_indices(6), strict=True)
    heads = (
        "joint",
        "flexure",
        "shape",
        "material",
        "dimensions",
        "bending",
        "allowable_stress_Pa",
        *(f"stiffness_{DIRECTIONS[i]}_{DIRECTIONS[j]}_SI" for i, j in pairs),
    )
    caption = "Flexures; the stiffness matrices in the file have joint axes"
    return Echo("flexures", caption, columns, shown, heads, exact)


def _sizes(flexure: Flexure) -> list[tuple[str, float]]:
    names = ("thickness", "width", *flexure.sizes)
    sizes = [(name.replace("_", " "), getattr(flexure, name)) for name in names]
    return [(name, size) for name, size in sizes if size is not None]


def _pivot(flexure: Flexure) -> str:
    if not isinstance(flexure, CrossSpring):
        return ""
    return (
        f"; {flexure.leaves} leaves that cross at {number(degrees(flexure.angle))}°, "
        f"{number(flexure.crossing)} of their length from the first part"
    )
