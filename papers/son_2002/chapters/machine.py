"""The MIT-SS-1: the machine in numbers, its drawing, and what was assumed."""

from __future__ import annotations

import numpy as np

from strutwork.machines import MitSS1, get
from strutwork.papers.son_2002.assembly_table import SETS
from strutwork.papers.son_2002.chapters.energies import place_shares
from strutwork.papers.son_2002.chapters.modes import MET
from strutwork.papers.son_2002.chapters.whole import whole_assumptions, whole_blocks
from strutwork.papers.son_2002.figures.planar_machine import planar_machine_view
from strutwork.papers.son_2002.mit_ss1_study import NAME, MitSS1Study
from strutwork.papers.son_2002.modes import TILT
from strutwork.papers.son_2002.planar_stiffness import map_figures
from strutwork.papers.son_2002.published import (
    DIMENSIONS,
    FIGURE_29_TICK,
    MACHINE,
    MANIPULABILITY,
    MODES,
)
from strutwork.papers.son_2002.tolerances import (
    AXIAL_FACTOR,
    HOUSING_TILT,
    RAIL_HEIGHT,
    STATIC_RATING,
)
from strutwork.papers.tables import assumed
from strutwork.reports.chapters.overconstraint import governing, label, shown
from strutwork.reports.content import (
    Chapter,
    Fact,
    Facts,
    Figure,
    Note,
    Text,
)
from strutwork.reports.data_files import json_file
from strutwork.reports.drawing_data import drawing_data
from strutwork.reports.numbers import MINUS, micro, significant

DRAWING = (
    "The mechanism alone, with its joints, seen from outside towards the granite. Drag to "
    "rotate, scroll to zoom; names appear under the pointer. Lengths are in mm; struts have "
    "their section, blocks, rails and housing are not to scale. Black arrows show the driven "
    "motions."
)


def summary_chapter(study: MitSS1Study) -> Chapter:
    """The machine in a sentence and its headline numbers."""
    states = int(study.own.responses.influence.redundant.max(initial=0))
    blocks = (
        Text(
            "MIT-SS-1: three blocks on vertical guides move a spindle housing in the x-z plane "
            "by struts of fixed length, a planar 3-PRR mechanism, [P vertical] R R (P prismatic, "
            "R revolute; driven ones in brackets), before a granite L on four mounts. These "
            "values show how it moves, how stiff it is, at which frequencies it vibrates, and "
            "how these depend on its size:"
        ),
        Facts((*_plane_facts(study), *_whole_facts(study))),
        Text(
            "All pins are parallel, so the machine is constrained more than once, and the "
            "deviations between its parts are locked in as forces in its bearings:"
        ),
        Facts(tuple(_force_facts(study))),
        Note(
            f"With two elastic bearings per pin the machine has {states} states of self-stress. "
            "The dimensions are the thesis's; stiffnesses, masses and thicknesses are "
            "calibrated; the static rating, the damping and some tolerances are assumptions, "
            "each named below. The thesis's numbers do not all come from one machine: stiffness "
            "map and assembly forces, the modes of its finite element model and the measured "
            "ones each have their own set of bearings, and each chapter says which it uses."
        ),
    )
    return Chapter("summary", "Summary", blocks)


def _plane_facts(study: MitSS1Study) -> list[Fact]:
    """Kinematics and planar stiffness."""
    condition = study.kinematics["condition"]
    low, high = float(condition.min()), float(condition.max())
    printed = [
        MANIPULABILITY.value(MACHINE, f"position condition number, {end}")
        for end in ("least", "most")
    ]
    plane = map_figures(study.whole.planar)
    return [
        Fact(
            "Position condition number",
            f"{low:.2f}–{high:.2f}",
            "",
            f"published {printed[0]:g} to {printed[1]:g}; nothing fitted",
        ),
        Fact(
            "Stiffness along x at home",
            micro(plane["home"]),
            "N/µm",
            "none is published: k_i was chosen so that the flat part lies at "
            f"{micro(FIGURE_29_TICK)}, the highest tick of Fig. 29-(a); at the two soft corners "
            f"{significant(plane['home over lower left'], 2)} and "
            f"{significant(plane['home over upper right'], 2)} times less",
        ),
    ]


