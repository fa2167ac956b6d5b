"""Compliance budget: which part gives way at the tool."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import NumericalError
from strutwork.kinematics import DIRECTIONS
from strutwork.msa.assembly import system_of
from strutwork.msa.movable import movable_directions
from strutwork.msa.solve import METHODS, Method, default_method
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]


@dataclass(frozen=True)
class ComplianceBudget:
    """Share of every part in the tool's deflection along a wrench.

    Parameters
    ----------
    parts : tuple of str
        "beam …", "joint …:direction", "drive …:direction", "spring …", "element …".
    shares : (..., q)
        Shares of the strain energy, no unit; they add to one.
    deflection : (...)
        Of the tool in the sense of the wrench, wᵀ C w: J, twice the strain energy.
    wrench : (6,)
        N and N·m.
    """

    parts: tuple[str, ...]
    shares: Array
    deflection: Array
    wrench: Array

    def __repr__(self) -> str:
        return f"<ComplianceBudget: {len(self.parts)} parts, batch {self.deflection.shape}>"

    def to_dict(self) -> dict[str, float]:
        """Share by part, for a single pose."""
        return dict(zip(self.parts, (float(s) for s in self.shares.reshape(-1)), strict=True))


def compliance_budget(
    placed: PlacedStructure, wrench: ArrayLike, method: Method | None = None
) -> ComplianceBudget:
    """Share of every beam, joint direction, drive and spring in the tool's deflection.

    By Clapeyron's theorem the work of the wrench, ½ wᵀ C w, equals the strain energy; the
    energy of each part is its share in the deflection.

    Parameters
    ----------
    placed : PlacedStructure
        With a tool.
    wrench : (6,)
        At the tool, N and N·m.
    method : str, optional
        As `solve`.

    Returns
    -------
    ComplianceBudget

    Raises
    ------
    MechanismError
        The structure moves freely under the wrench.
    NumericalError
        The shares do not add to one within 1e-6.
    """
    system = system_of(placed)
    w = np.asarray(wrench, dtype=float)
    # what rigid joints take alone does no work: left in, it would be all rounding
    working = movable_directions(system).working_part(w)
    load = system.tool_load() @ working[..., None]
    gaps = np.zeros((system.poses, len(system.row_labels), 1))
    solver = METHODS[method or default_method(system)]
    unknowns = solver(system, load, gaps)
    work = np.einsum("pim,pim->p", load, unknowns.displacements)
    u = system.expand(unknowns.displacements)[..., 0]
    parts: dict[str, Array] = {}
    linkage = system.placed.structure.linkage
    for name, nodes, stiffness in system.contributions():
        if name.startswith("joint "):
            continue
        at = u[:, nodes].reshape(system.poses, -1)
        energy = np.einsum("pi,pij,pj->p", at, stiffness, at)
        parts[name] = parts.get(name, 0.0) + energy
    index = linkage.node_index
    for j in system.topology.elastic_joints:
        joint = linkage.joints[j]
        first, second = (index[n] for n in joint.between)
        turn = np.swapaxes(system.joint_frames[:, j], -1, -2)
        stretch = np.einsum("pij,pj->pi", turn, u[:, second] - u[:, first])
        force = stretch @ joint.stiffness_matrix
        for d, direction in enumerate(DIRECTIONS):
            if np.any(joint.stiffness_matrix[d]):
                kind = "drive" if direction in joint.driven else "joint"
                parts[f"{kind} {joint.name}:{direction}"] = stretch[:, d] * force[:, d]
    energies = np.stack(list(parts.values()), axis=-1) if parts else np.zeros((system.poses, 0))
    total = energies.sum(axis=-1)
    if not np.all(np.abs(total - work) <= 1e-6 * np.abs(work)):
        raise NumericalError(
            "compliance budget",
            "the parts' energies do not add up to the work of the wrench.",
            "The structure is badly conditioned: look for stiffnesses that differ too much.",
        )
    # a wrench that rigid joints take alone stores nothing: no part has a share
    shares = np.divide(
        energies, total[:, None], out=np.zeros_like(energies), where=total[:, None] > 0
    )
    batch = placed.batch
    # a refined solution has extended precision; results have not
    return ComplianceBudget(
        tuple(parts),
        shares.reshape(*batch, -1).astype(float),
        work.reshape(batch).astype(float),
        w,
    )
