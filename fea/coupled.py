"""Damping that couples the undamped modes: material and joint loss factors, joint dashpots."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.damping import Damping, LossFactor, ModalRatio, Rayleigh
from strutwork.fea.eigen import Eigen
from strutwork.fea.reduction import Reduced
from strutwork.kinematics import DIRECTIONS
from strutwork.msa.assembly import System

Array = NDArray[Any]


@dataclass(frozen=True)
class PartDamping:
    """Damping by parts.

    Parameters
    ----------
    background : Damping or None
        Acts on every mode beside the parts.
    materials : bool
        Take the loss factors of the beams' materials, and of elements that have one.
    joints : mapping of joint name to float
        Loss factors of elastic joints, no unit.
    dashpots : bool
        Take the viscous damping of the joints.

    Raises
    ------
    ModelError
        A loss factor that is negative or not below two.
    """

    background: Damping | None = None
    materials: bool = True
    joints: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))
    dashpots: bool = True

    def __post_init__(self) -> None:
        for name, value in self.joints.items():
            if not (isfinite(value) and 0 <= value < 2):
                raise ModelError(
                    f"joint {name}", f"loss factor is {value!r}.", "Give one from 0 to below 2."
                )

    def __str__(self) -> str:
        parts = [str(self.background)] if self.background is not None else []
        if self.materials:
            parts.append("materials' loss factors")
        if self.joints:
            parts.append("joints' loss factors")
        if self.dashpots:
            parts.append("joints' dashpots")
        return ", ".join(parts)


AnyDamping = ModalRatio | LossFactor | Rayleigh | PartDamping


def part_matrices(system: System, damping: PartDamping) -> tuple[Array, Array]:
    """Viscous matrix C and structural matrix D of the parts on the unknowns, (p, n, n).

    N·s/m and N/m. The force of the structure is (K + iD + iωC − ω²M) u; the background is not in
    them.

    Parameters
    ----------
    system : System
        At p poses, with n unknowns.
    damping : PartDamping

    Raises
    ------
    ModelError
        A loss factor for a joint that is unknown or not elastic.
    """
    structure = system.placed.structure
    n = system.topology.size
    viscous = np.zeros((system.poses, n, n))
    structural = np.zeros((system.poses, n, n))
    linkage = structure.linkage
    elastic = {linkage.joints[j].name for j in system.topology.elastic_joints}
    for name in damping.joints:
        if name not in elastic:
            raise ModelError(
                f"joint {name}",
                "has a loss factor but no elastic direction.",
                "Name an elastic joint.",
            )
    material = {f"beam {b.name}": b.material.loss_factor or 0.0 for b in structure.beams}
    for element in structure.elements:
        material[f"element {element.name}"] = getattr(element, "loss_factor", None) or 0.0
    for name, nodes, part in system.contributions():
        factor = 0.0
        if damping.materials:
            factor = material.get(name, 0.0)
        if name.startswith("joint "):
            factor = damping.joints.get(name.removeprefix("joint "), 0.0)
        if factor:
            system.add_part(structural, nodes, factor * part)
    if damping.dashpots:
        index = linkage.node_index
        for j, joint in enumerate(linkage.joints):
            if not joint.damping:
                continue
            values = np.diag([float(joint.damping.get(d, 0.0)) for d in DIRECTIONS])
            turn = system.joint_frames[:, j]
            c = turn @ values @ np.swapaxes(turn, -1, -2)
            whole = np.concatenate(
                [np.concatenate([c, -c], -1), np.concatenate([-c, c], -1)], axis=-2
            )
            system.add_part(viscous, np.array([index[n] for n in joint.between]), whole)
    return viscous, structural


@dataclass(frozen=True)
class DampedMatrices:
    """A structure's matrices on its c independent coordinates, damping included.

    Parameters
    ----------
    stiffness, mass, viscous, structural : (p, c, c)
        K, M, C and D: N/m, kg, N·s/m and N/m, with rad for m of rotations.
    """

    stiffness: Array
    mass: Array
    viscous: Array
    structural: Array


def damped_matrices(reduced: Reduced, eigen: Eigen, damping: AnyDamping) -> DampedMatrices:
    """Damping of any kind as matrices C and D on the coordinates.

    A modal ratio becomes C = Σ 2ζω (Mφ)(Mφ)ᵀ over the modes that have mass.

    Parameters
    ----------
    reduced : Reduced
        At p poses.
    eigen : Eigen
        Its modes, for a modal ratio.
    damping : damping of any kind
    """
    viscous = np.zeros_like(reduced.stiffness)
    structural = np.zeros_like(reduced.stiffness)
    background = damping.background if isinstance(damping, PartDamping) else damping
    if isinstance(damping, PartDamping):
        c, d = part_matrices(reduced.system, damping)
        viscous, structural = reduced.project(c), reduced.project(d)
    if isinstance(background, ModalRatio):
        shapes = eigen.flexibility * np.where(eigen.finite, eigen.circular, 0.0)[:, None, :]
        push = reduced.mass @ shapes
        weight = 2.0 * background.ratio * np.where(eigen.finite, eigen.circular, 0.0)
        viscous = viscous + (push * weight[:, None, :]) @ np.swapaxes(push, -1, -2)
    elif isinstance(background, Rayleigh):
        viscous = viscous + background.alpha * reduced.mass + background.beta * reduced.stiffness
    elif isinstance(background, LossFactor):
        structural = structural + background.value * reduced.stiffness
    return DampedMatrices(reduced.stiffness, reduced.mass, viscous, structural)


def is_coupled(reduced: Reduced, damping: AnyDamping) -> bool:
    """Whether the damping couples the undamped modes of this structure.

    Parameters
    ----------
    reduced : Reduced
    damping : damping of any kind
    """
    if not isinstance(damping, PartDamping):
        return False
    c, d = part_matrices(reduced.system, damping)
    return bool(np.any(c) or np.any(d))
