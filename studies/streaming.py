"""Stiffness maps that are larger than the memory: written while they are computed."""

from __future__ import annotations

import json
import shutil
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from strutwork.machines import Machine
from strutwork.studies.check_points import CheckPoints
from strutwork.studies.chunks import Arrays, ChunkStore
from strutwork.studies.description import study_key
from strutwork.studies.evaluation import keep_said
from strutwork.studies.filters import Filters
from strutwork.studies.region_store import RegionStore
from strutwork.studies.run import Chunk, Run
from strutwork.studies.stiffness_map import map_function
from strutwork.studies.variables import named

#: Candidates of a chunk: files of some hundred kilobytes, and tens of megabytes a worker.
CHUNK = 8192


def stream_stiffness_map(
    machine: Machine,
    path: Path,
    points: CheckPoints | None = None,
    rolls: ArrayLike | None = None,
    filters: Filters | None = None,
    run: Run | None = None,
) -> xr.Dataset:
    """The stiffness map of `strutwork.studies.stiffness_map`, written to disk as it grows.

    Memory does not grow with the number of points, but for their places. An interrupted map goes
    on with the next call of the same arguments. Chunks that are finished before one in front of
    them wait in the folder PATH.part, which is removed at the end.

    Parameters
    ----------
    machine : Machine
    path : Path
        Folder of the Zarr store (version 3).
    points : CheckPoints, optional
    rolls : (r,), optional
        rad.
    filters : Filters, optional
        These as of `strutwork.studies.stiffness_map`.
    run : Run, optional
        Workers or executor, and progress; its folder is not used.

    Returns
    -------
    xarray.Dataset
        As of `strutwork.studies.stiffness_map`; its arrays stay on disk until they are asked for.

    Raises
    ------
    ModelError
        As of `strutwork.studies.stiffness_map`.
    OutputError
        The folder holds another study, or the disk is full; what is finished stays.
    """
    asked = map_function(machine, points, rolls, filters)
    points, turns = asked.points, asked.rolls
    size = max(1, CHUNK // len(turns))
    settings = {"filters": asked.evaluator.filters, "chunk": size}
    key = study_key(
        "streamed stiffness map", machine, settings, points.position, points.normal, turns
    )
    store = RegionStore(Path(path), key, "point", len(points), size)
    notes = store.finished()
    waiting = Path(f"{path}.part")
    ahead = ChunkStore(waiting, key)
    found = (run or Run()).in_folder(waiting)
    rest: xr.Dataset | None = None
    for chunk, part in found.chunks(
        asked, len(points), size, lambda: key, len(turns), first=len(notes)
    ):
        note = _note(part, len(turns))
        made = asked.dataset(part | _places(points, chunk), {}, {})
        along = {
            str(name): variable
            for name, variable in made.variables.items()
            if variable.dims[:1] == ("point",)
        }
        number = np.arange(chunk.start, chunk.stop)
        along["point"] = named("point", number, "1", "number of the point")
        store.write(chunk.number, along, note)
        notes.append(note)
        ahead.path(chunk.number).unlink(missing_ok=True)
        rest = made.drop_dims("point") if rest is None else rest
    if rest is not None:
        store.complete(rest.assign_attrs(_details(notes, len(points) * len(turns))))
    shutil.rmtree(waiting, ignore_errors=True)
    return store.opened()


def _places(points: CheckPoints, chunk: Chunk) -> Arrays:
    return {"position": points.position[chunk.items], "normal": points.normal[chunk.items]}


def _note(part: Arrays, rolls: int) -> dict[str, Any]:
    """What the attributes of the map count, of one chunk; taken out of its arrays."""
    examples: dict[str, str] = {}
    keep_said(examples, part)
    counts = part.pop("reason_counts").tolist()
    words = dict(zip(part.pop("reasons").tolist(), counts, strict=True))
    return {
        "words": {w: n for w, n in words.items() if n},
        "examples": examples,
        "candidates": int(len(part["status"]) * rolls - part["dropped"].sum()),
        "points": int(np.count_nonzero(part["status"] == 0)),
    }


def _details(notes: list[dict[str, Any]], candidates: int) -> Mapping[str, Any]:
    words: Counter[str] = Counter()
    examples: dict[str, str] = {}
    for note in notes:
        words.update(note["words"])
        examples = note["examples"] | examples
    return {
        "candidates": candidates,
        "candidates_kept": sum(note["candidates"] for note in notes),
        "points_kept": sum(note["points"] for note in notes),
        "dropped_by_reason": json.dumps(words),
        "first_of_reason": json.dumps(examples),
    }
