"""What every command over a grid prints and writes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import xarray as xr

from strutwork.names import visible
from strutwork.reports.cli.output import console
from strutwork.studies.dataset_files import write_netcdf
from strutwork.studies.survey_files import write_survey


def written(folder: str, target: str, what: str, found: xr.Dataset) -> list[str]:
    """Write a survey as NetCDF and CSV; the paths."""
    stem = f"{Path(target).stem.replace(':', '-')}-{what}-survey"
    paths = (
        write_netcdf(Path(folder) / f"{stem}.nc", found),
        write_survey(Path(folder) / f"{stem}.csv", found),
    )
    return [str(path) for path in paths]


def print_kept(result: dict[str, Any], grid: str) -> None:
    """The machine, its grid, and which poses do not count for which reason."""
    out = console()
    out.print(visible(result["model"] or result["target"]), markup=False, style="bold")
    out.print(f"{grid}; {result['poses_kept']} of {result['poses']} are valid", markup=False)
    for reason, count in result["dropped_by_reason"].items():
        out.print(f"  {count}: {visible(reason)}", markup=False, soft_wrap=True)
