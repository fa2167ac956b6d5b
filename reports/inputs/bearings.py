"""The bearings and guides of a catalogue that joints refer to."""

from __future__ import annotations

import numpy as np

from strutwork.kinematics import DIRECTIONS
from strutwork.machines.model import Model
from strutwork.names import listed
from strutwork.reports.content import Column
from strutwork.reports.inputs.echo import NONE, Echo
from strutwork.reports.inputs.joints import by_direction


def bearings(model: Model) -> Echo:
    """Stiffness at preload and source of each entry, and the joints that have it."""
    columns = (
        Column("bearing", "", False),
        Column("joints", "", False),
        Column("stiffness at preload", "N/µm and N·m/rad", False),
        Column("preload", "", False),
        Column("source", "", False),
    )
    shown, exact = {}, {}
    for entry in {e.name: e for e in model.bearings.values()}.values():
        owners = [joint for joint, other in model.bearings.items() if other is entry]
        stiffness = dict(zip(DIRECTIONS, np.diag(entry.stiffness).tolist(), strict=True))
        held = {d: k for d, k in stiffness.items() if d in entry.held}
        shown[entry.name] = [
            listed(owners),
            by_direction(held, 1e-6, 1.0),
            entry.preload or NONE,
            entry.source,
        ]
        exact[entry.name] = [
            entry.type,
            "; ".join(owners),
            *(held.get(d) for d in DIRECTIONS),
            entry.preload,
            entry.source,
        ]
    heads = (
        "bearing",
        "type",
        "joints",
        *(f"stiffness_{d}_{'N_m_per_rad' if d[0] == 'r' else 'N_per_m'}" for d in DIRECTIONS),
        "preload",
        "source",
    )
    return Echo("bearings", "Bearings and guides of a catalogue", columns, shown, heads, exact)
