"""Structures that differ in numbers alone share what their topology decides.

A study varies sections, stiffnesses and places of one machine a thousand times. Which coordinate
meets which, the order of elimination and the clusters of nodes are the same for all of them: they
are made once, for the structure that was changed, and only numbers are put in anew.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from copy import copy
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.msa.program import Program
from strutwork.msa.structure import Structure

Array = NDArray[Any]

#: Derived data of a structure that no number of its parts changes.
_TOPOLOGY = (
    "flexible_bodies",
    "mesh_nodes",
    "mesh_index",
    "segments",
    "vertex_of_node",
    "reference_nodes",
)

_ORIGIN, _POSES, _PROGRAMS = "_origin", "_expected_poses", "_study_programs"
_TOPOLOGY_OF = "_topology"

#: Programs by the name under which a structure keeps them; None where the kernel does not apply.
Programs = Mapping[str, Program | None]


def share_where_same(structure: Structure, origin: Structure) -> None:
    """As `share_topology` where two structures differ in numbers alone; else nothing is shared.

    Parameters
    ----------
    structure : Structure
        Made by itself.
    origin : Structure
    """
    if structure is origin or structure.elements or origin.elements:
        return
    # a frozen dataclass keeps derived data in its __dict__, as functools.cached_property does
    kept = origin.__dict__
    if _TOPOLOGY_OF not in kept:
        kept[_TOPOLOGY_OF] = _topology(origin)
    if _topology(structure) == kept[_TOPOLOGY_OF]:
        share_topology(structure, origin)


def _topology(structure: Structure) -> tuple[Any, ...]:
    """All that a program and the clusters of nodes are made from, without a number."""
    linkage = structure.linkage
    return (
        *(linkage.nodes, linkage.bodies, linkage.tool, linkage.against, structure.rigid),
        tuple((j.name, j.between) for j in linkage.joints),
        linkage.states().tolist(),
        tuple((t.joint, t.direction, t.other_joint, t.other_direction) for t in linkage.ties),
        tuple(
            (b.name, b.nodes, b.elements, b.orientation if isinstance(b.orientation, str) else "")
            for b in structure.beams
        ),
        tuple((s.name, s.nodes) for s in structure.springs),
    )


def share_topology(structure: Structure, origin: Structure) -> None:
    """Let a structure take from another what does not depend on the numbers of its parts.

    Parameters
    ----------
    structure : Structure
        Of the same nodes, bodies, joints with the same free, locked and elastic directions, beams
        with as many elements, springs, and elements.
    origin : Structure
    """
    # a frozen dataclass keeps derived data in its __dict__, as functools.cached_property does
    for name in _TOPOLOGY:
        structure.__dict__[name] = getattr(origin, name)
    structure.__dict__[_ORIGIN] = origin_of(origin) or origin


def origin_of(structure: Structure) -> Structure | None:
    """The structure whose topology a structure shares; None where it was made by itself.

    Parameters
    ----------
    structure : Structure
    """
    found: Structure | None = structure.__dict__.get(_ORIGIN)
    return found


def elsewhere(structure: Structure) -> Structure:
    """The same structure for nodes at other places: what is kept with it is its own.

    Parameters
    ----------
    structure : Structure
    """
    made = copy(structure)
    # frozen fields stay; of what was derived, only what no place decides
    fresh = {f: structure.__dict__[f] for f in structure.__dataclass_fields__}
    made.__dict__.clear()
    made.__dict__.update(fresh)
    made.__dict__["numbers"] = structure.numbers
    share_topology(made, structure)
    return made


def expect_poses(
    structure: Structure, poses: int, programs: Callable[[], Programs] | None = None
) -> None:
    """State at how many poses a structure and its like will be solved, which decides the solver.

    Parameters
    ----------
    structure : Structure
        Left as it is where it shares no topology: its program would serve it alone.
    poses : int
        Of all structures of one topology together.
    programs : callable, optional
        Makes or returns the programs of the topology, which all of them share; called when one is
        needed. Without it they are made at the poses that come first, of whichever structure.
    """
    if _ORIGIN in structure.__dict__:
        structure.__dict__[_POSES] = poses
        structure.__dict__[_PROGRAMS] = programs


def shared_programs(structure: Structure) -> Programs | None:
    """What the `programs` of `expect_poses` gives; None where they were not stated.

    Parameters
    ----------
    structure : Structure
    """
    made: Callable[[], Programs] | None = structure.__dict__.get(_PROGRAMS)
    return None if made is None else made()


def expected_poses(structure: Structure) -> int:
    """The poses of `expect_poses`, zero where nothing was stated.

    Parameters
    ----------
    structure : Structure
    """
    return int(structure.__dict__.get(_POSES, 0))


def renumbered(program: Program, structure: Structure, offsets: Array) -> Program | None:
    """A program with the numbers of another structure of the same topology.

    None where the stiffness of one of its joint coordinates acts on another: the kernel has one
    number for each.

    Parameters
    ----------
    program : Program
    structure : Structure
        As `share_topology` states.
    offsets : (e, 2, 3)
        From the nodes to the ends of its beam elements, m.
    """
    joints, springs = structure.linkage.joints, structure.springs
    if any(joints[j].couples for j in set(program.axis_joint.tolist()) if j >= 0):
        return None
    direction = program.axis_direction + 3 * program.turns
    elastic = np.zeros(len(direction))
    for c, (joint, d) in enumerate(zip(program.axis_joint, direction, strict=True)):
        if joint >= 0:
            elastic[c] = joints[joint].stiffness_matrix[d, d]
    links = [np.diag(s.diagonal) for s in springs]
    links += [joints[j].stiffness_matrix for j in program.link_joint[len(springs) :]]
    orientation = [
        b.orientation if isinstance(b.orientation, tuple) else (np.nan,) * 3
        for b in structure.beams
    ]
    spread = program.spread._replace(outer_value=elastic[program.spread.outer_coordinate])
    return program._replace(
        item_offsets=offsets,
        properties=np.array([b.properties for b in structure.beams]).reshape(-1, 6),
        orientation=np.array(orientation).reshape(-1, 3),
        link_stiffness=np.array(links, dtype=float).reshape(-1, 6, 6),
        spring_value=elastic[program.spring_coordinate],
        spread=spread,
    )
