"""What the tables of a model file must keep to, verified before anything is built from them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from strutwork.errors import ModelError
from strutwork.machines.model_parts import unknown
from strutwork.machines.model_schema import ModelTable

#: Bounds that keep a file from asking for more memory than any machine has.
MAX_MESH_NODES = 20_000
MAX_JOINTS = 1_000


def check_tables(tables: ModelTable) -> None:
    """Sizes, names, and the nodes that parts name.

    Parameters
    ----------
    tables : ModelTable

    Raises
    ------
    ModelError
        Names the part that is wrong.
    """
    _check_size(tables)
    _check_names(tables)
    _check_bodies(tables)
    _check_nodes(tables)


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


def _check_size(tables: ModelTable) -> None:
    if not tables.nodes:
        raise ModelError("nodes", "are none.", "Define the nodes of the structure.")
    mesh = len(tables.nodes) + sum(beam.elements - 1 for beam in tables.beams)
    if mesh > MAX_MESH_NODES:
        raise ModelError(
            "model",
            f"has {mesh} nodes, those inside divided beams counted; at most {MAX_MESH_NODES} are "
            "allowed.",
            "Divide beams into fewer elements.",
        )
    count = len(tables.joints) + len(tables.supports)
    if count > MAX_JOINTS:
        raise ModelError(
            "model",
            f"has {count} joints and supports; at most {MAX_JOINTS} are allowed.",
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
                "Give it at least two nodes; a single node needs no body.",
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
        *(
            ()
            if tables.tool is None or tables.tool.against is None
            else (("tool.against", (tables.tool.against,)),)
        ),
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
