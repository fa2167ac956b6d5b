"""The report of the Hexel hexapod: mobility, stiffness map and manipulability."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees
from typing import Any

import numpy as np
import xarray as xr

from strutwork.kinematics import Mobility, drive_values, mobility
from strutwork.machines import HexelHexapod, MitSS1, get
from strutwork.machines.hexel_hexapod import LEVEL, MAP_REACH, MAP_TILT, REACH, TILT
from strutwork.papers.son_2002.chapters.manipulability import manipulability_chapter
from strutwork.papers.son_2002.figures.hexapod import hexapod_view
from strutwork.papers.son_2002.manipulability import (
    hexapod_manipulability,
    manipulability_rows,
)
from strutwork.papers.son_2002.published import MANIPULABILITY
from strutwork.papers.tables import assumed
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.chapters.plane_stiffness import falls_table, plane_figures
from strutwork.reports.chapters.stiffness import map_files
from strutwork.reports.content import (
    Block,
    Chapter,
    Fact,
    Facts,
    Figure,
    Note,
    Text,
)
from strutwork.reports.data_files import json_file
from strutwork.reports.drawing_data import drawing_data
from strutwork.reports.numbers import fixed, micro, significant
from strutwork.studies import plane_map, stiffness_falls
from strutwork.studies.description import parameters
from strutwork.studies.plane_map import Fall
from strutwork.studies.progress import Teller, silent

NAME = "hexel-hexapod"

ENDS = ("least", "most")

#: Steps to either side of the stiffness maps.
STEPS = 20

DRAWING = (
    "Drag to rotate, scroll to zoom; names appear under the pointer. Lengths are in mm; the "
    "legs' diameters, joint symbols and the table are not to scale. Black arrows show the driven "
    "motions."
)


@dataclass(frozen=True)
class HexapodStudy:
    """Everything that the report shows.

    Parameters
    ----------
    machine : HexelHexapod
    mobility : Mobility
        At home.
    stiffness, planar : Dataset
        Maps of the hexapod and of the MIT-SS-1, of `plane_map`.
    ellipsoids : Dataset
        Of `hexapod_manipulability`.
    """

    machine: HexelHexapod
    mobility: Mobility
    stiffness: xr.Dataset
    planar: xr.Dataset
    ellipsoids: xr.Dataset

    def __repr__(self) -> str:
        return f"<HexapodStudy: {self.stiffness.sizes['pose']} poses, {self.mobility!r}>"

    @property
    def falls(self) -> dict[str, list[Fall]]:
        """How much the stiffness of either machine changes."""
        return {
            "hexapod": stiffness_falls(self.stiffness),
            "MIT-SS-1": stiffness_falls(self.planar),
        }


def hexapod_chapters(
    name: str, progress: Teller | None = None
) -> tuple[str, str, tuple[Chapter, ...]]:
    """Title, subtitle and chapters of the hexapod's report."""
    tell: Teller = progress or (lambda _: silent)
    entry, machine, planar = get(name), HexelHexapod(), MitSS1()
    study = HexapodStudy(
        machine,
        mobility(machine.linkage, machine.place(machine.home())),
        plane_map(machine, machine.pose_grid(STEPS), progress=tell(NAME)),
        plane_map(planar, planar.pose_grid(STEPS), progress=tell("mit-ss1")),
        hexapod_manipulability(machine),
    )
    chapters = [
        _summary(study),
        _drawing(study),
        _stiffness(study),
        manipulability_chapter(study.ellipsoids),
        _assumptions(study),
    ]
    chapters.append(closing_chapter(NAME, _settings(study), _content(study), chapters))
    return (
        f"{entry.title}: stiffness and manipulability",
        f"{entry.topology} · {entry.paper.citation}",
        tuple(chapters),
    )


