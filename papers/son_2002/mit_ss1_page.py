"""The report of the MIT-SS-1: kinematics, stiffness, modes, over-constraint, size."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from strutwork.machines import get
from strutwork.papers.son_2002.chapters.assembly_scale import scale_blocks
from strutwork.papers.son_2002.chapters.assembly_table import (
    case_i_file,
    cases_table,
    misfit_blocks,
    published_markers,
    table_2_blocks,
)
from strutwork.papers.son_2002.chapters.calibration import calibration_chapter
from strutwork.papers.son_2002.chapters.designs import design_blocks
from strutwork.papers.son_2002.chapters.kinematics import kinematics_chapter, map_blocks
from strutwork.papers.son_2002.chapters.machine import (
    assumptions_chapter,
    drawing_chapter,
    summary_chapter,
)
from strutwork.papers.son_2002.chapters.modes import modes_chapter
from strutwork.papers.son_2002.chapters.planar_stiffness import (
    stiffness_chapter as planar_stiffness_chapter,
)
from strutwork.papers.son_2002.chapters.response import response_chapter
from strutwork.papers.son_2002.chapters.size import scale_chapter as size_chapter
from strutwork.papers.son_2002.chapters.whole import calibrated_blocks
from strutwork.papers.son_2002.figures.assembly_scene import machine_misfit_view
from strutwork.papers.son_2002.mit_ss1_study import NAME, OBJECTIVES, MitSS1Study, study_mit_ss1
from strutwork.papers.son_2002.tolerances import STATIC_RATING
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.chapters.cover import locked_answer
from strutwork.reports.chapters.overconstraint import (
    governing,
    headline,
    label,
    shown,
    study_file,
    tolerance_table,
    tool_blocks,
)
from strutwork.reports.chapters.overconstraint import pose as pose_label
from strutwork.reports.chapters.overconstraint_allocation import allocation_blocks
from strutwork.reports.chapters.overconstraint_forces import (
    METHODS,
    cause_blocks,
    force_blocks,
    spread_blocks,
)
from strutwork.reports.content import Block, Chapter, Figure, Text
from strutwork.reports.data_files import DataFile, json_file
from strutwork.reports.figures.assembly_scene import assembled
from strutwork.reports.numbers import significant, times
from strutwork.studies.description import parameters
from strutwork.studies.progress import Teller

#: How the machine's tool displacements are to be read.
IN_PLANE = (
    "What moves the tool within the plane (x, z and about y) is an offset at each pose that "
    "a calibration of the drives can take out; what moves it along y or about x and z stays."
)

#: What the locked-in force on the cover depends on.
CALIBRATED = "; bearings are calibrated, their rating and some tolerances assumed."

RATING = f"{significant(STATIC_RATING / 1e3)} kN"


def mit_ss1_chapters(
    name: str, progress: Teller | None = None
) -> tuple[str, str, tuple[Chapter, ...]]:
    """Title, subtitle and chapters of the MIT-SS-1's report."""
    study = study_mit_ss1(progress)
    entry = get(name)
    chapters = [
        summary_chapter(study),
        drawing_chapter(study),
        kinematics_chapter(study),
        stiffness_chapter(study),
        modes_chapter(study.whole),
        response_chapter(study.whole),
        calibration_chapter(study.whole),
        machine_chapter(study),
        table_2_chapter(study),
        Chapter("scale", "Assembly forces against size", *_gathered(scale_blocks(study))),
        Chapter(
            "designs",
            "Where the rails are mounted: three designs",
            *_gathered(design_blocks(study)),
        ),
        size_chapter(study.moving_size, study.whole_size),
        assumptions_chapter(study),
    ]
    chapters.append(closing_chapter(NAME, _settings(study), _content(study), chapters))
    return (
        f"{entry.title}: kinematics, stiffness, modes, assembly forces and size",
        f"{entry.topology} · {entry.paper.citation}",
        tuple(chapters),
    )


def _gathered(
    *parts: tuple[Sequence[Block], Sequence[DataFile]],
) -> tuple[tuple[Block, ...], tuple[DataFile, ...]]:
    """Blocks and files of the parts of a chapter."""
    return (
        tuple(block for blocks, _ in parts for block in blocks),
        tuple(file for _, files in parts for file in files),
    )


def stiffness_chapter(study: MitSS1Study) -> Chapter:
    """The planar stiffness of the thesis, and that of the calibrated machine."""
    planar = planar_stiffness_chapter()
    blocks, files = calibrated_blocks(study.whole)
    return replace(planar, blocks=(*planar.blocks, *blocks), files=(*planar.files, *files))


