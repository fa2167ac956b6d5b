"""What moving asks of the drives: mass that the tool feels, weight, and a standard circle."""

from __future__ import annotations

from math import degrees

import numpy as np

from strutwork.reports.content import Block, Chapter, Column, Fact, Facts, Figure, Note, Table, Text
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.figures.curves import Curve, curves
from strutwork.reports.figures.theme import PALETTE
from strutwork.reports.numbers import significant
from strutwork.reports.subject import Subject
from strutwork.reports.survey_words import grid_text, pose_text
from strutwork.studies.drive_demand import DriveDemand, Peak
from strutwork.studies.standard_motion import ACCELERATION, StandardMotion
from strutwork.studies.trajectory import TrajectoryStudy

KEY = "dynamics"
TITLE = "What does motion demand of its drives?"

#: Share of the largest force that is rounding.
ROUNDING = 1e-9

#: Drives that a figure names.
DRAWN = 8


def missing(subject: Subject) -> str:
    """Why there is nothing to say; empty where there is."""
    if subject.model.tool is None:
        return "it has no tool: add [tool] with tcp"
    if subject.model.workspace is None:
        return "the file gives no poses: add [workspace] with ranges of the tool"
    if not subject.model.structure.linkage.driven:
        return "it has no drives: name the driven directions of its joints"
    return subject.undynamic


def write(subject: Subject) -> Chapter:
    """Masses, weight on the drives, and the circle."""
    found = subject.standard_motion
    drives = subject.model.structure.linkage.driven
    labels = [f"{joint}:{d}" for joint, d in drives]
    blocks: list[Block] = [
        Text(
            "All bodies are rigid here and joints have no losses; elastic directions are locked. "
            "Masses are those of the model at home."
        ),
        Facts(tuple(_facts(found))),
        _masses(found),
        _standing(found, labels),
    ]
    files = [_standing_file(found, labels)]
    if found.round is not None:
        blocks += [_circle_text(found), _demands(found.round), *_figures(found.round, labels)]
        blocks += [Note(f"{note[0].upper()}{note[1:]}.") for note in found.round.notes]
        files.append(_round_file(found.round, labels))
    return Chapter(KEY, TITLE, tuple(blocks), tuple(files))


def _facts(found: StandardMotion) -> list[Fact]:
    facts = [
        Fact(
            f"Effective mass along {label}",
            significant(float(free)),
            "kg",
            "at home, the other coordinates free to follow",
        )
        for label, free in zip(found.labels, found.free, strict=True)
        if label in ("x", "y", "z")
    ]
    if found.surely is not None:
        facts.append(
            Fact(
                "Force it can exert in every direction",
                significant(found.surely),
                "N",
                "at home, within the force limits of all drives",
            )
        )
    return facts


def _masses(found: StandardMotion) -> Table:
    rows = [
        [
            label,
            significant(float(held)),
            significant(float(free)),
            "kg m²" if label.rpartition(":")[2].startswith("r") else "kg",
        ]
        for label, held, free in zip(found.labels, found.held, found.free, strict=True)
    ]
    columns = (
        Column("coordinate", "", False),
        Column("others held"),
        Column("others free"),
        Column("unit", "", False),
    )
    return Table("Effective mass or moment of inertia at the tool, at home", columns, rows)


def _unit(label: str) -> str:
    return "N·m" if label.rpartition(":")[2].startswith("r") else "N"


def _standing(found: StandardMotion, labels: list[str]) -> Table:
    task = found.grid.task()
    rows = []
    for k, label in enumerate(labels):
        forces = found.standing[:, k]
        if np.isnan(forces).all():
            rows.append([label, "none", "", _unit(label)])
            continue
        worst = int(np.nanargmax(np.abs(forces)))
        where = pose_text({d: float(values[worst]) for d, values in task.items()})
        value = float(forces[worst])
        small = abs(value) <= ROUNDING * float(np.nanmax(np.abs(found.standing), initial=0.0))
        rows.append(
            [label, "0" if small else significant(value), "" if small else where, _unit(label)]
        )
    columns = (
        Column("drive", "", False),
        Column("largest"),
        Column("at", "", False),
        Column("unit", "", False),
    )
    lost = int(np.isnan(found.standing).any(axis=1).sum())
    caption = f"Force of each drive at rest under the weight, over {grid_text(found.grid)}"
    if lost:
        caption += f"; {lost} of them cannot be reached"
    return Table(caption, columns, rows, "dynamics-standing.csv")


