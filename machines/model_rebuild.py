"""A model anew from tables of which some changed: what they leave alone is taken over."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Joint, Linkage
from strutwork.machines.described_process import process_of
from strutwork.machines.limits import joint_limits
from strutwork.machines.model import Model
from strutwork.machines.model_builder import build_model, warn_of_unjoined
from strutwork.machines.model_cases import load_cases
from strutwork.machines.model_flexures import flexures_of, joint_flexures, stiffness_rows
from strutwork.machines.model_motion_tables import drives_of, home_values, workspace_of
from strutwork.machines.model_parts import beams_of, damping_of, joint_of, masses_of, springs_of
from strutwork.machines.model_placement import home_placement
from strutwork.machines.model_schema import JointTable, ModelTable
from strutwork.machines.model_servos import servos_of
from strutwork.machines.model_tolerances import model_tolerances
from strutwork.msa import Structure
from strutwork.msa.variant_of import elsewhere, share_topology

if TYPE_CHECKING:
    from strutwork.flexures import Flexure

#: Tables whose numbers leave the bodies and the joints' free, locked and elastic directions alone.
LIGHT = frozenset(
    {
        *(
            "nodes",
            "title",
            "gravity",
            "preload",
            "materials",
            "sections",
            "beams",
            "bodies",
            "masses",
        ),
        *("joints", "springs", "loads", "line_loads", "settlements", "misfits", "tolerances"),
        "flexures",
        *("force_limits", "workspace", "drives", "servos", "damping", "process"),
    }
)

#: Of a joint, what its stiffness, damping or limits state, and where it points.
_OF_FORCE = frozenset({"stiffness", "damping", "limits", "matrix"})
_AXES = frozenset({"axis", "second_axis"})

_ELASTIC = frozenset({"materials", "sections", "beams"})
#: What masses are made from: the centre of a body's stands relative to its first node.
_HEAVY = frozenset({"bodies", "masses", "nodes"})
_OF_FLEXURES = frozenset({"flexures", "materials", "joints"})
_CASES = frozenset({"gravity", "loads", "line_loads", "settlements", "misfits"})
_TOLERANCES = frozenset({"tolerances", "force_limits"})


def rebuilt_model(
    model: Model, before: ModelTable, after: ModelTable, folder: Path = Path()
) -> Model:
    """The model of tables that differ in numbers from those of another model.

    Where nodes, axes, the set of elastic directions and the division of beams stay, so do the
    placement and how the machine moves: nothing is closed or factorised again. Where only nodes and
    axes are elsewhere, the machine is placed anew, and keeps its bodies and what depends on these.

    Parameters
    ----------
    model : Model
        Of `before`.
    before, after : ModelTable
        What is the same object in both has not changed.
    folder : Path
        Where names of solids' and shapes' files begin.

    Raises
    ------
    ModelError
        As `strutwork.machines.model_builder.build_model`; a geometry that does not close.
    """
    differ = frozenset(
        name
        for name in ModelTable.model_fields
        if getattr(before, name) is not getattr(after, name)
    )
    if not differ:
        return model
    flexures = _flexures(model, before, after) if differ & _OF_FLEXURES else model.flexures
    bent = {name for name, flexure in flexures.items() if flexure is not model.flexures[name]}
    joints = _joints(model, before, after, flexures) if bent or "joints" in differ else ()
    if not differ <= LIGHT or joints is None or _reshaped(before, after, differ):
        return build_model(after, folder)
    moved = _moved(before, after)
    if moved and (after.solids or after.shapes):
        # meshes stand at nodes
        return build_model(after, folder)
    linkage = _linkage(model.structure.linkage, joints)
    own = linkage.joints[: len(model.joints)]
    supports = {
        node: linkage.joints[linkage.joint_index[name]] for node, name in model.supports.items()
    }
    structure = model.structure
    new: dict[str, Any] = {}
    masses = masses_of(after) if differ & _HEAVY else structure.masses
    if joints or differ & (_ELASTIC | {"springs"}) or masses != structure.masses:
        new["structure"] = Structure(
            linkage,
            beams_of(after) if differ & _ELASTIC else structure.beams,
            springs_of(after) if "springs" in differ else structure.springs,
            structure.rigid,
            masses,
            structure.elements,
        )
        share_topology(new["structure"], structure)
    elif moved:
        new["structure"] = elsewhere(structure)
    if moved:
        home = home_values(after, own)
        new["placement"] = home_placement(after, tuple(supports), home)
    if joints:
        new |= {"limits": joint_limits(linkage), "flexures": flexures}
    new |= _stated(model, after, differ, own, supports)
    made = replace(model, **new)
    if moved:
        # what a model that is built verifies of its geometry
        _ = made.placed
        if made.task:
            made.motion.require_task(made.task)
        warn_of_unjoined(made)
        return made
    # without a motion it cannot be moved either, and says why when it is asked to
    with suppress(ModelError):
        # a frozen dataclass keeps what it has derived in its __dict__, as cached_property does
        made.__dict__["motion"] = model.motion.with_joints_of(linkage)
    if "structure" in new:
        # lengths and orientations of beams: now, not at the first solve
        _ = made.placed
    else:
        made.__dict__["placed"] = model.placed
    return made


def _stated(
    model: Model,
    after: ModelTable,
    differ: frozenset[str],
    own: tuple[Joint, ...],
    supports: Mapping[str, Joint],
) -> dict[str, Any]:
    """What the tables that differ state beside the structure."""
    new: dict[str, Any] = {}
    linkage = model.structure.linkage
    if differ & _CASES:
        follows = {(linkage.joints[t.joint].name, DIRECTIONS[t.direction]) for t in linkage.ties}
        new["cases"] = load_cases(after, own, supports, follows)
    if differ & _TOLERANCES:
        toleranced = model_tolerances(after, own, supports)
        new |= {
            "tolerances": toleranced.tolerances,
            "tolerance_costs": toleranced.costs,
            "force_limits": toleranced.limits,
        }
    if "workspace" in differ:
        new["workspace"] = workspace_of(after, model.task)
    if "drives" in differ:
        new["drives"] = drives_of(after, {j.name: j for j in own})
    if "servos" in differ:
        new["servos"] = servos_of(after.servos, {j.name: j for j in own})
    if "damping" in differ:
        new["damping"] = damping_of(after)
    if "process" in differ:
        new["process"] = process_of(after.process)
    return new


def _flexures(model: Model, before: ModelTable, after: ModelTable) -> dict[str, Flexure]:
    """The flexures of joints, those as before where neither size nor material changed."""
    found = joint_flexures(after, flexures_of(after))
    of = {table.name: table.flexure or "" for table in after.joints}

    def same(name: str) -> bool:
        old, new = before.flexures.get(of[name]), after.flexures[of[name]]
        return old is new and before.materials[new.material] is after.materials[new.material]

    kept = {name: model.flexures[name] for name in found if name in model.flexures and same(name)}
    return found | kept


def _joints(
    model: Model, before: ModelTable, after: ModelTable, flexures: Mapping[str, Flexure]
) -> tuple[Joint, ...] | None:
    """The joints anew, None where one locks, frees or turns otherwise than before."""
    made = list(model.structure.linkage.joints)
    for i, (old, new) in enumerate(zip(before.joints, after.joints, strict=True)):
        if old is new and flexures.get(new.name) is model.flexures.get(new.name):
            continue
        if any(
            getattr(old, name) != getattr(new, name)
            for name in JointTable.model_fields
            if name not in _OF_FORCE | _AXES
        ):
            return None
        if new.bearing is not None:
            # its stiffness stands in a catalogue
            return None
        joint = joint_of(new, matrix=stiffness_rows(new, flexures))
        if joint.states != made[i].states:
            return None
        made[i] = joint
    return tuple(made)


def _moved(before: ModelTable, after: ModelTable) -> bool:
    """Whether a node or the axes of a joint are elsewhere."""
    return before.nodes is not after.nodes or any(
        getattr(old, name) != getattr(new, name)
        for old, new in zip(before.joints, after.joints, strict=True)
        if old is not new
        for name in _AXES
    )


def _linkage(linkage: Linkage, joints: tuple[Joint, ...]) -> Linkage:
    return replace(linkage, joints=joints) if joints else linkage


def _reshaped(before: ModelTable, after: ModelTable, differ: frozenset[str]) -> bool:
    """Whether beams are divided otherwise, or a solid is of another material."""
    if "beams" in differ and any(
        old.elements != new.elements for old, new in zip(before.beams, after.beams, strict=True)
    ):
        return True
    changed = {n for n, m in after.materials.items() if m is not before.materials[n]}
    used = {name for s in after.solids for name in (s.material, *(s.materials or {}).values())}
    return bool(changed & used)
