"""Linkages: bodies joined by joints. Topology only, no coordinates."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.coupling import Coupling, Tie, ties_of
from strutwork.kinematics.joint import DIRECTIONS, Joint, State

#: Name of the body that does not move.
GROUND = "ground"


@dataclass(frozen=True)
class Body:
    """A named group of nodes that move together when nothing deforms.

    Parameters
    ----------
    name : str
        Unique in the linkage; "ground" for what does not move.
    nodes : tuple of str
        Its nodes, each of no other body.
    """

    name: str
    nodes: tuple[str, ...]


@dataclass(frozen=True)
class Linkage:
    """Bodies joined by joints.

    Parameters
    ----------
    nodes : tuple of str
        All nodes, in the order in which placements give their positions.
    bodies : tuple of Body
        Groups of nodes. A node in no group is a body of its own. The body named "ground"
        does not move.
    joints : tuple of Joint
        The joints, in the order in which placements give their frames.
    tool : str or None
        The node of the tool centre point.
    couplings : tuple of Coupling
        Joint coordinates that follow others.
    against : str or None
        A node of the workpiece, relative to which the tool gives way and errs; None for the ground.

    Raises
    ------
    ModelError
        A repeated or unknown name, a node in two bodies, a workpiece without a tool, or a coupling
        that cannot be.
    """

    nodes: tuple[str, ...]
    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    tool: str | None = None
    couplings: tuple[Coupling, ...] = ()
    against: str | None = None

    def __post_init__(self) -> None:
        _unique("node", self.nodes)
        _unique("body", (body.name for body in self.bodies))
        _unique("joint", (joint.name for joint in self.joints))
        _unique("coupling", (coupling.name for coupling in self.couplings))
        known = set(self.nodes)
        for body in self.bodies:
            _known(f"body {body.name}", body.nodes, known)
        for joint in self.joints:
            _known(f"joint {joint.name}", joint.between, known)
        if self.tool is not None:
            _known("tool", (self.tool,), known)
        if self.against is not None:
            _known("tool.against", (self.against,), known)
            if self.tool is None:
                raise ModelError(
                    "tool.against", "is given without a tool.", "Name the tool centre point's node."
                )
        owner: dict[str, str] = {}
        for body in self.bodies:
            for node in body.nodes:
                if node in owner:
                    raise ModelError(
                        f"node {node}",
                        f'belongs to bodies "{owner[node]}" and "{body.name}".',
                        "Leave it in one of them, or merge the bodies.",
                    )
                owner[node] = body.name
        _ = self.ties

    def __repr__(self) -> str:
        return (
            f"<Linkage: {len(self.nodes)} nodes, {len(self.body_names)} bodies, "
            f"{len(self.joints)} joints, {len(self.driven)} driven directions>"
        )

    @cached_property
    def node_index(self) -> dict[str, int]:
        """Row of each node in the positions of a placement."""
        return {name: i for i, name in enumerate(self.nodes)}

    @cached_property
    def joint_index(self) -> dict[str, int]:
        """Row of each joint in the frames of a placement."""
        return {joint.name: i for i, joint in enumerate(self.joints)}

    @cached_property
    def _grouping(self) -> tuple[tuple[str, ...], tuple[int, ...]]:
        names: list[str] = []
        owner: dict[str, int] = {}
        for body in self.bodies:
            if body.name != GROUND:
                names.append(body.name)
            for node in body.nodes:
                owner[node] = -1 if body.name == GROUND else len(names) - 1
        for node in self.nodes:
            if node not in owner:
                owner[node] = len(names)
                names.append(node)
        return tuple(names), tuple(owner[node] for node in self.nodes)

    @property
    def body_names(self) -> tuple[str, ...]:
        """Moving bodies in column order; a node in no group stands under its own name."""
        return self._grouping[0]

    @property
    def body_of_node(self) -> NDArray[np.intp]:
        """Index into `body_names` of each node's body, -1 for ground, (n,)."""
        return np.asarray(self._grouping[1], dtype=np.intp)

    @property
    def tool_body(self) -> int:
        """Index into `body_names` of the tool's body, -1 for ground.

        Raises
        ------
        ModelError
            The linkage has no tool.
        """
        if self.tool is None:
            raise ModelError("linkage", "has no tool.", "Name the tool centre point's node.")
        return int(self.body_of_node[self.node_index[self.tool]])

    @property
    def workpiece_body(self) -> int:
        """Index into `body_names` of the workpiece's body, -1 for ground."""
        if self.against is None:
            return -1
        return int(self.body_of_node[self.node_index[self.against]])

    @property
    def relative_to(self) -> str:
        """Words behind the tool: " relative to NODE" where there is a workpiece, else none."""
        return "" if self.against is None else f" relative to {self.against}"

    @cached_property
    def ties(self) -> tuple[Tie, ...]:
        """What couplings and helical joints tie, in the order of their rows."""
        return ties_of(self.joints, self.joint_index, self.couplings)

    @property
    def driven(self) -> tuple[tuple[str, str], ...]:
        """Driven directions as (joint name, direction), in joint order."""
        return tuple(
            (joint.name, d) for joint in self.joints for d in DIRECTIONS if d in joint.driven
        )

    def states(self) -> NDArray[np.int8]:
        """`State` of every joint direction in statics, (j, 6); what follows others is locked."""
        return self._states.copy()

    @cached_property
    def _states(self) -> NDArray[np.int8]:
        found = np.asarray([j.states for j in self.joints], dtype=np.int8).reshape(-1, 6)
        found[self.tied_mask()] = State.LOCKED
        return found

    def tied_mask(self) -> NDArray[np.bool_]:
        """True where a joint coordinate follows another, (j, 6)."""
        found = np.zeros((len(self.joints), 6), dtype=bool)
        for tie in self.ties:
            found[tie.joint, tie.direction] = True
        return found

    def driven_mask(self) -> NDArray[np.bool_]:
        """True where a joint direction is driven, (j, 6)."""
        return np.asarray(
            [[d in j.driven for d in DIRECTIONS] for j in self.joints], dtype=bool
        ).reshape(-1, 6)

    def elastic_or_locked(self) -> NDArray[np.bool_]:
        """True where a joint direction resists motion in statics, (j, 6)."""
        return np.asarray(self.states() != State.FREE)

    def still_mask(self) -> NDArray[np.bool_]:
        """True where a joint's own parts let nothing move, whatever couplings ask, (j, 6)."""
        return np.asarray(self.elastic_or_locked() & ~self.driven_mask() & ~self.tied_mask())


def _unique(kind: str, names: Iterable[str]) -> None:
    repeated = [name for name, count in Counter(names).items() if count > 1]
    if repeated:
        raise ModelError(
            f"{kind} {repeated[0]}", "is defined twice.", f"Give every {kind} a name of its own."
        )


def _known(part: str, nodes: Iterable[str], known: set[str]) -> None:
    for node in nodes:
        if node not in known:
            near = ", ".join(sorted(known)[:8])
            raise ModelError(
                part, f'names the unknown node "{node}".', f"Nodes of this linkage: {near} …"
            )
