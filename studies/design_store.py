"""The result of a design on disk: each generation is kept until the whole is written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.studies.chunks import Arrays, ChunkStore
from strutwork.studies.dataset_files import read_result_file, write_netcdf
from strutwork.studies.design import Design
from strutwork.studies.design_dataset import Archive, judged_of
from strutwork.studies.design_judged import CANNOT_BE, Judged
from strutwork.studies.design_search import generations
from strutwork.studies.design_table import design_rows, reasons_of
from strutwork.studies.design_terms import GRADIENT
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

Array = NDArray[Any]

ENDING = ".nc"


def run_design(
    design: Design,
    path: str | Path | None = None,
    *,
    resume: bool = False,
    workers: int | None = None,
    progress: Progress | None = None,
    told: Callable[[int, int, int], None] | None = None,
) -> xr.Dataset:
    """Search for designs.

    Parameters
    ----------
    design : Design
    path : str or Path, optional
        Where the result is written, ending in .nc, with a CSV of the front beside it; finished
        generations are kept beside it until then.
    resume : bool
        Go on from finished generations, or from a result with fewer generations; a result that is
        complete is read. A folder of `strutwork.studies.executor.computed_on` keeps the generations
        instead, and they stay there.
    workers : int, optional
        Threads; default one per processor.
    progress : callable, optional
        Called with how many machines are judged, or starts done, and of how many.
    told : callable, optional
        Called after each generation with its number from one, the feasible machines so far and
        those of the front.

    Returns
    -------
    xarray.Dataset
        Every machine along `machine`, with its parameters, quantities, status and reason; `front`
        are the numbers of those that no other one beats.

    Raises
    ------
    ModelError
        Another ending; the file holds something else; finished generations are there and `resume`
        is not given; no machine is feasible (with the reason of most); pymoo is not installed.
    OutputError
        The file cannot be written: finished generations stay.
    """
    before = None if path is None else _there(Path(path), design)
    if before is not None and resume and _complete(before, design):
        return before
    store = _store(design, path, resume=resume)
    archive = Archive(design)

    def known(number: int) -> tuple[Array, Judged] | None:
        found = judged_of(before, design, number) if resume and before is not None else None
        if found is None and store is not None:
            arrays = store.read(number)
            found = None if arrays is None else _from_arrays(arrays)
        return found

    total = design.search.machines
    starts = design.search.method == GRADIENT
    feasible = 0
    if progress is not None:
        progress(0, total)
    for generation in generations(design, workers, known):
        archive.add(generation)
        feasible += int(np.count_nonzero(generation.judged.status == 0))
        if store is not None:
            store.write(generation.number, _arrays(generation.shares, generation.judged))
        if progress is not None:
            # along gradients nobody knows how many machines there will be
            progress(min(generation.number + 1 if starts else archive.count, total), total)
        if told is not None:
            told(generation.number + 1, feasible, len(archive.front))
    found = archive.dataset()
    if not archive.front.size:
        raise ModelError(
            "design",
            f"none of its {archive.count} machines is feasible: {_most(found)}.",
            "Change the ranges of its parameters, its poses or its constraints.",
        )
    if path is not None:
        write_netcdf(Path(path), found)
        write_rows(Path(path).with_suffix(".csv"), *design_rows(found))
        if kept_elsewhere().folder is None:
            remove(parts_of(design, Path(path)))
    return found


def _store(design: Design, path: str | Path | None, *, resume: bool) -> ChunkStore | None:
    """Where finished generations are kept; None: nowhere."""
    kept = kept_elsewhere().folder
    if kept is not None:
        # generations that are kept on purpose stay, and are gone on from without being asked
        return ChunkStore(kept, design.key)
    if path is None:
        return None
    parts = parts_of(design, Path(path))
    require_resumed(parts, "finished generations of this design", resume=resume)
    return ChunkStore(parts.parent, design.key)


def read_design_result(path: str | Path) -> xr.Dataset:
    """Read the result of a design.

    Parameters
    ----------
    path : str or Path
        Ends in .nc.

    Raises
    ------
    ModelError
        It is missing, or no result of a design.
    """
    place = Path(path)
    if not place.exists():
        raise ModelError(str(path), "does not exist.", "Check the path.")
    return read_result_file(place, "h5netcdf", "design_key", "design")


def parts_of(design: Design, path: Path) -> Path:
    """Folder of the finished generations of a design, until its result is written.

    Parameters
    ----------
    design : Design
    path : Path
        Of its result.
    """
    return ChunkStore(beside(path), design.key).path(0).parent


def _complete(found: xr.Dataset, design: Design) -> bool:
    """Whether it has as many generations as are asked for, or no more machines were left."""
    have, asked = int(found.attrs["generations"]), int(found.attrs["asked_generations"])
    return have >= design.search.rounds or have < asked


def _there(path: Path, design: Design) -> xr.Dataset | None:
    if path.suffix != ENDING:
        raise ModelError(str(path), "names no kind of file.", "End it in .nc for NetCDF.")
    found = result_there(path, read_design_result)
    if found is None:
        return None
    if found.attrs["design_key"] != design.key:
        raise ModelError(
            str(path),
            f"holds the result of another design ({found.attrs.get('title', '')}), or of this one "
            "by other code or other versions of libraries.",
            OTHER_FILE,
        )
    return found


def _most(found: xr.Dataset) -> str:
    """Why most machines are not feasible; reasons with numbers in them are of one machine each."""
    text, count = next(iter(reasons_of(found).items()))
    text = text.rstrip(".")
    lost = int(np.count_nonzero(found["status"].to_numpy() == CANNOT_BE))
    if lost > count or (lost == count and count == found.sizes["machine"]):
        one = next(
            str(found["reason_text"].to_numpy()[int(r)])
            for s, r in zip(found["status"].to_numpy(), found["reason"].to_numpy(), strict=True)
            if s == CANNOT_BE
        )
        return f"{lost} of them cannot be built, the first because of {one.rstrip('.')}"
    return f"{text} ({count} of them)"


def _arrays(shares: Array, judged: Judged) -> Arrays:
    return {
        "shares": shares,
        "values": judged.values,
        "status": judged.status,
        "reached": judged.reached,
        "reasons": np.array(judged.reasons, dtype=str),
    }


def _from_arrays(arrays: Arrays) -> tuple[Array, Judged]:
    reasons = tuple(str(r) for r in arrays["reasons"])
    judged = Judged(arrays["values"], arrays["status"], arrays["reached"], reasons)
    return arrays["shares"], judged
