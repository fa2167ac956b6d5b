"""Compliance budget of a machine of the literature at its best, median and worst poses."""

from __future__ import annotations

import numpy as np
import xarray as xr

from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.figures.theme import PALETTE

#: The same part has the same colour in every machine.
PART_COLOURS = {
    "first link": PALETTE[0],
    "column": PALETTE[0],
    "link": PALETTE[1],
    "strut": PALETTE[1],
    "guide drive": PALETTE[2],
    "slide drive": PALETTE[3],
    "shoulder drive": PALETTE[3],
}


def by_kind(budget: xr.Dataset) -> tuple[list[str], dict[str, list[float]]]:
    """Bars and shares in percent, parts of the same name in the three legs added up."""
    share = budget["share"].to_numpy()
    parts = [str(p) for p in budget["part"].to_numpy()]
    kinds: dict[str, np.ndarray[tuple[int], np.dtype[np.float64]]] = {}
    for i, part in enumerate(parts):
        word, _, name = part.partition(" ")
        name = name.split("/", 1)[-1]
        if word != "beam":
            # a spring across a guide stands for its drive, whatever direction it acts in
            name = f"{name.split(':')[0]} drive"
        kinds[name] = kinds.get(name, 0.0) + 100.0 * share[..., i].reshape(-1)
    categories = [
        f"{force}, {rank}"
        for force in budget["force"].to_numpy()
        for rank in budget["rank"].to_numpy()
    ]
    return categories, {kind: values.tolist() for kind, values in kinds.items()}


def budget_file(budget: xr.Dataset, name: str, label: str) -> DataFile:
    """Every part's share at every pose of the budget."""
    rows = []
    for f, force in enumerate(budget["force"].to_numpy()):
        for r, rank in enumerate(budget["rank"].to_numpy()):
            place = [float(v) for v in budget["position"].to_numpy()[f, r]]
            values = [
                float(budget[v].to_numpy()[f, r]) for v in ("roll", "stiffness", "deflection")
            ]
            rows += [
                [
                    force,
                    rank,
                    *place,
                    *values,
                    str(part),
                    float(budget["share"].to_numpy()[f, r, p]),
                ]
                for p, part in enumerate(budget["part"].to_numpy())
            ]
    columns = (
        "force",
        "rank",
        "x_m",
        "y_m",
        "z_m",
        "roll_rad",
        "stiffness_blocked_N_per_m",
        "deflection_m_per_N",
        "part",
        "share",
    )
    return csv_file(
        name, f"share of every part at the best, median and worst pose, {label}", columns, rows
    )
