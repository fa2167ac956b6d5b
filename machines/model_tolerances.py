"""Tolerances and force limits from the tables of a model file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Joint, State
from strutwork.machines.model_parts import unknown
from strutwork.machines.model_schema import ForceLimitTable, ModelTable, ToleranceTable
from strutwork.overconstraint.joint_forces import JOINT_FORCES
from strutwork.overconstraint.tolerance import Tolerance

#: Key of a force limit by the quantity that it bounds.
LIMIT_KEYS: Mapping[str, str] = {kind: kind.replace(" ", "_") for kind, _, _ in JOINT_FORCES}


@dataclass(frozen=True)
class ModelTolerances:
    """What a model file says of tolerances.

    Parameters
    ----------
    tolerances : tuple of Tolerance
        In the order of the file.
    costs : mapping of tolerance name to float
        Weights of the allocation, any unit; 1 where the file names none.
    limits : mapping of (joint name, kind of quantity) to float
        Greatest forces and moments, N and N·m.
    """

    tolerances: tuple[Tolerance, ...] = ()
    costs: Mapping[str, float] = field(default_factory=dict)
    limits: Mapping[tuple[str, str], float] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"<ModelTolerances: {len(self.tolerances)} tolerances, {len(self.limits)} limits>"


def model_tolerances(
    tables: ModelTable, joints: Sequence[Joint], supports: Mapping[str, Joint]
) -> ModelTolerances:
    """Tolerances and force limits of a file.

    Parameters
    ----------
    tables : ModelTable
    joints : sequence of Joint
        Those of the file.
    supports : mapping of node to Joint

    Raises
    ------
    ModelError
        An unknown joint or datum, a size given twice or not at all, a limit of what a joint
        cannot carry, or two limits of one quantity.
    """
    known = {joint.name: joint for joint in (*joints, *supports.values())}
    named = Counter(table.name for table in tables.tolerances)
    made = []
    for table in tables.tolerances:
        part = f"tolerance {table.name}"
        if named[table.name] > 1:
            raise ModelError(part, "is defined twice.", "Give every tolerance its own name.")
        made.append(tolerance_of(table, known, tables.nodes))
    limits: dict[tuple[str, str], float] = {}
    carried = {joint.name: joint for joint in joints}
    for i, limit in enumerate(tables.force_limits):
        _add_limits(limits, limit, f"force_limits[{i}]", carried)
    costs = {table.name: table.cost for table in tables.tolerances}
    return ModelTolerances(tuple(made), costs, limits)


def tolerance_of(
    table: ToleranceTable, known: Mapping[str, Joint], nodes: Mapping[str, object]
) -> Tolerance:
    """The tolerance of a table.

    Parameters
    ----------
    table : ToleranceTable
    known : mapping of name to Joint
        That it may name.
    nodes : mapping of name to anything
        That may be its datum.

    Raises
    ------
    ModelError
        An unknown joint or datum, or a size given twice or not at all.
    """
    part = f"tolerance {table.name}"
    joints = _named(table, part, known)
    if table.datum is not None and table.datum not in nodes:
        raise unknown(part, "datum", table.datum, nodes)
    return Tolerance(
        name=table.name,
        kind=table.kind,
        joints=joints,
        size=table.size,
        slope=table.slope,
        datum=table.datum,
        axis=table.axis,
        length=table.length,
        width=table.width,
        along=table.along,
        limits=table.limits,
        distribution=table.distribution,
    )


def _named(
    table: ToleranceTable | ForceLimitTable, part: str, known: Mapping[str, Joint]
) -> tuple[str, ...]:
    """The joints of a table, by `joint` or `joints`."""
    if (table.joint is None) == (table.joints is None):
        found = "neither joint nor joints" if table.joint is None else "both joint and joints"
        raise ModelError(part, f"has {found}.", "Name one joint, or several as a list.")
    joints = table.joints if table.joint is None else (table.joint,)
    for name in joints or ():
        if name not in known:
            raise unknown(part, "joint", name, known)
    return joints or ()


def _add_limits(
    limits: dict[tuple[str, str], float],
    table: ForceLimitTable,
    part: str,
    known: Mapping[str, Joint],
) -> None:
    values = {kind: getattr(table, key) for kind, key in LIMIT_KEYS.items()}
    given = {kind: value for kind, value in values.items() if value is not None}
    if table.static_rating is not None:
        if "radial force" in given:
            raise ModelError(
                part, "has both radial_force and static_rating.", "Give the radial limit once."
            )
        given["radial force"] = table.static_rating / table.safety_factor
    elif "safety_factor" in table.model_fields_set:
        raise ModelError(
            part, "has a safety_factor but no static_rating.", "Give the bearing's static rating."
        )
    if not given:
        raise ModelError(
            part,
            "limits nothing.",
            "Give static_rating or one of: " + ", ".join(LIMIT_KEYS.values()) + ".",
        )
    joints = _named(table, part, known)
    if not joints:
        raise ModelError(part, "names no joint.", "Name the joints that it limits.")
    for name in joints:
        carried = carries(known[name])
        for kind, value in given.items():
            if kind not in carried:
                raise ModelError(
                    part,
                    f"limits the {kind} of {name}, which is free and carries no load.",
                    f"It carries: {', '.join(carried) or 'nothing'}.",
                )
            if (name, kind) in limits:
                raise ModelError(
                    part, f"limits the {kind} of {name} a second time.", "Limit it once."
                )
            limits[name, kind] = value


def carries(joint: Joint) -> tuple[str, ...]:
    """Kinds of quantity that a joint can carry.

    Parameters
    ----------
    joint : Joint
    """
    held = {d for d, s in zip(DIRECTIONS, joint.states, strict=True) if s != State.FREE}
    return tuple(kind for kind, directions, _ in JOINT_FORCES if held.intersection(directions))
