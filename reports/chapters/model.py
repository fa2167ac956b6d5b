"""A model file: what it is, how it stands, whether it can move."""

from __future__ import annotations

import numpy as np

from strutwork.machines.model import Model
from strutwork.msa import axis_stiffness_blocked, axis_stiffness_free
from strutwork.names import listed
from strutwork.reports.alike import grouped
from strutwork.reports.content import (
    Block,
    Chapter,
    Column,
    Details,
    Fact,
    Facts,
    Figure,
    Table,
    Text,
)
from strutwork.reports.data_files import json_file
from strutwork.reports.figures.model import model_view
from strutwork.reports.freedom_words import freedom_words, joint_words
from strutwork.reports.model_check import ModelCheck
from strutwork.reports.model_solution import ModelSolution
from strutwork.reports.numbers import MINUS, clean, count, significant

#: Rows of motions and self-stress states a reader is shown; the file has all.
SHOWN = 12


def summary_chapter(model: Model, check: ModelCheck, solution: ModelSolution | None) -> Chapter:
    """The structure in a sentence and its headline numbers."""
    structure, found = model.structure, check.mobility
    parts = [
        count(len(model.nodes), "node"),
        count(len(structure.beams), "beam"),
        count(len(model.solids), "solid"),
        count(len(model.joints), "joint"),
        count(len(structure.springs), "spring"),
        count(len(model.supports), "supported node"),
        count(len(model.cases), "load case"),
    ]
    present = [part for part in parts if not part.startswith("0 ")]
    where = "in one configuration" if model.workspace is None else "at home"
    text = f"A structure of {listed(present)}, {where}."
    facts = [
        Fact("Degrees of freedom", str(check.degrees_of_freedom), "", "of the flexible structure"),
        Fact(
            "Mobility",
            str(found.mobility),
            "",
            f"of the rigid linkage; {found.mobility_locked} with the drives held",
        ),
        Fact("Redundant constraints", str(found.redundant), "", "with the drives held"),
    ]
    if check.mass is not None and check.mass.total:
        facts.append(Fact("Mass", significant(check.mass.total), "kg"))
    if solution is not None and solution.compliance is not None:
        free = axis_stiffness_free(solution.compliance)
        blocked = axis_stiffness_blocked(solution.compliance)
        for i, axis in enumerate("xyz"):
            held = significant(blocked[i] / 1e6) + (" N/µm" if np.isfinite(blocked[i]) else "")
            value, unit = significant(free[i] / 1e6), "N/µm"
            if not np.isfinite(free[i]):
                value, unit = "does not move", ""
            detail = f"the other directions follow; with them blocked: {held}"
            facts.append(Fact(f"Tool stiffness along {axis}", value, unit, detail))
    return Chapter("summary", "Summary", (Text(text), Facts(tuple(facts))))


def structure_chapter(model: Model) -> Chapter:
    """The structure in 3-D."""
    linkage = model.structure.linkage
    drawing = {
        "unit": "m",
        "nodes": dict(zip(linkage.nodes, model.placement.positions.tolist(), strict=True)),
        "beams": {b.name: list(b.nodes) for b in model.structure.beams},
        "solids": {
            s.name: {
                "nodes": list(s.tied),
                "inside": list(s.monitors),
                "materials": list(s.materials),
                "surface": {
                    "points": s.points_at(model.placed).tolist(),
                    "triangles": s.triangles.tolist(),
                },
            }
            for s in model.solids
        },
        "bodies": {b.name: list(b.nodes) for b in (*model.structure.rigid, *linkage.bodies)},
        "joints": {
            joint.name: {
                "type": joint.type,
                "between": list(joint.between),
                "driven": list(joint.driven),
                "axes_as_columns": frame.tolist(),
            }
            for joint, frame in zip(linkage.joints, model.placement.frames, strict=True)
        },
        "springs": {s.name: list(s.nodes) for s in model.structure.springs},
        "tool": model.tool,
    }
    figure = Figure(
        "structure-drawing",
        "The structure as the file describes it, in mm. Drag to rotate, scroll to zoom; names "
        "appear under the pointer. Joint symbols are not to scale.",
        model_view(model),
        f"Three-dimensional drawing of the structure with {count(len(linkage.joints), 'joint')} "
        "marked by type.",
        "drawing.json",
        height=560,
    )
    file = json_file("drawing.json", "what the drawing shows: nodes, parts and joint axes", drawing)
    return Chapter("structure", "The structure", (figure,), (file,))


def check_chapter(check: ModelCheck) -> Chapter:
    """Mobility, redundancy, mechanisms and states of self-stress of the rigidified linkage."""
    found, model = check.mobility, check.model
    blocks: list[Block] = [Text(_counted(check)), Text(_weight(check))]
    for when, motions in (
        ("With the drives held", found.motions),
        ("With the drives free", found.driven_motions),
    ):
        if motions:
            lines = [[str(i), joint_words(m)] for i, m in enumerate(motions[:SHOWN], 1)]
            columns = (Column("motion", "", False), Column("joints that move", "", False))
            table = Table(f"{when}: joints that move", columns, lines, "check.json")
            blocks += [
                Text(f"{when} {freedom_words(model, motions)}."),
                Details(f"The joints of {count(len(motions), 'motion')}", (table,)),
            ]
    if found.self_stress:
        many = count(len(found.self_stress), "independent state")
        lines = [
            [str(i), listed([g.label for g in grouped(dict.fromkeys(s.joints, ()))], ";")]
            for i, s in enumerate(found.self_stress[:SHOWN], 1)
        ]
        columns = (Column("state", "", False), Column("joints involved", "", False))
        blocks += [
            Text(
                f"There {'is' if len(found.self_stress) == 1 else 'are'} {many} of self-stress: "
                "redundant constraints let manufacturing errors lock forces into these joints; "
                "without redundancy there would be none."
            ),
            Details(
                "The joints of the states of self-stress",
                (Table("States of self-stress", columns, lines, "check.json"),),
            ),
        ]
    file = json_file("check.json", "mobility, redundancy, motions and mass, SI", check.to_dict())
    return Chapter("check", "Mobility and redundancy", tuple(blocks), (file,))


def _counted(check: ModelCheck) -> str:
    found = check.mobility
    gruebler = str(found.gruebler).replace("-", MINUS)
    many = "no" if not found.redundant else str(found.redundant)
    verb = "constraint is" if found.redundant < 2 else "constraints are"
    return (
        f"Its mobility is {found.mobility} with the drives free and {found.mobility_locked} with "
        f"them held; {many} {verb} redundant with the drives held. Grübler's count, which ignores "
        f"the geometry, gives {gruebler} with the drives free. The flexible structure has "
        f"{check.degrees_of_freedom} degrees of freedom. For the mobility, every beam, solid, "
        "body and elastic joint counts as rigid and springs to ground as absent; the rank of the "
        "constraints decides, not a count."
    )


def _weight(check: ModelCheck) -> str:
    if check.mass is None:
        return "Its mass is not known: a density is missing."
    text = f"Its mass is {significant(check.mass.total, 4)} kg"
    if check.mass.center is not None:
        middle = clean([1e3 * v for v in check.mass.center], 4)
        text += f", with the centre at x, y, z = {middle} mm"
    return f"{text}."
