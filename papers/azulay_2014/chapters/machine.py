"""A machine of the literature: what it is, how it stands, what was assumed."""

from __future__ import annotations

from typing import Any

from strutwork.kinematics import Placement
from strutwork.machines import ThreeLegs
from strutwork.papers.azulay_2014.chapters.assumptions import (
    assumptions_table,
    method_table,
    models_table,
)
from strutwork.papers.azulay_2014.figures.three_legs import drawn_joints, machine_view
from strutwork.papers.azulay_2014.machine_study import FILTERS, MachineStudy
from strutwork.papers.azulay_2014.published import TABLE_4
from strutwork.reports.chapters.stiffness import AXES
from strutwork.reports.content import Chapter, Fact, Facts, Figure, Note, Text
from strutwork.reports.data_files import DataFile, json_file
from strutwork.reports.numbers import fixed, micro, percent, significant

DRAWING = (
    "Drag to rotate, scroll to zoom; names appear under the pointer. Lengths are in mm and links "
    "at their true diameter; joint symbols are not to scale. Black arrows show the driven "
    "motions."
)


def summary_chapter(study: MachineStudy) -> Chapter:
    """The machine in a sentence and its headline numbers."""
    wide, fitted = study.summaries["spherical"], study.summaries["apparent"]
    parted = study.barred["spherical"]
    # what the machine's own limits exclude stands in no headline
    found = parted.parts[True, "all"] or wide
    linkage = study.machines["spherical"].linkage
    text = (
        f"{study.entry.title}: three legs on one circular guide carry the platform, each leg, "
        f"from the guide up, {study.entry.topology} (P prismatic, R revolute, S spherical; driven "
        f"ones in brackets), {len(linkage.driven)} drives in all. Its static stiffness at the "
        f"tool was computed at the {found.points_kept} of {found.points} check points on a "
        "hemisphere that its own joint ranges leave, at each of them with the roll that makes "
        f"Kxx largest; {parted.kept(True, 'pole')} of them lie on the pole's side of the singular "
        f"ring and {parted.kept(True, 'beyond')} beyond it, which six drives do not reach. The "
        "paper's means agree best with the ranges of the revolute joints alone, which leave "
        f"{wide.points_kept}."
    )
    facts = []
    for axis in AXES:
        mean = found.axis(axis).statistics.mean
        published = TABLE_4.value(study.name, f"K{axis * 2} mean")
        all_points = wide.axis(axis).statistics.mean
        apparent = fitted.axis(axis).statistics.mean
        facts.append(
            Fact(
                f"Mean K{axis * 2}",
                micro(mean),
                "N/µm",
                f"at {found.points_kept} points; without the ranges of slides and spherical "
                f"joints {micro(all_points)} at {wide.points_kept}, "
                f"{percent(100 * (all_points / 1e6 / published - 1))} against the published "
                f"{significant(published, 4)}; the model that the paper's numbers suggest: "
                f"{micro(apparent)}",
            )
        )
    worst = min((found.axis(a) for a in AXES), key=lambda a: a.worst.value)
    where = ", ".join(fixed(1e3 * v, 1) for v in worst.worst.position)
    facts.append(
        Fact(
            "Least stiffness",
            micro(worst.worst.value),
            "N/µm",
            f"K{worst.direction * 2} at x, y, z = {where} mm",
        )
    )
    return Chapter(
        "summary",
        "Summary",
        (
            Text(text),
            Facts(tuple(facts)),
            Note(
                "The large numbers are for true spherical joints, the machine as described. The "
                "paper's own numbers suggest links clamped in the platform; both models are "
                "shown side by side below, each labelled. Both are calibrated: dimensions that "
                "the paper leaves open were chosen to match its means."
            ),
        ),
    )


def drawing_chapter(study: MachineStudy) -> Chapter:
    """The machine in 3-D at home."""
    machine = study.machines["spherical"]
    return Chapter(
        "drawing",
        "The machine",
        (Text(DRAWING), machine_figure(machine, study.name, study.entry.title, height=600)),
        (drawing_file(machine, study.name),),
    )


def machine_figure(machine: ThreeLegs, name: str, title: str, height: int) -> Figure:
    """A machine at home, rotatable."""
    return Figure(
        f"drawing-{name}",
        f"{title} at home.",
        machine_view(machine, home_placement(machine)),
        f"Three-dimensional drawing of {title}: circular guide, three legs, platform, joints by "
        "type and drives.",
        f"drawing-{name}.json",
        height,
    )


def home_placement(machine: ThreeLegs) -> Placement:
    """The machine at home, a single pose."""
    return machine.place(machine.home())


def drawing_file(machine: ThreeLegs, name: str) -> DataFile:
    """What the drawing shows: nodes, links and joints, SI."""
    placement = home_placement(machine)
    content: dict[str, Any] = {
        "unit": "m",
        "guide_radius": machine.base_radius,
        "nodes": dict(zip(machine.linkage.nodes, placement.positions.tolist(), strict=True)),
        "beams": {
            b.name: {"nodes": list(b.nodes), "outline": list(b.section.outline)}
            for b in machine.structure.beams
        },
        "lines": [list(pair) for pair in machine.skeleton()],
        "joints": {
            j.name: {
                "type": j.style,
                "at": j.at.tolist(),
                "axes_as_columns": j.frame.tolist(),
                "driven": bool(j.driven),
            }
            for j in drawn_joints(machine, placement)
        },
        "tool": machine.linkage.tool,
    }
    return json_file(
        f"drawing-{name}.json", "what the drawing shows: nodes, links, joints", content
    )


def assumptions_chapter(study: MachineStudy) -> Chapter:
    """Every assumption with its source, and the two joint models."""
    machine, apparent = study.machines["spherical"], study.machines["apparent"]
    return Chapter(
        "assumptions",
        "Assumptions and their sources",
        (
            Text(f"The paper: {study.entry.paper.citation}"),
            models_table(),
            assumptions_table(machine, apparent, study.entry.title),
            method_table(FILTERS),
        ),
    )
