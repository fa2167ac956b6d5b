"""What a dataset over poses offers by `dataset.strutwork`: a table, units apart, a plot."""

from __future__ import annotations

from typing import TYPE_CHECKING

import xarray as xr

from strutwork.studies.dataset_units import split_units
from strutwork.studies.pose_table import pose_table

if TYPE_CHECKING:
    import pandas as pd
    import plotly.graph_objects as go


@xr.register_dataset_accessor("strutwork")  # type: ignore[no-untyped-call, untyped-decorator]
class Surveyed:
    """The result of `survey`, of a machine or of `strutwork.studies`.

    Parameters
    ----------
    dataset : xarray.Dataset
        Over poses: with a variable `status`.
    """

    def __init__(self, dataset: xr.Dataset) -> None:
        self._dataset = dataset

    def to_dataframe(self) -> pd.DataFrame:
        """One row per pose, one column per number: `strutwork.studies.pose_table.pose_table`."""
        return pose_table(self._dataset)

    def split_units(self) -> xr.Dataset:
        """Every variable with one unit: `strutwork.studies.dataset_units.split_units`."""
        return split_units(self._dataset)

    def plot(self, name: str | None = None, label: str | None = None) -> go.Figure:
        """A curve over one direction of the poses, a map over two; the worst pose is marked.

        Parameters
        ----------
        name : str, optional
            Of a variable; the first of numbers by default.
        label : str, optional
            Of its further dimension, as "z" of a stiffness; the first by default.

        Raises
        ------
        ModelError
            No such variable or label, or poses along more than two directions.
        """
        from strutwork.reports.notebook import survey_figure

        return survey_figure(self._dataset, name, label)