def machine_chapter(study: MitSS1Study) -> Chapter:
    """The machine's own tolerances: forces in its twelve bearings."""
    own, key = study.own, "assembly"
    introduction = Text(
        "Every pin rotates in two bearings, so three parallel pins at the blocks and three at "
        "the housing are constrained more than once. Where the pins are not parallel or the "
        "rails not level, the bearings and struts deform until the parts fit; the forces this "
        "takes stay in the machine. They are linear in the misfits, and the worst case is the "
        "largest over everything that the tolerances allow at once."
    )
    gathered = _gathered(
        ([introduction, headline(own)], [study_file(own, key)]),
        _misfit(study),
        ([tolerance_table(own.tolerances, "Tolerances of the machine")], []),
        force_blocks(own, key),
        map_blocks(study),
        spread_blocks(own, key),
        cause_blocks(own, key),
        ([*tool_blocks(own, key), Text(IN_PLANE)], []),
        allocation_blocks(
            own.tolerances,
            {OBJECTIVES[o]: a for o, a in study.allocations.items()},
            key,
            f"every bearing within the assumed static rating of {RATING} at every pose",
        ),
    )
    key = "overconstraint"
    cover = (locked_answer(own, key, CALIBRATED),)
    return Chapter(key, "Assembly forces of the machine", *gathered, cover=cover)


def _misfit(study: MitSS1Study) -> tuple[list[Block], list[DataFile]]:
    own = study.own
    top = governing(own)
    if top is None:
        return [], []
    pose = int(own.worst_pose[top])
    worst = {
        (joint, d): value for joint, some in own.misfits(top).items() for d, value in some.items()
    }
    placement = study.toleranced.placed.placement[pose]
    shape = assembled(study.machine.structure.at(placement), worst)
    file = "misfit-machine.json"
    figure = Figure(
        "misfit-machine",
        f"The misfits at which the {label(own.quantities[top])} is largest, "
        f"{shown(float(own.largest[top]), 'N')} kN, at {pose_label(own, pose)}. Misfits and "
        f"displacements are drawn {times(shape.factor)} times their true size; arrows show the "
        "forces on the strut at the block's pins and on the housing at its own.",
        machine_misfit_view(study.machine, shape),
        "Three-dimensional drawing: the machine as designed, the axes of its pins as made, and "
        "struts and housing strained between them, with the bearing forces as arrows.",
        file,
        600,
    )
    what = "the drawn worst case of the machine: misfits, displacements, forces"
    return [figure], [json_file(file, what, shape.to_dict())]


def table_2_chapter(study: MitSS1Study) -> Chapter:
    """Table 2: the published forces, the reconstruction, and what the thesis does not print."""
    case, key = study.cases["I"], "table-2-case-I"
    others = []
    for numeral in ("II", "III"):
        name = f"table-2-case-{numeral}"
        blocks, files = force_blocks(study.cases[numeral], name, published_markers(numeral))
        # the 36 numbers stand in Table 2's own table; the picture is what is new
        others.append(([b for b in blocks if isinstance(b, Figure)], files))
    gathered = _gathered(
        table_2_blocks(study),
        misfit_blocks(study),
        force_blocks(case, key, published_markers("I")),
        spread_blocks(case, key),
        cause_blocks(case, key),
        (tool_blocks(case, key), [case_i_file(study), study_file(case, key)]),
        *others,
        ([cases_table(study)], []),
    )
    title = "Table 2 of the thesis: assembly forces of three equal struts"
    return Chapter("table-2", title, *gathered)


def _settings(study: MitSS1Study) -> dict[str, Any]:
    found = study.own.distribution
    return {
        "machine": NAME,
        "poses of the assembly forces": str(len(study.own.poses)),
        "worst case": "exact, certified to 1e-9 of its value",
        "samples": f"{found.samples:,}" if found else "none",
        "sampling": METHODS.get(found.method, found.method) if found else "none",
        "static rating, kN": f"{STATIC_RATING / 1e3:g}",
        "struts": study.machine.struts,
        "drives and guides": "rigid, except for the ball screw mode",
        "damping of the responses": "1 % of critical in every mode, assumed",
        "solver of the granite": study.whole.whole.granite.solver,
    }


def _content(study: MitSS1Study) -> dict[str, Any]:
    return {
        "parameters": parameters(study.machine),
        "singular_tilts": {str(x): b for x, b in study.singular.items()},
        "table_2": {w: [r.to_dict() for r in rows] for w, rows in study.table_2.items()},
        "calibrations": [c.to_dict() for c in study.calibrations],
        "scale": study.scale.to_dict(),
        "designs": [d.to_dict() for d in study.designs],
        "allocations": {o: a.to_dict() for o, a in study.allocations.items()},
        "whole": study.whole.to_dict(),
        "case_allocations": {n: a.to_dict() for n, a in study.case_allocations.items()},
    }
