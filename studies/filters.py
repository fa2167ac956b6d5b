"""Which poses of a study count."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import IntEnum
from math import isfinite
from typing import Protocol, runtime_checkable

import numpy as np

from strutwork.errors import ModelError
from strutwork.kinematics import characteristic_length
from strutwork.machines import Limit, Machine, ThreeLegs


@runtime_checkable
class RedundantMachine(Protocol):
    """A machine with more drives than freedoms, some of which can be locked."""

    def locked(self) -> Machine:
        """With those drives locked that its inverse kinematics does not move."""


class PoseStatus(IntEnum):
    """Outcome of a pose; a higher number was excluded at a later stage."""

    GOOD = 0
    UNREACHABLE = 1
    JOINT_RANGE = 2
    NEAR_SINGULAR = 3
    MECHANISM = 4
    UNSOLVED = 5

    @property
    def word(self) -> str:
        """Name as a flag in a file."""
        return self.name.lower()


#: The reasons for which poses are dropped, in the order in which they are looked for.
REASONS = tuple(status for status in PoseStatus if status is not PoseStatus.GOOD)


@dataclass(frozen=True, kw_only=True)
class Filters:
    """Conditions for a pose to count.

    Parameters
    ----------
    joint_kinds : tuple of str or None
        Types of joints whose ranges are kept ("revolute", "prismatic", "spherical"); None for
        all.
    condition_limit : float or None
        A pose counts as near-singular where the condition number of its inverse Jacobian, angles
        multiplied by `length`, reaches this; no unit. None: not looked at. The default is this
        package's: on the hemisphere of Azulay et al. it takes out the ring of their Fig. 4, 3 to 4
        % of the candidates, and changes no mean by more than 1 %, but for the Glozman machine,
        which is near-singular more often.
    length : float or None
        How much translation counts as much as one radian, m; None for the radius of the tool's
        body, `tool_radius`.

    Raises
    ------
    ModelError
        A condition limit of one or less, or a length that is not positive.
    """

    joint_kinds: tuple[str, ...] | None = None
    condition_limit: float | None = 100.0
    length: float | None = None

    def __post_init__(self) -> None:
        if self.condition_limit is not None and not self.condition_limit > 1:
            raise ModelError(
                "filters",
                f"the condition limit is {self.condition_limit}.",
                "A condition number is at least one: give more, or None.",
            )
        if self.length is not None and not (isfinite(self.length) and self.length > 0):
            raise ModelError(
                "filters", f"the length is {self.length}.", "Give a positive length, m."
            )

    def limits(self, machine: Machine) -> tuple[Limit, ...]:
        """The joint ranges that are kept.

        Parameters
        ----------
        machine : Machine
        """
        if self.joint_kinds is None:
            return machine.limits
        return tuple(limit for limit in machine.limits if limit.kind in self.joint_kinds)

    def length_for(self, machine: Machine) -> float:
        """The length, m, or the radius of the machine's tool body.

        Parameters
        ----------
        machine : Machine
        """
        return tool_radius(machine) if self.length is None else self.length


def tool_radius(machine: Machine) -> float:
    """Root mean square distance of the joints on the tool's body from the tool, m.

    For a platform with its joints on a circle about the tool it is that circle's radius. A
    tool alone on its body gets the machine's half extent.

    Parameters
    ----------
    machine : Machine

    Raises
    ------
    ModelError
        The machine has no tool.
    """
    linkage = machine.linkage
    if linkage.tool is None:
        raise ModelError("linkage", "has no tool.", "Name the tool centre point's node.")
    home = machine.place(machine.home())
    tool = linkage.node_index[linkage.tool]
    owner = linkage.body_of_node
    arms = home.positions[owner == owner[tool]] - home.positions[tool]
    squares = np.einsum("ni,ni->n", arms, arms)
    squares = squares[squares > 0]
    return float(np.sqrt(squares.mean())) if squares.size else characteristic_length(home)


def moving_machine(machine: Machine) -> Machine:
    """The machine whose Jacobian says how near a pose is to a singularity.

    A structure with links clamped in the platform cannot move with its drives; its singularities
    are those of the machine it stands for, with spherical joints. A machine with redundant drives
    is looked at with those locked that its inverse kinematics does not move.

    Parameters
    ----------
    machine : Machine
    """
    if isinstance(machine, ThreeLegs) and machine.platform_joint == "clamped":
        machine = replace(machine, platform_joint="spherical")
    return machine.locked() if isinstance(machine, RedundantMachine) else machine
