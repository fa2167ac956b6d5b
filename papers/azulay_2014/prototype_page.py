"""The report of the prototype, a machine without published numbers beside it."""

from __future__ import annotations

import json
from dataclasses import replace

from strutwork.machines import Prototype3PPPRS, get
from strutwork.papers.azulay_2014.chapters.machine import DRAWING, drawing_file, machine_figure
from strutwork.papers.azulay_2014.chapters.measurement import measurement_chapter
from strutwork.papers.azulay_2014.machine_study import FILTERS
from strutwork.papers.azulay_2014.regions import OWN_RANGES
from strutwork.papers.tables import assumed
from strutwork.reports.chapters.budget import budget_file, by_kind
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.chapters.cover import vibration_answers
from strutwork.reports.chapters.stiffness import (
    AXES,
    VIEW,
    dropped_table,
    map_figure,
    map_files,
    pose_columns,
    pose_rows,
    statistics_table,
)
from strutwork.reports.chapters.vibration import vibration_chapter
from strutwork.reports.content import Chapter, Fact, Facts, Figure, Note, Row, Table, Text
from strutwork.reports.figures.charts import stacked_shares
from strutwork.reports.numbers import micro, significant
from strutwork.reports.vibration_study import VibrationStudy, study_machine_vibration
from strutwork.studies import Summary, budget_map, stiffness_map, summary
from strutwork.studies.description import parameters
from strutwork.studies.progress import Teller, silent

NAME = "prototype-3ppprs"

UNPRINTED = (
    "The paper prints no numbers of this machine, so none are shown beside the computed values. "
    "Only the guide's radius, the links' steel and tube and the motors' stiffness have a source; "
    "masses, heights and travels are assumed."
)


def prototype_chapters(
    name: str, progress: Teller | None = None
) -> tuple[str, str, tuple[Chapter, ...]]:
    """Title, subtitle and chapters of the prototype's report."""
    entry = get(name)
    # with nine drives the Jacobian's condition has no one meaning: the guides are locked
    machine = Prototype3PPPRS().locked()
    dataset = stiffness_map(
        machine, filters=FILTERS, progress=progress(NAME) if progress else silent
    )
    blocked, free = summary(dataset), summary(dataset, "free")
    own = summary(stiffness_map(machine, filters=OWN_RANGES))
    budget = budget_map(machine, dataset)
    categories, shares = by_kind(budget)
    vibration = study_machine_vibration(f"vibration-{NAME}", entry.title, machine)
    csv = "stiffness-map.csv"
    chapters = [
        _summary(entry.title, entry.topology, blocked, own, vibration),
        Chapter(
            "drawing",
            "The machine",
            (Text(DRAWING), machine_figure(machine, NAME, entry.title, height=600)),
            (drawing_file(machine, NAME),),
        ),
        Chapter(
            "maps",
            "Stiffness over the hemisphere",
            (
                Text(VIEW),
                Row(
                    tuple(
                        map_figure(dataset, a, f"map-{a}", "true spherical joints", csv)
                        for a in AXES
                    )
                ),
                statistics_table("Other directions blocked, (C⁻¹)_ii", {"prototype": blocked}),
                statistics_table("Other directions free, 1/C_ii", {"prototype": free}),
                Table(
                    "Worst and best poses",
                    pose_columns("model"),
                    pose_rows("prototype", dataset, blocked),
                    "report.json",
                ),
                dropped_table({"prototype": dataset}, "model"),
            ),
            map_files(dataset, "stiffness-map", "stiffness map"),
        ),
        Chapter(
            "budget",
            "Compliance budget",
            (
                Figure(
                    "budget-bars",
                    "Share of each kind of part, all three legs, in the deflection along the "
                    "force, at the best, median and worst pose of each axis.",
                    stacked_shares(categories, shares, "share of the deflection"),
                    "Stacked bars of the shares of links and drives in the tool's deflection.",
                    "budget.csv",
                    height=480,
                ),
            ),
            (budget_file(budget, "budget.csv", "prototype"),),
        ),
        _vibration(vibration),
        measurement_chapter(machine),
        _assumptions(machine),
    ]
    settings = {
        "machine": NAME,
        "curvilinear stages": "locked in the middle of their guides",
        "check points": str(blocked.points),
        "joint ranges kept": ", ".join(json.loads(dataset.attrs["joint_ranges_kept"])),
        "condition limit": f"{dataset.attrs['condition_limit']:g}",
        "drives": "held by their stiffness",
    }
    content = {
        "parameters": parameters(machine),
        "blocked": blocked.to_dict(),
        "free": free.to_dict(),
        "candidates": int(dataset.attrs["candidates"]),
        "candidates_kept": int(dataset.attrs["candidates_kept"]),
        "dropped_by_reason": json.loads(dataset.attrs["dropped_by_reason"]),
        "vibration": vibration.to_dict(),
    }
    chapters.append(closing_chapter(NAME, settings, content, chapters))
    return (
        f"{entry.title}: static stiffness and vibration",
        f"{entry.topology} · {entry.paper.citation}",
        tuple(chapters),
    )


