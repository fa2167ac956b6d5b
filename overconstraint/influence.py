"""Joint forces and tool displacement per unit misfit: F = S g, from the saddle-point system."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Linkage, State
from strutwork.msa.assembly import system_of
from strutwork.msa.loads import LoadCase
from strutwork.msa.nodal_response import tool_displacement
from strutwork.msa.solve import Method, solve
from strutwork.msa.structure import PlacedStructure
from strutwork.msa.undetermined import undetermined
from strutwork.outcome import Outcome, solve_poses
from strutwork.overconstraint.rounding import without_rounding
from strutwork.overconstraint.self_stress import redundancy
from strutwork.overconstraint.tool_place import MOVES, check_tool_place

Array = NDArray[Any]


class UndeterminedWarning(UserWarning):
    """Only the sum of some forces is determined."""


@dataclass(frozen=True)
class Influence:
    """Effect of every misfit, at a batch of poses.

    Parameters
    ----------
    linkage : Linkage
    columns : tuple of (joint name, direction)
        The misfits: in joint axes, the displacement of the second side against the first that
        closes the joint.
    forces : (..., j, 6, g)
        On the second node of every joint in joint axes, per unit misfit: N/m, N·m/m, N/rad and
        N·m/rad.
    tool : (..., 6, g)
        Displacement and rotation of the tool per unit misfit, relative to the workpiece where the
        linkage names one, global axes: m/m, rad/m, m/rad and rad/rad.
    redundant : (...) of int
        States of self-stress; where there is none the forces are exactly zero.
    residual : (...)
        Of the equilibrium, as a share of the forces.
    outcome : Outcome
        Which poses were solved, and why others were not; the numbers of those are NaN.
    """

    linkage: Linkage
    columns: tuple[tuple[str, str], ...]
    forces: Array
    tool: Array
    redundant: NDArray[np.intp]
    residual: Array
    outcome: Outcome = field(default_factory=lambda: Outcome.good(()))

    def __repr__(self) -> str:
        return (
            f"<Influence: {len(self.linkage.joints)} joints, {len(self.columns)} misfits, "
            f"batch {self.redundant.shape}, N/m>"
        )

    def __getitem__(self, index: Any) -> Influence:
        return Influence(
            self.linkage,
            self.columns,
            self.forces[index],
            self.tool[index],
            np.asarray(self.redundant[index]),
            np.asarray(self.residual[index]),
            self.outcome[index],
        )


@dataclass(frozen=True)
class AssemblyForces:
    """Forces and tool displacement due to given misfits.

    Parameters
    ----------
    linkage : Linkage
    forces : (..., j, 6)
        On the second node of every joint in joint axes, N and N·m.
    tool : (..., 6)
        Displacement and rotation of the tool, global axes, m and rad.
    """

    linkage: Linkage
    forces: Array
    tool: Array

    def __repr__(self) -> str:
        return f"<AssemblyForces: {len(self.linkage.joints)} joints, N and N·m>"

    def to_dict(self) -> dict[str, Any]:
        """Forces by joint and the tool's displacement, SI."""
        return {
            "joint_forces": {
                joint.name: self.forces[..., j, :].tolist()
                for j, joint in enumerate(self.linkage.joints)
            },
            "tool": self.tool.tolist(),
        }


def influence(
    placed: PlacedStructure,
    columns: Sequence[tuple[str, str]] | None = None,
    method: Method | None = None,
) -> Influence:
    """Joint forces and tool displacement per unit misfit.

    The saddle-point system with no load and the misfits on its right; the forces are its
    multipliers, and the stiffness times what is left of the gap in elastic directions. With
    S the whole matrix, ½ gᵀ S g is the energy locked in, so S is symmetric.

    Parameters
    ----------
    placed : PlacedStructure
    columns : sequence of (joint, direction), optional
        Default: every locked or elastic direction of a joint that is no support.
    method : str, optional
        Of `strutwork.msa.solve`.

    Returns
    -------
    Influence
        Entries that no state of self-stress reaches are exactly zero. In a batch, NaN at poses
        without an answer; `outcome` says which and why.

    Raises
    ------
    MechanismError
        Misfits move the tool along a motion that nothing resists; names the joints. Free motions
        that no misfit drives, a shaft that spins in its bearings, change nothing.
        As the next, at the single pose or where no pose of the batch has an answer.
    InconsistentConstraintsError
        A rigid loop that no elastic part closes: its misfit would take an infinite force.
    ModelError
        An unknown joint, or a free direction.

    Warns
    -----
    UndeterminedWarning
        Rigid joints side by side carry a force whose division among them rigid parts leave open.
    """
    linkage = placed.structure.linkage
    chosen = tuple(misfit_directions(linkage) if columns is None else columns)
    batch = placed.batch
    if not chosen:
        empty = np.zeros((*batch, len(linkage.joints), 6, 0))
        return Influence(
            linkage,
            (),
            empty,
            np.zeros((*batch, 6, 0)),
            redundancy(placed).count,
            np.zeros(batch),
            Outcome.good(batch),
        )
    flat = system_of(placed).placed
    poses = flat.batch[0]
    every: list[Array] = []

    def run(part: NDArray[np.intp]) -> None:
        found = _solved(flat[part], chosen, method)
        if not every:
            every.extend(
                np.full((poses, *a.shape[1:]), np.nan if a.dtype.kind == "f" else 0, a.dtype)
                for a in found
            )
        for whole, array in zip(every, found, strict=True):
            whole[part] = array

    outcome = solve_poses(run, poses).require_some()
    forces, tool, count, residual, open_ = every
    _warn_of_rigid_shares(linkage, forces[outcome.solved], open_[outcome.solved])
    return Influence(
        linkage,
        chosen,
        forces.reshape(*batch, *forces.shape[1:]),
        tool.reshape(*batch, *tool.shape[1:]),
        count.reshape(batch),
        residual.reshape(batch),
        outcome.reshaped(batch),
    )


