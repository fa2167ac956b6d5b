"""How large its workspace is, and what ends it."""

from __future__ import annotations

from math import degrees

import numpy as np
import xarray as xr

from strutwork.kinematics.largest_shape import LargestShape
from strutwork.reports.content import Block, Chapter, Column, Fact, Facts, Figure, Table, Text
from strutwork.reports.data_files import DataFile, csv_file, netcdf_file
from strutwork.reports.figures.curves import heat
from strutwork.reports.figures.shapes import Shape, box, mesh
from strutwork.reports.figures.solid import scene
from strutwork.reports.figures.theme import rounded
from strutwork.reports.numbers import MINUS, count, share, significant
from strutwork.reports.subject import SPREAD, Subject
from strutwork.reports.survey_words import pose_text
from strutwork.studies.workspace import Workspace

KEY = "workspace-size"
TITLE = "How large is its workspace?"
STEM = "workspace"

#: Reasons that the table names.
SHOWN = 12

#: Of the largest box: its colour, and corners of a rectangle of halves one.
BOX_COLOUR = "#d55e00"
OUTLINE = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]])


def missing(subject: Subject) -> str:
    """Why there is nothing to say; empty where there is."""
    return subject.unmoved or subject.unbounded


def write(subject: Subject) -> Chapter:
    """Its size with the error of it, its pieces, and what it ends at."""
    found = subject.workspace
    directions = found.grid.directions
    scale, unit = shown_unit(found.unit)
    facts = [
        Fact(
            "Size",
            significant(scale * found.measure),
            unit,
            f"± {significant(scale * found.error, 2)}",
        ),
        Fact(
            "Pieces",
            str(len(found.regions.sizes)),
            "",
            f"{count(found.regions.holes, 'hole')}; home is "
            + (f"in piece {found.home_component}" if found.home_component else "in none"),
        ),
    ]
    near = found.nearest
    if near is not None:
        place = dict(zip(directions, near.place.tolist(), strict=True))
        facts.append(
            Fact(
                "Limit nearest to home",
                significant(1e3 * near.distance),
                "mm",
                f"away, at {pose_text(place)}: {_minus(near.reason)}",
            )
        )
    shapes = len(subject.model.shapes)
    meshes = count(shapes, "mesh", "meshes")
    apart = f" and without a collision of beams and shapes ({meshes})" if shapes else ""
    blocks: list[Block] = [
        Text(
            f"The workspace consists of all poses over {', '.join(directions)} that the machine "
            f"reaches within its joint ranges{apart}, with the other directions at home. The "
            f"search covers {SPREAD:g} times the ranges of this report. Borders are refined "
            "between the poses of a grid; the error is the difference from a grid half as fine."
        ),
        Facts(tuple(facts)),
    ]
    inside = subject.largest_box
    if inside is not None:
        blocks.append(Text(_box_words(found, inside)))
    slacks = "reach, joint ranges and shapes" if shapes else "reach and joint ranges"
    figure = _figure(found, inside, slacks)
    if figure is not None:
        blocks.append(figure)
    rows = [[_minus(words), share(part)] for words, part in found.shares.items()]
    columns = (Column("what limits the workspace", "", False), Column("share of the border"))
    if rows:
        blocks.append(Table("What limits it", columns, rows[:SHOWN], f"{STEM}-border.csv"))
    files: tuple[DataFile, ...] = (
        netcdf_file(
            f"{STEM}.nc", "margins of poses over the grid, NetCDF", _dataset(found, inside)
        ),
        csv_file(
            f"{STEM}-border.csv",
            "what limits the workspace, shares of its border",
            ["what", "share"],
            [[words, part] for words, part in found.shares.items()],
        ),
    )
    return Chapter(KEY, TITLE, tuple(blocks), files)


def _minus(words: str) -> str:
    """Numbers in a reason with the sign that the page has."""
    return words.replace(" -", f" {MINUS}")


def shown_unit(unit: str) -> tuple[float, str]:
    """Litres, square centimetres and millimetres; as it is where turns are among them."""
    known = {"m³": (1e3, "litres"), "m²": (1e4, "cm²"), "m": (1e3, "mm"), "rad": (degrees(1), "°")}
    return known.get(unit, (1.0, unit))


def _box_words(found: Workspace, inside: LargestShape) -> str:
    directions = found.grid.directions
    sides = " × ".join(significant(1e3 * side) for side in inside.sides)
    critical = dict(zip(directions, inside.critical.tolist(), strict=True))
    what = "box" if len(directions) == 3 else "rectangle"
    return (
        f"The largest {what} about home inside it, in the proportions of the ranges searched, is "
        f"{sides} mm along {', '.join(directions)}; it touches the border at "
        f"{pose_text(critical)}: {_minus(inside.reason)}. {inside.confirmed} poses that fill it "
        "were checked and are good."
    )


def _dataset(found: Workspace, inside: LargestShape | None) -> xr.Dataset:
    """The grid, with centre and sides of the box, m."""
    data = found.to_dataset()
    if inside is None:
        return data
    return data.assign_attrs(largest_box_centre=inside.centre, largest_box_sides=inside.sides)


def _figure(found: Workspace, inside: LargestShape | None, slacks: str) -> Figure | None:
    directions = found.grid.directions
    if len(directions) == 3 and not any(d.startswith("r") for d in directions):
        triangles = found.border.facets
        if not len(triangles):
            return None
        shape = Shape(found.border.points, triangles, "border of the workspace")
        traces = [mesh([shape], "border of the workspace", "#56b4e9", opacity=0.4)]
        if inside is not None:
            block = box(inside.centre, np.eye(3), inside.sides.tolist(), "largest box about home")
            traces.append(mesh([block], "largest box about home", BOX_COLOUR))
        return Figure(
            "workspace-border",
            "Border of the workspace of the tool centre point, in mm"
            + (", and the largest box about home in it. " if inside is not None else ". ")
            + "Drag to rotate, scroll to zoom.",
            scene(traces),
            "Three-dimensional surface of the workspace.",
            f"{STEM}.nc",
            520,
        )
    if len(directions) != 2:
        return None
    x, y = (
        np.degrees(a) if d.startswith("r") else 1e3 * a
        for d, a in zip(directions, found.grid.axes, strict=True)
    )
    titles = [f"{d} ({'deg' if d.startswith('r') else 'mm'})" for d in directions]
    values = found.grid.margins.value
    spec = heat(
        x,
        y,
        np.where(values >= 0, values, np.nan),
        (titles[0], titles[1], "margin (1 or more is far)"),
    )
    if inside is not None:
        corners = inside.centre + 0.5 * inside.sides * OUTLINE
        spec["data"].append(
            {
                "type": "scatter",
                "mode": "lines",
                "name": "largest rectangle about home",
                "x": rounded(1e3 * corners[:, 0]),
                "y": rounded(1e3 * corners[:, 1]),
                "line": {"color": BOX_COLOUR, "width": 2},
                "hovertemplate": "%{x:.4g}, %{y:.4g}<extra>largest rectangle about home</extra>",
            }
        )
    return Figure(
        "workspace-margin",
        f"Margin of the poses: the least slack of {slacks}, 0 at the border. Blank: outside the "
        "workspace."
        + (" Line: the largest rectangle about home inside." if inside is not None else ""),
        spec,
        f"Map of the margin over {' and '.join(directions)}.",
        f"{STEM}.nc",
        440,
    )
