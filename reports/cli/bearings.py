"""`strutwork bearings`: the catalogue of bearings and guides, and those of a machine."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from strutwork.kinematics import DIRECTIONS
from strutwork.machines.bearing_catalogue import package_catalogue
from strutwork.machines.bearing_entry import BearingEntry
from strutwork.msa import axis_stiffness_free, tool_compliance
from strutwork.reports.cli.output import console, print_json, print_table

if TYPE_CHECKING:
    from rich.console import Console

    from strutwork.machines.model import Model
    from strutwork.reports.model_solution import ModelSolution

#: A displacement below this share of the largest is rounding.
ROUNDING = 1e-9


def run(model: Model | None, json: bool) -> None:
    """Print the entries that a machine's joints use, or those of the package."""
    used = {} if model is None else dict(model.bearings)
    entries = package_catalogue() if model is None else {e.name: e for e in used.values()}
    if json:
        result: dict[str, Any] = {name: _dict(entry) for name, entry in entries.items()}
        joints = {joint: entry.name for joint, entry in used.items()}
        print_json({"bearings": result} | ({} if model is None else {"joints": joints}))
        return
    out = console()
    if model is not None:
        out.print(model.title or "Model", markup=False, style="bold")
        if not used:
            out.print("No joint names a bearing.", markup=False)
            return
        print_table(out, "Bearings of joints", ["joint", "bearing"], _joints(used))
    rows = [(name, *_stiffness(entry), entry.preload or "") for name, entry in entries.items()]
    title = "Stiffness at preload, N/µm and kN·m/rad"
    print_table(out, title, ["bearing", *DIRECTIONS, "preload"], rows)
    for entry in entries.values():
        out.print(
            f"{entry.name} ({entry.type}, {entry.origin}): {entry.source}",
            markup=False,
            soft_wrap=True,
        )


def print_states(out: Console, found: ModelSolution, number: int) -> None:
    """Print the bearings of a load case: each in the direction of its displacement."""
    if not found.equilibria or not found.equilibria[number].states:
        return
    from strutwork.reports.cli.manner import MANNER
    from strutwork.reports.cli.solve import SHORT

    states = found.equilibria[number].states
    far = max(float(np.linalg.norm(s.displacement[:3])) for s in states)
    # less is rounding
    moved = [s for s in states if np.linalg.norm(s.displacement[:3]) > ROUNDING * far]
    moved.sort(key=lambda s: -float(np.linalg.norm(s.load[:3])))
    shown = moved if MANNER.whole else moved[:SHORT]
    rows = []
    for state in shown:
        way = state.displacement[:3] / np.linalg.norm(state.displacement[:3])
        along = [
            1e-6 * float(way @ k[:3, :3] @ way)
            for k in (state.entry.stiffness, state.secant, state.tangent)
        ]
        force = float(np.linalg.norm(state.load[:3]))
        rows.append((state.joint, state.entry.name, force, *along, f"{100 * state.loaded:.0f} %"))
    columns = ["joint", "bearing", "force, N", "at preload", "secant", "tangent", "loaded"]
    print_table(out, "Bearings along their displacement, N/µm", columns, rows)
    if len(shown) < len(moved):
        out.print(
            f"Only the most loaded are shown; --verbose lists {len(moved) - len(shown)} more.",
            markup=False,
        )
    if found.compliance is not None:
        free = 1e-6 * axis_stiffness_free(tool_compliance(found.equilibria[number].tangent))[:3]
        words = ", ".join(
            f"{k:.4g} N/µm in {d}" if np.isfinite(k) else f"infinite in {d}"
            for k, d in zip(free, "xyz", strict=True)
        )
        out.print(
            f"Under this load the stiffness at {found.model.tool}, others free, is {words}.",
            markup=False,
            soft_wrap=True,
        )
    if MANNER.verbose:
        steps = found.equilibria[number].steps
        out.print(f"The bearings settled after {steps} solutions.", markup=False)


def _joints(used: Mapping[str, BearingEntry]) -> list[tuple[str, str]]:
    return [(joint, entry.name) for joint, entry in used.items()]


def _stiffness(entry: BearingEntry) -> list[object]:
    diagonal = np.diag(entry.stiffness)
    scale = np.array([1e-6] * 3 + [1e-3] * 3)
    return [
        float(k * s) if d in entry.held else ""
        for d, k, s in zip(DIRECTIONS, diagonal, scale, strict=True)
    ]


def _dict(entry: BearingEntry) -> dict[str, Any]:
    return {
        "type": entry.type,
        "source": entry.source,
        "origin": entry.origin,
        "preload": entry.preload,
        "held": list(entry.held),
        "stiffness": entry.stiffness.tolist(),
    }
