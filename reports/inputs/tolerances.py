"""Tolerance zones and force limits of a model."""

from __future__ import annotations

from strutwork.machines.model import Model
from strutwork.overconstraint.tolerance import TILTS, Tolerance
from strutwork.reports.content import Column
from strutwork.reports.inputs.echo import NONE, Echo, number, vector


def tolerances(model: Model) -> Echo:
    """Kind, zone, datum and length of every tolerance."""
    columns = (
        Column("tolerance", "", False),
        Column("kind", "", False),
        Column("zone", "", False),
        Column("over a length", "mm", False),
        Column("datum", "", False),
        Column("joints", "", False),
        Column("distribution", "", False),
        Column("cost"),
    )
    joints = {joint.name: joint for joint in model.structure.linkage.joints}
    shown, exact = {}, {}
    for t in model.tolerances:
        datum = t.datum or joints[t.joints[0]].between[0]
        cost = model.tolerance_costs.get(t.name)
        shown[t.name] = [
            "position of a point" if t.kind == "point_position" else t.kind,
            _zone(t),
            _over(t),
            datum,
            ", ".join(t.joints),
            t.distribution,
            number(cost),
        ]
        exact[t.name] = [
            t.kind,
            t.size,
            t.slope,
            *(t.limits or (None, None)),
            t.length,
            t.width,
            datum,
            "" if t.axis is None else vector(t.axis),
            "; ".join(t.joints),
            t.distribution,
            cost,
        ]
    heads = (
        "tolerance",
        "kind",
        "size_m",
        "slope_rad",
        "low_m",
        "high_m",
        "length_m",
        "width_m",
        "datum",
        "axis",
        "joints",
        "distribution",
        "cost",
    )
    caption = "Tolerance zones"
    return Echo("tolerances", caption, columns, shown, heads, exact, loose=(3, 4))


def force_limits(model: Model) -> Echo:
    """The greatest forces and moments that joints may bear."""
    columns = (
        Column("joint", "", False),
        Column("limits", "", False),
    )
    shown: dict[str, list[str]] = {}
    for (joint, kind), value in model.force_limits.items():
        unit = "N" if kind.endswith("force") else "N·m"
        words = f"{kind} {number(value)} {unit}"
        shown[joint] = [f"{shown[joint][0]}; {words}" if joint in shown else words]
    exact: dict[str, list[object]] = {
        f"{joint} {kind}": [joint, kind, value]
        for (joint, kind), value in model.force_limits.items()
    }
    heads = ("quantity", "joint", "kind", "limit_SI")
    return Echo("force-limits", "Limits of joint forces", columns, shown, heads, exact)


def _zone(t: Tolerance) -> str:
    if t.limits is not None:
        return f"{number(t.limits[0], 1e6)} to {number(t.limits[1], 1e6)} µm"
    if t.slope is not None:
        return f"{number(t.slope, 1e6)} µrad to either side"
    mark = "±" if t.kind == "length" else ""
    return f"{mark}{number(t.size, 1e6)} µm" + ("" if mark or t.kind in TILTS else " wide")


def _over(t: Tolerance) -> str:
    if t.length is None:
        return NONE
    across = "" if t.width is None else f" × {number(t.width, 1e3)}"
    return f"{number(t.length, 1e3)}{across}"
