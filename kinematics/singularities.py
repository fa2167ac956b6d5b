"""Singular poses along a line of poses."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.pose_family import PoseFamily, Progress
from strutwork.kinematics.reach_end import reach_ends
from strutwork.kinematics.singular_poses import (
    PARTS,
    Singularity,
    before_the_end,
    ends_of_reach,
    local_minima,
    ordered_ends,
    singular_poses,
)
from strutwork.kinematics.singularity_search import refine_least, refine_zeros, sign_changes

Array = NDArray[Any]

#: Singular poses nearer to each other than this share of the spacing are one.
SAME = 1e-6


def singularities_on_line(
    family: PoseFamily, values: ArrayLike, progress: Progress | None = None
) -> tuple[Singularity, ...]:
    """Singular poses and limits of reach along a line of poses, in its order.

    Between neighbours a minor of the motions' tool or drive part changes its sign at a simple
    singularity; others (where it touches zero, or of machines with more drives than freedoms)
    are least singular values that are zero. Each is refined to rounding and judged there.

    Parameters
    ----------
    family : PoseFamily
        Of one parameter, or of k that go along a straight line.
    values : (n,) or (n, k)
        Poses along the line, m and rad, so near to each other that between two of them there is one
        singularity of a kind at most.
    progress : callable, optional

    Raises
    ------
    ModelError
        Less than two values, no pose that is reached, or as `tool_drive_space`.
    """
    points = np.asarray(values, dtype=float)
    points = points[:, None] if points.ndim == 1 else points
    if len(points) < 2 or not np.all(np.isfinite(points)):
        raise ModelError(
            "line", f"has {len(points)} poses.", "Give two or more finite values along it."
        )
    looked = family.look(points, progress)
    family = replace(family, known=looked.space.known)
    edges = np.stack([np.arange(len(points) - 1), np.arange(1, len(points))], axis=1)
    found: list[Singularity] = []
    inner = edges[looked.reach[edges].all(axis=1)]
    line = _line(family, points[0], points[-1])
    for part in PARTS:
        changed = inner[sign_changes(looked, inner, part)]
        if len(changed):
            a, b = points[changed].swapaxes(0, 1)
            found += singular_poses(family, refine_zeros(family, a, b, part))
        low = local_minima(looked, edges, changed, part)
        if low.size:
            share = (low / (len(points) - 1.0))[:, None]
            refined = refine_least(line, share, np.array([1.0 / (len(points) - 1)]), part)
            whole = points[0] + refined.parameters * (points[-1] - points[0])
            found += singular_poses(family, replace(refined, parameters=whole))
    ends = edges[looked.reach[edges].sum(axis=1) == 1]
    if len(ends):
        inside, outside, reasons = ordered_ends(looked, ends)
        reached = reach_ends(family, inside, outside, reasons)
        found += ends_of_reach(family, reached)
        found += before_the_end(family, inside, reached.parameters)
    way = points[-1] - points[0]

    def share_of(one: Singularity) -> float:
        return float(way @ (np.array(list(one.parameters.values())) - points[0]) / (way @ way))

    # a refined pose may have gone beyond the ends
    found = sorted((one for one in found if -1e-12 <= share_of(one) <= 1 + 1e-12), key=share_of)
    near = SAME / (len(points) - 1)
    return tuple(
        one
        for k, one in enumerate(found)
        if not any(
            o.kind is one.kind and abs(share_of(o) - share_of(one)) <= near for o in found[:k]
        )
    )


def _line(family: PoseFamily, start: Array, end: Array) -> PoseFamily:
    """The poses between two of a family, by the share of the way."""

    def place(share: Array) -> Placement:
        return family.place(start + share * (end - start))

    return replace(family, place=place, names=("share",), section=None)
