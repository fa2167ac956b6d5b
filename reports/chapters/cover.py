"""What the machine can do, in one sentence and a number each."""

from __future__ import annotations

import numpy as np

from strutwork.kinematics import DIRECTIONS
from strutwork.msa import compliance_budget
from strutwork.reports.chapters import (
    workspace_assembly,
    workspace_stiffness,
    workspace_vibration,
)
from strutwork.reports.content import Fact
from strutwork.reports.numbers import share, significant
from strutwork.reports.subject import Subject
from strutwork.reports.survey_words import Extreme, least


def cover_facts(subject: Subject) -> tuple[Fact, ...]:
    """Stiffness at home and at worst, what gives way, vibration, what locks in."""
    return (
        *_stiffness(subject),
        *_vibration(subject),
        *_assembly(subject),
    )


def _stiffness(subject: Subject) -> tuple[Fact, ...]:
    solution = subject.solution
    if solution is None or solution.compliance is None:
        return ()
    diagonal = np.diag(solution.compliance)[:3]
    soft = int(np.argmax(diagonal))
    if diagonal[soft] <= 0:
        return ()
    axis = DIRECTIONS[soft]
    facts = [
        Fact(
            "Softest at home",
            significant(1e-6 / float(diagonal[soft])),
            "N/µm",
            f"along {axis}, other directions free",
            "tool",
        )
    ]
    budget = compliance_budget(subject.model.placed, np.eye(6)[soft])
    shares = budget.shares.reshape(-1)
    if shares.size:
        first = int(np.argmax(shares))
        facts.append(
            Fact(
                "Gives way most",
                share(float(shares[first])),
                "",
                f"{budget.parts[first]}, under a force along {axis} at home",
                "budget",
            )
        )
    if not workspace_stiffness.missing(subject):
        found = subject.stiffness_survey
        poses = [_softest(subject, d) for d in "xyz"]
        known = [(e.value, d, e) for d, e in zip("xyz", poses, strict=True) if e is not None]
        if known:
            value, axis, extreme = min(known, key=lambda item: item[0])
            facts.append(
                Fact(
                    "Softest in the workspace",
                    significant(value),
                    "N/µm",
                    f"along {axis}, at {extreme.where}",
                    workspace_stiffness.KEY,
                )
            )
        kept, all_ = int(found.attrs["poses_kept"]), int(found.attrs["poses"])
        facts.append(
            Fact(
                "Workspace reached",
                share(kept / all_),
                "",
                f"{kept} of {all_} poses asked for",
                "motion",
            )
        )
    return tuple(facts)


def _softest(subject: Subject, direction: str) -> Extreme | None:
    found = subject.stiffness_survey
    values = found["stiffness_free"].sel(direction=direction).to_numpy() / 1e6
    values = np.where(np.isfinite(values), values, np.nan)
    return least(found, values) if np.isfinite(values).any() else None


def _vibration(subject: Subject) -> tuple[Fact, ...]:
    if not subject.vibrates:
        return ()
    study = subject.vibration
    facts = []
    if len(study.modes.frequencies):
        facts.append(
            Fact(
                "Lowest frequency at home",
                significant(float(study.modes.frequencies[0])),
                "Hz",
                "first natural frequency that strains something",
                "vibration",
            )
        )
    known = [(least.value, axis, least) for axis, least in zip("xyz", study.least, strict=False)]
    if known:
        value, axis, where = min(known, key=lambda item: item[0])
        facts.append(
            Fact(
                "Least dynamic stiffness at home",
                significant(1e-6 * value),
                "N/µm",
                f"along {axis}, at {significant(where.frequency)} Hz",
                "vibration",
            )
        )
    if not workspace_vibration.missing(subject):
        found = subject.vibration_survey
        values = found["least_dynamic_stiffness"].to_numpy() / 1e6
        worst = [least(found, values[..., k]) for k in range(3)]
        k = int(np.argmin([w.value for w in worst]))
        facts.append(
            Fact(
                "Least dynamic stiffness in the workspace",
                significant(worst[k].value),
                "N/µm",
                f"along {'xyz'[k]}, at {worst[k].where}",
                workspace_vibration.KEY,
            )
        )
    return tuple(facts)


def _assembly(subject: Subject) -> tuple[Fact, ...]:
    if not subject.model.tolerances:
        return ()
    study = subject.tolerances.study
    facts = []
    forces = [i for i, q in enumerate(study.quantities) if q.unit == "N"]
    if forces:
        top = max(forces, key=lambda i: float(study.largest[i]))
        value = float(study.largest[top])
        redundant = subject.check.mobility.redundant
        what = (
            f"worst case of the {study.quantities[top].name}"
            if redundant
            else "no constraint is redundant: errors move the tool and lock nothing in"
        )
        facts.append(
            Fact(
                "Errors lock in",
                significant(value) if redundant else "0",
                "N",
                what,
                "tolerances",
            )
        )
    moves = [i for i, q in enumerate(study.quantities) if q.joint is None and q.unit == "m"]
    if moves:
        top = max(moves, key=lambda i: float(study.largest[i]))
        facts.append(
            Fact(
                "Errors move the tool",
                significant(1e6 * float(study.largest[top])),
                "µm",
                f"worst case along {study.quantities[top].directions[0]} at home",
                "tolerances",
            )
        )
    if not workspace_assembly.missing(subject) and moves:
        found = subject.assembly_survey
        names = [str(q) for q in found["quantity"].to_numpy()]
        some = [i for i, n in enumerate(names) if n.startswith("tool displacement")]
        values = 1e6 * found["worst_case"].to_numpy()[..., some]
        facts.append(
            Fact(
                "Errors move the tool at most",
                significant(float(np.nanmax(values))),
                "µm",
                "along one axis, anywhere in the workspace",
                workspace_assembly.KEY,
            )
        )
    return tuple(facts)
