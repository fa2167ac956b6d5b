"""What acts on a model: its load cases."""

from __future__ import annotations

from strutwork.machines.model import Model
from strutwork.msa import LoadCase
from strutwork.reports.alike import grouped
from strutwork.reports.content import Column
from strutwork.reports.inputs.echo import Echo, number, vector


def acting(model: Model) -> Echo:
    """Every load case in words."""
    columns = (Column("load case", "", False), Column("what acts", "", False, width="wide"))
    shown = {case.name: ["; ".join(_words(case))] for case in model.cases}
    exact: dict[str, list[float | None]] = {}
    for case in model.cases:
        for node, wrench in case.wrenches:
            exact[f"{case.name}: {node}"] = [*wrench]
        if case.gravity is not None:
            exact[f"{case.name}: gravity, m/s2"] = [*case.gravity, None, None, None]
        for line in case.line_loads:
            exact[f"{case.name}: {line.beam}, N/m at either end"] = [*line.first, *line.second]
        for (joint, direction), gap in case.gaps.items():
            exact[f"{case.name}: gap of {joint}:{direction}"] = [gap, *[None] * 5]
    heads = ("load", *(f"F{a}_N" for a in "xyz"), *(f"M{a}_N_m" for a in "xyz"))
    return Echo("loads", "Load cases", columns, shown, heads, exact)


def _words(case: LoadCase) -> list[str]:
    words = []
    if case.gravity is not None:
        words.append(f"weight under {vector(case.gravity)} m/s²")
    rows: dict[str, list[str]] = {}
    for node, wrench in case.wrenches:
        some = []
        if any(wrench[:3]):
            some.append(f"the force {vector(wrench[:3])} N")
        if any(wrench[3:]):
            some.append(f"the moment {vector(wrench[3:])} N·m")
        rows[node] = [" and ".join([*rows.get(node, ()), *some])]
    words += [f"at {g.label} {g.cells[0]}" for g in grouped(rows) if g.cells[0]]
    for line in case.line_loads:
        words.append(
            f"on {line.beam} a line load of {vector(line.first)}"
            + ("" if line.first == line.second else f" to {vector(line.second)}")
            + " N/m"
        )
    for (joint, direction), gap in case.gaps.items():
        turns = direction.startswith("r")
        size = f"{number(gap, 1e6)} {'µrad' if turns else 'µm'}"
        words.append(f"in {joint} a gap of {size} in {direction}")
    return words or ["nothing"]
