"""The MIT-SS-1 on its granite: what it consists of, and its stiffness on it."""

from __future__ import annotations

import numpy as np

from strutwork.machines.mit_ss1_frame import MOUNTS
from strutwork.machines.mit_ss1_whole import MitSS1Whole
from strutwork.papers.son_2002.calibrated import CALIBRATED_GRANITE
from strutwork.papers.son_2002.chapters.plane import axes, extremes, plane_file
from strutwork.papers.son_2002.figures.whole_machine import whole_machine_view
from strutwork.papers.son_2002.published import FIGURE_29_TICK, MACHINE, STIFFNESS
from strutwork.papers.son_2002.whole_study import WholeStudy
from strutwork.papers.tables import assumed
from strutwork.reports.content import Block, Column, Fact, Facts, Figure, Points, Row, Table, Text
from strutwork.reports.data_files import DataFile, json_file, netcdf_file
from strutwork.reports.figures.curves import heat
from strutwork.reports.numbers import fixed, micro, significant
from strutwork.studies.variables import AXES

DRAWING_FILE, STIFFNESS_FILE = "drawing-whole-machine.json", "stiffness-calibrated.csv"


def whole_blocks(study: WholeStudy) -> tuple[list[Block], list[DataFile]]:
    """The complete machine in 3-D, its masses and size as a model."""
    whole = study.whole
    weight = study.masses["whole"] - study.masses["moving"]
    blocks: list[Block] = [
        Text(
            "The complete machine is one structure: the granite, a solid, on four elastic "
            "mounts; three rails on its vertical plate; blocks, struts as beams, pins in two "
            "bearings each, and the spindle housing. It can take any pose of the plane; the "
            "granite is reduced once to the footings of its mounts and rails."
        ),
        Facts(
            (
                Fact("Granite", fixed(weight, 0), "kg", "from its dimensions and 3000 kg/m³"),
                Fact(
                    "Moving mass",
                    significant(study.masses["moving"]),
                    "kg",
                    "struts and housing; calibrated, the thesis's 7.1 kg of spindle as 6 % of it "
                    "make 118",
                ),
                Fact(
                    "Granite as a solid",
                    f"{whole.granite.shapes.shape[0]:,}",
                    "",
                    f"degrees of freedom in {whole.frame.mesh.cell_count} quadratic hexahedra, "
                    f"reduced to {6 * len(whole.granite.nodes)}",
                ),
                Fact(
                    "Reduction is accurate to",
                    "400",
                    "Hz",
                    "to 1e-4 of a frequency; retained modes to "
                    f"{significant(whole.granite.cutoff)} Hz",
                ),
            )
        ),
        Figure(
            "drawing-whole-machine",
            "The complete MIT-SS-1 at home. The granite is drawn with the cells of its mesh; "
            "drag to rotate, scroll to zoom, names appear under the pointer. The work table is "
            "omitted.",
            whole_machine_view(whole),
            "Three-dimensional drawing: an L of granite on four mounts, three rails on its plate, "
            "struts, spindle housing and tool before them.",
            DRAWING_FILE,
            640,
        ),
    ]
    return blocks, [
        json_file(DRAWING_FILE, "what the drawing of the entire machine shows", _drawing(whole))
    ]


def _drawing(whole: MitSS1Whole) -> dict[str, object]:
    mesh = whole.frame.mesh
    home = whole.place(whole.home())
    return {
        "unit": "m",
        "nodes": dict(zip(whole.linkage.nodes, home.positions.tolist(), strict=True)),
        "lines": [list(pair) for pair in whole.skeleton()],
        "granite_points": (mesh.points - whole.origin).tolist(),
        "granite_cells": [b.nodes.tolist() for b in mesh.blocks],
        "mounts": {
            j.name: {"between": list(j.between), "stiffness": dict(j.stiffness)}
            for j in whole.linkage.joints
            if j.name.startswith("mount")
        },
    }


