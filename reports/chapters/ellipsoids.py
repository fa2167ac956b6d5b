"""Which way the tool yields most: ellipsoids of its compliance at home and where it is worst."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.machines.model_poses import at_pose
from strutwork.msa.tool import tool_compliance
from strutwork.reports.content import Block, Chapter, Column, Figure, Row, Table, Text
from strutwork.reports.data_files import csv_file
from strutwork.reports.figures.ellipsoid import AXES, compliance_ellipsoid
from strutwork.reports.numbers import fixed, significant
from strutwork.reports.subject import Subject
from strutwork.reports.survey_words import least

Array = NDArray[Any]

KEY = "ellipsoids"
TITLE = "In which direction is it most compliant?"
FILE = "ellipsoids.csv"

#: A principal axis below this share of the largest is rounding of a tool that cannot move so.
NOTHING = 1e-12

#: Semi-axes that differ by less than this share of the largest are equal, as a symmetric machine's.
EQUAL = 1e-6


@dataclass(frozen=True)
class Half:
    """One of the two blocks on the diagonal of a compliance.

    Parameters
    ----------
    name : str
        Of the tool's motion.
    under : str
        Unit load.
    rows : slice
        Of the (6, 6).
    unit, si : str
        As drawn, and in the file.
    factor : float
        From SI to the first.
    colour : str
    """

    name: str
    under: str
    rows: slice
    unit: str
    si: str
    factor: float
    colour: str


HALVES = (
    Half("displacement", "force", slice(0, 3), "µm/N", "m/N", 1e6, "#4c7fb0"),
    Half("rotation", "moment", slice(3, 6), "µrad/(N·m)", "rad/(N m)", 1e6, "#c07a3a"),
)


def missing(subject: Subject) -> str:
    """Why there is nothing to say; empty where there is."""
    if subject.model.tool is None:
        return "it has no tool: add [tool] with tcp"
    solution = subject.solution
    return "the tool moves freely" if solution is None or solution.compliance is None else ""


def write(subject: Subject) -> Chapter:
    """Ellipsoids of displacement and rotation, drawn and by their axes."""
    places = _places(subject)
    figures, rows, lines = [], [], []
    for n, (place, compliance) in enumerate(places.items()):
        for half in HALVES:
            block = compliance[half.rows, half.rows]
            sizes, axes = np.linalg.eigh(0.5 * (block + block.T))
            sizes = np.where(sizes > NOTHING * max(float(sizes[-1]), 0.0), sizes, 0.0)
            # the first part that is not rounding points the positive way
            axes = axes * np.where(np.take_along_axis(axes, _leading(axes), 0) < 0, -1.0, 1.0)
            words = _directions(sizes[::-1], axes.T[::-1])
            for name, size, axis, where in zip(AXES, sizes[::-1], axes.T[::-1], words, strict=True):
                shown = significant(half.factor * float(size), 4)
                rows.append([place, f"{half.name}, {name}", half.unit, shown, where])
                lines.append([place, half.name, name, half.si, float(size), *axis.tolist()])
            if sizes[-1] > 0:
                figures.append(_figure(f"ellipsoid-{half.name}-{n}", place, half, block))
    columns = (
        *(Column(title, "", False) for title in ("pose", "semi-axis", "unit")),
        Column("length"),
        Column("direction x, y, z"),
    )
    blocks: list[Block] = [
        Text(
            f"A unit force in any direction moves the tool{subject.model.relative} to the surface "
            "of the first ellipsoid, and a unit moment rotates it to that of the second; the other "
            "directions are free "
            "to follow and the drives are held. A short axis is a stiff direction. "
            + (
                "The second pose is the one of the workspace's grid at which the stiffness along "
                "x, y or z is least."
                if len(places) > 1
                else f"Shown at home only: {subject.unmoved or 'no other pose is softer'}."
            )
        ),
        Row(tuple(figures), 380),
        Table("Semi-axes", columns, rows, FILE),
    ]
    file = csv_file(
        FILE,
        "semi-axes of the compliance ellipsoids, SI, with their directions",
        ("pose", "motion", "axis", "unit", "length", "x", "y", "z"),
        lines,
    )
    return Chapter(KEY, TITLE, tuple(blocks), (file,))


def _figure(key: str, place: str, half: Half, block: Array) -> Figure:
    return Figure(
        key,
        f"{half.name.capitalize()} under a unit {half.under}, {place}.",
        compliance_ellipsoid(
            block, half.colour, half.unit, half.factor, f"{half.name} under a unit {half.under}"
        ),
        f"Ellipsoid of the tool's {half.name} under a unit {half.under}, {place}, with its "
        "principal axes.",
        FILE,
    )


def _leading(axes: Array) -> NDArray[np.intp]:
    """Row of each column's largest entry, of several nearly as large the first, (1, 3)."""
    size = np.abs(axes)
    return np.asarray(np.argmax(size > 0.5 * size.max(axis=0), axis=0)[None])


def _directions(sizes: Array, axes: Array) -> list[str]:
    """Directions of semi-axes in words; of equal ones any mixture is an axis as well."""
    near = np.abs(sizes[:, None] - sizes) <= EQUAL * sizes[0]
    count = near.sum(axis=1)
    return [
        "none"
        if size <= 0
        else "any"
        if equal == 3
        else "any normal to the other"
        if equal == 2
        else ", ".join(fixed(float(v) + 0.0, 3) for v in np.round(axis, 3))
        for size, equal, axis in zip(sizes, count, axes, strict=True)
    ]


def _places(subject: Subject) -> dict[str, Array]:
    """Compliance (6, 6) at home and, where there is another one, at the softest pose, by names."""
    solution = subject.solution
    assert solution is not None  # noqa: S101 - asked by `missing`
    assert solution.compliance is not None  # noqa: S101 - as above
    places = {"at home": np.asarray(solution.compliance)}
    if subject.unmoved:
        return places
    found = subject.stiffness_survey
    free = found["stiffness_free"].sel(direction=["x", "y", "z"]).min("direction").to_numpy()
    free = np.where(np.isfinite(free), free, np.nan)
    if np.isfinite(free).any():
        softest = least(found, free)
        compliance = tool_compliance(at_pose(subject.model, softest.task).placed)
        if not _same(np.asarray(compliance), places["at home"]):
            places[f"at {softest.where}"] = np.asarray(compliance)
    return places


def _same(first: Array, second: Array) -> bool:
    """Whether two compliances differ by rounding only, block by block."""
    return all(
        bool(np.abs(gap).max() <= EQUAL * np.abs(second[half.rows, half.rows]).max())
        for half in HALVES
        for gap in [(first - second)[half.rows, half.rows]]
    )
