"""`strutwork check`: mobility, redundancy and mass of a machine."""

from __future__ import annotations

from strutwork.machines.model import Model
from strutwork.reports.cli.manner import MANNER
from strutwork.reports.cli.output import console, print_json, show, table
from strutwork.reports.freedom_words import freedom_sentences
from strutwork.reports.model_check import ModelCheck, check_model


def run(model: Model, json: bool) -> None:
    """Check a machine and print what was found."""
    found = check_model(model)
    if json:
        print_json(found.to_dict())
    else:
        _print(found)


def _print(found: ModelCheck) -> None:
    out, counts = console(), found.mobility
    rows: list[tuple[str, object]] = [
        ("degrees of freedom of the flexible structure", found.degrees_of_freedom),
        ("mobility of the rigid linkage, drives free", counts.mobility),
        ("mobility with the drives held", counts.mobility_locked),
        ("redundant constraints, drives held", counts.redundant),
        ("Grübler's count, drives free", counts.gruebler),
    ]
    if found.surplus_drives:
        rows += [
            ("drives", found.drives),
            ("drives in excess of the freedoms that they move", found.surplus_drives),
        ]
    if found.mass is not None:
        rows.append(("mass, kg", found.mass.total))
        if found.mass.center is not None:
            center = ", ".join(show(round(1e3 * v, 6)) for v in found.mass.center)
            rows.append(("centre of mass, mm", center))
    out.print(table(found.model.title or "Model", ["", ""], rows))
    if found.model.solids:
        heads = ["solid", "mass, kg", "degrees of freedom", "kept", "accurate below, Hz"]
        solids = [
            (s.name, s.weighed[0], s.reduced.shapes.shape[0], 6 * len(s.nodes), s.accurate_to)
            for s in found.model.solids
        ]
        out.print(table("Solids, reduced to their interfaces", heads, solids))
    if found.model.shapes:
        named = ", ".join(
            f"{shape.name} ({len(shape.triangles):,} triangles)" for shape in found.model.shapes
        )
        out.print(f"Shapes that must not interfere: {named}.", soft_wrap=True)
    for title, motions in (
        # those that a model should not have are listed always
        ("Motions left with the drives held", counts.motions),
        ("Motions with the drives free", counts.driven_motions if MANNER.whole else ()),
    ):
        if motions:
            numbered = [(i, motion.description) for i, motion in enumerate(motions, 1)]
            out.print(table(title, ["", "motion"], numbered, names=2))
    if counts.self_stress and MANNER.whole:
        numbered = [(i, ", ".join(s.joints)) for i, s in enumerate(counts.self_stress, 1)]
        out.print(table("States of self-stress", ["", "joints involved"], numbered, names=2))
    out.print(" ".join(freedom_sentences(found)), soft_wrap=True)
    if not MANNER.whole and (counts.driven_motions or counts.self_stress):
        out.print("--verbose lists the joints involved.")