def calibrated_blocks(study: WholeStudy) -> tuple[list[Block], list[DataFile]]:
    """Stiffness with the bearings that the modes were calibrated with, and with the granite."""
    found = study.stiffness
    x, b = axes(found)
    held = found["stiffness"].sel(base="rails held")
    figures = []
    for axis in AXES:
        values = held.sel(direction=axis).to_numpy() / 1e6
        marks = extremes(x, b, values)
        figures.append(
            Figure(
                f"stiffness-calibrated-{axis}",
                f"K{axis * 2}, bearings calibrated to the modes, rails held.",
                heat(x, b, values, ("x (mm)", "tilt b (deg)", f"K{axis * 2} (N/µm)"), marks),
                f"Map of the stiffness along {axis} over x and tilt; softest and stiffest pose "
                "marked.",
                STIFFNESS_FILE,
                400,
            )
        )
    blocks: list[Block] = [
        Text(
            "The maps above are for rigid guides and one spring per strut, the structure of eq. "
            "51. The machine whose modes follow has radial and axial bearing stiffness and "
            "masses calibrated to frequencies and to the stiffness at home (see Calibration); "
            "its maps, 1/Cᵢᵢ at the tool tip with other directions free to follow:"
        ),
        Row(tuple(figures), 320),
        _at_home(study),
        Text(
            "On its granite the tool moves relative to the floor mostly because the mounts are "
            "soft; tool and work move together, so the stiffness on held rails acts in a cut, "
            "together with the bending of the granite. The work table is not in the model."
        ),
    ]
    maps = {
        f"K{axis * 2} {base} [N/m]": found["stiffness"].sel(base=base, direction=axis).to_numpy()
        for base in found["base"].to_numpy()
        for axis in AXES
    }
    what = "stiffness of the calibrated machine over x and tilt"
    return blocks, [
        plane_file(STIFFNESS_FILE, what, found, maps),
        netcdf_file("stiffness-calibrated.nc", "the same as a dataset", found),
    ]


def _at_home(study: WholeStudy) -> Table:
    home = study.stiffness["stiffness"].sel(x=0.0, b=0.0, method="nearest")
    rows = [
        [
            f"computed, {base}",
            *(micro(float(home.sel(base=base, direction=axis))) for axis in AXES),
        ]
        for base in map(str, study.stiffness["base"].to_numpy())
    ]
    rows.append(
        [
            "thesis, section 6.2",
            f"not printed; tick {micro(FIGURE_29_TICK)} of Fig. 29-(a)",
            f"{STIFFNESS.value(MACHINE, 'Ky'):g}",
            "not printed",
        ]
    )
    return Table(
        (
            "Stiffness at the tool tip at home; x and y of the thesis are among the targets of "
            "the calibration"
        ),
        (Column("", "", False), *(Column(f"K{axis * 2}", "N/µm") for axis in AXES)),
        rows,
        STIFFNESS_FILE,
    )


def whole_assumptions(whole: MitSS1Whole) -> Points:
    """What the entire machine assumes, with the sources."""
    frame, machine = whole.frame, whole.machine
    mm = 1e3
    mounts = " and ".join(micro(k) for k in whole.mount_stiffness)
    return assumed(
        "The complete machine: granite, mounts, masses; its bearings differ from those above, "
        "which are calibrated to other numbers",
        [
            [
                "Granite: envelope; Young's modulus, density",
                " × ".join(f"{v:g}" for v in frame.envelope) + " m; 78 GPa, 3000 kg/m³",
                "sections 6.1 and 8.1",
            ],
            ["Poisson's ratio of the granite", "0.25", "assumed; the thesis prints none"],
            [
                "Thickness of plate and base",
                ", ".join(f"{mm * v:g} mm" for v in CALIBRATED_GRANITE.values()),
                "calibrated; the thesis prints none",
            ],
            [
                f"The {len(MOUNTS)} mounts, across and down",
                f"{mounts} N/µm each",
                "calibrated to rigid-body modes (section 9.2.2)",
            ],
            [
                "Footings of rails and mounts",
                (
                    f"{mm * frame.rail_width:g} mm wide; {mm * frame.mount_size:g} mm square, "
                    f"{mm * frame.mount_inset:g} mm from the edges"
                ),
                "assumed; mean motion of the footing (RBE3), the blocks' rails rigid",
            ],
            [
                "Plane of the mechanism",
                (
                    f"{mm * whole.offset:g} mm before the plate, origin {mm * whole.height:g} mm "
                    "above the base"
                ),
                "assumed",
            ],
            [
                "Bearings on the housing, radial and axial",
                (
                    f"{micro(machine.radial_stiffness or np.inf)} and "
                    f"{micro(machine.axial_stiffness or np.inf)} N/µm"
                ),
                "calibrated",
            ],
            [
                "Bearings on the blocks, radial and axial",
                (
                    f"{micro(machine.block_radial_stiffness or np.inf)} and "
                    f"{micro(machine.block_axial_stiffness or np.inf)} N/µm"
                ),
                "calibrated",
            ],
            [
                "Housing; each strut",
                (
                    f"{machine.housing_mass:g} kg, {machine.housing_inertia:g} kg m²; "
                    f"{machine.strut_mass:g} kg"
                ),
                "calibrated; housing on its lower bounds",
            ],
            ["Damping of every mode", "1 %", "assumed; the thesis prints none"],
            [
                "Work table; masses of blocks, screws, motors",
                "omitted",
                "not published; the table's own modes lie above 400 Hz (section 9.2.2)",
            ],
        ],
    )
