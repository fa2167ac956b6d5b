"""Makes the elimination program of a structure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import State, characteristic_length
from strutwork.msa.assembly import System
from strutwork.msa.elimination import elimination_order, elimination_tape, ints, symbolic_factor
from strutwork.msa.loops import LARGEST_ROWS, Loop, closed_loops
from strutwork.msa.program import Program
from strutwork.msa.program_loops import (
    Following,
    following,
    loop_program,
    spread_program,
)
from strutwork.msa.structure import PlacedStructure, Structure
from strutwork.msa.topology import Topology

Array = NDArray[Any]

#: Coordinates that move the first and the second end of a part: 1 where it does.
Touch = dict[int, tuple[int, int]]


@dataclass(frozen=True)
class _Coordinate:
    joint: int
    direction: int
    sign: float
    node: int


def compile_program(system: System) -> Program | None:
    """Program of a structure with a tool; None where the kernel does not apply.

    The kernel takes beams, joints, springs and closed loops of any of them; structures with
    elements of other kinds and very large ones go to the other solvers. Which coordinates of a
    loop follow from the others is chosen on the poses of `system`.

    Parameters
    ----------
    system : System
        At the poses on which the dependent coordinates are chosen.
    """
    topology = system.topology
    structure, forest = topology.structure, topology.forest
    linkage = structure.linkage
    if linkage.tool is None or structure.elements or forest.count == 0:
        return None
    if linkage.ties:
        # the row of a coordinate that follows another holds two at once, the kernel's hold one
        return None
    if any(linkage.joints[j].couples for j in forest.tree_joints):
        # a coordinate of the tree has one stiffness, which no other coordinate shares
        return None
    coordinates, of_vertex = _coordinates(topology)
    tool_node = structure.mesh_index[linkage.tool]
    of_tool = of_vertex.get(int(structure.vertex_of_node[tool_node]), [])
    of_work = of_vertex.get(structure.workpiece_vertex, [])
    # a coordinate that carries both moves them as one, about whatever point
    moves = [c for c in of_tool if c not in of_work] + [c for c in of_work if c not in of_tool]
    sign = np.array([1.0 if c in of_tool else -1.0 for c in moves])
    closing = _closing_touches(topology, of_vertex)
    loops: tuple[Loop, ...] = ()
    turns = np.array([c.direction >= 3 for c in coordinates])
    length = characteristic_length(system.placed[:256].placement)
    scale = np.where(turns, 1.0 / length, 1.0)
    if closing:
        if system.poses == 0 or topology.size * len(system.row_owner[0]) > LARGEST_ROWS:
            return None
        loops = closed_loops({j: list(t) for j, t in closing.items()}, system, length, scale, moves)
    follows = following(loops)
    frames = body_frames(system.placed)
    links = _links(topology, frames)
    touches = _touches(structure, of_vertex, links)
    order = _order(len(coordinates), follows, [*touches], moves)
    position = np.argsort(order)
    coordinates, scale = [coordinates[i] for i in order], scale[order]
    touches = [_placed(t, position) for t in touches]
    loops = tuple(
        Loop(
            loop.joints,
            tuple(sorted(int(position[c]) for c in loop.dependent)),
            tuple(sorted(int(position[c]) for c in loop.independent)),
        )
        for loop in loops
    )
    follows = following(loops)
    moved = position[ints(moves)]
    sign = sign[np.argsort(moved)]
    moves = sorted(int(c) for c in moved)
    reached = [follows.reached(t) for t in touches]
    count = len(coordinates) - len(follows)
    pattern = {(i, i) for i in range(count)}
    for group in (*reached, *(follows.reached([d]) for d in follows)):
        pattern |= {(i, j) for i in group for j in group if i >= j}
    factor = symbolic_factor(count, pattern)
    if factor is None:
        return None
    entries = sorted(pattern, key=lambda e: (e[1], e[0]))
    slot = {entry: k for k, entry in enumerate(entries)}
    fill, column_start, column_row, column_slot, update_start, update, slots = elimination_tape(
        factor, entries
    )
    elastic = {
        k: float(linkage.joints[c.joint].stiffness_matrix[c.direction, c.direction])
        for k, c in enumerate(coordinates)
        if c.joint >= 0 and linkage.states()[c.joint, c.direction] == State.ELASTIC
    }
    springs = [(slot[k, k], k, value) for k, value in elastic.items() if k < count]
    segments = structure.segments
    pairs = [[slot[i, j] for i in group for j in group if j <= i] for group in reached]
    return Program(
        axis_joint=ints([c.joint for c in coordinates]),
        axis_direction=ints([c.direction % 3 for c in coordinates]),
        axis_sign=np.array([c.sign for c in coordinates]),
        turns=ints([c.direction >= 3 for c in coordinates]),
        pivot_node=ints([c.node for c in coordinates]),
        item_nodes=ints(segments[:, 1:]),
        item_beam=ints(segments[:, 0]),
        item_offsets=element_offsets(structure),
        properties=np.array([b.properties for b in structure.beams]).reshape(-1, 6),
        turn_frame=ints([frames.get(b.nodes[0], -1) for b in structure.beams]),
        orientation=np.array(
            [
                b.orientation if isinstance(b.orientation, tuple) else (np.nan,) * 3
                for b in structure.beams
            ]
        ).reshape(-1, 3),
        orientation_joint=ints(
            [
                linkage.joint_index[b.orientation] if isinstance(b.orientation, str) else -1
                for b in structure.beams
            ]
        ),
        link_nodes=ints([nodes for nodes, _, _ in links]).reshape(-1, 2),
        link_joint=ints([joint for _, joint, _ in links]),
        link_stiffness=np.array([k for _, _, k in links], dtype=float).reshape(-1, 6, 6),
        touch_start=ints(np.cumsum([0, *(len(t) for t in touches)])),
        touch_coordinate=ints([c for t in touches for c in t]),
        touch_ends=ints([e for t in touches for e in t.values()]).reshape(-1, 2),
        pair_start=ints(np.cumsum([0, *(len(p) for p in pairs)])),
        pair_slot=ints([s for p in pairs for s in p]),
        spring_slot=ints([s for s, _, _ in springs]),
        spring_coordinate=ints([k for _, k, _ in springs]),
        spring_value=np.array([v for _, _, v in springs], dtype=float),
        diagonal=ints([slot[k, k] for k in range(count)]),
        fill=fill,
        column_start=column_start,
        column_row=column_row,
        column_slot=column_slot,
        update_start=update_start,
        update=update,
        entry_row=ints([i for i, _ in entries]),
        entry_column=ints([j for _, j in entries]),
        slots=slots,
        tool_node=tool_node,
        tool_moves=ints(moves),
        tool_sign=sign,
        tool_touches=ints(follows.reached(moves)),
        loops=loop_program(
            topology,
            loops,
            {j: _placed(t, position) for j, t in closing.items()},
            scale,
            length,
        ),
        spread=spread_program(follows, touches, reached, slot, elastic, moves),
    )


def _placed(touch: Touch, position: NDArray[np.intp]) -> Touch:
    """The touch with its coordinates at their places in the elimination."""
    return dict(sorted((int(position[c]), ends) for c, ends in touch.items()))


def _order(count: int, follows: Following, touches: list[Touch], moves: list[int]) -> list[int]:
    """Independent coordinates in the order of their elimination, then dependent ones."""
    free = [c for c in range(count) if c not in follows]
    place = {c: i for i, c in enumerate(free)}
    groups = [*(follows.reached(t) for t in touches), *(follows.reached([d]) for d in follows)]
    order = elimination_order(
        len(free),
        [[place[c] for c in group] for group in groups],
        [place[c] for c in follows.reached(moves)],
    )
    return [*(free[i] for i in order), *sorted(follows)]


def _closing_touches(topology: Topology, of_vertex: dict[int, list[int]]) -> dict[int, Touch]:
    """Coordinates that move the sides of each closing joint against one another."""
    structure = topology.structure
    index, joints = structure.linkage.node_index, structure.linkage.joints
    found = {}
    for j in topology.forest.closing:
        pair = tuple(index[n] for n in joints[j].between)
        (touch,) = _ends_moved(structure, of_vertex, [(pair[0], pair[1])])
        # what carries both sides of a joint does not move them apart
        found[j] = {c: ends for c, ends in touch.items() if ends != (1, 1)}
    return found


def element_offsets(structure: Structure) -> Array:
    """From the mesh nodes of every beam element to its ends, (e, 2, 3), m.

    Parameters
    ----------
    structure : Structure
    """
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


def body_frames(placed: PlacedStructure) -> dict[str, int]:
    """Frame of each node's body behind those of the joints; none where bodies carry no axes.

    Parameters
    ----------
    placed : PlacedStructure
    """
    linkage = placed.structure.linkage
    if placed.placement.turns is None:
        return {}
    owner = linkage.body_of_node
    first = len(linkage.joints)
    return {n: first + int(b) for n, b in zip(linkage.nodes, owner, strict=True) if b >= 0}


def _links(topology: Topology, frames: dict[str, int]) -> list[tuple[tuple[int, int], int, Array]]:
    """Springs and elastic joints that carry nothing: nodes, frame of the axes, stiffness."""
    structure = topology.structure
    linkage = structure.linkage
    index = linkage.node_index
    found: list[tuple[tuple[int, int], int, Array]] = []
    for spring in structure.springs:
        nodes = [index[n] for n in spring.nodes]
        pair = (nodes[0], nodes[1]) if len(nodes) == 2 else (-1, nodes[0])
        axes = frames.get(spring.nodes[0], -1) if len(nodes) == 2 else -1
        found.append((pair, axes, np.diag(spring.diagonal)))
    for j in topology.elastic_joints:
        if j not in topology.forest.tree_joints:
            first, second = (index[n] for n in linkage.joints[j].between)
            found.append(((first, second), j, linkage.joints[j].stiffness_matrix))
    return found


def _touches(
    structure: Structure,
    of_vertex: dict[int, list[int]],
    links: list[tuple[tuple[int, int], int, Array]],
) -> list[Touch]:
    """For each beam element and link the coordinates that move its first and second end."""
    pairs = [(int(a), int(b)) for _, a, b in structure.segments] + [nodes for nodes, _, _ in links]
    return _ends_moved(structure, of_vertex, pairs)


def _ends_moved(
    structure: Structure, of_vertex: dict[int, list[int]], pairs: list[tuple[int, int]]
) -> list[Touch]:
    result = []
    for nodes in pairs:
        ends = [
            set(of_vertex.get(int(structure.vertex_of_node[n]), []) if n >= 0 else [])
            for n in nodes
        ]
        result.append(
            {c: (int(c in ends[0]), int(c in ends[1])) for c in sorted(ends[0] | ends[1])}
        )
    return result
