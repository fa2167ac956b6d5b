"""From the tables of a model file to a structure, its placement and its load cases."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, GROUND, Body, Joint, Linkage
from strutwork.kinematics.coupling import ties_of
from strutwork.machines.described_process import process_of
from strutwork.machines.limits import joint_limits
from strutwork.machines.model import Model, ModelWarning
from strutwork.machines.model_cases import load_cases
from strutwork.machines.model_checks import check_tables, ground_name, support_name
from strutwork.machines.model_couplings import couplings_of
from strutwork.machines.model_flexures import flexures_of, joint_flexures, stiffness_rows
from strutwork.machines.model_motion_tables import (
    drives_of,
    home_values,
    task_of,
    workspace_of,
)
from strutwork.machines.model_parts import (
    Borne,
    beams_of,
    damping_of,
    joint_of,
    masses_of,
    springs_of,
)
from strutwork.machines.model_placement import home_placement
from strutwork.machines.model_schema import ModelTable
from strutwork.msa import Beam, Structure
from strutwork.msa.unjoined import in_words, unjoined_nodes

if TYPE_CHECKING:
    from strutwork.kinematics.mesh_shapes import MeshShape
    from strutwork.machines.bearing_entry import BearingEntry
    from strutwork.machines.model_solid_element import SolidElement
    from strutwork.machines.servos import Servo
    from strutwork.overconstraint.tolerance import Tolerance


def build_model(tables: ModelTable, folder: Path = Path()) -> Model:
    """Build the structure that the tables describe.

    Rigid bodies, beams and solids that share nodes are one body of the linkage. A supported node
    is joined to a ground node of its own, at the same place, by a joint in global axes.

    Parameters
    ----------
    tables : ModelTable
    folder : Path
        Where names of solids' and shapes' files begin.

    Returns
    -------
    Model

    Raises
    ------
    ModelError
        Names the part that is wrong.
    """
    check_tables(tables)
    flexures = joint_flexures(tables, flexures_of(tables))
    bearings, borne = _bearings(tables, folder)
    joints = tuple(
        joint_of(table, borne.get(table.name), stiffness_rows(table, flexures))
        for table in tables.joints
    )
    couplings = couplings_of(tables)
    follows = {
        (joints[tie.joint].name, DIRECTIONS[tie.direction])
        for tie in ties_of(joints, {joint.name: j for j, joint in enumerate(joints)}, couplings)
    }
    home = home_values(tables, joints)
    task = task_of(tables)
    supports = _supports(tables)
    nodes = tuple(tables.nodes)
    grounds = tuple(joint.between[0] for joint in supports.values())
    beams, springs, masses = beams_of(tables), springs_of(tables), masses_of(tables)
    cases = load_cases(tables, joints, supports, follows)
    tolerances, costs, limits = _tolerances(tables, joints, supports)
    # last, for a solid may take minutes
    solids = _solids(tables, folder)
    monitors = {
        node: place
        for solid in solids
        for node, place in zip(solid.nodes, solid.positions, strict=True)
        if node not in solid.tied
    }
    bodies, rigid = _bodies(tables, beams, solids)
    if grounds:
        bodies = (*bodies, Body(GROUND, grounds))
    linkage = Linkage(
        nodes=(*nodes, *monitors, *grounds),
        bodies=bodies,
        joints=(*joints, *supports.values()),
        tool=None if tables.tool is None else tables.tool.tcp,
        couplings=couplings,
        against=None if tables.tool is None else tables.tool.against,
    )
    structure = Structure(linkage, beams, springs, rigid, masses, solids)
    _ = structure.workpiece_vertex  # a workpiece that moves with the tool is an error now
    placement = home_placement(tables, tuple(supports), home, list(monitors.values()))
    model = Model(
        title=tables.title,
        structure=structure,
        placement=placement,
        cases=cases,
        nodes=nodes,
        joints=tuple(joint.name for joint in joints),
        supports={node: joint.name for node, joint in supports.items()},
        damping=damping_of(tables),
        process=process_of(tables.process),
        tolerances=tolerances,
        tolerance_costs=costs,
        force_limits=limits,
        solids=solids,
        preload=tables.preload,
        limits=joint_limits(linkage),
        task=task,
        workspace=workspace_of(tables, task),
        drives=drives_of(tables, {j.name: j for j in joints}),
        servos=_servos(tables, joints),
        shapes=_shapes(tables, folder, linkage, list(placement.positions)),
        flexures=flexures,
        bearings=bearings,
    )
    if model.preload is not None:
        model.case(model.preload)
    # coincidence of joint nodes, lengths and orientations of beams: now, not at the first solve
    _ = model.placed
    if task:
        model.motion.require_task(task)
    warn_of_unjoined(model)
    return model


def warn_of_unjoined(model: Model) -> None:
    """Warn of ends that meet under two names; a tool may stand at a workpiece's place.

    Parameters
    ----------
    model : Model
    """
    for group in unjoined_nodes(model.placed):
        if model.tool not in group:
            warnings.warn(
                f"{in_words(model.placed, group)}. If they meet, give them one node or a joint.",
                ModelWarning,
                stacklevel=4,
            )


def _bearings(tables: ModelTable, folder: Path) -> tuple[dict[str, BearingEntry], dict[str, Borne]]:
    """The bearings of joints, and what they make of their stiffness, by joint."""
    if not (tables.bearings or tables.catalogue or any(t.bearing for t in tables.joints)):
        return {}, {}
    # only such files wait for the contacts
    from strutwork.machines.bearing_catalogue import (  # noqa: PLC0415
        borne_stiffness,
        joint_bearings,
    )

    found = joint_bearings(tables, folder)
    named = {t.name: t for t in tables.joints}
    return found, {name: borne_stiffness(named[name], entry) for name, entry in found.items()}


def _tolerances(
    tables: ModelTable, joints: Sequence[Joint], supports: Mapping[str, Joint]
) -> tuple[tuple[Tolerance, ...], Mapping[str, float], Mapping[tuple[str, str], float]]:
    if not (tables.tolerances or tables.force_limits):
        return (), {}, {}
    # only such files wait for what assembly forces are computed with
    from strutwork.machines.model_tolerances import model_tolerances  # noqa: PLC0415

    made = model_tolerances(tables, joints, supports)
    return made.tolerances, made.costs, made.limits


def _servos(tables: ModelTable, joints: Sequence[Joint]) -> tuple[Servo, ...]:
    if not tables.servos:
        return ()
    # few files have controllers
    from strutwork.machines.model_servos import servos_of  # noqa: PLC0415

    return servos_of(tables.servos, {j.name: j for j in joints})


def _solids(tables: ModelTable, folder: Path) -> tuple[SolidElement, ...]:
    if not tables.solids:
        return ()
    # meshes and SfePy take longer to load than a file without solids to check
    from strutwork.machines.model_solids import solids_of  # noqa: PLC0415

    solids = solids_of(tables, folder)
    for solid in solids:
        for node in solid.monitors:
            if node in tables.nodes:
                raise ModelError(
                    f"node {node}",
                    f"has the name of a node inside the solid {solid.name}.",
                    "Rename the node.",
                )
    return solids


def _shapes(
    tables: ModelTable, folder: Path, linkage: Linkage, positions: Sequence[ArrayLike]
) -> tuple[MeshShape, ...]:
    if not tables.shapes:
        return ()
    # only such files wait for what it imports
    from strutwork.machines.model_shapes import shapes_of  # noqa: PLC0415

    return shapes_of(tables, folder, linkage, dict(zip(linkage.nodes, positions, strict=True)))


def _bodies(
    tables: ModelTable, beams: Sequence[Beam], solids: Sequence[SolidElement]
) -> tuple[tuple[Body, ...], tuple[Body, ...]]:
    """Bodies of the linkage, and the rigid groups inside those that bend."""
    groups = [
        *((t.name, t.nodes) for t in tables.bodies),
        *((b.name, b.nodes) for b in beams),
        *((s.name, s.nodes) for s in solids),
    ]
    known = dict.fromkeys((*tables.nodes, *(n for s in solids for n in s.nodes)))
    piece = {node: node for node in known}

    def root(node: str) -> str:
        while piece[node] != node:
            piece[node] = piece[piece[node]]
            node = piece[node]
        return node

    for _, members in groups:
        for node in members[1:]:
            piece[root(node)] = root(members[0])
    parts: dict[str, list[str]] = {}
    for name, members in groups:
        parts.setdefault(root(members[0]), []).append(name)
    nodes: dict[str, list[str]] = {}
    for node in known:
        nodes.setdefault(root(node), []).append(node)
    taken = {GROUND}
    bodies = []
    for key, names in parts.items():
        name = names[0] if len(names) == 1 else f"{names[0]} and {len(names) - 1} more"
        while name in taken:
            name += "'"
        taken.add(name)
        bodies.append(Body(name, tuple(nodes[key])))
    bending = {root(b.nodes[0]) for b in beams} | {root(s.nodes[0]) for s in solids}
    rigid = tuple(Body(t.name, t.nodes) for t in tables.bodies if root(t.nodes[0]) in bending)
    return tuple(bodies), rigid


def _supports(tables: ModelTable) -> dict[str, Joint]:
    """The joint that holds each supported node, several tables of one node merged."""
    fixed: dict[str, list[str]] = {}
    for table in tables.supports:
        if not table.fixed:
            raise ModelError(
                f"support of node {table.node}", "fixes no direction.", 'Name some, or use "all".'
            )
        for direction in table.fixed:
            if direction in fixed.setdefault(table.node, []):
                raise ModelError(
                    f"support of node {table.node}",
                    f"fixes {direction} twice: supports in conflict.",
                    "Fix each direction of a node once.",
                )
            fixed[table.node].append(direction)
    return {
        node: Joint(
            support_name(node),
            "support",
            (ground_name(node), node),
            locks=tuple(d for d in DIRECTIONS if d in held),
        )
        for node, held in fixed.items()
    }
