"""The result of a study on disk: written whole, gone on with, never put over another's."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

from strutwork.errors import ModelError, OutputError
from strutwork.files import write_error
from strutwork.staging import staging
from strutwork.studies.chunks import ChunkStore
from strutwork.studies.dataset_files import read_result_file, write_netcdf
from strutwork.studies.executor import Executor
from strutwork.studies.executor import place as kept_elsewhere
from strutwork.studies.finished_parts import (
    OTHER_FILE,
    beside,
    remove,
    require_resumed,
    result_there,
    write_rows,
)
from strutwork.studies.progress import Progress
from strutwork.studies.study import Study
from strutwork.studies.study_table import study_columns

ENDINGS = (".nc", ".zarr")


def run_to_file(
    study: Study,
    path: str | Path,
    *,
    resume: bool = False,
    workers: int | None = None,
    progress: Progress | None = None,
    executor: Executor | None = None,
) -> xr.Dataset:
    """Run a study into a file; what was finished before an interruption is kept beside it.

    Parameters
    ----------
    study : Study
    path : str or Path
        Ends in .nc for NetCDF or .zarr for Zarr; a CSV of the machines is written beside it.
    resume : bool
        Go on from what was finished; a result that is complete is read. A folder of
        `strutwork.studies.executor.computed_on` keeps the parts instead, and they stay there.
    workers, progress, executor
        As `Study.run`.

    Returns
    -------
    xarray.Dataset

    Raises
    ------
    ModelError
        Another ending; the file holds something else, the result of another study or of other code;
        finished parts are there and `resume` is not given; as `Study.run`.
    OutputError
        The file cannot be written: finished parts stay.
    """
    place = Path(path)
    if place.suffix not in ENDINGS:
        raise ModelError(
            str(path), "names no kind of file.", "End it in .nc for NetCDF or .zarr for Zarr."
        )
    there = _there(place, study)
    if there is not None and resume:
        return there
    if kept_elsewhere().folder is not None:
        # parts that are kept on purpose stay, and are gone on from without being asked
        found = study.run(workers=workers, progress=progress, executor=executor)
        write_result(place, found)
        _write_csv(place.with_suffix(".csv"), found)
        return found
    parts = parts_of(study, place)
    require_resumed(parts, "finished parts of this study", resume=resume)
    found = study.run(workers=workers, progress=progress, folder=parts, executor=executor)
    write_result(place, found)
    _write_csv(place.with_suffix(".csv"), found)
    remove(parts)
    return found


def parts_of(study: Study, path: Path) -> Path:
    """Folder of what is finished of a study, until its result is written.

    Parameters
    ----------
    study : Study
    path : Path
        Of its result.
    """
    return ChunkStore(beside(path), study.key).path(0).parent


def write_result(path: Path, dataset: xr.Dataset) -> Path:
    """Write a study as NetCDF or Zarr, by the ending; whole or not at all.

    Parameters
    ----------
    path : Path
        Ends in .nc or .zarr.
    dataset : xarray.Dataset

    Raises
    ------
    OutputError
        It cannot be written.
    ModelError
        Zarr is not installed.
    """
    if path.suffix == ".nc":
        return write_netcdf(path, dataset)
    _require_zarr(path)
    target = path.resolve()
    try:
        if target.exists() and not target.is_dir():
            raise OutputError(str(path), "cannot be written (it is a file).", "Name a folder.")
        target.parent.mkdir(parents=True, exist_ok=True)
        with staging(target.parent) as folder:
            made = folder / target.name
            # the older format, which every reader knows
            dataset.to_zarr(made, mode="w", zarr_format=2, consolidated=True)
            if target.exists():
                target.replace(folder / "before")
            made.replace(target)
    except OSError as error:
        raise write_error(path, error) from error
    return path


def read_result(path: str | Path) -> xr.Dataset:
    """Read the result of a study, all of it.

    Parameters
    ----------
    path : str or Path
        Ends in .nc or .zarr.

    Raises
    ------
    ModelError
        It is missing, or no result of a study.
    """
    place = Path(path)
    if not place.exists():
        raise ModelError(str(path), "does not exist.", "Check the path.")
    if place.suffix == ".zarr":
        _require_zarr(place)
    engine = "zarr" if place.suffix == ".zarr" else "h5netcdf"
    return read_result_file(place, engine, "study_key", "study")


def _there(path: Path, study: Study) -> xr.Dataset | None:
    """The result of this study that is there; None where there is no file."""
    found = result_there(path, read_result)
    if found is None:
        return None
    if found.attrs["study_key"] == study.key:
        return found
    if found.attrs.get("inputs_sha256") == study.inputs:
        raise ModelError(
            str(path),
            f"holds the result of this study by other code ({found.attrs.get('source', 'unknown')})"
            " or other versions of libraries.",
            OTHER_FILE,
        )
    raise ModelError(
        str(path),
        f"holds the result of another study ({found.attrs.get('title', '')}).",
        OTHER_FILE,
    )


def _write_csv(path: Path, dataset: xr.Dataset) -> Path:
    """One row a machine."""
    columns = study_columns(dataset)
    heads = [c.head for c in columns]
    return write_rows(path, heads, zip(*(c.cells for c in columns), strict=True))


def _require_zarr(path: Path) -> None:
    try:
        import zarr  # noqa: F401, PLC0415
    except ImportError:
        raise ModelError(
            str(path),
            "is a Zarr folder, and the library zarr is not installed.",
            'Install it: pip install "strutwork[cluster]"; or end the name in .nc.',
        ) from None