def _vibration(study: VibrationStudy) -> Chapter:
    chapter = vibration_chapter(
        study,
        (
            Text(
                "The machine at home, curvilinear stages locked, linear stages held by their "
                "motors' stiffness, with the masses of stages, platform and spindle."
            ),
        ),
        assumptions=(
            "Damping: 1 % of critical in every mode, viscous, assumed.",
            (
                "Roots of the links clamped in the radial tables except for their hinges; "
                "locked guides rigid, linear drives 3 N/µm each along their motion."
            ),
            "Platform and stages are rigid; spherical and revolute joints rotate freely.",
        ),
    )
    return replace(chapter, cover=vibration_answers(study, given="With assumed masses and damping"))


def _summary(
    title: str, topology: str, wide: Summary, own: Summary, vibration: VibrationStudy
) -> Chapter:
    facts = [
        Fact(
            f"Mean K{a * 2}",
            micro(own.axis(a).statistics.mean),
            "N/µm",
            f"at {own.points_kept} points; without the ranges of slides and spherical joints "
            f"{micro(wide.axis(a).statistics.mean)} at {wide.points_kept}",
        )
        for a in AXES
    ]
    first = float(vibration.modes.frequencies[0])
    facts.append(Fact("First frequency", significant(first, 4), "Hz", "at home"))
    softest = min(range(len(AXES)), key=lambda i: vibration.least[i].value)
    least = vibration.least[softest]
    facts.append(
        Fact(
            "Least dynamic stiffness",
            micro(least.value),
            "N/µm",
            f"along {AXES[softest]} at {significant(least.frequency, 4)} Hz, exact",
        )
    )
    text = (
        f"{title}: three legs, each, from the guide up, {topology}; nine drives move six freedoms. "
        f"The curvilinear stages are locked. Static stiffness at the {own.points_kept} of "
        f"{own.points} check points of a hemisphere that the machine's own joint ranges leave; the "
        f"maps below keep the ranges of revolute joints alone, which leave {wide.points_kept}. "
        "Vibration at home."
    )
    return Chapter("summary", "Summary", (Text(text), Facts(tuple(facts)), Note(UNPRINTED)))


def _assumptions(machine: Prototype3PPPRS) -> Chapter:
    def mm(length: float) -> str:
        return f"{significant(1e3 * length)} mm"

    ours = "assumed"
    rows = [
        ("Radius of the guide", mm(machine.base_radius), "the guide's model number, 150R"),
        ("Radius of the spherical joints' circle", mm(machine.platform_radius), ours),
        ("Links", f"{machine.section.name} mm, {machine.material.name}", "paper, section 3.3.1"),
        ("Length of the links", mm(machine.link_length), "the paper's design length"),
        ("Height of the pole", mm(machine.pole_height), ours),
        ("Linear drives", "3 N/µm each", "paper, section 3.3.1, ultrasonic motors"),
        ("Curvilinear stages", "locked and rigid", "no stiffness is printed"),
        ("Travel of the tangential and radial stages", mm(machine.radial_travel), ours),
        (
            "Masses: curvilinear stage, linear stage, its table, spindle",
            (
                f"{machine.carriage_mass:g}, {machine.stage_mass:g}, {machine.table_mass:g}, "
                f"{machine.spindle_mass:g} kg"
            ),
            ours,
        ),
        ("Platform", f"steel disc, {significant(machine.platform.mass)} kg", ours),
        ("Joint ranges", "revolute joints only, as for the paper's machines", ours),
    ]
    return Chapter(
        "assumptions",
        "Assumptions and their sources",
        (assumed("Dimensions and properties", rows),),
    )
