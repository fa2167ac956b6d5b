"""What the machine can do, in at most eight sentences with a number each, and its picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import StrutworkError
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.model import Model
from strutwork.machines.model_poses import at_pose
from strutwork.msa import compliance_budget
from strutwork.names import listed
from strutwork.reports.chapters import (
    accuracy,
    singularities,
    workspace_assembly,
    workspace_size,
    workspace_stiffness,
    workspace_vibration,
)
from strutwork.reports.content import Answer, Answers, Block, Figure
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.figures.model import marked_view
from strutwork.reports.numbers import count, share, significant
from strutwork.reports.part_groups import PartGroup, part_groups
from strutwork.reports.subject import Subject
from strutwork.reports.survey_words import Extreme, largest, least
from strutwork.reports.vibration_study import VibrationStudy
from strutwork.studies.tolerance_result import ToleranceStudy

Array = NDArray[Any]

#: A part that is made stiffer by this share is what the cover speaks of.
STIFFER = 0.1
#: Stiffness that is not worth a word, N/m: the tool does not give way there.
STIFF = 1e15
HOME = "home"
FREE = "with the other directions free to follow"


@dataclass(frozen=True)
class Softest:
    """Where the tool gives way most, and what does.

    Parameters
    ----------
    model : Model
        Standing there.
    axis : str
    where : str
        The pose in words; "home" where no other was looked at.
    groups : tuple of PartGroup
        By their share of the tool's displacement under a force along the axis.
    """

    model: Model
    axis: str
    where: str
    groups: tuple[PartGroup, ...]

    @property
    def part(self) -> PartGroup:
        """What gives way most."""
        return self.groups[0]


def cover_blocks(
    subject: Subject, more: Sequence[Answer] = ()
) -> tuple[tuple[Block, ...], tuple[DataFile, ...]]:
    """Sentences, the machine where it is softest, and the file beside it.

    Parameters
    ----------
    subject : Subject
    more : sequence of Answer
        Sentences of chapters that the subject does not write.
    """
    worst = _worst(subject)
    found = softest(subject, worst)
    sentences = [
        *_stiffness(subject, worst, found),
        *_vibration(subject),
        *more,
        *_assembly(subject),
        *_reach(subject),
    ]
    sentences.sort(key=lambda s: not s.alarm)
    blocks: list[Block] = [Answers(tuple(sentences))] if sentences else []
    if found is None:
        return tuple(blocks), ()
    name = "cover-softest.csv"
    blocks.append(
        Figure(
            "cover-softest",
            f"The machine at {found.where}, where it is softest, along {found.axis}. Red: "
            f"{found.part.label}, which deform{found.part.ending} most. Drag to rotate, scroll to "
            "zoom.",
            marked_view(found.model, found.part.members),
            "Three-dimensional drawing of the machine with the part that deforms most in red.",
            name,
            height=430,
        )
    )
    rows = [(g.kind, "; ".join(g.members), g.share) for g in found.groups]
    what = f"parts' shares of the tool's displacement along {found.axis} at {found.where}"
    return tuple(blocks), (csv_file(name, what, ("kind", "parts", "share"), rows),)


def softest(subject: Subject, worst: list[tuple[str, Extreme]]) -> Softest | None:
    """Of the axes, the softest at the softest pose of the workspace; else at home.

    Parameters
    ----------
    subject : Subject
    worst : list of (axis, Extreme)
        Softest poses of the workspace; empty where none was looked at.
    """
    home = _home(subject)
    if home is None:
        return None
    model, where = subject.model, HOME
    axis = DIRECTIONS[int(np.argmin(home))]
    if worst:
        axis, extreme = min(worst, key=lambda item: item[1].value)
        try:
            model, where = at_pose(subject.model, extreme.task), extreme.where
        except StrutworkError:
            # a survey goes pose by pose from its neighbours, one step from home may not arrive
            axis = DIRECTIONS[int(np.argmin(home))]
    budget = compliance_budget(model.placed, np.eye(6)[DIRECTIONS.index(axis)])
    groups = part_groups(budget.to_dict())
    return Softest(model, axis, where, groups) if groups else None


def _home(subject: Subject) -> Array | None:
    """Stiffness along x, y, z at home, N/m; None where the tool gives nowhere way."""
    solution = subject.solution
    if solution is None or solution.compliance is None:
        return None
    diagonal = np.diag(solution.compliance)[:3]
    with np.errstate(divide="ignore"):
        free = np.where(diagonal > 0, 1.0 / diagonal, np.inf)
    return free if np.min(free) < STIFF else None


def _worst(subject: Subject) -> list[tuple[str, Extreme]]:
    """The softest pose along each of x, y, z that has one; N/µm."""
    if workspace_stiffness.missing(subject):
        return []
    found, worst = subject.stiffness_survey, []
    for direction in "xyz":
        values = found["stiffness_free"].sel(direction=direction).to_numpy() / 1e6
        values = np.where(np.isfinite(values), values, np.nan)
        if np.isfinite(values).any():
            worst.append((direction, least(found, values)))
    return worst


def _stiffness(
    subject: Subject, worst: list[tuple[str, Extreme]], found: Softest | None
) -> tuple[Answer, ...]:
    home = _home(subject)
    if home is None:
        return ()
    moves = [(axis, k) for axis, k in zip("xyz", home, strict=True) if k < STIFF]
    numbers = listed([significant(k / 1e6) for _, k in moves])
    axes = listed([axis for axis, _ in moves])
    said = [
        Answer(
            f"At home the stiffness of the tool{subject.model.relative} is ",
            f"{numbers} N/µm",
            f" along {axes}, {FREE}.",
            "tool",
        )
    ]
    if worst:
        numbers = listed([significant(e.value) for _, e in worst])
        along = listed([axis for axis, _ in worst])
        places = [e.where for _, e in worst]
        where = places[0] if len(set(places)) == 1 else listed(places, ";")
        after = f" along {along}, at {where}."
        key = workspace_stiffness.KEY
        said.append(
            Answer("In its workspace the stiffness falls to ", f"{numbers} N/µm", after, key)
        )
    if found is not None:
        amount = found.part.share
        # of its compliance the part keeps 1/1.1
        gain = 1.0 / (1.0 - amount * (1.0 - 1.0 / (1.0 + STIFFER))) - 1.0
        there = "At home" if found.where == HOME else "Where it is softest,"
        said.append(
            Answer(
                (
                    f"{there} {found.part.label} deform{found.part.ending} most and "
                    f"cause{found.part.ending} "
                ),
                share(amount),
                f" of the displacement along {found.axis}. Stiffened by {100 * STIFFER:.0f} %, "
                f"{found.part.pronoun} the tool about {share(gain)} stiffer.",
                "budget",
            )
        )
    return tuple(said)


def _vibration(subject: Subject) -> tuple[Answer, ...]:
    if not subject.vibrates:
        return ()
    lowest = least_stiff = "."
    if not workspace_vibration.missing(subject):
        found = subject.vibration_survey
        low = least(found, found["natural_frequency"].to_numpy()[..., 0])
        lowest = f"; in the workspace it falls to {significant(low.value)} Hz, at {low.where}."
        values = found["least_dynamic_stiffness"].to_numpy() / 1e6
        worst = [least(found, values[..., k]) for k in range(3)]
        k = int(np.argmin([w.value for w in worst]))
        least_stiff = (
            f"; in the workspace it falls to {significant(worst[k].value)} N/µm along "
            f"{'xyz'[k]}, at {worst[k].where}."
        )
    return vibration_answers(subject.vibration, lowest, least_stiff)


def vibration_answers(
    study: VibrationStudy,
    lowest: str = ".",
    least_stiff: str = ".",
    given: str = "",
    link: str = "vibration",
) -> tuple[Answer, ...]:
    """Lowest frequency and least dynamic stiffness at home.

    Parameters
    ----------
    study : VibrationStudy
    lowest, least_stiff : str
        How the two sentences end.
    given : str
        What they hold for, as in "With calibrated masses".
    link : str
        Key of the chapter that says more.
    """
    its, said = f"{given}, its" if given else "Its", []
    if len(study.modes.frequencies):
        number = f"{significant(float(study.modes.frequencies[0]))} Hz"
        said.append(Answer(f"{its} lowest natural frequency at home is ", number, lowest, link))
    known = [(dip.value, axis, dip) for axis, dip in zip("xyz", study.least, strict=False)]
    if known:
        value, axis, dip = min(known, key=lambda item: item[0])
        number = f"{significant(1e-6 * value)} N/µm"
        after = f" along {axis}, at {significant(dip.frequency)} Hz{least_stiff}"
        said.append(Answer(f"{its} least dynamic stiffness at home is ", number, after, link))
    return tuple(said)


def _assembly(subject: Subject) -> tuple[Answer, ...]:
    said = []
    if subject.model.tolerances:
        said.append(_locked(subject))
    if not accuracy.missing(subject):
        moved = _displaced(subject)
        said += [moved] if moved is not None else []
    return tuple(said)


def _locked(subject: Subject) -> Answer:
    if not subject.check.mobility.redundant:
        return Answer(
            "Manufacturing errors lock in ",
            "no force",
            ": no constraint is redundant, so they only move the tool.",
            "tolerances",
        )
    return locked_answer(subject.tolerances.study)


def locked_answer(study: ToleranceStudy, link: str = "tolerances", ending: str = ".") -> Answer:
    """The force that manufacturing errors lock in: nearest to its limit, else the largest.

    Parameters
    ----------
    study : ToleranceStudy
        Of a machine that is constrained more than once.
    link : str
        Key of the chapter that says more.
    ending : str
        How the sentence ends.
    """
    used = study.utilisation
    top = int(np.argmax(used))
    if used[top] <= 0:
        forces = [i for i, q in enumerate(study.quantities) if q.unit == "N"]
        if not forces:
            return Answer("Manufacturing errors lock in ", "moments only", ending, link)
        top = max(forces, key=lambda i: float(study.largest[i]))
    quantity = study.quantities[top]
    after = f": {quantity.name} in the worst case; no limit is given{ending}"
    if used[top] > 0:
        limit = f"{significant(float(study.limit[top]))} {quantity.unit}"
        beyond = "more than" if used[top] > 1 else f"{share(float(used[top]))} of"
        after = f": {quantity.name} in the worst case, {beyond} its limit of {limit}{ending}"
    number = f"{significant(float(study.largest[top]))} {quantity.unit}"
    return Answer("Manufacturing errors lock in up to ", number, after, link, bool(used[top] > 1))


def _displaced(subject: Subject) -> Answer | None:
    if not subject.model.tolerances:
        return None
    study = subject.tolerances.study
    moves = [i for i, q in enumerate(study.quantities) if q.joint is None and q.unit == "m"]
    if not moves:
        return None
    top = max(moves, key=lambda i: float(study.largest[i]))
    number = f"{significant(1e6 * float(study.largest[top]))} µm"
    after = f" along {study.quantities[top].directions[0]} at home"
    if not workspace_assembly.missing(subject):
        found = subject.assembly_survey
        names = [str(q) for q in found["quantity"].to_numpy()]
        some = [i for i, n in enumerate(names) if n.startswith("tool displacement")]
        values = 1e6 * found["worst_case"].to_numpy()[..., some].max(axis=-1)
        if np.isfinite(values).any():
            most = largest(found, values)
            after += f" and by up to {significant(most.value)} µm in the workspace, at {most.where}"
    what = f"Manufacturing errors displace the tool{subject.model.relative} by up to "
    return Answer(what, number, f"{after}.", accuracy.KEY)


def _reach(subject: Subject) -> tuple[Answer, ...]:
    if subject.model.workspace is None or workspace_stiffness.missing(subject):
        return ()
    found = subject.stiffness_survey
    kept, asked = int(found.attrs["poses_kept"]), int(found.attrs["poses"])
    after = " poses of its stated workspace"
    if not singularities.missing(subject):
        plane = subject.singular_plane
        inner = [] if plane is None else [c for c in plane.curves if not c.border]
        if plane is not None:
            many = (
                f"{count(len(inner), 'curve')} of singular poses" if inner else "no singular pose"
            )
            verb = ("crosses" if len(inner) == 1 else "cross") if inner else "lies in"
            after += f"; {many} {verb} the plane of its first two directions"
    key = workspace_stiffness.KEY if workspace_size.missing(subject) else workspace_size.KEY
    return (Answer("The machine reaches ", f"{kept} of {asked}", f"{after}.", key),)


def answers_by_chapter(blocks: tuple[Block, ...]) -> dict[str, str]:
    """Sentences of the cover by the key of the chapter that says more."""
    by: dict[str, list[str]] = {}
    for block in blocks:
        if isinstance(block, Answers):
            for item in block.items:
                by.setdefault(item.link, []).append(item.sentence)
    return {key: " ".join(sentences) for key, sentences in by.items()}
