"""The elimination program of a topology: which joint coordinate meets which, in what order.

Made once per structure and free of coordinates: the compiled kernel (`msa.kernel`) runs it on
many poses at a time. Joint coordinates of the spanning forest are the unknowns; those that
move the tool come last, so that eliminating the others condenses each leg to the tool.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics import State
from msa.structure import Structure
from msa.topology import Topology

Array = NDArray[Any]
Ints = NDArray[np.int64]

#: Longest list of multiplications that the kernel takes; larger structures are solved sparse.
LARGEST = 20_000_000


class Program(NamedTuple):
    """Integer arrays and constants of one topology, as the kernel reads them.

    Parameters
    ----------
    axis_joint, axis_direction : (c,)
        Joint and axis 0-2 of every coordinate; joint −1 means a global axis.
    axis_sign : (c,)
    turns : (c,)
        1 where the coordinate is a rotation.
    pivot_node : (c,)
        Mesh node about which it rotates.
    item_nodes : (e, 2)
        Mesh nodes of the beam elements.
    item_beam : (e,)
    item_offsets : (e, 2, 3)
        From the nodes to the element's ends, m.
    properties : (b, 6)
        As `Beam.properties`.
    orientation : (b, 3)
        NaN for the default.
    orientation_joint : (b,)
        Joint whose z axis is taken, or −1.
    link_nodes : (l, 2)
        Mesh nodes of the springs and elastic joints that carry nothing, −1 for ground.
    link_joint : (l,)
        Joint in whose axes the stiffness is given, or −1 for global axes.
    link_stiffness : (l, 6, 6)
    touch_start : (e + l + 1,)
        Range of each element's touches, beams before links.
    touch_coordinate : (t,)
    touch_ends : (t, 2)
        1 where the coordinate moves the first, the second end.
    pair_start : (e + l + 1,)
    pair_slot : (q,)
        Slot of K for each pair i ≥ j of an element's touches, row by row.
    spring_slot, spring_value
        Stiffness of elastic joint coordinates.
    diagonal : (c,)
        Slot of each coordinate's diagonal entry.
    fill : (k,)
        Slot in the factor of every slot of K.
    column_start : (c + 1,), column_row, column_slot : (l,)
        Factor by columns below the diagonal.
    update_start : (c + 1,), update : (u, 3)
        target −= first · second, by eliminated column.
    entry_row, entry_column : (k,)
        Coordinates of every slot of K.
    slots : int
        Entries of the factor.
    tool_node : int
    tool_touches : (g,)
        Coordinates that move the tool.
    """

    axis_joint: Ints
    axis_direction: Ints
    axis_sign: Array
    turns: Ints
    pivot_node: Ints
    item_nodes: Ints
    item_beam: Ints
    item_offsets: Array
    properties: Array
    orientation: Array
    orientation_joint: Ints
    link_nodes: Ints
    link_joint: Ints
    link_stiffness: Array
    touch_start: Ints
    touch_coordinate: Ints
    touch_ends: Ints
    pair_start: Ints
    pair_slot: Ints
    spring_slot: Ints
    spring_value: Array
    diagonal: Ints
    fill: Ints
    column_start: Ints
    column_row: Ints
    column_slot: Ints
    update_start: Ints
    update: Ints
    entry_row: Ints
    entry_column: Ints
    slots: int
    tool_node: int
    tool_touches: Ints


@dataclass(frozen=True)
class _Coordinate:
    joint: int
    direction: int
    sign: float
    node: int


def compile_program(topology: Topology) -> Program | None:
    """Program of a topology with a tool; None where the kernel does not apply.

    The kernel takes beams, joints and springs; structures with a joint that closes a rigid
    loop, with elements of other kinds, and very large ones go to the other solvers.
    """
    structure = topology.structure
    forest = topology.forest
    linkage = structure.linkage
    if linkage.tool is None or forest.closing or structure.elements or forest.count == 0:
        return None
    coordinates, of_vertex = _coordinates(topology)
    vertex = structure.vertex_of_node
    tool_node = structure.mesh_index[linkage.tool]
    at_tool = of_vertex.get(int(vertex[tool_node]), [])
    links = _links(topology)
    touches = _touches(structure, of_vertex, links)
    order = _elimination_order(len(coordinates), [list(t) for t in touches], at_tool)
    position = np.argsort(order)
    coordinates = [coordinates[i] for i in order]
    touches = [dict(sorted((int(position[c]), ends) for c, ends in t.items())) for t in touches]
    pattern = {(i, i) for i in range(len(coordinates))}
    for touch in touches:
        pattern |= {(i, j) for i in touch for j in touch if i >= j}
    factor = _symbolic(len(coordinates), pattern)
    if factor is None:
        return None
    entries = sorted(pattern, key=lambda e: (e[1], e[0]))
    slot = {entry: k for k, entry in enumerate(entries)}
    fill, column_start, column_row, column_slot, update_start, update, slots = _tape(
        factor, entries
    )
    springs = [
        (slot[k, k], linkage.joints[c.joint].stiffness_matrix[c.direction, c.direction])
        for k, c in enumerate(coordinates)
        if c.joint >= 0 and linkage.states()[c.joint, c.direction] == State.ELASTIC
    ]
    segments = structure.segments
    counts = np.cumsum([0, *(len(t) for t in touches)])
    pairs = [[slot[i, j] for i in t for j in t if j <= i] for t in touches]
    return Program(
        axis_joint=_ints([c.joint for c in coordinates]),
        axis_direction=_ints([c.direction % 3 for c in coordinates]),
        axis_sign=np.array([c.sign for c in coordinates]),
        turns=_ints([c.direction >= 3 for c in coordinates]),
        pivot_node=_ints([c.node for c in coordinates]),
        item_nodes=_ints(segments[:, 1:]),
        item_beam=_ints(segments[:, 0]),
        item_offsets=_offsets(structure),
        properties=np.array([b.properties for b in structure.beams]).reshape(-1, 6),
        orientation=np.array(
            [
                b.orientation if isinstance(b.orientation, tuple) else (np.nan,) * 3
                for b in structure.beams
            ]
        ).reshape(-1, 3),
        orientation_joint=_ints(
            [
                linkage.joint_index[b.orientation] if isinstance(b.orientation, str) else -1
                for b in structure.beams
            ]
        ),
        link_nodes=_ints([nodes for nodes, _, _ in links]).reshape(-1, 2),
        link_joint=_ints([joint for _, joint, _ in links]),
        link_stiffness=np.array([k for _, _, k in links], dtype=float).reshape(-1, 6, 6),
        touch_start=_ints(counts),
        touch_coordinate=_ints([c for t in touches for c in t]),
        touch_ends=_ints([e for t in touches for e in t.values()]).reshape(-1, 2),
        pair_start=_ints(np.cumsum([0, *(len(p) for p in pairs)])),
        pair_slot=_ints([s for p in pairs for s in p]),
        spring_slot=_ints([s for s, _ in springs]),
        spring_value=np.array([v for _, v in springs], dtype=float),
        diagonal=_ints([slot[k, k] for k in range(len(coordinates))]),
        fill=fill,
        column_start=column_start,
        column_row=column_row,
        column_slot=column_slot,
        update_start=update_start,
        update=update,
        entry_row=_ints([i for i, _ in entries]),
        entry_column=_ints([j for _, j in entries]),
        slots=slots,
        tool_node=tool_node,
        tool_touches=_ints(sorted(int(position[c]) for c in at_tool)),
    )


def _ints(values: Any) -> Ints:
    return np.ascontiguousarray(values, dtype=np.int64)


def _offsets(structure: Structure) -> Array:
    offsets = np.zeros((len(structure.segments), 2, 3))
    for k, (beam, first, second) in enumerate(structure.segments):
        names = (structure.mesh_nodes[first], structure.mesh_nodes[second])
        for end in (0, 1):
            if names[end] == structure.beams[beam].nodes[end]:
                offsets[k, end] = structure.beams[beam].offsets[end]
    return offsets


def _coordinates(topology: Topology) -> tuple[list[_Coordinate], dict[int, list[int]]]:
    """Coordinates of the forest, and for each cluster those that move it."""
    structure = topology.structure
    linkage = structure.linkage
    found: list[_Coordinate] = []
    of_vertex: dict[int, list[int]] = {}
    for step in topology.forest.steps:
        inherited = list(of_vertex.get(step.parent, []))
        first = len(found)
        if step.joint < 0:
            node = int(structure.reference_nodes[step.vertex])
            found += [_Coordinate(-1, d, 1.0, node) for d in range(6)]
        else:
            joint = linkage.joints[step.joint]
            node = linkage.node_index[joint.between[1 if step.sign > 0 else 0]]
            found += [_Coordinate(step.joint, d, step.sign, node) for d in step.free]
        of_vertex[step.vertex] = [*inherited, *range(first, len(found))]
    return found, of_vertex


def _links(topology: Topology) -> list[tuple[tuple[int, int], int, Array]]:
    """Springs and elastic joints that carry nothing: nodes, joint of the axes, stiffness."""
    structure = topology.structure
    linkage = structure.linkage
    index = linkage.node_index
    found: list[tuple[tuple[int, int], int, Array]] = []
    for spring in structure.springs:
        nodes = [index[n] for n in spring.nodes]
        pair = (nodes[0], nodes[1]) if len(nodes) == 2 else (-1, nodes[0])
        found.append((pair, -1, np.diag(spring.diagonal)))
    for j in topology.elastic_joints:
        if j not in topology.forest.tree_joints:
            first, second = (index[n] for n in linkage.joints[j].between)
            found.append(((first, second), j, linkage.joints[j].stiffness_matrix))
    return found


def _touches(
    structure: Structure,
    of_vertex: dict[int, list[int]],
    links: list[tuple[tuple[int, int], int, Array]],
) -> list[dict[int, tuple[int, int]]]:
    """For each beam element and link the coordinates that move its first and second end."""
    result = []
    pairs = [(int(a), int(b)) for _, a, b in structure.segments] + [nodes for nodes, _, _ in links]
    for nodes in pairs:
        ends = [
            set(of_vertex.get(int(structure.vertex_of_node[n]), []) if n >= 0 else [])
            for n in nodes
        ]
        result.append(
            {c: (int(c in ends[0]), int(c in ends[1])) for c in sorted(ends[0] | ends[1])}
        )
    return result


def _elimination_order(count: int, groups: list[list[int]], last: list[int]) -> list[int]:
    """Minimum degree order with the coordinates of `last` at the end."""
    neighbours: list[set[int]] = [set() for _ in range(count)]
    for group in groups:
        for c in group:
            neighbours[c].update(group)
    for c in range(count):
        neighbours[c].discard(c)
    late = set(last)
    remaining = [c for c in range(count) if c not in late]
    order = []
    while remaining:
        c = min(remaining, key=lambda c: len(neighbours[c]))
        remaining.remove(c)
        order.append(c)
        around = neighbours[c]
        for other in around:
            neighbours[other] |= around
            neighbours[other] -= {c, other}
    return order + sorted(late)


def _symbolic(count: int, pattern: set[tuple[int, int]]) -> list[list[int]] | None:
    """Rows below the diagonal of each column of the factor; None where it is too large."""
    columns: list[set[int]] = [set() for _ in range(count)]
    for i, j in pattern:
        if i > j:
            columns[j].add(i)
    work = 0
    for j in range(count):
        if columns[j]:
            parent = min(columns[j])
            columns[parent] |= columns[j] - {parent}
        work += len(columns[j]) ** 2
        if work > LARGEST:
            return None
    return [sorted(column) for column in columns]


def _tape(
    factor: list[list[int]], entries: list[tuple[int, int]]
) -> tuple[Ints, Ints, Ints, Ints, Ints, Ints, int]:
    slot: dict[tuple[int, int], int] = {}
    for j, column in enumerate(factor):
        for i in (j, *column):
            slot[i, j] = len(slot)
    column_row = [i for column in factor for i in column]
    column_slot = [slot[i, j] for j, column in enumerate(factor) for i in column]
    column_start = np.cumsum([0, *(len(column) for column in factor)])
    update = [
        (slot[i, k], slot[i, j], slot[k, j])
        for j, column in enumerate(factor)
        for a, i in enumerate(column)
        for k in column[: a + 1]
    ]
    counts = [len(column) * (len(column) + 1) // 2 for column in factor]
    return (
        _ints([slot[e] for e in entries]),
        _ints(column_start),
        _ints(column_row),
        _ints(column_slot),
        _ints(np.cumsum([0, *counts])),
        _ints(update).reshape(-1, 3),
        len(slot),
    )