def _whole_facts(study: MitSS1Study) -> list[Fact]:
    """Modes, responses and size."""
    whole = study.whole
    facts = []
    modes = {v.row for v in MODES}
    for quantity, words in (("numerical", "finite element model"), ("measured", "measurement")):
        some = [r for r in whole.rows if r.quantity == quantity and r.row in modes]
        worst = max(some, key=lambda r: abs(r.difference_percent))
        facts.append(
            Fact(
                f"Modes beside the thesis's {words}",
                f"{len([r for r in some if abs(r.difference_percent) <= MET])} of {len(some)}",
                "",
                f"within {MET:g} %, calibrated; farthest: {worst.row} {worst.computed:.1f} for "
                f"{worst.published:g} Hz",
            )
        )
    tilt = whole.named["numerical"].frequencies[TILT]
    beyond = min(whole.beyond_mounts.least, key=lambda one: one.value)
    least = min(whole.vibration.least, key=lambda one: one.value)
    exponents = (study.moving_size.stiffness_law(0), study.moving_size.frequency_law(0))
    rollers = (study.moving_size.stiffness_law(1), study.moving_size.frequency_law(1))
    facts += [
        Fact(
            "Lowest mode of the mechanism",
            f"{tilt:.1f}",
            "Hz",
            "the housing's tilt at home; "
            f"{place_shares(whole.named['numerical'], TILT)['housing bearings']:.0f} % of "
            "its energy in the bearings on the housing",
        ),
        Fact(
            "Least dynamic stiffness at the tool",
            significant(least.value / 1e6),
            "N/µm",
            f"along {least.output.direction} at {significant(least.frequency)} Hz, on the mounts; "
            f"{significant(beyond.value / 1e6)} at {significant(beyond.frequency)} Hz; 1 % damping "
            "assumed",
        ),
        Fact(
            "Exponents of size: stiffness, frequency",
            f"{float(exponents[0].exponent[0]):.2f}, {MINUS}{-float(exponents[1].exponent[0]):.2f}",
            "",
            "similar joints; with catalogue roller bearings "
            f"{float(rollers[0].exponent[0]):.2f} and {MINUS}{-float(rollers[1].exponent[0]):.2f}",
        ),
    ]
    return facts


def _force_facts(study: MitSS1Study) -> list[Fact]:
    """Assembly forces."""
    own = study.own
    top, case = governing(own), study.cases["I"]
    first = governing(case)
    facts = []
    if top is not None:
        facts.append(
            Fact(
                "Largest bearing force of the machine",
                shown(float(own.largest[top]), "N"),
                "kN",
                f"{label(own.quantities[top])}, exact worst case over the workspace; "
                f"{100 * float(own.utilisation[top]):.0f} % of the assumed static rating",
            )
        )
    if first is not None:
        facts.append(
            Fact(
                "Table 2, case I: largest force",
                shown(float(case.largest[first]), "N"),
                "kN",
                f"{label(case.quantities[first])}, calibrated; Table 2 prints 10.2 kN as its "
                "largest",
            )
        )
    for which, rows in study.table_2.items():
        used = [r for r in rows if which == "all cases" or " I " not in r.row]
        some = [abs(r.difference_percent) for r in used]
        what = "all 36 forces" if which == "all cases" else "cases II and III"
        facts.append(Fact(f"Largest difference, {what}", f"{max(some):.1f}", "%", f"{SETS[which]}"))
    facts.append(
        Fact(
            "Longest struts within the rating",
            significant(study.scale.length_at()),
            "m",
            f"Table 2's structure, no bearing above {significant(STATIC_RATING / 1e3)} kN",
        )
    )
    return facts


