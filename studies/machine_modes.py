"""The other ways in which a machine can be put together with its drives where they stand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.assembly_modes import AssemblyModes, assembly_modes
from strutwork.kinematics.branches import SAME, branches
from strutwork.kinematics.circle_kernel import ROOTS
from strutwork.kinematics.mechanism import Poses
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.platform_circles import platform_circles
from strutwork.machines.model import Model

Array = NDArray[Any]

#: Starts where the modes are not found all at once.
STARTS = 60


@dataclass(frozen=True)
class MachineModes:
    """Assembly modes, the machine's own first; a rod's turn about itself makes no other.

    Parameters
    ----------
    tool : Poses
        (m)
    lines : tuple of tuple of (k, 3)
        What to draw of each mode, m.
    ways : int
        Of an elimination all ways, complex ones too; else the starts that closed.
    starts : int
        0 of an elimination, which finds all.
    apart : float
        Largest turn of a leg to the nearest other mode, rad; not a number where it is not known.
    moves : bool
        Whether bodies can move on where the drives are held.
    """

    tool: Poses
    lines: tuple[tuple[Array, ...], ...]
    ways: int
    starts: int
    apart: float
    moves: bool = False

    def __repr__(self) -> str:
        return f"<MachineModes: {len(self)}, {'all' if self.every else 'found from starts'}>"

    @property
    def every(self) -> bool:
        """Whether there are no others: else they are those that several starts have found."""
        return self.starts == 0

    def __len__(self) -> int:
        return len(self.tool.position)


def machine_modes(
    model: Model, placement: Placement | None = None, starts: int = STARTS
) -> MachineModes:
    """Find the assembly modes of a machine.

    Parameters
    ----------
    model : Model
        With a tool and drives.
    placement : Placement, optional
        One pose whose drives count; default home. Its values are those of the model's motion.
    starts : int
        Where the modes are not found all at once.

    Raises
    ------
    ModelError
        No tool, or no drive.
    """
    model.require_tool()
    linkage = model.structure.linkage
    if not linkage.driven:
        raise ModelError("drives", "are none.", "Name driven directions of joints.")
    here = model.placement if placement is None else placement
    if isinstance(platform_circles(linkage, here), str):
        return _found(model.motion, placement, starts)
    modes = assembly_modes(linkage, here, _rotation(model, placement))
    # of fewer ways some coincide or were lost, and which is not known
    if int(modes.count) < ROOTS or int(modes.home) < 0:
        return _found(model.motion, placement, starts)
    return _every(modes)


def _rotation(model: Model, placement: Placement | None) -> Array:
    if placement is None or placement.turns is None:
        return model.rotation
    body = model.structure.linkage.tool_body
    home = model.motion.home.turns
    turn = placement.turns[body]
    return np.asarray((turn if home is None else turn @ home[body].T) @ model.rotation)


def _every(modes: AssemblyModes) -> MachineModes:
    count, home = int(modes.real), int(modes.home)
    order = [home, *(k for k in range(count) if k != home)]
    points = modes.points[order]
    lines = tuple(
        (
            *(np.stack([modes.circles.centre[k], p[k]]) for k in range(3)),
            p[[0, 1, 2, 0]],
            modes.circles.centre[[0, 1, 2, 0]],
        )
        for p in points
    )
    return MachineModes(
        Poses(modes.position[order], modes.rotation[order]),
        lines,
        int(modes.count),
        0,
        float(modes.apart),
    )


def _found(motion: Motion, placement: Placement | None, starts: int) -> MachineModes:
    names = motion.joints.names
    values = motion.home_values
    if placement is not None:
        known = dict(zip(placement.names, np.ravel(placement.values), strict=True))
        values = np.array([known[name] for name in names])
    drives = {pair: float(values[names.index(pair)]) for pair in motion.linkage.driven}
    found = branches(motion, joints=drives, starts=starts)
    assert found.tool is not None  # noqa: S101 - asked by the caller
    positions, _, _ = motion.joints.place(found.bodies)
    kept = _apart(positions, found.tool, SAME * motion.length)
    return MachineModes(
        found.tool[kept],
        _skeletons(motion, positions[kept]),
        ways=found.closed,
        starts=found.starts,
        apart=float("nan"),
        moves=found.moves,
    )


def _apart(positions: Array, tool: Poses, near: float) -> NDArray[np.intp]:
    """Ways (m) that put nodes (m, n, 3) or the tool elsewhere than those before.

    A rod between two universal joints fits turned about itself by half a turn as well: that is no
    other place of anything.
    """
    kept: list[int] = []
    for k in range(len(positions)):
        moved = np.abs(positions[kept] - positions[k]).max(axis=(1, 2), initial=0.0) > near
        turned = np.abs(tool.rotation[kept] - tool.rotation[k]).max(axis=(1, 2), initial=0.0) > SAME
        if np.all(moved | turned):
            kept.append(k)
    return np.asarray(kept, dtype=np.intp)


def _skeletons(motion: Motion, positions: Array) -> tuple[tuple[Array, ...], ...]:
    """Every body as a line through its nodes."""
    owner = motion.linkage.body_of_node
    members = [np.flatnonzero(owner == b) for b in range(len(motion.linkage.body_names))]
    return tuple(tuple(p[m] for m in members if len(m) > 1) for p in positions)
