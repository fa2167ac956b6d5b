"""The MIT-SS-1 whole: granite on its four mounts, rails, blocks, struts, bearings, housing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.fea.superelement import Superelement
from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, Poses
from strutwork.machines import mit_ss1_parts as parts
from strutwork.machines.limits import Limit, joint_limits
from strutwork.machines.mit_ss1 import MitSS1
from strutwork.machines.mit_ss1_frame import MOUNTS, GraniteFrame, mount, rail_foot
from strutwork.msa.structure import PlacedStructure, Structure

Array = NDArray[Any]

#: The body that carries the rails.
FRAME = "granite"


def floor(i: int) -> str:
    """Node of the ground under a mount.

    Parameters
    ----------
    i : int
        1 to 4.
    """
    return f"floor/mount{i}"


def mount_joint(i: int) -> str:
    """Joint of a mount.

    Parameters
    ----------
    i : int
        1 to 4.
    """
    return f"mount{i}"


@dataclass(frozen=True, kw_only=True)
class MitSS1Whole:
    """`MitSS1` on its granite, which stands on four elastic mounts.

    The rails' nodes ride on the granite by rigid arms from the middles of the rails' footings,
    since the blocks slide. The granite is reduced once, whatever the pose.

    Left out: the work table with its two axes, whose masses are not published and whose own
    frequencies lie above 400 Hz (Son 2002, section 9.2.2), the ball screws' and the motors'
    masses.

    Parameters
    ----------
    machine : MitSS1
        What moves.
    frame : GraniteFrame
    mount_stiffness : (horizontal, vertical)
        Of one mount, N/m. Near the rigid-body frequencies of Fig. 57 with the granite alone; for
        the whole see `strutwork.papers.son_2002.calibrated`.
    offset : float
        From the plate's front to the plane in which the machine moves, m. Our choice: the near
        bearings stand 60 mm clear of the granite.
    height : float
        From the base's top to the machine's origin, m. Our choice: the work table's carriage.
    folder : Path or None
        Of stored superelements; None: the user's cache.

    Raises
    ------
    ModelError
        A number that is not positive; rails of the frame where the machine has none.
    """

    machine: MitSS1 = field(default_factory=MitSS1)
    frame: GraniteFrame = field(default_factory=GraniteFrame)
    mount_stiffness: tuple[float, float] = (7.4e6, 165e6)
    offset: float = 0.150
    height: float = 0.100
    folder: Path | None = None

    def __post_init__(self) -> None:
        for name, values in (
            ("mount_stiffness", self.mount_stiffness),
            ("offset", (self.offset,)),
        ):
            if not all(isfinite(v) and v > 0 for v in values):
                raise ModelError(
                    f"MitSS1Whole.{name}",
                    f"is {getattr(self, name)!r}.",
                    "Give positive numbers, SI.",
                )
        apart = np.diff(self.frame.rails) - np.diff(self.machine.rails)
        if np.abs(apart).max() > 1e-9:
            raise ModelError(
                "MitSS1Whole.frame",
                f"has its rails at x = {self.frame.rails} m, the machine at "
                f"{tuple(self.machine.rails.tolist())} m: their distances differ.",
                "Give GraniteFrame the machine's guide distances.",
            )

    @cached_property
    def origin(self) -> Array:
        """The machine's origin in the frame's axes, (3,), m; the axes are parallel."""
        across = self.frame.rails[0] - self.machine.rails[0]
        return np.array([across, self.frame.plate + self.offset, self.frame.base + self.height])

    @cached_property
    def granite(self) -> Superelement:
        """The reduced granite."""
        return self.frame.superelement(self.folder)

    @cached_property
    def linkage(self) -> Linkage:
        """The machine's, its rails on the granite instead of the ground, and the mounts."""
        inner = self.machine.linkage
        rails = tuple(parts.rail(i) for i in parts.STRUTS)
        floors = tuple(floor(i) for i in MOUNTS)
        bodies = (
            Body(GROUND, floors),
            Body(FRAME, (*self.granite.nodes, *rails)),
            *(b for b in inner.bodies if b.name != GROUND),
        )
        nodes = (*inner.nodes, *self.granite.nodes, *floors)
        return Linkage(nodes, bodies, (*inner.joints, *self._mounts), inner.tool)

    @property
    def _mounts(self) -> tuple[Joint, ...]:
        across, down = self.mount_stiffness
        stiffness = {"x": across, "y": across, "z": down}
        return tuple(
            Joint(mount_joint(i), "bushing", (floor(i), mount(i)), stiffness) for i in MOUNTS
        )

    @property
    def _still(self) -> Array:
        """The granite's nodes, then those of the floor, in the machine's axes, (k, 3), m."""
        granite = self.granite.positions - self.origin
        return np.vstack([granite, granite[: len(MOUNTS)]])

    @cached_property
    def structure(self) -> Structure:
        """Granite, struts and bearings are flexible; blocks and housing are rigid."""
        inner = self.machine.structure
        arms = tuple(
            Body(f"rail{i} on the granite", (rail_foot(i), parts.rail(i))) for i in parts.STRUTS
        )
        return replace(
            inner,
            linkage=self.linkage,
            rigid=(*inner.rigid, *arms),
            elements=(*inner.elements, self.granite),
        )

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        """Joint ranges: none, the thesis prints none."""
        return joint_limits(self.linkage)

    def poses(self, x: ArrayLike, z: ArrayLike = 0.0, b: ArrayLike = 0.0) -> Poses:
        """As `MitSS1.poses`.

        Parameters
        ----------
        x, z : (...)
            Place of the tool tip, m.
        b : (...)
            Tilt about y, rad.
        """
        return self.machine.poses(x, z, b)

    def home(self) -> Poses:
        """Tool upright, its tip at the machine's origin."""
        return self.machine.home()

    def skeleton(self) -> Sequence[tuple[str, str]]:
        """Pairs of nodes that a drawing connects: the mechanism alone."""
        return self.machine.skeleton()

    def place(self, poses: Poses) -> Placement:
        """As `MitSS1.place`, in its axes, with the granite and the mounts beside it.

        Parameters
        ----------
        poses : Poses
            Of the tool, (...), in the machine's axes.
        """
        inner = self.machine.place(poses)
        still = self._still
        batch = inner.batch
        eye = np.broadcast_to(np.eye(3), (*batch, len(MOUNTS), 3, 3))
        return replace(
            inner,
            positions=np.concatenate(
                [inner.positions, np.broadcast_to(still, (*batch, *still.shape))], axis=-2
            ),
            frames=np.concatenate([inner.frames, eye], axis=-3),
        )

    def granite_alone(self) -> PlacedStructure:
        """The granite on its mounts without the machine."""
        floors = tuple(floor(i) for i in MOUNTS)
        bodies = (Body(GROUND, floors), Body(FRAME, self.granite.nodes))
        linkage = Linkage((*self.granite.nodes, *floors), bodies, self._mounts)
        frames = np.broadcast_to(np.eye(3), (len(MOUNTS), 3, 3))
        return Structure(linkage, elements=(self.granite,)).at(
            Placement(self._still, frames, np.zeros(0))
        )