def _circle_text(found: StandardMotion) -> Text:
    return Text(
        f"The tool moves once round a circle of {significant(1e3 * found.radius)} mm radius about "
        f"home in {' and '.join(found.plane)}, from rest to rest in {significant(found.duration)} "
        f"s, with at most {ACCELERATION:g} m/s². For a path of your own, use strutwork trajectory."
    )


def _demands(study: TrajectoryStudy) -> Table:
    rows = []
    # forces and moments, speeds and turning speeds side by side: what rounding leaves is far less
    speeds, forces, powers = (
        ROUNDING * max(float(getattr(d, what).value) for d in study.demands)
        for what in ("speed", "force", "power")
    )
    for demand in study.demands:
        turns = demand.direction.startswith("r")
        factor, speed = (degrees(1.0), "deg/s") if turns else (1e3, "mm/s")
        rows.append(
            [
                demand.label,
                _peak(demand.speed, factor, speeds),
                speed,
                _peak(demand.force, 1.0, forces),
                significant(demand.rms_force if demand.rms_force > forces else 0.0),
                _unit(demand.label),
                _peak(demand.power, 1.0, powers),
            ]
        )
    columns = (
        Column("drive", "", False),
        Column("speed"),
        Column("unit", "", False),
        Column("force"),
        Column("RMS force"),
        Column("unit", "", False),
        Column("power", "W"),
    )
    beyond = [d.label for d in study.demands if _exceeds(d)]
    words = f"; beyond their limits: {', '.join(beyond)}" if beyond else ""
    return Table(
        f"Largest values of each drive on the circle, with its limit where one is given{words}. "
        f"Work and energy agree within {study.followed.imbalance:.0e}",
        columns,
        rows,
        "dynamics-circle.csv",
    )


def _exceeds(demand: DriveDemand) -> bool:
    return any(p.exceeded for p in (demand.speed, demand.force, demand.power))


def _peak(peak: Peak, factor: float, rounding: float) -> str:
    value = significant(factor * peak.value if peak.value > rounding else 0.0)
    return value if peak.limit is None else f"{value} of {significant(factor * peak.limit)}"


def _figures(study: TrajectoryStudy, labels: list[str]) -> list[Figure]:
    """Forces over time: one figure for forces, one for moments."""
    followed, figures = study.followed, []
    for unit, what in (("N", "forces"), ("N·m", "moments")):
        some = [k for k, label in enumerate(labels) if _unit(label) == unit]
        if not some:
            continue
        some = sorted(some, key=lambda k: -float(np.abs(followed.forces[:, k]).max()))[:DRAWN]
        lines = [
            Curve(labels[k], followed.forces[:, k], PALETTE[n % len(PALETTE)])
            for n, k in enumerate(sorted(some))
        ]
        spec = curves(followed.times, lines, ("time (s)", f"{what[:-1]} of the drive ({unit})"))
        figures.append(
            Figure(
                f"dynamics-{what}",
                f"{what.capitalize()} of the drives round the circle"
                + (f"; the {DRAWN} largest" if len(labels) > DRAWN else "")
                + ".",
                spec,
                f"Lines of the drives' {what} over time.",
                "dynamics-circle.csv",
                360,
            )
        )
    return figures


def _standing_file(found: StandardMotion, labels: list[str]) -> DataFile:
    task = found.grid.task()
    units = ["N_m" if _unit(label) != "N" else "N" for label in labels]
    return csv_file(
        "dynamics-standing.csv",
        "forces of the drives at rest over the workspace, SI",
        [*task, *(f"{label}_{unit}" for label, unit in zip(labels, units, strict=True))],
        [
            [*(float(v[n]) for v in task.values()), *found.standing[n].tolist()]
            for n in range(len(found.grid))
        ],
    )


def _round_file(study: TrajectoryStudy, labels: list[str]) -> DataFile:
    followed = study.followed
    columns = ["time_s"]
    for what in ("coordinate", "speed", "acceleration", "force", "power"):
        columns += [f"{label}_{what}" for label in labels]
    table = np.hstack(
        [
            followed.times[:, None],
            followed.drives,
            followed.speeds,
            followed.accelerations,
            followed.forces,
            followed.powers,
        ]
    )
    return csv_file(
        "dynamics-circle.csv", "the drives round the standard circle, SI", columns, table.tolist()
    )