def _summary(study: HexapodStudy) -> Chapter:
    condition = study.ellipsoids["position_condition"]
    by_direction = {fall.direction: fall for fall in study.falls["hexapod"]}
    published = [MANIPULABILITY.value("hexapod", f"position condition number, {e}") for e in ENDS]
    facts = (
        Fact(
            "Freedoms",
            str(study.mobility.mobility),
            "",
            f"{study.mobility.redundant} redundant constraints: assembly costs no force",
        ),
        Fact(
            "Position condition number",
            f"{float(condition.min()):.2f} to {float(condition.max()):.2f}",
            "",
            f"published {published[0]:.2f} to {published[1]:.2f}; calibrated: the drawing is "
            "missing, and its interpretation was chosen by these",
        ),
        *(
            Fact(
                f"K{d * 2} in the middle of the map",
                micro(by_direction[d].centre),
                "N/µm",
                f"falls {significant(by_direction[d].whole)}-fold over the map; legs assumed",
            )
            for d in ("x", "z")
        ),
    )
    text = (
        "Six telescopic legs, each, from the fixed platform down, a universal joint, a driven "
        "prismatic joint and a ball, hold the moving platform; two balls share each of its three "
        "joint centres. The thesis compares its own machine with this one (sections 2.2 and "
        f"6.2). Values are computed at y = 0, {significant(1e3 * LEVEL)} mm over the work table."
    )
    note = (
        "The thesis prints the dimensions but neither the stiffness of a leg nor, in the available "
        "text, the drawing of Appendix A. Stiffness is proportional to the leg's, which is "
        "assumed: its variation is meaningful, not its size."
    )
    return Chapter("summary", "Summary", (Text(text), Facts(facts), Note(note)))


def _drawing(study: HexapodStudy) -> Chapter:
    machine = study.machine
    placement = machine.place(machine.home())
    file = f"drawing-{NAME}.json"
    figure = Figure(
        f"drawing-{NAME}",
        "The Hexel hexapod at home.",
        hexapod_view(machine, placement),
        "Three-dimensional drawing of the hexapod: hexagonal fixed platform, six telescopic legs, "
        "moving platform with three joint centres, tool and work table.",
        file,
        640,
    )
    content = drawing_data(machine, placement)
    found = study.mobility
    lengths = drive_values(machine, machine.place(machine.poses(*_mesh(study.ellipsoids))))
    text = (
        f"Mobility {found.mobility} with the legs driven and {found.mobility_locked} with them "
        f"held; {found.redundant} redundant constraints. Unlike the planar machine's pins, its "
        "joints fit whatever the errors of its parts, which move the tool but lock in no force. "
        f"Over x = ±{1e3 * REACH:g} mm and a = ±{degrees(TILT):g}° the legs are from "
        f"{fixed(1e3 * float(lengths.min()), 0)} to {fixed(1e3 * float(lengths.max()), 0)} mm "
        "long."
    )
    return Chapter(
        "drawing",
        "The machine",
        (Text(DRAWING), figure, Text(text)),
        (json_file(file, "what the drawing shows: nodes, lines and joints", content),),
    )


def _mesh(found: xr.Dataset) -> tuple[Any, Any]:
    x, a = np.meshgrid(found["x"].to_numpy(), found["a"].to_numpy(), indexing="ij")
    return x, a


def _stiffness(study: HexapodStudy) -> Chapter:
    machine = study.machine
    k = significant((machine.leg_stiffness or np.inf) / 1e6)
    file, other = f"{NAME}-map", "mit-ss1-map"
    blocks: list[Block] = [
        Text(
            "1/C_ii at the tool tip, other directions free to follow, legs of "
            f"{k} N/µm each and everything else rigid, over x and the tilt a about x "
            f"(Fig. 29-(b), whose axes are legible to ±{1e3 * MAP_REACH:g} mm and "
            f"±{degrees(MAP_TILT):g}°; of its values nothing is)."
        ),
        plane_figures(study.stiffness, "stiffness", "Hexel hexapod", f"{file}.csv"),
        Text(
            "For comparison the MIT-SS-1 over its nominal workspace, x and the tilt b about y "
            f"(Fig. 29-(a)). Its struts have {k} N/µm too, with their bearings: the two machines "
            "differ by their geometry."
        ),
        plane_figures(study.planar, "planar", "MIT-SS-1", f"{other}.csv", ("x", "z")),
        falls_table(study.falls, "report.json"),
        _verdict(study),
    ]
    files = (
        *map_files(study.stiffness, file, "stiffness over x and tilt"),
        *map_files(study.planar, other, "stiffness of the MIT-SS-1 over x and tilt"),
    )
    return Chapter("stiffness", "Stiffness over x and tilt", tuple(blocks), files)


