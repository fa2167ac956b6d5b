"""Placements: where a linkage stands, for a batch of poses."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, UnreachableError
from strutwork.kinematics.linkage import Linkage

#: Nodes of a joint must coincide to this many metres.
COINCIDENCE = 1e-9


@dataclass(frozen=True)
class Placement:
    """Node positions and joint frames of a linkage at a batch of poses.

    Parameters
    ----------
    positions : (..., n, 3)
        Node positions, m, in the order of `Linkage.nodes`.
    frames : (..., j, 3, 3)
        Joint axes as columns x, y, z, unit vectors, in the order of `Linkage.joints`.
    values : (..., m)
        Joint coordinates, m or rad, in the order of `names`.
    names : tuple of (joint, direction)
        What each entry of `values` measures.
    status : (...) of int
        0 where the pose is good, else 1 + index into `reasons`.
    reasons : tuple of str
        Why a pose is not good.
    turns : (..., b, 3, 3) or None
        Rotation matrix of each body of `Linkage.body_names` from the configuration in which vectors
        of its parts are written in global axes: these follow their bodies. None: no body has
        turned, or no part has such vectors.
    """

    positions: NDArray[Any]
    frames: NDArray[Any]
    values: NDArray[Any]
    names: tuple[tuple[str, str], ...] = ()
    status: NDArray[np.signedinteger[Any]] | None = None
    reasons: tuple[str, ...] = ()
    turns: NDArray[Any] | None = None

    def __post_init__(self) -> None:
        if self.status is None:
            object.__setattr__(self, "status", np.zeros(self.positions.shape[:-2], dtype=np.int8))

    def __repr__(self) -> str:
        good = int(np.count_nonzero(self.reachable))
        return f"<Placement: {self.reachable.size} poses, {good} reachable, positions in m>"

    @property
    def batch(self) -> tuple[int, ...]:
        """Shape of the batch of poses."""
        return tuple(self.positions.shape[:-2])

    @property
    def reachable(self) -> NDArray[np.bool_]:
        """True where the pose is good, (...)."""
        return np.asarray(np.asarray(self.status) == 0)

    def reason(self, index: int | tuple[int, ...]) -> str:
        """Why the pose at `index` is not good; empty where it is.

        Parameters
        ----------
        index : int or tuple of int
            Of a pose in the batch; () for a single one.
        """
        code = int(np.asarray(self.status)[index])
        return self.reasons[code - 1] if code else ""

    def require_reachable(self) -> Placement:
        """Return the placement itself when every pose is good.

        Raises
        ------
        UnreachableError
            Names the first pose that is not, with the reason.
        """
        bad = np.argwhere(~self.reachable)
        if len(bad):
            first = tuple(int(i) for i in bad[0])
            raise UnreachableError(
                f"pose {first[0] if len(first) == 1 else first}",
                f"cannot be reached: {self.reason(first)} ({len(bad)} of {self.reachable.size} "
                "poses are not reached).",
                "Move the pose into the workspace, or use `reachable` to omit such poses.",
            )
        return self

    def __getitem__(self, index: Any) -> Placement:
        """The poses selected by `index` on the batch axes."""
        return replace(
            self,
            positions=self.positions[index],
            frames=self.frames[index],
            values=self.values[index],
            status=np.asarray(self.status)[index],
            turns=None if self.turns is None else self.turns[index],
        )

    def flat(self) -> Placement:
        """The same poses with one batch axis."""
        count, batch = int(np.prod(self.batch, dtype=int)), len(self.batch)

        def made(array: NDArray[Any]) -> NDArray[Any]:
            return array.reshape(count, *array.shape[batch:])

        return replace(
            self,
            positions=made(self.positions),
            frames=made(self.frames),
            values=made(self.values),
            status=made(np.asarray(self.status)),
            turns=None if self.turns is None else made(self.turns),
        )


def check_coincidence(linkage: Linkage, placement: Placement) -> None:
    """Check that the two nodes of every joint coincide.

    Parameters
    ----------
    linkage : Linkage
        Whose joints are looked at.
    placement : Placement
        Any batch axes; poses that are not good are left out.

    Raises
    ------
    ModelError
        Names the joint, its nodes, their distance and the pose.
    """
    if not linkage.joints:
        return
    first = [linkage.node_index[j.between[0]] for j in linkage.joints]
    second = [linkage.node_index[j.between[1]] for j in linkage.joints]
    positions = placement.positions
    gap = np.linalg.norm(positions[..., second, :] - positions[..., first, :], axis=-1)
    gap = np.where(placement.reachable[..., None], gap, 0.0)
    # a machine of 100 m cannot meet 1e-9 m in double precision: allow its rounding
    allowed = COINCIDENCE + 1e-14 * np.abs(positions).max(initial=0.0)
    if gap.size and gap.max() > allowed:
        *pose, j = (int(i) for i in np.unravel_index(int(gap.argmax()), gap.shape))
        joint = linkage.joints[j]
        where = f" at pose {pose[0] if len(pose) == 1 else tuple(pose)}" if pose else ""
        raise ModelError(
            f"joint {joint.name}",
            f'{joint.type} joint between "{joint.between[0]}" and "{joint.between[1]}": the two '
            f"nodes are {gap.max():.3g} m apart{where}.",
            f"A joint's nodes must coincide (tolerance {COINCIDENCE:g} m). Correct the "
            "coordinates, or put a rigid body between the nodes.",
        )
