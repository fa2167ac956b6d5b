"""Other ways to put a linkage together, found from many starts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from strutwork.errors import ModelError
from strutwork.kinematics.given import given
from strutwork.kinematics.joint_motion import BodyPoses
from strutwork.kinematics.mechanism import Poses
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.turns import rotation_matrix
from strutwork.kinematics.walk import CLOSED, Walk

Array = NDArray[Any]

#: Corrections of a start, and the least damping, of the largest entry of the normal matrix.
CORRECTIONS, DAMPING = 120, 1e-14
#: Two ways whose bodies stand closer, of the machine's size, and are turned by less, rad, are one.
SAME = 1e-5
#: How far starts lie from home, of the machine's size.
AWAY = 1.0
#: Largest turn, rad, and shift, of the machine's size, of one correction.
FARTHEST = 1.0
#: Singular value of the rows, of the largest, below which bodies may move on: no way by itself.
LOOSE = 1e-7


@dataclass(frozen=True)
class Branches:
    """Assemblies of a linkage in which the given coordinates have their values.

    Parameters
    ----------
    bodies : BodyPoses
        Of the moving bodies, (m, b, 3) and (m, b, 3, 3) from home; the way nearest to home first.
    tool : Poses or None
        (m); None without a tool.
    error : (m,)
        Largest gap that is left in a joint or in what was given, m.
    starts, closed : int
        Starts made, and how many of them closed with no joint's axis turned round.
    moves : bool
        Whether bodies can still move where everything given is held, so that a way stands for a
        whole family.
    """

    bodies: BodyPoses
    tool: Poses | None
    error: Array
    starts: int
    closed: int
    moves: bool

    def __repr__(self) -> str:
        return f"<Branches: {len(self)} ways, {self.closed} of {self.starts} starts closed>"

    def __len__(self) -> int:
        return len(self.error)


def branches(
    motion: Motion,
    tool: Poses | None = None,
    task: Mapping[str, ArrayLike] | None = None,
    joints: Mapping[tuple[str, str], ArrayLike] | None = None,
    starts: int = 200,
    seed: int = 1,
) -> Branches:
    """Look for ways to put a linkage together: assembly modes, or working modes.

    The bodies are thrown about home, half of them in planes through it, and closed by damped
    Newton corrections of all joints at once. The results are ways; that there are no others
    is not shown.

    Parameters
    ----------
    motion : Motion
    tool : Poses, optional
        One pose: its working modes are looked for.
    task : mapping of direction to (), optional
        Some coordinates of the tool instead, m or rad; one value each.
    joints : mapping of (joint, direction) to (), optional
        Joint coordinates, m or rad, one value each: with all drives given, assembly modes. Turns
        count within half a turn of home.
    starts : int
        Beside home itself.
    seed : int

    Returns
    -------
    Branches

    Raises
    ------
    ModelError
        As `Motion.move`, more than one target, or no start.
    """
    start = motion.home_pose if tool is not None or task else None
    wanted = given(motion.joints, start, motion.home_values, tool, task, joints)
    if wanted.poses != 1 or starts < 1:
        raise ModelError(
            "branches",
            f"are requested for {wanted.poses} targets from {starts} starts.",
            "Give one target and one start or more.",
        )
    many = given(
        motion.joints,
        start,
        motion.home_values,
        None
        if tool is None
        else Poses(_tile(tool.position, starts, 1), _tile(tool.rotation, starts, 2)),
        {d: np.full(starts + 1, float(np.ravel(v)[0])) for d, v in (task or {}).items()},
        {p: np.full(starts + 1, float(np.ravel(v)[0])) for p, v in (joints or {}).items()},
    )
    walk = Walk(motion.joints, motion.rotation, many, lenient=True)
    bodies = _thrown(walk, starts, seed)
    error, loose = _closed(walk, bodies)
    good = np.flatnonzero((error <= CLOSED) & ~motion.joints.reversed(bodies))
    kept = _distinct(bodies[good], walk)
    index = good[kept]
    found = bodies[index]
    return Branches(
        found,
        _tools(motion, walk, found),
        walk.length * error[index],
        starts + 1,
        len(good),
        bool(loose[index].any()),
    )


def _tile(values: Array, starts: int, width: int) -> Array:
    """One pose's place (3,) or rotation (3, 3) for home and every start."""
    one = np.asarray(values).reshape((3,) * width)
    return np.tile(one, (starts + 1, *(1,) * width))