def _verdict(study: HexapodStudy) -> Text:
    falls = {name: {f.direction: f for f in some} for name, some in study.falls.items()}

    def sentence(direction: str) -> str:
        one, other = falls["hexapod"][direction], falls["MIT-SS-1"][direction]
        return (
            f"K{direction * 2} changes {fixed(one.middle, 2)}-fold in the middle of the hexapod's "
            f"map and {fixed(other.middle, 2)}-fold in that of the MIT-SS-1"
        )

    return Text(
        "The thesis says that the hexapod's stiffness “drops far more rapidly as the end-effector "
        f"moves away from the middle” (section 6.2). {sentence('x')}; {sentence('z')}. Over the "
        "entire maps the MIT-SS-1 falls as well, towards the two corners where its struts come "
        "near a common point."
    )


def _assumptions(study: HexapodStudy) -> Chapter:
    m = study.machine

    def mm(length: float) -> str:
        return f"{significant(1e3 * length, 4)} mm"

    thesis, ours = "Appendix A", "assumed"
    rows = [
        ["Sides of the fixed hexagon, in turn", f"{mm(m.long_side)}, {mm(m.short_side)}", thesis],
        ["Equal angles of the hexagon", "120°", "as interpreted here: the drawing is missing"],
        ["Fixed platform over the work table", mm(m.base_height), thesis],
        [
            "Joint centres beside and above the tool tip",
            f"{mm(m.joint_radius)}, {mm(m.joint_height)}",
            thesis,
        ],
        [
            "Two legs to a joint centre (“6 x 3 type”)",
            "facing the short sides",
            "as interpreted here: facing the long sides the condition number is 2.31 to 2.59",
        ],
        ["A long side along x", "", "as interpreted here"],
        ["Height of the tool tip", mm(LEVEL), "sections 2.2 and 6.2"],
        [
            "Reach of figures 3 to 5",
            f"±{1e3 * REACH:g} mm, ±{degrees(TILT):g}°",
            "read from the figures",
        ],
        [
            "Stiffness of a leg along its line",
            f"{significant((m.leg_stiffness or np.inf) / 1e6)} N/µm",
            "assumed: the k_i of the MIT-SS-1's struts; the thesis prints none",
        ],
        ["Platforms, joints across the legs", "rigid, without play", ours],
        ["Bending and twist of the legs, friction, weight", "none", ours],
        ["Joint ranges", "none", "the thesis prints none"],
    ]
    return Chapter(
        "assumptions",
        "Assumptions and their sources",
        (
            Text(f"The thesis: {get(NAME).paper.citation}"),
            assumed("Dimensions and properties", rows),
        ),
    )


def _settings(study: HexapodStudy) -> dict[str, Any]:
    return {
        "machine": NAME,
        "poses of a stiffness map": str(study.stiffness.sizes["pose"]),
        "poses of the manipulability": str(study.ellipsoids["position_condition"].size),
        "drives": "held by the legs' stiffness",
        "stiffness along an axis": "1/C_ii, other directions free to follow",
    }


def _content(study: HexapodStudy) -> dict[str, Any]:
    return {
        "parameters": parameters(study.machine),
        "mobility": study.mobility.mobility,
        "redundant_constraints": study.mobility.redundant,
        "falls": {name: [f.to_dict() for f in some] for name, some in study.falls.items()},
        "manipulability": [r.to_dict() for r in manipulability_rows(study.ellipsoids)],
    }