def drawing_chapter(study: MitSS1Study) -> Chapter:
    """The complete machine and its mechanism in 3-D at home."""
    machine = study.machine
    placement = machine.place(machine.home())
    file = f"drawing-{NAME}.json"
    content = drawing_data(machine, placement)
    figure = Figure(
        f"drawing-{NAME}",
        "The mechanism of the MIT-SS-1 at home.",
        planar_machine_view(machine, placement),
        "Three-dimensional drawing of the MIT-SS-1: three guides with blocks, three struts, the "
        "spindle housing, pins with two bearings each, and the tool.",
        file,
        600,
    )
    what = "what the drawing of the mechanism shows: nodes, lines and joints"
    blocks, files = whole_blocks(study.whole)
    return Chapter(
        "drawing",
        "The complete machine",
        (*blocks, Text(DRAWING), figure),
        (*files, json_file(file, what, content)),
    )


def assumptions_chapter(study: MitSS1Study) -> Chapter:
    """Every assumption with its source."""
    machine = study.machine
    return Chapter(
        "assumptions",
        "Assumptions and their sources",
        (
            Text(f"The thesis: {get(NAME).paper.citation}"),
            assumed(
                "Dimensions, properties and tolerances of the assembly forces", _assumed(machine)
            ),
            whole_assumptions(study.whole.whole),
        ),
    )


def _assumed(machine: MitSS1) -> list[list[str]]:
    def mm(*lengths: float) -> str:
        return ", ".join(significant(1e3 * v, 4) for v in lengths) + " mm"

    ours = "assumed"
    thesis = DIMENSIONS.note.split(".")[0]
    return [
        [
            "Guides w₁, w₂, w₃",
            mm(*machine.guide_distances),
            f"{thesis}; −w₁, lost in the scan of eq. 40",
        ],
        ["Struts l₁, l₂, l₃", mm(*machine.strut_lengths), thesis],
        [
            "Housing t, r, p",
            mm(machine.joint_height, machine.joint_radius, machine.joint_rise),
            thesis,
        ],
        [
            "Distance of a pin's bearings",
            mm(machine.pin_width),
            "assumed: section 8.2 has 140 to 220 mm",
        ],
        [
            "Radial stiffness of a bearing",
            f"{micro(machine.radial_stiffness or np.inf)} N/µm",
            "calibrated: with the strut 255 N/µm (eq. 51), the highest tick of Fig. 29-(a)",
        ],
        [
            "Axial stiffness of a bearing",
            f"{micro(machine.axial_stiffness or np.inf)} N/µm",
            "calibrated: two in series give the k_y of the reconstructed Table 2",
        ],
        ["Struts", f"{machine.section.name} mm, {machine.material.name}, beams with shear", ours],
        [
            "Guides, drives, blocks, housing",
            "rigid",
            "the drives are held in section 6.2; the rest is assumed",
        ],
        [
            "Parallelism of the pins in the blocks",
            "300 µm/m, any azimuth, about the near bearing",
            "section 6.6",
        ],
        [
            "Parallelism of the pins in the housing",
            f"{1e6 * HOUSING_TILT:g} µm/m",
            "assumed: wire EDM in one set-up, “quite good” (section 8.6)",
        ],
        [
            "Height of the rails on the granite",
            f"zone of {1e6 * RAIL_HEIGHT:g} µm",
            "section 8.6: rails parallel within 4 µm",
        ],
        [
            "Static rating of a bearing",
            f"{significant(STATIC_RATING / 1e3)} kN",
            (
                "assumed: Table 4 names a tapered roller bearing 15 x 35 mm by NSK, no rating; "
                "catalogues give 13 to 15 kN for this size (30202)"
            ),
        ],
        [
            "Limit of a bearing",
            "radial and axial force each below the static rating, safety factor 1",
            f"ISO 76: P₀ = max(Fr, ½ Fr + {AXIAL_FACTOR:g} Fa); each separately, assumed",
        ],
        [
            "Distribution of the machine's tolerances",
            "uniform in each zone; Table 2's on the surface of the cone",
            "assumed; section 6.6 for Table 2",
        ],
        ["Clearance, preload, friction, gravity", "none", ours],
    ]