def _solved(
    placed: PlacedStructure, columns: tuple[tuple[str, str], ...], method: Method | None
) -> tuple[Array, Array, Array, Array, Array]:
    """Forces, tool, states of self-stress, residual and what is undetermined, (p, …) each."""
    linkage = placed.structure.linkage
    cases = [LoadCase(f"misfit {j} {d}", gaps={(j, d): 1.0}) for j, d in columns]
    solution = solve(placed, cases, method)
    solution.outcome.require_all()
    found = redundancy(placed)
    index = linkage.joint_index
    active = np.stack(
        [found.takes_part[..., index[j], DIRECTIONS.index(d)] for j, d in columns], axis=-1
    )
    forces = np.where(
        found.takes_part[..., None] & active[..., None, None, :], solution.joint_forces, 0.0
    )
    moved = solution.displacements
    tool = (
        np.zeros_like(moved[..., 0, :, :])
        if linkage.tool is None
        else tool_displacement(placed, moved)
    )
    forces, tool = without_rounding(placed, columns, forces, tool)
    check_tool_place(system_of(placed), tool.reshape(-1, *tool.shape[-2:]))
    return forces, tool, found.count, solution.residual, undetermined(placed)


def assembly_forces(
    found: Influence, misfits: Mapping[tuple[str, str], float] | Array
) -> AssemblyForces:
    """Forces and tool displacement for given misfits.

    Parameters
    ----------
    found : Influence
    misfits : mapping of (joint, direction) to float, or (..., g)
        m or rad; an array in the order of the influence's columns, batch axes after the poses'.

    Returns
    -------
    AssemblyForces

    Raises
    ------
    ModelError
        A misfit that is no column of the influence.
    """
    if isinstance(misfits, Mapping):
        unknown = [key for key in misfits if key not in found.columns]
        if unknown:
            joint, direction = unknown[0]
            raise ModelError(
                f"joint {joint}",
                f"has no column for a misfit in {direction}.",
                "Compute the influence of this direction, if it is locked or elastic.",
            )
        gap = np.array([misfits.get(key, 0.0) for key in found.columns])
    else:
        gap = np.asarray(misfits, dtype=float)
    return AssemblyForces(
        found.linkage,
        np.einsum("...jdg,...g->...jd", found.forces, gap),
        np.einsum("...dg,...g->...d", found.tool, gap),
    )


def _warn_of_rigid_shares(linkage: Linkage, forces: Array, open_: NDArray[np.bool_]) -> None:
    carries = np.abs(forces).max(axis=-1) > MOVES * np.abs(forces).max(initial=0.0)
    found = (open_ & carries).reshape(-1, len(linkage.joints), 6).any(axis=0)
    named = [
        f"{linkage.joints[j].name} in {DIRECTIONS[d]}"
        for j, d in zip(*found.nonzero(), strict=True)
    ]
    if named:
        warnings.warn(
            f"joints {', '.join(named)}: rigid parts alone decide how these share a force, so "
            "only their sum is certain; the least forces in balance are given. Give one of these "
            "joints or bodies its real stiffness.",
            UndeterminedWarning,
            stacklevel=3,
        )


def misfit_directions(linkage: Linkage) -> tuple[tuple[str, str], ...]:
    """Locked or elastic directions of the joints that are no supports.

    Parameters
    ----------
    linkage : Linkage
    """
    return tuple(
        (joint.name, d)
        for joint, states in zip(linkage.joints, linkage.states(), strict=True)
        if joint.type != "support"
        for d, state in zip(DIRECTIONS, states, strict=True)
        if state != State.FREE
    )
