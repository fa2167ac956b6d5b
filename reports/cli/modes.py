"""`strutwork modes`: natural frequencies, shapes and damping ratios."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from reports.cli.output import console, print_json, table
from reports.vibration import TargetModes, target_modes, vibration_target

_DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")


def run(
    name: str,
    count: int,
    out: str | None,
    *,
    modal_ratio: float | None,
    loss_factor: float | None,
    preload: str | None = None,
    json: bool,
) -> None:
    """Find the lowest modes and print them."""
    found = target_modes(vibration_target(name, modal_ratio, loss_factor, preload), count)
    written = [] if out is None else [str(path) for path in found.write(Path(out))]
    if found.modes.note:
        sys.stderr.write(f"Note: {found.modes.note}\n")
    if json:
        print_json(found.to_dict() | ({"data": written} if written else {}))
        return
    _print(found)
    for path in written:
        console().print(f"Written: {path}", markup=False, soft_wrap=True)


def _print(found: TargetModes) -> None:
    out, modes = console(), found.modes
    out.print(found.target.title, markup=False, style="bold")
    if found.target.damping is not None:
        out.print(f"Damping: {found.target.damping}", markup=False)
    rows = []
    for m, frequency in enumerate(modes.frequencies.tolist()):
        moved = modes.effective_mass[m] / np.where(modes.total_mass > 0, modes.total_mass, 1.0)
        shares = modes.energy_shares[m]
        bends = "rigid body" if frequency == 0 else modes.energy_parts[int(shares.argmax())]
        if frequency:
            bends += f" {100 * float(shares.max()):.0f} %"
        rows.append(
            (
                m + 1,
                float(frequency),
                "" if found.ratios is None else f"{100 * float(found.ratios[m]):.4g}",
                *(f"{100 * share:.1f}" for share in moved),
                bends,
            )
        )
    columns = ["mode", "Hz", "ζ, %", *(f"{d}, %" for d in _DIRECTIONS), "stores most energy"]
    out.print(table("Modes; share of the mass that moves along and about each axis", columns, rows))
