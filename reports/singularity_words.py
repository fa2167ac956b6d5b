"""Singular poses in words: what a reader types, and what is printed and written of them."""

from __future__ import annotations

from collections.abc import Mapping
from io import StringIO
from math import degrees
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.csv_rows import RowWriter
from strutwork.errors import ModelError
from strutwork.kinematics.lost_motion import Kind, Lost
from strutwork.kinematics.singular_poses import Singularity
from strutwork.kinematics.singularity_curves import SingularCurve, SingularPlane
from strutwork.reports.grid_words import grid_of_words
from strutwork.reports.motion_table import targets_of_words

Array = NDArray[Any]

#: Poses along a line.
POINTS = 101

#: Coordinates by their directions, (n,) each.
Axes = dict[str, Array]


def line_of_words(text: str) -> Axes:
    """`x=0..40mm` or `x=0..40mm:201,ry=0deg..10deg:201`: coordinates that go along together.

    Raises
    ------
    ModelError
        As `grid_of_words`; a coordinate of one value, or different numbers of poses.
    """
    axes = dict(grid_of_words([text], "--line", POINTS).axes)
    counts = {len(values) for values in axes.values()}
    if counts == {1} or len(counts) > 1:
        raise ModelError(
            "--line",
            f'"{text}" has coordinates of {sorted(counts)} poses.',
            "Give each the same number of poses; fixed coordinates belong to --at.",
        )
    return axes


def plane_of_words(text: str, low: str | None, high: str | None, steps: int) -> Axes:
    """`x,y` with its start and end, or `x=-40mm..40mm:41,y=-40mm..40mm:41`.

    Raises
    ------
    ModelError
        Not two coordinates, a start or end that does not name both, or no extent.
    """
    if "=" in text:
        if low or high:
            raise ModelError(
                "--plane",
                "gives ranges, and --from or --to is given too.",
                "Give one or the other.",
            )
        axes = dict(grid_of_words([text], "--plane", steps).axes)
    else:
        names = [name.strip() for name in text.split(",")]
        ends = []
        for part, words in (("--from", low), ("--to", high)):
            if words is None:
                raise ModelError(
                    "--plane",
                    f"{text} has no {part}.",
                    f"Give {part} {','.join(f'{n}=…' for n in names)}.",
                )
            found = {d: v for (_, d), v in targets_of_words([words], part).items()}
            if set(found) != set(names):
                raise ModelError(
                    part, f"does not name exactly {text}.", "Give a value for each coordinate."
                )
            ends.append(found)
        for name in names:
            if not ends[0][name] < ends[1][name]:
                raise ModelError("--plane", f"{name} has no extent.", "Give the lower end first.")
        axes = {n: np.linspace(ends[0][n], ends[1][n], steps) for n in names}
    if len(axes) != 2 or any(len(values) < 2 for values in axes.values()):
        raise ModelError(
            "--plane", f'"{text}" is not two ranges.', "Give two coordinates, as in x,y."
        )
    return axes


def place_words(parameters: Mapping[str, float]) -> str:
    """`x = 12.5 mm, ry = 3 deg`."""
    return ", ".join(
        f"{n} = {degrees(v):.6g} deg" if n.startswith("r") else f"{n} = {1e3 * v:.6g} mm"
        for n, v in ((n, v if abs(v) > 1e-12 else 0.0) for n, v in parameters.items())
    )


def kind_words(kind: Kind) -> str:
    """`actuator, type 2`."""
    return kind.value if kind.type is None else f"{kind.value}, type {kind.type}"


def lost_words(lost: Lost | None, reason: str) -> str:
    """What is lost, or why the reach ends."""
    return lost.description if lost is not None else reason


def singularity_dict(one: Singularity) -> dict[str, Any]:
    """Plain numbers and strings, SI."""
    return {"at": dict(one.parameters), **_kind(one.kind), **lost_dict(one.lost)} | (
        {"reason": one.reason} if one.reason else {}
    )


def lost_dict(lost: Lost | None) -> dict[str, Any]:
    """Plain numbers and strings, SI; empty where nothing is lost."""
    if lost is None:
        return {}
    return {
        "lost": lost.description,
        "twist": None if lost.twist is None else lost.twist.tolist(),
        "moving": [f"{joint}:{direction}" for joint, direction in lost.moving],
        "continuous": lost.continuous,
    }


def curve_dict(curve: SingularCurve) -> dict[str, Any]:
    """Plain numbers and strings, SI."""
    return {
        **_kind(curve.kind),
        "border_of_reach": curve.border,
        "closed": curve.closed,
        "points": len(curve.points),
        "nearest": singularity_dict(curve.at),
    }


def _kind(kind: Kind) -> dict[str, Any]:
    return {"kind": kind.value, "type": kind.type, "meaning": kind.meaning}


def line_csv(names: tuple[str, ...], found: tuple[Singularity, ...]) -> str:
    """Singular poses along a line, one a row."""
    rows = [
        (*one.parameters.values(), one.kind.value, lost_words(one.lost, one.reason))
        for one in found
    ]
    return _csv(names, ("kind", "what"), rows)


def curves_csv(plane: SingularPlane) -> str:
    """Vertices of all curves, one a row, and single poses as curves of one."""
    rows: list[tuple[Any, ...]] = []
    for number, curve in enumerate(plane.curves, 1):
        border = "border of reach" if curve.border else "inside"
        rows += [(*point, number, curve.kind.value, border) for point in curve.points]
    for number, one in enumerate(plane.points, len(plane.curves) + 1):
        rows.append((*one.parameters.values(), number, one.kind.value, "alone"))
    return _csv(plane.names, ("curve", "kind", "where"), rows)


def distance_csv(plane: SingularPlane) -> str:
    """Distances over the grid; poses out of reach are left out."""
    x, y = np.meshgrid(*plane.axes, indexing="ij")
    kept = plane.reach
    columns = zip(x[kept], y[kept], plane.parallel[kept], plane.serial[kept], strict=True)
    rows = [(a, b, float(p), float(s)) for a, b, p, s in columns]
    return _csv(plane.names, ("parallel distance", "serial distance"), rows)


def _csv(names: tuple[str, ...], others: tuple[str, ...], rows: list[tuple[Any, ...]]) -> str:
    text = StringIO(newline="")
    writer = RowWriter(text)
    turns = [name.startswith("r") for name in names]
    writer.writerow(
        [*(f"{n}, {'deg' if t else 'mm'}" for n, t in zip(names, turns, strict=True)), *others]
    )
    for row in rows:
        shown = [
            repr(float(degrees(v) if t else 1e3 * v)) for v, t in zip(row, turns, strict=False)
        ]
        writer.writerow(
            [*shown, *(repr(v) if isinstance(v, float) else v for v in row[len(names) :])]
        )
    return text.getvalue()
