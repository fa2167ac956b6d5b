"""Datasets as the bytes of a NetCDF file."""

from __future__ import annotations

import io

import h5netcdf
import xarray as xr
from xarray.backends import H5NetCDFStore

from strutwork.studies.dataset_units import without_unit_coordinates


def netcdf_bytes(dataset: xr.Dataset) -> bytes:
    """A dataset as NetCDF-4, made in memory.

    The HDF5 library ends in a segmentation fault when the disk it writes to becomes full: it never
    writes to one.

    Parameters
    ----------
    dataset : xarray.Dataset
    """
    buffer = io.BytesIO()
    with h5netcdf.File(buffer, "w") as file:
        without_unit_coordinates(dataset).dump_to_store(H5NetCDFStore(file))
    return buffer.getvalue()
