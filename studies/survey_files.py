"""A survey as CSV: one line per pose."""

from __future__ import annotations

from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from strutwork.csv_rows import RowWriter
from strutwork.files import write_whole
from strutwork.studies.dataset_units import unit_at
from strutwork.studies.filters import PoseStatus


def write_survey(path: Path, found: xr.Dataset) -> Path:
    """Write a survey, one row per pose, units in the header.

    Flags and reasons stand in words; numbers that are missing are empty.

    Parameters
    ----------
    path : Path
    found : xarray.Dataset
        Of `survey`.

    Raises
    ------
    OutputError
        The file cannot be written.
    """
    dims = [str(d) for d in found["status"].dims]
    grids = np.meshgrid(*(found[d].to_numpy() for d in dims), indexing="ij")
    columns: dict[str, list[Any]] = {
        f"{d}, {'rad' if d.startswith('r') else 'm'}": g.ravel().tolist()
        for d, g in zip(dims, grids, strict=True)
    }
    words = {int(s): s.word for s in PoseStatus}
    columns["status"] = [words[int(s)] for s in found["status"].to_numpy().ravel()]
    texts = [str(t) for t in found["reason_text"].to_numpy()]
    columns["reason"] = [texts[int(i)] for i in found["reason"].to_numpy().ravel()]
    for name, variable in found.data_vars.items():
        if name in ("status", "reason"):
            continue
        extra = [str(d) for d in variable.dims if d not in dims]
        labels = [[str(v) for v in found[d].to_numpy()] for d in extra]
        values = variable.to_numpy().reshape(len(columns["status"]), -1)
        for k, parts in enumerate(product(*labels)):
            head = " ".join([str(name), *parts])
            unit = unit_at(found, str(name), parts[-1] if parts else "")
            columns[f"{head}, {unit}"] = [
                "" if np.isnan(v) else repr(float(v)) for v in values[:, k]
            ]

    def write(part: Path) -> None:
        with part.open("w", encoding="utf-8", errors="backslashreplace", newline="") as file:
            writer = RowWriter(file)
            writer.writerow(list(columns))
            writer.writerows(zip(*columns.values(), strict=True))

    return write_whole(Path(path), write)
