"""A dataset over poses as a table of one row per pose."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from strutwork.errors import ModelError

if TYPE_CHECKING:
    import pandas as pd


def pose_table(dataset: xr.Dataset) -> pd.DataFrame:
    """One row per pose, one column per number.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of `survey` and its like: the dimensions of its variable `status` are the poses.

    Returns
    -------
    pandas.DataFrame
        The grid's directions are the index, and the coordinates that follow are columns; of a plain
        list of poses all coordinates are the index, beside the number. A variable with further
        dimensions has a column per label, as `stiffness_free_x`; reasons stand in words.

    Raises
    ------
    ModelError
        It has no variable `status`.
    """
    # read when asked for: a quarter of a second
    import pandas as pd  # noqa: PLC0415

    if "status" not in dataset:
        raise ModelError(
            "dataset", 'has no variable "status".', "Give the result of a survey over poses."
        )
    poses = dataset["status"].dims
    beside = [n for n, c in dataset.coords.items() if n not in poses and c.dims == poses]
    gridded = all(d in dataset.coords for d in poses)
    columns: dict[str, Any] = (
        {str(n): dataset[n].to_numpy().ravel() for n in beside} if gridded else {}
    )
    for name, variable in dataset.data_vars.items():
        if not set(poses) <= set(variable.dims):
            continue
        if name == "reason" and "reason_text" in dataset:
            columns["reason"] = dataset["reason_text"].to_numpy()[variable.to_numpy()].ravel()
            continue
        rest = [d for d in variable.dims if d not in poses]
        values = variable.transpose(*poses, *rest).to_numpy()
        values = values.reshape(dataset["status"].size, -1)
        labels = product(*(_labels(dataset, str(d)) for d in rest))
        for column, label in zip(values.T, labels, strict=True):
            columns["_".join([str(name), *label])] = column
    axes = [dataset[d].to_numpy() for d in poses]
    grids = [g.ravel() for g in np.meshgrid(*axes, indexing="ij")]
    names = [str(d) for d in poses]
    if not gridded:
        grids += [dataset[n].to_numpy().ravel() for n in beside]
        names += [str(n) for n in beside]
    return pd.DataFrame(columns, index=pd.MultiIndex.from_arrays(grids, names=names))


def _labels(dataset: xr.Dataset, dim: str) -> list[str]:
    if dim in dataset.coords:
        return [str(v) for v in dataset[dim].to_numpy()]
    return [str(k) for k in range(dataset.sizes[dim])]
