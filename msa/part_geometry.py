"""Where a structure's parts stand at a batch of poses: what a parameter of geometry moves."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.msa.assembly import System
from strutwork.msa.point_mass import mass_axes

Array = NDArray[Any]

#: Changes of a place by fewer units in its last digit are rounding.
ROUNDING = 16.0


@dataclass(frozen=True)
class PartGeometry:
    """Places and axes of the parts of a structure, at p poses.

    Parameters
    ----------
    span : (p, s, 3)
        From the first to the second end of every beam element, m.
    up : (p, s, 3)
        Vectors in their local x-z planes, global axes, no unit.
    ends : (p, s, 2, 3)
        From the reference nodes of the clusters to the elements' ends, m.
    frames : (p, j, 3, 3)
        Joint axes as columns, no unit.
    joints : (p, j, 2, 3)
        From the reference nodes to the two nodes of the joints, m.
    axes : (p, k, 3, 3)
        Axes of the springs as columns, no unit.
    springs : (p, k, 2, 3)
        From the reference nodes to the springs' nodes, m; zero for ground.
    turns : (p, m, 3, 3)
        Axes of the point masses as columns, no unit.
    masses : (p, m, 3)
        From the reference nodes to the masses' nodes, m.
    nodes : (p, n, 3)
        From the reference nodes to the mesh nodes, m.
    """

    span: Array
    up: Array
    ends: Array
    frames: Array
    joints: Array
    axes: Array
    springs: Array
    turns: Array
    masses: Array
    nodes: Array

    @classmethod
    def of(cls, system: System) -> PartGeometry:
        """Those of a structure.

        Parameters
        ----------
        system : System
            At p poses.
        """
        placed, structure = system.placed, system.placed.structure
        p = system.poses
        segments, mesh = structure.segments, structure.mesh_index
        offsets = np.broadcast_to(placed.segment_offsets, (p, len(segments), 2, 3))
        arms, positions = placed.arms, placed.positions
        at = positions[:, segments[:, 1:]] + offsets
        pairs = [[mesh[n] for n in j.between] for j in structure.linkage.joints]
        of_springs = [[mesh[s.nodes[0]], mesh[s.nodes[-1]]] for s in structure.springs]
        axes = [np.broadcast_to(placed.spring_axes(s), (p, 6, 6)) for s in structure.springs]
        carried = [mesh[m.node] for m in structure.masses]
        turns = [mass_axes(m, placed) for m in structure.masses]
        return cls(
            at[:, :, 1] - at[:, :, 0],
            placed.beam_upright[:, segments[:, 0]] if len(segments) else at[:, :, 0],
            arms[:, segments[:, 1:]] + offsets,
            placed.placement.frames,
            arms[:, np.array(pairs, dtype=np.intp).reshape(-1, 2)],
            np.array(axes).reshape(-1, p, 6, 6).swapaxes(0, 1)[..., :3, :3],
            arms[:, np.array(of_springs, dtype=np.intp).reshape(-1, 2)],
            np.array(turns).reshape(-1, p, 3, 3).swapaxes(0, 1),
            arms[:, np.array(carried, dtype=np.intp)],
            arms,
        )

    def rate(self, before: PartGeometry, width: float) -> PartGeometry:
        """Change per unit of a parameter since `before`, which stands `width` below.

        Zero where it is no more than the rounding of places.

        Parameters
        ----------
        before : PartGeometry
            Of the same structure at the same poses.
        width : float
            In the parameter's unit.
        """
        size = max(float(np.abs(self.span).max(initial=0.0)), 1e-300)
        size = max(size, float(np.abs(self.nodes).max(initial=0.0)))
        unit = {"up": 1.0, "frames": 1.0, "axes": 1.0, "turns": 1.0}
        result = []
        for f in fields(self):
            change = getattr(self, f.name) - getattr(before, f.name)
            least = ROUNDING * np.finfo(float).eps * unit.get(f.name, size)
            result.append(np.where(np.abs(change) > least, change, 0.0) / width)
        return PartGeometry(*result)
