"""The planar machine of the MIT-SS-1 under a moving bridge: four axes (Son 2002, chapter 10)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, Poses
from strutwork.machines import mit_ss1_parts as parts
from strutwork.machines.dimensions import OR_RIGID, check_positive
from strutwork.machines.mit_ss1 import MitSS1
from strutwork.msa.springs import PointMass
from strutwork.msa.structure import Structure

Array = NDArray[Any]

#: The body that carries the rails, its joint, and the ground's node on its way.
BRIDGE, GUIDE, WAY = "bridge", "bridge/guide", "way"

#: Height of the bridge's way over the tool tip at home, m, where no rail stands: our choice.
WAY_HEIGHT = 0.900


@dataclass(frozen=True, kw_only=True)
class MovingBridge(MitSS1):
    """The three blocks' rails are on a bridge that slides along y; the workpiece is fixed.

    "The planar PKM in the MIT-SS-1 may be attached to a moving bridge" of "almost unlimited
    length", with four axes: x, z and b of the planar machine and y of the bridge. That is all the
    text carries. The planar machine keeps its dimensions; the bridge is rigid, its way too, since
    nothing of them is printed, and its travel has no end. In statics the machine is therefore as
    stiff as the planar machine alone.
    All parameters that are not named here are those of `MitSS1`.

    Parameters
    ----------
    bridge_mass : float
        kg, without struts and housing. Our choice; it counts when the bridge is driven, and in
        no mode, since drive and way are rigid.
    bridge_stiffness : float or None
        Of the bridge's drive along y, N/m. None: rigid; the thesis prints none.
    """

    bridge_mass: float = 400.0
    bridge_stiffness: float | None = None

    def __post_init__(self) -> None:
        check_positive(self, ["bridge_mass"])
        check_positive(self, ["bridge_stiffness"], OR_RIGID)
        super().__post_init__()

    @cached_property
    def planar(self) -> MitSS1:
        """The planar machine on rails that stand still."""
        return MitSS1(**{f.name: getattr(self, f.name) for f in fields(MitSS1)})

    @cached_property
    def linkage(self) -> Linkage:
        """The planar machine's, its rails on a body that slides along y."""
        planar = self.planar.linkage
        rails = next(body.nodes for body in planar.bodies if body.name == GROUND)
        others = tuple(body for body in planar.bodies if body.name != GROUND)
        elastic = {} if self.bridge_stiffness is None else {"z": self.bridge_stiffness}
        bodies = (Body(GROUND, (WAY,)), Body(BRIDGE, (BRIDGE, *rails)), *others)
        slide = Joint(GUIDE, "prismatic", (WAY, BRIDGE), elastic, driven=("z",))
        nodes = (WAY, BRIDGE, *planar.nodes)
        return Linkage(nodes, bodies, (slide, *planar.joints), parts.TOOL)

    @cached_property
    def structure(self) -> Structure:
        """The planar machine's, and the bridge's mass where its way is."""
        planar = self.planar.structure
        masses = (*planar.masses, PointMass(BRIDGE, self.bridge_mass))
        return replace(planar, linkage=self.linkage, masses=masses)

    def skeleton(self) -> Sequence[tuple[str, str]]:
        """Pairs of nodes that a drawing connects by a line: the bridge over the blocks, too."""
        return (*((BRIDGE, parts.rail(i)) for i in parts.STRUTS), *self.planar.skeleton())

    def place(self, poses: Poses) -> Placement:
        """Inverse kinematics: the bridge takes y, the planar machine the rest; batch first.

        Analytic in the pose, as that of `MitSS1`.

        Parameters
        ----------
        poses : Poses
            Of the tool, (...).
        """
        y = poses.position[..., 1]
        aside = y[..., None] * np.array([0.0, 1.0, 0.0])
        planar = self.planar.place(Poses(poses.position - aside, poses.rotation))
        way = np.stack([np.zeros_like(y), y, np.full_like(y, WAY_HEIGHT)], axis=-1)
        moved = planar.positions + aside[..., None, :]
        x, along, up = np.eye(3)
        guide = np.broadcast_to(np.stack([-x, up, along], axis=-1), (*y.shape, 1, 3, 3))
        return replace(
            planar,
            positions=np.concatenate([np.stack([way, way], axis=-2), moved], axis=-2),
            frames=np.concatenate([guide, planar.frames], axis=-3),
            values=np.concatenate([y[..., None], planar.values], axis=-1),
            names=((GUIDE, "z"), *planar.names),
        )
