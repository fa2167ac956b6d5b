"""`strutwork trajectory`: what a path over time asks of the drives."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np

from strutwork.errors import ModelError
from strutwork.files import write_whole
from strutwork.machines.load import load
from strutwork.names import visible
from strutwork.reports.cli.drive_limits import drive_limits
from strutwork.reports.cli.output import console, print_json, show, table, tell
from strutwork.reports.cli.progress import shown
from strutwork.reports.trajectory_table import read_samples, trajectory_files
from strutwork.studies.drive_demand import DriveDemand, Peak
from strutwork.studies.trajectory import TrajectoryStudy, study_trajectory
from strutwork.units import ACCELERATION, quantity

QUANTITIES = ("speed", "acceleration", "force", "power")


def run(
    name: str,
    file: str,
    gravity: str | None,
    limits: Sequence[str],
    out: str | None,
    *,
    reactions: bool,
    json: bool,
) -> None:
    """Follow the trajectory and print what it asks."""
    pull = None if gravity is None else _gravity(gravity)
    samples = read_samples(Path(file))
    model = load(name)
    allowed = drive_limits(limits, model.structure.linkage.driven)
    with shown("poses") as progress:
        study = study_trajectory(
            model,
            samples,
            gravity=pull,
            limits=allowed,
            reactions=reactions,
            progress=progress("trajectory"),
        )
    written = []
    if out is not None:
        written = [
            str(write_whole(Path(out) / one.name, one.write)) for one in trajectory_files(study)
        ]
    if json:
        print_json(_plain(study) | ({"data": written} if written else {}))
        return
    _print(study)
    for path in written:
        console().print(f"Written: {visible(path)}", markup=False, soft_wrap=True)


def _gravity(text: str) -> tuple[float, ...]:
    parts = text.split(",")
    if len(parts) != 3:
        raise ModelError("--gravity", f'"{text}" is not three numbers.', "Write it as 0,0,-9.81.")
    found = []
    for one in parts:
        try:
            found.append(float(one))
        except ValueError:
            found.append(quantity(one.strip(), ACCELERATION, "--gravity"))
    return tuple(found)


def _print(study: TrajectoryStudy) -> None:
    screen, followed = console(), study.followed
    path = study.trajectory
    screen.print(study.title, markup=False, style="bold")
    pull = ", ".join(f"{g:g}" for g in np.asarray(followed.dynamics.gravity, dtype=float))
    screen.print(
        f"{len(path.times)} samples over {path.duration:.4g} s; gravity {pull} m/s²; moving rigid "
        f"bodies of {followed.moving_mass:.4g} kg",
        markup=False,
        soft_wrap=True,
    )
    moving = [label for label in path.coordinates.labels if label not in study.held]
    stays = [
        f"{label} {_shown(value, label.rpartition(':')[2].startswith('r'))}"
        for label, value in study.held.items()
    ]
    rest = f"; kept at home: {', '.join(stays)}" if stays else ""
    screen.print(f"Given: {', '.join(moving)}{rest}", markup=False, soft_wrap=True)
    heads = ["drive", "from", "to", "speed", "at, s", "acceleration", "at, s"]
    rows = [_motion_row(d) for d in study.demands]
    screen.print(table("Motion of the drives, largest", heads, rows))
    heads = ["drive", "force", "at, s", "RMS", "power", "at, s"]
    screen.print(table("Forces of the drives, largest", heads, map(_force_row, study.demands)))
    screen.print(
        f"Work of the drives {show(followed.work)} J, change of energy "
        f"{show(followed.energy_change)} J; they differ by {followed.imbalance:.1e} of the work "
        "that goes in and out",
        markup=False,
        soft_wrap=True,
    )
    for line in _exceeded(study):
        screen.print(line, markup=False, soft_wrap=True)
    if followed.reactions is not None:
        _print_reactions(study)
    for note in study.notes:
        tell(f"Note: {note}.")


def _print_reactions(study: TrajectoryStudy) -> None:
    followed = study.followed
    assert followed.reactions is not None  # noqa: S101 - asked for only where they are
    rows = []
    for k, label in enumerate(followed.reaction_labels):
        values = followed.reactions[:, k]
        first = int(np.argmax(np.abs(values)))
        unit = "N·m" if label.rpartition(":")[2].startswith("r") else "N"
        rows.append((label, f"{show(float(values[first]))} {unit}", float(followed.times[first])))
    console().print(table("Joint reactions, largest", ["joint direction", "", "at, s"], rows))


def _motion_row(demand: DriveDemand) -> tuple[object, ...]:
    turning = demand.direction.startswith("r")
    span = (_shown(value, turning) for value in (demand.low, demand.high))
    return (demand.label, *span, *_cells(demand, "speed"), *_cells(demand, "acceleration"))


def _force_row(demand: DriveDemand) -> tuple[object, ...]:
    turning = demand.direction.startswith("r")
    rms = _unit("force", demand.rms_force, turning)
    return (demand.label, *_cells(demand, "force"), rms, *_cells(demand, "power"))


def _cells(demand: DriveDemand, what: str) -> tuple[str, str]:
    peak: Peak = getattr(demand, what)
    return _unit(what, peak.value, demand.direction.startswith("r")), f"{peak.time:.4g}"


def _unit(what: str, value: float, turning: bool) -> str:
    if what == "power":
        return f"{show(value)} W"
    if what == "force":
        return f"{show(value)} {'N·m' if turning else 'N'}"
    return _shown(value, turning) + {"speed": "/s", "acceleration": "/s²"}[what]


def _shown(value: float, turning: bool) -> str:
    return f"{show(degrees(value))} deg" if turning else f"{show(1e3 * value)} mm"


def _exceeded(study: TrajectoryStudy) -> list[str]:
    lines = []
    for demand in study.demands:
        turning = demand.direction.startswith("r")
        for what in QUANTITIES:
            peak: Peak = getattr(demand, what)
            if peak.exceeded and peak.limit is not None:
                lines.append(
                    f"Beyond its limit: {demand.label}, {what} {_unit(what, peak.value, turning)} "
                    f"at t = {peak.time:.4g} s, {_over(peak.value, peak.limit)} more than "
                    f"{_unit(what, peak.limit, turning)}"
                )
    lines += [
        f"Out of its range: {one.label} from t = {one.first:.4g} s on, furthest "
        f"{_shown(one.value, one.turning)} at t = {one.time:.4g} s, "
        f"{_shown(abs(one.value - one.bound), one.turning)} beyond "
        f"{_shown(one.bound, one.turning)}"
        for one in study.ranges
    ]
    return lines


def _over(value: float, limit: float) -> str:
    return f"{show(100.0 * (value / limit - 1.0))} %"


def _plain(study: TrajectoryStudy) -> dict[str, Any]:
    followed = study.followed

    def peak(one: Peak) -> dict[str, Any]:
        return {
            "value": one.value,
            "time": one.time,
            "limit": one.limit,
            "exceeded": one.exceeded,
        }

    return {
        "title": study.title,
        "duration": study.trajectory.duration,
        "poses": len(followed.times),
        "coordinates": list(study.trajectory.coordinates.labels),
        "held": dict(study.held),
        "gravity": np.asarray(followed.dynamics.gravity, dtype=float).tolist(),
        "moving_mass": followed.moving_mass,
        "drives": [
            {
                "drive": d.label,
                "low": d.low,
                "high": d.high,
                **{what: peak(getattr(d, what)) for what in QUANTITIES},
                "rms_force": d.rms_force,
            }
            for d in study.demands
        ],
        "out_of_range": [
            {
                "coordinate": r.label,
                "value": r.value,
                "bound": r.bound,
                "first": r.first,
                "time": r.time,
            }
            for r in study.ranges
        ],
        "work": followed.work,
        "energy_change": followed.energy_change,
        "imbalance": followed.imbalance,
        "reactions": None
        if followed.reactions is None
        else {
            label: float(np.abs(followed.reactions[:, k]).max())
            for k, label in enumerate(followed.reaction_labels)
        },
        "notes": list(study.notes),
    }
