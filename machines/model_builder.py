"""From the tables of a model file to a structure, its placement and its load cases."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, GROUND, Body, Joint, Linkage, Placement, axes_frame
from strutwork.kinematics.coupling import ties_of
from strutwork.kinematics.mesh_shapes import MeshShape
from strutwork.machines.limits import joint_limits
from strutwork.machines.model import Model, ModelWarning
from strutwork.machines.model_cases import load_cases
from strutwork.machines.model_couplings import couplings_of
from strutwork.machines.model_motion_tables import (
    drives_of,
    home_values,
    task_of,
    workspace_of,
)
from strutwork.machines.model_parts import (
    beams_of,
    damping_of,
    joint_of,
    masses_of,
    springs_of,
    unknown,
)
from strutwork.machines.model_schema import ModelTable
from strutwork.machines.model_solid_element import SolidElement
from strutwork.machines.model_tolerances import model_tolerances
from strutwork.msa import Beam, Structure
from strutwork.msa.unjoined import in_words, unjoined_nodes

#: Bounds that keep a file from asking for more memory than any machine has.
MAX_MESH_NODES = 20_000
MAX_JOINTS = 1_000


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
    _check_size(tables)
    _check_names(tables)
    _check_bodies(tables)
    _check_nodes(tables)
    joints = tuple(joint_of(table) for table in tables.joints)
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
    toleranced = model_tolerances(tables, joints, supports)
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
    )
    structure = Structure(linkage, beams, springs, rigid, masses, solids)
    positions = [
        *(tables.nodes[n] for n in nodes),
        *monitors.values(),
        *(tables.nodes[n] for n in supports),
    ]
    frames = [
        *(axes_frame(t.axis, t.second_axis, f"joint {t.name}") for t in tables.joints),
        *(np.eye(3) for _ in supports),
    ]
    placement = Placement(
        np.array(positions, dtype=float).reshape(-1, 3),
        np.array(frames, dtype=float).reshape(-1, 3, 3),
        np.array(list(home.values()), dtype=float),
        tuple(home),
    )
    model = Model(
        title=tables.title,
        structure=structure,
        placement=placement,
        cases=cases,
        nodes=nodes,
        joints=tuple(joint.name for joint in joints),
        supports={node: joint.name for node, joint in supports.items()},
        damping=damping_of(tables),
        tolerances=toleranced.tolerances,
        tolerance_costs=toleranced.costs,
        force_limits=toleranced.limits,
        solids=solids,
        preload=tables.preload,
        limits=joint_limits(linkage),
        task=task,
        workspace=workspace_of(tables, task),
        drives=drives_of(tables, {j.name: j for j in joints}),
        shapes=_shapes(tables, folder, linkage, positions),
    )
    if model.preload is not None:
        model.case(model.preload)
    # coincidence of joint nodes, lengths and orientations of beams: now, not at the first solve
    _ = model.placed
    if task:
        model.motion.require_task(task)
    _warn_of_unjoined(model)
    return model


def _warn_of_unjoined(model: Model) -> None:
    """Ends that meet under two names; a tool may stand at a workpiece's place."""
    for group in unjoined_nodes(model.placed):
        if model.tool not in group:
            warnings.warn(
                f"{in_words(model.placed, group)}. If they meet, give them one node or a joint.",
                ModelWarning,
                stacklevel=4,
            )


def _check_size(tables: ModelTable) -> None:
    if not tables.nodes:
        raise ModelError("nodes", "are none.", "Define the nodes of the structure.")
    mesh = len(tables.nodes) + sum(beam.elements - 1 for beam in tables.beams)
    if mesh > MAX_MESH_NODES:
        raise ModelError(
            "model",
            f"has {mesh} nodes, those inside divided beams counted; at most {MAX_MESH_NODES} are "
            "taken.",
            "Divide beams into fewer elements.",
        )
    count = len(tables.joints) + len(tables.supports)
    if count > MAX_JOINTS:
        raise ModelError(
            "model",
            f"has {count} joints and supports; at most {MAX_JOINTS} are taken.",
            "Split it.",
        )


