"""`strutwork modes`: natural frequencies, shapes and damping ratios."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from strutwork.names import visible
from strutwork.reports.cli.output import console, print_json, table, tell
from strutwork.reports.cli.subject import HOME, Where
from strutwork.reports.vibration import TargetModes, target_modes, vibration_target

_DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")


def run(
    name: str,
    count: int,
    out: str | None,
    *,
    at: Where = HOME,
    modal_ratio: float | None,
    loss_factor: float | None,
    preload: str | None = None,
    json: bool,
) -> None:
    """Find the lowest modes and print them."""
    found = target_modes(vibration_target(name, modal_ratio, loss_factor, preload, at.put), count)
    written = [] if out is None else [str(path) for path in found.write(Path(out))]
    if found.modes.note:
        tell(f"Note: {found.modes.note}")
    if json:
        print_json(found.to_dict() | ({"data": written} if written else {}))
        return
    _print(found)
    for path in written:
        console().print(f"Written: {visible(path)}", markup=False, soft_wrap=True)


def _print(found: TargetModes) -> None:
    rigid, found = int(found.modes.rigid_body_modes), found.elastic
    out, modes = console(), found.modes
    out.print(found.target.title, markup=False, style="bold")
    if found.target.damping is not None:
        out.print(f"Damping: {found.target.damping}", markup=False)
    if rigid:
        out.print(found.rigid_line, markup=False, soft_wrap=True)
    rows = []
    for m, frequency in enumerate(modes.frequencies.tolist()):
        moved = modes.effective_mass[m] / np.where(modes.total_mass > 0, modes.total_mass, 1.0)
        shares = modes.energy_shares[m]
        # parts alike store the same but for rounding: the first of the file is named
        most = int(np.argmax(shares >= (1.0 - 1e-6) * shares.max()))
        bends = f"{modes.energy_parts[most]} {100 * float(shares[most]):.0f} %"
        rows.append(
            (
                m + 1,
                float(frequency),
                _ratio(found, m),
                *(f"{100 * share:.1f}" for share in moved),
                bends,
            )
        )
    columns = ["mode", "Hz", "ζ, %", *(f"{d}, %" for d in _DIRECTIONS), "stores most energy"]
    out.print(table("Modes; share of the mass that moves along and about each axis", columns, rows))


def _ratio(found: TargetModes, mode: int) -> str:
    if found.ratios is None:
        return ""
    ratio = float(found.ratios[mode])
    return f"{100 * ratio:.4g}" if np.isfinite(ratio) else "withheld"
