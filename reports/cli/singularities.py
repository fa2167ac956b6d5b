"""`strutwork singularities`: where a machine is singular, and how far a pose is from it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console

from strutwork.errors import ModelError
from strutwork.files import write_text
from strutwork.kinematics import characteristic_length
from strutwork.kinematics.pose_family import PoseFamily
from strutwork.kinematics.singular_poses import Singularity
from strutwork.kinematics.singularities import singularities_on_line
from strutwork.kinematics.singularity_curves import SingularPlane, singularities_in_plane
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.machines.singular_sections import PoseDistance, pose_distance, section_family
from strutwork.names import visible
from strutwork.reports.cli.output import console, print_json
from strutwork.reports.cli.progress import shown
from strutwork.reports.cli.subject import where
from strutwork.reports.singularity_words import (
    Axes,
    curve_dict,
    curves_csv,
    distance_csv,
    kind_words,
    line_csv,
    lost_dict,
    lost_words,
    place_words,
    singularity_dict,
)
from strutwork.units import LENGTH, quantity

#: Joint types whose ranges count; None for all.
_RANGES: dict[str, tuple[str, ...] | None] = {"all": None, "revolute": ("revolute",), "none": ()}


def run(
    target: str,
    line: Axes | None,
    plane: Axes | None,
    at: Sequence[str],
    place: tuple[Sequence[str], Sequence[str]],
    length: str | None,
    *,
    ranges: str,
    out: str | None,
    json: bool,
) -> None:
    """Look, and print what is found."""
    model = load(target)
    model.require_tool()
    # one length for home, pose, line and plane
    size = characteristic_length(model.placement) if length is None else _length(length)
    here = pose_distance(where(*place).put(model), size)
    axes = line or plane
    found: tuple[Singularity, ...] | SingularPlane | None = None
    if axes is not None:
        held = where(at, ()).task
        family = section_family(model, tuple(axes), held, size, kinds=_RANGES[ranges])
        with shown() as started:
            progress = started(f"singularities of {visible(target)}")
            if line is not None:
                values = np.stack(list(axes.values()), axis=1)
                found = singularities_on_line(family, values, progress)
            else:
                x, y = axes.values()
                found = singularities_in_plane(family, (x, y), _home(model, family), progress)
    written = [] if out is None else _write(Path(out), target, tuple(axes or ()), found)
    if json:
        print_json(_result(here, found) | ({"data": written} if written else {}))
        return
    screen = console()
    screen.print(model.title or target, markup=False, style="bold")
    _print_distance(screen, here, "at the pose" if any(place) else "at home")
    if isinstance(found, SingularPlane):
        _print_plane(screen, found)
    elif found is not None:
        _print_line(screen, found)
    for path in written:
        screen.print(f"Written: {visible(path)}", markup=False, soft_wrap=True)


def _length(text: str) -> float:
    found = quantity(_number(text), LENGTH, "--length")
    if not found > 0.0:
        raise ModelError("--length", f"is {text}.", "Give a positive length, as in 100mm.")
    return found


def _number(text: str) -> object:
    try:
        return float(text)
    except ValueError:
        return text


def _home(model: Model, family: PoseFamily) -> list[float]:
    home = model.motion.task_of(model.motion.home_pose)
    return [float(home[("x", "y", "z", "rx", "ry", "rz").index(n)]) for n in family.names]


def _result(
    here: PoseDistance, found: tuple[Singularity, ...] | SingularPlane | None
) -> dict[str, Any]:
    distance = here.distance
    result: dict[str, Any] = {
        "length": distance.length,
        "freedoms": here.known.freedoms,
        "parallel_distance": float(distance.parallel[0]),
        "serial_distance": float(distance.serial[0]),
        "passive_distance": float(distance.passive[0]),
        "singular": None if here.kind is None else here.kind.value,
        **lost_dict(here.lost),
    }
    if isinstance(found, SingularPlane):
        result |= {
            "poses": int(found.reach.size),
            "reached": int(found.reach.sum()),
            "curves": [curve_dict(curve) for curve in found.curves],
            "points": [singularity_dict(one) for one in found.points],
            "edges_missed": found.missed,
        }
    elif found is not None:
        result["singularities"] = [singularity_dict(one) for one in found]
    return result


def _write(
    folder: Path,
    target: str,
    names: tuple[str, ...],
    found: tuple[Singularity, ...] | SingularPlane | None,
) -> list[str]:
    stem = f"{Path(target).stem.replace(':', '-')}-singularities"
    if isinstance(found, SingularPlane):
        texts = {f"{stem}.csv": curves_csv(found), f"{stem}-distance.csv": distance_csv(found)}
    else:
        texts = {f"{stem}.csv": line_csv(names, found or ())}
    return [str(write_text(folder / name, text)) for name, text in texts.items()]


def _print_distance(screen: Console, here: PoseDistance, place: str) -> None:
    distance = here.distance
    say(
        screen,
        f"Distance {place}, with {1e3 * distance.length:.4g} mm counting as one radian: "
        f"{distance.parallel[0]:.4g} from a parallel singularity (type 2), "
        f"{distance.serial[0]:.4g} from a serial one (type 1)",
    )
    if here.kind is not None:
        say(screen, f"The pose itself is singular: {kind_words(here.kind)}")
        say(screen, f"  {lost_words(here.lost, here.kind.meaning)}")


def _print_line(screen: Console, found: tuple[Singularity, ...]) -> None:
    ends = [one for one in found if one.reason]
    say(
        screen,
        f"{_count(len(found) - len(ends), 'singular pose')} along the line, and "
        f"{_count(len(ends), 'end')} of reach",
    )
    for one in found:
        end = "end of reach: " if one.reason else ""
        say(screen, f"  {place_words(one.parameters)}: {end}{kind_words(one.kind)}")
        say(screen, f"    {lost_words(one.lost, one.reason)}")


def _print_plane(screen: Console, found: SingularPlane) -> None:
    inner = [curve for curve in found.curves if not curve.border]
    borders = [curve for curve in found.curves if curve.border]
    say(screen, f"{int(found.reach.sum())} of {found.reach.size} poses reached")
    alone = _count(len(found.points), "pose")
    say(screen, f"{_count(len(inner), 'curve')} of singular poses, and {alone} alone")
    for curve in inner:
        _print_curve(screen, curve.kind.meaning, curve.at, len(curve.points))
    for one in found.points:
        _print_curve(screen, one.kind.meaning, one, 1)
    if borders:
        say(screen, f"Reach ends on {_count(len(borders), 'curve')}")
    for curve in borders:
        _print_curve(screen, curve.kind.meaning, curve.at, len(curve.points))
    if found.missed:
        say(screen, f"On {found.missed} edges of the grid, poses differ too much: use more steps")


def _print_curve(screen: Console, meaning: str, one: Singularity, points: int) -> None:
    say(screen, f"  {kind_words(one.kind)}, {_count(points, 'point')}: {meaning}")
    say(screen, f"    nearest to home at {place_words(one.parameters)}")
    said = lost_words(one.lost, one.reason)
    if said:
        say(screen, f"    {said}")


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


def say(screen: Console, text: str) -> None:
    """A line that is not cut."""
    screen.print(text, markup=False, soft_wrap=True)
