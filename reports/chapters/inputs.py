"""What was given and assumed: the model as it was read, part by part."""

from __future__ import annotations

import hashlib
from pathlib import Path

from strutwork.machines.model import Model
from strutwork.names import visible
from strutwork.reports.content import Block, Chapter, Points, Text
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.inputs import (
    Echo,
    acting,
    assumed,
    beams,
    bearings,
    drives,
    flexures,
    force_limits,
    joints,
    masses,
    materials,
    sections,
    solids,
    springs,
    tolerances,
)
from strutwork.reports.numbers import count
from strutwork.reports.subject import Subject
from strutwork.reports.survey_words import grid_text

KEY = "inputs"
TITLE = "What was given and assumed?"

_KINDS = (
    materials,
    sections,
    beams,
    solids,
    joints,
    flexures,
    bearings,
    springs,
    masses,
    drives,
    tolerances,
    force_limits,
    acting,
)


def missing(_: Subject) -> str:
    """Every model has inputs."""
    return ""


def write(subject: Subject) -> Chapter:
    """Tables of every input, then what was assumed where the model says nothing."""
    model = subject.model
    found = [echo for echo in (kind(model) for kind in _KINDS) if echo.shown]
    nodes = _nodes(model)
    files = (*(echo.file for echo in found), nodes)
    blocks: list[Block] = [
        Text(
            "This is the model as it was read; every chapter is computed from it. Rows whose "
            "names differ only in their numbers are shown as one; the files list each separately."
        ),
        *(echo.table for echo in found),
        Text(f"{_other(model)} The positions of all nodes are in {nodes.name}."),
        Text("The model does not state the following, which was assumed:"),
        Points(assumed(model)),
        Text(_identity(subject, found)),
    ]
    answer = ", ".join(count(len(echo.shown), *_noun(echo)) for echo in found if _noun(echo))
    return Chapter(KEY, TITLE, tuple(blocks), files, f"{answer}." if answer else "")


_NOUNS = {
    "materials": ("material",),
    "sections": ("section",),
    "beams": ("beam",),
    "solids": ("solid",),
    "joints": ("joint and support", "joints and supports"),
    "masses": ("mass", "masses"),
    "tolerances": ("tolerance",),
}


def _noun(echo: Echo) -> tuple[str, ...]:
    return _NOUNS.get(echo.key, ())


def _other(model: Model) -> str:
    words = []
    if model.tool is not None:
        words.append(f"The tool centre point is the node {model.tool}.")
        against = model.structure.linkage.against
        if against is not None:
            words.append(
                f"The workpiece is held at the node {against}: stiffness, responses and errors of "
                "the tool are relative to it."
            )
    if model.task:
        words.append(f"The task directions of the tool are {', '.join(model.task)}.")
    if model.workspace is not None:
        words.append(f"The workspace has {grid_text(model.workspace)}.")
    for coupling in model.structure.linkage.couplings:
        first, second = (":".join(c) for c in (coupling.first, coupling.second))
        words.append(
            f"{second} follows {first} by the ratio {coupling.ratio:.6g} (coupling "
            f"{coupling.name}; m and rad)."
        )
    return " ".join(words)


def _nodes(model: Model) -> DataFile:
    places = model.placement.positions
    names = model.structure.linkage.nodes
    own = set(model.nodes)
    rows = [
        [name, *(float(v) for v in place), "given" if name in own else "created for a part"]
        for name, place in zip(names, places, strict=True)
    ]
    return csv_file(
        "inputs-nodes.csv",
        "positions of all nodes at home, m",
        ("node", "x", "y", "z", "origin"),
        rows,
    )


def _identity(subject: Subject, found: list[Echo]) -> str:
    digest = hashlib.sha256()
    for echo in found:
        digest.update(repr((echo.key, list(echo.exact.items()))).encode())
    digest.update(subject.model.placement.positions.tobytes())
    said = f"These inputs have the SHA-256 hash {digest.hexdigest()[:16]}"
    if subject.file is not None:
        name = visible(subject.file.name)
        return f"{said}…; the file {name} has {file_hash(subject.file)[:16]}…."
    return f"{said}…."


def file_hash(path: Path) -> str:
    """SHA-256 of a file, in hexadecimal digits."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
