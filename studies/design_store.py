"""The result of a design on disk: each generation is kept until the whole is written."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.csv_rows import RowWriter
from strutwork.errors import ModelError
from strutwork.files import write_text, write_whole
from strutwork.machines.model_edit import edited_text
from strutwork.names import visible
from strutwork.studies.chunks import Arrays, ChunkStore
from strutwork.studies.dataset_files import write_netcdf
from strutwork.studies.design import STATUS, Design, Judged
from strutwork.studies.design_dataset import MACHINE, Archive, judged_of
from strutwork.studies.design_search import generations
from strutwork.studies.parametric import Parametric
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
        complete is read.
    workers : int, optional
        Threads; default one per processor.
    progress : callable, optional
        Called with how many machines are judged, and of how many.
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
    before: xr.Dataset | None = None
    store: ChunkStore | None = None
    if path is not None:
        place = Path(path)
        before = _there(place, design)
        if before is not None and resume and _complete(before, design):
            return before
        store = ChunkStore(_parts(place), design.key)
        if not resume and store.path(0).exists():
            raise ModelError(
                str(store.path(0).parent),
                "holds finished generations of this design, which was interrupted.",
                "Give --resume (resume=True) to go on from them, or remove the folder.",
            )
    archive = Archive(design)

    def known(number: int, shares: Array) -> Judged | None:
        kept = judged_of(before, design, number) if resume and before is not None else None
        if kept is None and store is not None:
            arrays = store.read(number)
            kept = None if arrays is None else _from_arrays(arrays)
        return kept[1] if kept is not None and np.array_equal(kept[0], shares) else None

    total = design.search.population * design.search.generations
    feasible = 0
    if progress is not None:
        progress(0, total)
    for generation in generations(design, workers, known):
        archive.add(generation)
        feasible += int(np.count_nonzero(generation.judged.status == 0))
        if store is not None:
            store.write(generation.number, _arrays(generation.shares, generation.judged))
        if progress is not None:
            progress(archive.count, total)
        if told is not None:
            told(generation.number + 1, feasible, len(archive.front))
    found = archive.dataset()
    if not archive.front.size:
        raise ModelError(
            "design",
            f"none of its {archive.count} machines is feasible: {_most(found)}",
            "Change the ranges of its parameters or its constraints.",
        )
    if path is not None:
        _write(Path(path), found, design)
    return found


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
    try:
        with xr.open_dataset(place, engine="h5netcdf") as file:
            found = file.load()
    # libraries raise what they like for a damaged file
    except Exception as error:
        raise ModelError(
            str(path), f"cannot be read ({visible(str(error))}).", "Write it again."
        ) from error
    if "design_key" not in found.attrs:
        raise ModelError(str(path), "is no result of a design.", "Name one that a design wrote.")
    return found


def changes_of(found: xr.Dataset, number: int) -> dict[str, float]:
    """Numbers of a machine of the front by their paths, SI; factors are multiplied out.

    Parameters
    ----------
    found : xarray.Dataset
        Result of a design.
    number : int
        On the front, counted from one.

    Raises
    ------
    ModelError
        The front has no such machine, or the machine no longer states these numbers.
    """
    front = found["front"].to_numpy()
    if not 1 <= number <= len(front):
        raise ModelError(
            f"machine {number}", "is not on the front.", f"Name one from 1 to {len(front)}."
        )
    machine = _machine(found)
    changes: dict[str, float] = {}
    for name in (str(p) for p in found["parameter"].to_numpy()):
        column = found[name]
        value = float(column.to_numpy()[front[number - 1]])
        for path in json.loads(column.attrs["paths"]):
            stated = machine.matching(path)[0].value
            changes[path] = stated * value if column.attrs["relative"] else value
    return changes


def write_machine(found: xr.Dataset, number: int, path: str | Path) -> Path:
    """Write a machine of the front as a model file; the comments of the original stay.

    Parameters
    ----------
    found : xarray.Dataset
        Result of a design.
    number : int
        On the front, counted from one.
    path : str or Path
        Ends in .toml. Where the original names files, as of meshes, it belongs beside them.

    Returns
    -------
    Path

    Raises
    ------
    ModelError
        As `changes_of`; the machine is one of the catalogue; another ending.
    OutputError
        The file cannot be written.
    """
    changes = changes_of(found, number)
    text = str(found.attrs.get("model_file", ""))
    if not text:
        raise ModelError(
            f"machine {number}",
            "is a variant of a machine of the catalogue, which has no model file.",
            "Make it in Python: strutwork.studies.Parametric.of(NAME).model({...}).",
        )
    if Path(path).suffix != ".toml":
        raise ModelError(str(path), "names no model file.", "End it in .toml.")
    machine = _machine(found)
    places = {machine.paths[p].places: value for p, value in changes.items()}
    return write_text(Path(path), edited_text(text, places, f"machine {number} of a design"))


def _machine(found: xr.Dataset) -> Parametric:
    text = str(found.attrs.get("model_file", ""))
    if not text:
        return Parametric.of(json.loads(found.attrs["settings"])["machine"])
    return Parametric.of(text)


def _parts(path: Path) -> Path:
    return path.with_name(f"{path.name}.parts")


def _complete(found: xr.Dataset, design: Design) -> bool:
    """Whether it has as many generations as are asked for, or no more machines were left."""
    have, asked = int(found.attrs["generations"]), int(found.attrs["asked_generations"])
    return have >= design.search.generations or have < asked


def _there(path: Path, design: Design) -> xr.Dataset | None:
    if path.suffix != ENDING:
        raise ModelError(str(path), "names no kind of file.", "End it in .nc for NetCDF.")
    if not path.exists():
        return None
    remedy = "Name another file, or remove this one."
    try:
        found = read_design_result(path)
    except ModelError as error:
        raise ModelError(str(path), f"is there already and {error.problem}", remedy) from error
    if found.attrs["design_key"] != design.key:
        raise ModelError(
            str(path),
            f"holds the result of another design ({found.attrs.get('title', '')}), or of this one "
            "by other code or other versions of libraries.",
            remedy,
        )
    return found


def _most(found: xr.Dataset) -> str:
    texts = [str(t) for t in found["reason_text"].to_numpy()]
    counts = np.bincount(found["reason"].to_numpy(), minlength=len(texts))
    counts[0] = 0
    return f"{texts[int(np.argmax(counts))]} ({int(counts.max())} of them)."


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


def _write(path: Path, found: xr.Dataset, design: Design) -> None:
    write_netcdf(path, found)
    _write_csv(path.with_suffix(".csv"), found)
    store = ChunkStore(_parts(path), design.key)
    shutil.rmtree(store.path(0).parent, ignore_errors=True)
    if _parts(path).is_dir() and not any(_parts(path).iterdir()):
        _parts(path).rmdir()


def design_rows(found: xr.Dataset) -> tuple[list[str], list[list[Any]]]:
    """Heads and rows of all machines, those of the front first, in order.

    Parameters
    ----------
    found : xarray.Dataset
        Result of a design.
    """
    names = [str(p) for p in found["parameter"].to_numpy()]
    names += [n for n in found.data_vars if found[n].dims == (MACHINE,) and _is_quantity(n, found)]
    heads = [
        n if found[n].attrs["units"] == "1" else f"{n} [{found[n].attrs['units']}]" for n in names
    ]
    texts = [str(t) for t in found["reason_text"].to_numpy()]
    front = found["front"].to_numpy().tolist()
    others = sorted(set(range(found.sizes[MACHINE])) - set(front))
    columns = [found[n].to_numpy() for n in names]
    status, reason = found["status"].to_numpy(), found["reason"].to_numpy()
    born = found["generation"].to_numpy()
    rows = [
        [
            place + 1 if place < len(front) else "",
            *("" if np.isnan(c[i]) else repr(float(c[i])) for c in columns),
            STATUS[int(status[i])],
            texts[int(reason[i])],
            int(born[i]),
        ]
        for place, i in enumerate([*front, *others])
    ]
    return ["front", *heads, "status", "reason", "generation"], rows


def _is_quantity(name: Any, found: xr.Dataset) -> bool:
    return found[name].dtype.kind == "f" and "stated" in found[name].attrs


def _write_csv(path: Path, found: xr.Dataset) -> Path:
    heads, rows = design_rows(found)

    def write(part: Path) -> None:
        with part.open("w", encoding="utf-8", errors="backslashreplace", newline="") as file:
            writer = RowWriter(file)
            writer.writerow(heads)
            writer.writerows(rows)

    return write_whole(path, write)