def _check_names(tables: ModelTable) -> None:
    """Names of one table are unique, and none collides with a name made here."""
    for kind, names in (
        ("beam", [t.name for t in tables.beams]),
        ("solid", [t.name for t in tables.solids]),
        ("body", [t.name for t in tables.bodies]),
        ("joint", [t.name for t in tables.joints]),
        ("spring", [t.name for t in tables.springs if t.name is not None]),
    ):
        repeated = [name for name, count in Counter(names).items() if count > 1]
        if repeated:
            raise ModelError(
                f"{kind} {repeated[0]}", "is defined twice.", f"Give every {kind} its own name."
            )
    for solid in tables.solids:
        if solid.name in {t.name for t in tables.beams}:
            raise ModelError(
                f"solid {solid.name}", "has the name of a beam.", "Rename one of the two."
            )
    supports = {support_name(t.node) for t in tables.supports}
    for joint in tables.joints:
        if joint.name in supports:
            raise ModelError(
                f"joint {joint.name}", "has the name of a support's joint.", "Rename the joint."
            )
    inner = {f"{b.name}/{i}" for b in tables.beams for i in range(1, b.elements)}
    made = inner | {ground_name(t.node) for t in tables.supports}
    for node in tables.nodes:
        if node in made:
            raise ModelError(
                f"node {node}",
                "has the name of a node inside a divided beam or on the ground.",
                "Rename the node.",
            )


def _check_bodies(tables: ModelTable) -> None:
    """Rigid bodies have two nodes or more and share none."""
    owner: dict[str, str] = {}
    for table in tables.bodies:
        if len(set(table.nodes)) < 2:
            raise ModelError(
                f"body {table.name}",
                f"has {len(set(table.nodes))} node{'s' if not table.nodes else ''}.",
                "Give it two nodes at least; a single node needs no body.",
            )
        for node in table.nodes:
            if owner.get(node) == table.name:
                raise ModelError(
                    f"body {table.name}", f'names node "{node}" twice.', "Name it once."
                )
            if node in owner:
                raise ModelError(
                    f"node {node}",
                    f'is in two rigid bodies, "{owner[node]}" and "{table.name}".',
                    "Merge the bodies into one.",
                )
            owner[node] = table.name


def _check_nodes(tables: ModelTable) -> None:
    """Every node that is named exists, and every node that exists is held by something."""
    connecting: list[tuple[str, Sequence[str]]] = [
        *((f"beam {t.name}", (t.from_, t.to)) for t in tables.beams),
        *((f"body {t.name}", t.nodes) for t in tables.bodies),
        *(
            (f"solids.{t.name}.interfaces[{i}].node", (interface.node,))
            for t in tables.solids
            for i, interface in enumerate(t.interfaces)
        ),
        *((f"joint {t.name}", t.between) for t in tables.joints),
        *(
            (f"springs[{i}]", (*(t.between or ()), *((t.node,) if t.node else ())))
            for i, t in enumerate(tables.springs)
        ),
        *((f"support of node {t.node}", (t.node,)) for t in tables.supports),
    ]
    others: list[tuple[str, Sequence[str]]] = [
        *((f"masses[{i}]", (t.node,)) for i, t in enumerate(tables.masses)),
        *((f"loads[{i}]", (t.node,)) for i, t in enumerate(tables.loads)),
        *((f"settlements[{i}]", (t.node,)) for i, t in enumerate(tables.settlements)),
        *(() if tables.tool is None else (("tool", (tables.tool.tcp,)),)),
    ]
    for part, nodes in (*connecting, *others):
        for node in nodes:
            if node not in tables.nodes:
                raise unknown(part, "node", node, tables.nodes)
    held = {node for _, nodes in connecting for node in nodes}
    for node in tables.nodes:
        if node not in held:
            raise ModelError(
                f"node {node}",
                "is disconnected: no beam, body, solid, joint, spring or support has it.",
                "Connect it, or remove it.",
            )


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


def support_name(node: str) -> str:
    """Name of the joint that supports a node.

    Parameters
    ----------
    node : str
    """
    return f"support {node}"


def ground_name(node: str) -> str:
    """Name of the ground node under a supported node.

    Parameters
    ----------
    node : str
    """
    return f"{node} (ground)"


def _supports(tables: ModelTable) -> dict[str, Joint]:
    """The joint that holds each supported node, several tables of one node merged."""
    fixed: dict[str, list[str]] = {}
    for table in tables.supports:
        if not table.fixed:
            raise ModelError(
                f"support of node {table.node}", "fixes no direction.", 'Name some, or say "all".'
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
