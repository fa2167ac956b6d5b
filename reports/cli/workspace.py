"""`strutwork workspace`: the poses that a machine can take, and what bounds them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.inscribed_shape import InscribedShape
from strutwork.kinematics.largest_shape import LargestShape, largest_shape
from strutwork.kinematics.margin_grid import MarginFunction
from strutwork.kinematics.margins import Margins
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.machines.model_poses import at_pose
from strutwork.names import visible
from strutwork.reports.cli.output import console, print_json, table
from strutwork.reports.cli.progress import counted, shown
from strutwork.reports.cli.workspace_words import measure_word, parts_words, placed, unit_words
from strutwork.reports.grid_words import grid_of_words
from strutwork.reports.motion_table import targets_of_words
from strutwork.reports.numbers import count
from strutwork.studies.margin_bounds import AmplificationBound, Bound, StiffnessBound
from strutwork.studies.workspace import Workspace, workspace
from strutwork.studies.workspace_files import write_workspace
from strutwork.studies.workspace_margin import (
    ROLL,
    MachineMargin,
    Spare,
    dexterous,
    interference_of,
    tilted,
)
from strutwork.units import ANGLE, LENGTH, STIFFNESS, quantity

Array = NDArray[Any]

#: Points along each direction of a grid of one, two and three, where none are said.
POINTS = {1: 101, 2: 41, 3: 21}
#: Values of a spare coordinate, and rolls, where none are said.
SPARE, ROLLS = 9, 5
#: Most rows of a table of pieces and of reasons.
ROWS = 12


@dataclass(frozen=True)
class Asked:
    """What a pose must be good for, in words."""

    tilt: str | None
    azimuth: str
    dexterous: str | None
    azimuths: int
    roll: str | None
    spare: str | None
    radius: str | None
    interference: bool
    conditioning: float | None
    amplification: str | None = None
    stiffness: str | None = None


@dataclass(frozen=True)
class Wanted:
    """The shape that is sought inside, in words."""

    kind: Literal["box", "ball", "cylinder"] | None
    proportions: str | None
    around: str | None


def run(
    target: str, over: Sequence[str], asked: Asked, wanted: Wanted, out: str | None, *, json: bool
) -> None:
    """Find the workspace of a machine and print what it is."""
    model = load(target)
    axes, put = _axes(target, model, over)
    model = at_pose(model, put)
    step = np.array([axis[1] - axis[0] for axis in axes.values()])
    margin = MachineMargin(
        model,
        tuple(axes),
        step,
        _turns(asked),
        _spare(asked),
        _interference(model, asked),
        asked.conditioning,
        bounds=_bounds(model, asked),
    )
    shape = _shape(wanted, axes)
    with shown() as started:
        found = workspace(margin, axes, progress=started(f"workspace of {visible(target)}"))
    inside = None
    if shape is not None:
        with counted(f"largest {shape.kind} in the workspace of {visible(target)}") as tell:
            inside = _largest(found, _told(margin, tell), shape, wanted)
    result = _result(target, found, margin, inside)
    if out is not None:
        stem = f"{Path(target).stem.replace(':', '-')}-workspace"
        result["data"] = [str(path) for path in write_workspace(Path(out), stem, found)]
    if json:
        print_json(result)
        return
    _print(result)


def _axes(
    target: str, model: Model, over: Sequence[str]
) -> tuple[dict[str, Array], dict[str, float]]:
    """Axes of the grid, and where the tool is put first."""
    count = sum(".." in word for text in over for word in text.split(","))
    grid = grid_of_words(over, points=POINTS.get(count, 5)) if over else model.workspace
    if grid is None:
        raise ModelError(
            target,
            "gives no workspace.",
            "Give --over x=-100mm..100mm,y=…, or add a table [workspace] to the file.",
        )
    axes = {d: np.asarray(v) for d, v in grid.axes.items() if len(v) > 1}
    if not over:
        # the file's points are those of maps: an error needs every second one
        axes = {d: np.linspace(v[0], v[-1], POINTS.get(len(axes), 5)) for d, v in axes.items()}
    return axes, {d: float(v[0]) for d, v in grid.axes.items() if len(v) == 1}


def _turns(asked: Asked) -> Array:
    rolls = np.zeros(1)
    if asked.roll is not None:
        rolls = _span(asked.roll, ANGLE, "--roll", ROLLS)
    if asked.dexterous is not None:
        return dexterous(_angle(asked.dexterous, "--dexterous"), asked.azimuths, rolls)
    tilt = 0.0 if asked.tilt is None else _angle(asked.tilt, "--tilt")
    azimuth = _angle(asked.azimuth, "--azimuth")
    return np.array([tilted(tilt, azimuth, float(r)) for r in rolls])


def _spare(asked: Asked) -> Spare | None:
    if asked.spare is None:
        return None
    name, equals, span = asked.spare.partition("=")
    joint, _, direction = name.strip().rpartition(":")
    if not equals or direction not in (*DIRECTIONS, ROLL) or (joint and direction == ROLL):
        raise ModelError(
            "--spare",
            f'"{asked.spare}" does not name a coordinate and a range.',
            "Write it as in roll=-180deg..180deg:13, rz=-30deg..30deg or stage:z=-5mm..5mm.",
        )
    kind = ANGLE if direction.startswith("r") else LENGTH
    values = _span(span, kind, f"--spare {name.strip()}", SPARE)
    return Spare((joint, direction) if joint else direction, values)


def _interference(model: Model, asked: Asked) -> Any:
    if asked.radius is not None:
        return interference_of(model, quantity(_number(asked.radius), LENGTH, "--radius"))
    return interference_of(model, None) if asked.interference else None


def _bounds(model: Model, asked: Asked) -> tuple[Bound, ...]:
    found: list[Bound] = []
    if asked.amplification is not None:
        low, dots, high = asked.amplification.partition("..")
        try:
            ends = (float(low), float(high)) if dots else (0.0, float(low))
        except ValueError:
            raise ModelError(
                "--amplification",
                f'"{asked.amplification}" is not a bound.',
                "Write it as 3 or 0.33..3.",
            ) from None
        found.append(AmplificationBound(model, *ends))
    if asked.stiffness is not None:
        least = quantity(_number(asked.stiffness), STIFFNESS, "--stiffness")
        found.append(StiffnessBound(model, least))
    return tuple(found)


def _shape(wanted: Wanted, axes: Mapping[str, Array]) -> InscribedShape | None:
    if wanted.kind is None:
        return None
    spans = np.array([np.ptp(axis) for axis in axes.values()])
    if wanted.proportions is None:
        # of one kind alike in all directions, of lengths and turns as the grid is
        half = np.ones(len(spans)) if len({d.startswith("r") for d in axes}) == 1 else 0.5 * spans
        return InscribedShape(wanted.kind, half)
    try:
        parts = np.array([float(part) for part in wanted.proportions.split(":")])
    except ValueError:
        parts = np.zeros(0)
    if parts.size != spans.size or not np.all((parts > 0) & np.isfinite(parts)):
        raise ModelError(
            "--proportions",
            f'"{wanted.proportions}" does not give a number for each of {", ".join(axes)}.',
            "Write them as in 2:1:1, in m and rad or shares of either.",
        )
    return InscribedShape(wanted.kind, 0.5 * parts)


def _told(margin: MarginFunction, tell: Callable[[int], None]) -> MarginFunction:
    """The same margin, which tells how many poses it was asked."""
    asked = 0

    def margins(points: Array) -> Margins:
        nonlocal asked
        result = margin(points)
        asked += len(points)
        tell(asked)
        return result

    return margins


def _largest(
    found: Workspace, margin: MarginFunction, shape: InscribedShape, wanted: Wanted
) -> LargestShape:
    centre = None
    if wanted.around is not None:
        said = targets_of_words([wanted.around], "--around")
        names = {direction for joint, direction in said if not joint}
        if names - set(found.grid.directions) or any(joint for joint, _ in said):
            raise ModelError(
                "--around",
                "names something that is not a direction of the grid.",
                f"Directions are {', '.join(found.grid.directions)}; others stay at home.",
            )
        centre = [
            said.get(("", d), float(h))
            for d, h in zip(found.grid.directions, found.home, strict=True)
        ]
    return largest_shape(found.grid, margin, shape, centre=centre)


def _result(
    target: str, found: Workspace, margin: MachineMargin, inside: LargestShape | None
) -> dict[str, Any]:
    directions = found.grid.directions
    near, home = found.nearest, found.home_component
    sizes = found.regions.sizes
    safe = margin.interference
    return {
        "target": target,
        "model": found.title,
        "grid": {
            d: [float(a[0]), float(a[-1]), len(a)]
            for d, a in zip(directions, found.grid.axes, strict=True)
        },
        "poses": int(found.grid.good.size),
        "poses_good": int(np.count_nonzero(found.grid.good)),
        "measure": found.measure,
        "error": found.error,
        "unit": found.unit,
        "components": [{"poses": int(n), "home": k + 1 == home} for k, n in enumerate(sizes)],
        "holes": found.regions.holes,
        "home": {
            "at": dict(zip(directions, found.home.tolist(), strict=True)),
            "margin": found.home_margin,
            "least": found.home_reason if found.home_margin < 1.0 else None,
            "component": home or None,
        },
        "border": found.shares,
        "dropped_by_reason": found.refused,
        "nearest": None
        if near is None
        else {
            "at": dict(zip(directions, near.place.tolist(), strict=True)),
            "distance": near.distance,
            "reason": near.reason,
        },
        "interference": None
        if safe is None
        else {
            "capsules": len(safe.capsules),
            "shapes": len(safe.shapes),
            "pairs": len(safe.pairs),
        },
        "largest": None if inside is None else _inside(directions, inside),
        "data": [],
    }


def _inside(directions: Sequence[str], inside: LargestShape) -> dict[str, Any]:
    return {
        "kind": inside.shape.kind,
        "centre": dict(zip(directions, inside.centre.tolist(), strict=True)),
        "sides": dict(zip(directions, inside.sides.tolist(), strict=True)),
        "measure": inside.measure,
        "critical": dict(zip(directions, inside.critical.tolist(), strict=True)),
        "reason": inside.reason,
        "confirmed": inside.confirmed,
    }


def _print(result: Mapping[str, Any]) -> None:
    out = console()
    out.print(visible(result["model"] or result["target"]), markup=False, style="bold")
    unit = result["unit"]
    scale, shown_unit = unit_words(unit)
    out.print(
        f"{measure_word(unit)} {scale * result['measure']:.4g} ± {scale * result['error']:.2g} "
        f"{shown_unit}; {result['poses_good']} of {result['poses']} poses of the grid are good",
        markup=False,
    )
    home = result["home"]
    pieces = result["components"]
    where = (
        f"home is in piece {home['component']}"
        if home["component"]
        else f"home is in none ({home['least']})"
        if home["margin"] < 0.0
        else "home is outside the grid"
    )
    sizes = ", ".join(str(c["poses"]) for c in pieces[:ROWS])
    out.print(
        f"{len(pieces)} piece{'s' * (len(pieces) != 1)}{f' ({sizes} poses)' if sizes else ''}, "
        f"{result['holes']} hole{'s' * (result['holes'] != 1)}; {where}",
        markup=False,
        soft_wrap=True,
    )
    if not pieces:
        for words, number in list(result["dropped_by_reason"].items())[:ROWS]:
            out.print(f"  {number}: {visible(words)}", markup=False, soft_wrap=True)
    if result["interference"] is not None:
        safe = result["interference"]
        out.print(
            f"Interference: {parts_words(safe)}, {count(safe['pairs'], 'pair')} that may collide; "
            "solids are checked where they have [[shapes]]",
            markup=False,
            soft_wrap=True,
        )
    if result["border"]:
        rows = [(words, 100.0 * share) for words, share in result["border"].items()]
        out.print(table("Border", ["what limits the workspace", "%"], rows[:ROWS]))
    near = result["nearest"]
    if near is not None:
        out.print(
            f"The limit nearest to home is at {placed(near['at'])}, {1e3 * near['distance']:.4g} "
            f"mm away: {near['reason']}",
            markup=False,
            soft_wrap=True,
        )
    if result["largest"] is not None:
        big = result["largest"]
        out.print(
            f"Largest {big['kind']}: {placed(big['sides'])} about {placed(big['centre'])}; "
            f"critical at {placed(big['critical'])}: {big['reason']}; {big['confirmed']} poses in "
            "it were checked and are good",
            markup=False,
            soft_wrap=True,
        )
    for path in result["data"]:
        out.print(visible(path), markup=False, soft_wrap=True)


def _angle(text: str, part: str) -> float:
    return quantity(_number(text), ANGLE, part)


def _span(text: str, kind: Any, part: str, points: int) -> Array:
    """`LOW..HIGH` or `LOW..HIGH:N`, or one value."""
    low, dots, rest = text.partition("..")
    if not dots:
        return np.array([quantity(_number(low), kind, part)])
    high, colon, number = rest.partition(":")
    count = number.strip()
    if colon and not (count.isascii() and count.isdigit() and 2 <= int(count[:5]) <= 1000):
        raise ModelError(part, f'"{text}" has no number of values.', "Write it as in :9.")
    first, last = (quantity(_number(v), kind, part) for v in (low, high))
    if not first < last:
        raise ModelError(part, f'"{text}" has no extent.', "Give the lower end first.")
    return np.linspace(first, last, int(count) if colon else points)


def _number(text: str) -> float | str:
    """A bare number is in SI."""
    try:
        return float(text)
    except ValueError:
        return text.strip()
