"""Load cases from the tables of a model file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Joint, State
from strutwork.machines.model_parts import by_direction, unknown
from strutwork.machines.model_schema import ModelTable
from strutwork.msa import LineLoad, LoadCase
from strutwork.msa.loads import Vector, Wrench

#: Case that the table `gravity` makes.
GRAVITY_CASE = "gravity"


@dataclass
class _Draft:
    """A load case while it is collected."""

    gravity: Vector | None = None
    wrenches: list[tuple[str, Wrench]] = field(default_factory=list)
    lines: list[LineLoad] = field(default_factory=list)
    gaps: dict[tuple[str, str], float] = field(default_factory=dict)


def load_cases(
    tables: ModelTable,
    joints: Sequence[Joint],
    supports: Mapping[str, Joint],
    follows: AbstractSet[tuple[str, str]] = frozenset(),
) -> tuple[LoadCase, ...]:
    """Load cases in the order in which the file names them, gravity first.

    Parameters
    ----------
    tables : ModelTable
    joints : sequence of Joint
        Those of the file.
    supports : mapping of node to Joint
    follows : set of (joint, direction)
        Coordinates that follow others: they are held, and a coupling may be out by a misfit.

    Returns
    -------
    tuple of LoadCase

    Raises
    ------
    ModelError
        An unknown part, a load without force or moment, a settlement of a direction that is
        not fixed, a misfit in a free direction, or two of either in one direction and case.
    """
    drafts: dict[str, _Draft] = {}
    if tables.gravity is not None:
        drafts[GRAVITY_CASE] = _Draft(tables.gravity)
    for i, load in enumerate(tables.loads):
        if load.force is None and load.moment is None:
            raise ModelError(f"loads[{i}]", "has neither force nor moment.", "Give one of them.")
        force, moment = load.force or (0.0,) * 3, load.moment or (0.0,) * 3
        drafts.setdefault(load.case, _Draft()).wrenches.append((load.node, (*force, *moment)))
    beams = {beam.name: beam for beam in tables.beams}
    for i, line in enumerate(tables.line_loads):
        if line.beam not in beams:
            raise unknown(f"line_loads[{i}]", "beam", line.beam, beams)
        drafts.setdefault(line.case, _Draft()).lines.append(
            LineLoad(line.beam, line.force, line.force_to or line.force)
        )
    for i, settlement in enumerate(tables.settlements):
        part = f"settlements[{i}]"
        if settlement.node not in supports:
            raise ModelError(
                part, f'node "{settlement.node}" has no support.', "Add a support to the node."
            )
        draft = drafts.setdefault(settlement.case, _Draft())
        moved = by_direction(settlement.displacement)
        _add_gaps(draft, part, settlement.case, supports[settlement.node], moved)
    known = {joint.name: joint for joint in joints}
    for i, misfit in enumerate(tables.misfits):
        if misfit.joint not in known:
            raise unknown(f"misfits[{i}]", "joint", misfit.joint, known)
        draft = drafts.setdefault(misfit.case, _Draft())
        _add_gaps(
            draft,
            f"misfits[{i}]",
            misfit.case,
            known[misfit.joint],
            by_direction(misfit.gap),
            follows,
        )
    return tuple(
        LoadCase(name, tuple(d.wrenches), tuple(d.lines), d.gravity, d.gaps)
        for name, d in drafts.items()
    )


def _add_gaps(
    draft: _Draft,
    part: str,
    case: str,
    joint: Joint,
    values: Mapping[str, float],
    follows: AbstractSet[tuple[str, str]] = frozenset(),
) -> None:
    if not values:
        raise ModelError(part, "names no direction.", 'Name one, as in { z = "30 um" }.')
    for direction, value in values.items():
        free = joint.states[DIRECTIONS.index(direction)] == State.FREE
        if free and (joint.name, direction) not in follows:
            raise ModelError(
                part,
                f"{joint.name} is free in {direction}: nothing can be displaced by a known amount "
                "there.",
                "Name a locked or elastic direction.",
            )
        if (joint.name, direction) in draft.gaps:
            raise ModelError(
                part,
                f'{joint.name} has a second value in {direction} in case "{case}".',
                "Give each direction one value in a case.",
            )
        draft.gaps[joint.name, direction] = value
