"""Solids and point masses of a model."""

from __future__ import annotations

import numpy as np

from strutwork.machines.model import Model
from strutwork.reports.content import Column
from strutwork.reports.inputs.echo import NONE, Echo, number, vector


def solids(model: Model) -> Echo:
    """Every meshed solid, with the frequency up to which its reduced model holds."""
    columns = (
        Column("solid", "", False),
        Column("material", "", False),
        Column("cells"),
        Column("size of its mesh", "mm"),
        Column("order"),
        Column("mass", "kg"),
        Column("interfaces", "", False),
        Column("valid to", "Hz"),
    )
    shown, exact = {}, {}
    for s in model.solids:
        shown[s.name] = [
            ", ".join(s.materials),
            str(s.cells) if s.cells else NONE,
            number(s.mesh_size, 1e3, 3),
            str(s.order) if s.order else NONE,
            number(s.weighed[0]),
            ", ".join(s.tied),
            number(s.accurate_to, digits=3),
        ]
        exact[s.name] = [
            "; ".join(s.materials),
            s.cells or None,
            s.mesh_size,
            s.order or None,
            s.weighed[0],
            "; ".join(s.tied),
            s.accurate_to,
            s.cutoff,
        ]
    known = {s.name for s in model.solids}
    for element in model.structure.elements:
        if element.name in known:
            continue
        # a solid that a machine in Python made: its mesh is not kept
        frequencies = np.asarray(getattr(element, "fixed_frequencies", ()))
        cutoff = float(frequencies[-1]) if len(frequencies) else None
        valid = None if cutoff is None else cutoff / 2.0
        tied = element.nodes if len(element.nodes) <= 6 else (f"{len(element.nodes)} nodes",)
        shown[element.name] = [
            NONE,
            NONE,
            NONE,
            NONE,
            NONE,
            ", ".join(tied),
            number(valid, digits=3),
        ]
        exact[element.name] = [None] * 5 + ["; ".join(element.nodes), valid, cutoff]
    heads = (
        "solid",
        "materials",
        "cells",
        "mesh_size_m",
        "order",
        "mass_kg",
        "nodes",
        "valid_to_Hz",
        "cutoff_Hz",
    )
    return Echo("solids", "Solids and other elements", columns, shown, heads, exact)


def masses(model: Model) -> Echo:
    """Every mass that a node carries; bodies with a mass are among them."""
    owner = model.structure.linkage.body_of_node
    index, names = model.structure.linkage.node_index, model.structure.linkage.body_names
    columns = (
        Column("mass at", "", False),
        Column("of the body", "", False),
        Column("mass", "kg"),
        Column("principal moments of inertia", "kg·m²", False),
        Column("centre from its node", "mm", False),
    )
    shown, exact = {}, {}
    for number_, mass in enumerate(model.structure.masses):
        body = int(owner[index[mass.node]])
        inertia = np.asarray(mass.inertia, dtype=float)
        key = mass.node if mass.node not in shown else f"{mass.node} ({number_ + 1})"
        shown[key] = [
            "ground" if body < 0 else names[body],
            number(mass.mass),
            vector(np.linalg.eigvalsh(inertia).tolist()) if inertia.any() else NONE,
            vector(mass.offset, 1e3) if any(mass.offset) else NONE,
        ]
        exact[key] = [
            "ground" if body < 0 else names[body],
            mass.mass,
            *mass.offset,
            *inertia[np.triu_indices(3)].tolist(),
        ]
    heads = (
        "node",
        "body",
        "mass_kg",
        *(f"centre_{a}_m" for a in "xyz"),
        *(f"I{a}_kg_m2" for a in ("xx", "xy", "xz", "yy", "yz", "zz")),
    )
    return Echo("masses", "Masses at nodes", columns, shown, heads, exact, loose=(0, 3))