def _thrown(walk: Walk, starts: int, seed: int) -> BodyPoses:
    """Home, and bodies thrown about it; every other start turns them about one axis only."""
    # read when asked for: statistics take longer to load than all else that a command needs
    from scipy.stats import qmc  # noqa: PLC0415

    bodies = walk.joints.start(starts + 1)
    count = bodies.position.shape[1]
    points = qmc.Sobol(3, seed=seed).random(_power(starts * count))[: starts * count]
    shift = 2.0 * points.reshape(starts, count, 3) - 1.0
    random = np.random.default_rng(seed)
    turns = Rotation.random(starts * count, rng=random).as_matrix().reshape(starts, count, 3, 3)
    # planar machines close from starts in their plane: about the axis that their hinges share
    axis = _common_axis(walk)
    if axis is not None:
        angle = random.uniform(-np.pi, np.pi, (starts, count, 1))
        turns = rotation_matrix(angle * axis)
        shift -= (shift @ axis)[..., None] * axis
    bodies.position[1:] += AWAY * walk.length * shift
    bodies.rotation[1:] = turns
    return bodies


def _power(count: int) -> int:
    """The next power of two: what the sequence is balanced over."""
    return 1 << max(count - 1, 1).bit_length()


def _common_axis(walk: Walk) -> Array | None:
    """The direction of all hinges where they share one, else None."""
    j, d = np.nonzero(~walk.joints.still[:, 3:])
    if not len(j):
        return None
    axes = walk.joints.home.frames[j, :, d]
    return axes[0] if np.all(np.abs(np.abs(axes @ axes[0]) - 1.0) <= SAME) else None


def _closed(walk: Walk, bodies: BodyPoses) -> tuple[Array, NDArray[np.bool_]]:
    """Levenberg's corrections until nothing is open; what is left, and whether bodies move on."""
    count = len(bodies.position)
    error, damping = np.full(count, np.inf), np.full(count, 1e-2)
    loose = np.zeros(count, dtype=bool)
    going = np.arange(count)
    share = np.ones(count)
    left, matrix = walk.system(going, bodies, share)
    for _ in range(CORRECTIONS):
        size = np.abs(left).max(axis=-1, initial=0.0)
        error[going] = size
        done = size <= 0.1 * CLOSED
        loose[going[done]] = _moves_on(matrix[done])
        going, left, matrix = going[~done], left[~done], matrix[~done]
        if not going.size:
            break
        across = np.swapaxes(matrix, -1, -2)
        normal = across @ matrix
        top = np.abs(normal).max(axis=(-1, -2))
        normal += (damping[going] * top)[:, None, None] * np.eye(normal.shape[-1])
        change = -np.linalg.solve(normal, across @ left[..., None])[..., 0]
        far = np.abs(change).max(axis=-1)
        change *= np.minimum(1.0, FARTHEST / np.maximum(far, FARTHEST))[:, None]
        blocks = change.reshape(len(going), -1, 6)
        tried = BodyPoses(
            bodies.position[going] + walk.length * blocks[..., :3],
            rotation_matrix(blocks[..., 3:]) @ bodies.rotation[going],
        )
        after, rates = walk.system(going, tried, share[going])
        better = (after**2).sum(axis=-1) < (left**2).sum(axis=-1)
        took = going[better]
        bodies.position[took], bodies.rotation[took] = (
            tried.position[better],
            tried.rotation[better],
        )
        left[better], matrix[better] = after[better], rates[better]
        damping[going] = np.where(better, damping[going] * 0.1, damping[going] * 10.0)
        damping[going] = np.clip(damping[going], DAMPING, 1e6)
    error[going] = np.abs(left).max(axis=-1, initial=0.0)
    return error, loose


def _moves_on(matrix: Array) -> NDArray[np.bool_]:
    """Whether bodies can move with everything held, (k, r, n)."""
    if not len(matrix):
        return np.zeros(0, dtype=bool)
    if matrix.shape[1] < matrix.shape[2]:
        return np.ones(len(matrix), dtype=bool)
    values = np.linalg.svd(matrix, compute_uv=False)
    return np.asarray(values[:, -1] <= LOOSE * values[:, 0])


def _distinct(bodies: BodyPoses, walk: Walk) -> NDArray[np.intp]:
    """Indices of different ways, nearest to home first."""
    home = walk.joints.start(1)
    away = np.abs(bodies.position - home.position).max(axis=(1, 2)) / walk.length
    away += np.abs(bodies.rotation - home.rotation).max(axis=(1, 2, 3))
    kept: list[int] = []
    for k in np.argsort(away, kind="stable").tolist():
        near = np.abs(bodies.position[kept] - bodies.position[k]).max(axis=(1, 2), initial=0.0)
        turned = np.abs(bodies.rotation[kept] - bodies.rotation[k]).max(axis=(1, 2, 3), initial=0.0)
        if not np.any((near <= SAME * walk.length) & (turned <= SAME)):
            kept.append(k)
    return np.asarray(kept, dtype=np.intp)


def _tools(motion: Motion, walk: Walk, bodies: BodyPoses) -> Poses | None:
    if motion.linkage.tool is None:
        return None
    body, node = motion.linkage.tool_body, motion.linkage.node_index[motion.linkage.tool]
    positions, _, _ = walk.joints.place(bodies)
    turned = np.broadcast_to(motion.rotation, (len(positions), 3, 3))
    if body >= 0:
        turned = bodies.rotation[:, body] @ motion.rotation
    return Poses(positions[:, node], turned)
