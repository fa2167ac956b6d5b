"""Static solution of load cases."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.kinematics import DIRECTIONS
from strutwork.msa.assembly import System, system_of
from strutwork.msa.condensed import solve_condensed
from strutwork.msa.diagnosis import mechanisms_under
from strutwork.msa.loads import LoadCase
from strutwork.msa.nodal import beam_end_forces
from strutwork.msa.null_space import solve_null_space
from strutwork.msa.saddle_point import solve_saddle_point
from strutwork.msa.shared_placement import solve_shared
from strutwork.msa.sparse import SPARSE_FROM, solve_sparse
from strutwork.msa.structure import PlacedStructure
from strutwork.msa.trust import Unknowns
from strutwork.msa.undetermined import undetermined
from strutwork.outcome import Outcome, solve_poses
from strutwork.stages import stage

Array = NDArray[Any]
Method = Literal["saddle_point", "null_space", "condensed", "sparse"]

Solver = Callable[[System, Array, Array], Unknowns]

METHODS: Mapping[str, Solver] = MappingProxyType(
    {
        "saddle_point": solve_saddle_point,
        "null_space": solve_null_space,
        "condensed": solve_condensed,
        "sparse": solve_sparse,
    }
)

#: What solves structures that share one placement (`strutwork.msa.stacked`).
SHARED = "shared placement"


@dataclass(frozen=True)
class StaticSolution:
    """Displacements and forces of load cases.

    Every array has the poses' axes first and the cases' axis last.

    Parameters
    ----------
    placed : PlacedStructure
    cases : tuple of str
        Names of the load cases.
    displacements : (..., n, 6, m)
        Of the mesh nodes, global axes, m and rad.
    joint_forces : (..., j, 6, m)
        On the second node of every joint, joint axes, N and N·m. Where `undetermined`, one of
        many that balance the load: `joint_force` masks them.
    beam_forces : (..., b, 2, 6, m)
        On the beam at its first and second end, local beam axes, N and N·m.
    strain_energy : (..., m)
        J.
    residual : (...)
        Largest residual of the equilibrium as a share of the load, no unit.
    method : str
        Which solver ran.
    outcome : Outcome
        Which poses were solved, and why others were not; the numbers of those are NaN.
    """

    placed: PlacedStructure
    cases: tuple[str, ...]
    displacements: Array
    joint_forces: Array
    beam_forces: Array
    strain_energy: Array
    residual: Array
    method: str
    outcome: Outcome

    def __repr__(self) -> str:
        return (
            f"<StaticSolution: {len(self.cases)} cases, batch {self.placed.batch}, "
            f"method {self.method}, {self.outcome!r}, "
            f"residual {np.max(self.residual[self.outcome.solved], initial=0.0):.1g}>"
        )

    def displacement(self, node: str, case: str) -> Array:
        """Displacement of a node, (..., 6), m and rad.

        Parameters
        ----------
        node : str
            A mesh node.
        case : str
            A load case.
        """
        index = self.placed.structure.mesh_index
        if node not in index:
            raise ModelError("solution", f'has no node "{node}".', "Name a node of the structure.")
        return np.asarray(self.displacements[..., index[node], :, self._case(case)])

    def joint_force(self, joint: str, case: str) -> Array:
        """Force on the second node of a joint in joint axes, (..., 6), N and N·m.

        A masked array where a direction is `undetermined`, else a plain one.

        Parameters
        ----------
        joint : str
        case : str
            A load case.
        """
        index = self.placed.structure.linkage.joint_index
        if joint not in index:
            raise ModelError("solution", f'has no joint "{joint}".', "Name a joint.")
        force = np.asarray(self.joint_forces[..., index[joint], :, self._case(case)])
        open_ = self.undetermined[..., index[joint], :]
        return np.ma.masked_array(force, open_) if np.any(open_) else force

    @cached_property
    def undetermined(self) -> NDArray[np.bool_]:
        """Joint directions whose force rigid parts alone leave open, (..., j, 6)."""
        result = np.zeros(self.joint_forces.shape[:-1], dtype=bool)
        if self.placed.batch == ():
            return undetermined(self.placed)
        solved = np.nonzero(self.outcome.solved)
        if len(solved[0]):
            result[solved] = undetermined(self.placed[solved])
        return result

    @property
    def undetermined_names(self) -> dict[str, tuple[str, ...]]:
        """The same by joint: its directions that are `undetermined`, at any pose of a batch."""
        joints = self.placed.structure.linkage.joints
        found = np.asarray(self.undetermined.any(axis=tuple(range(len(self.placed.batch)))))
        return {
            joint.name: tuple(d for d, open_ in zip(DIRECTIONS, row, strict=True) if open_)
            for joint, row in zip(joints, found, strict=True)
            if row.any()
        }

    def _case(self, case: str) -> int:
        if case not in self.cases:
            raise ModelError(
                "solution", f'has no case "{case}".', "Cases: " + ", ".join(self.cases)
            )
        return self.cases.index(case)

    def to_dict(self) -> dict[str, Any]:
        """Nested dictionaries by case and part, single pose only; SI. Undetermined: None."""
        if self.placed.batch != ():
            raise ModelError("solution", "has several poses.", "Choose one: solve(placed[i], …).")
        structure = self.placed.structure
        result: dict[str, Any] = {}
        for m, case in enumerate(self.cases):
            result[case] = {
                "displacements": {
                    node: self.displacements[i, :, m].tolist()
                    for i, node in enumerate(structure.linkage.nodes)
                },
                "joint_forces": {
                    joint.name: np.ma.masked_array(
                        self.joint_forces[j, :, m], self.undetermined[j]
                    ).tolist()
                    for j, joint in enumerate(structure.linkage.joints)
                },
                "beam_forces": {
                    beam.name: {
                        "from": self.beam_forces[b, 0, :, m].tolist(),
                        "to": self.beam_forces[b, 1, :, m].tolist(),
                    }
                    for b, beam in enumerate(structure.beams)
                },
                "strain_energy": float(self.strain_energy[m]),
            }
        return result


def solve(
    placed: PlacedStructure, cases: Sequence[LoadCase], method: Method | None = None
) -> StaticSolution:
    """Solve load cases at a batch of poses.

    Parameters
    ----------
    placed : PlacedStructure
    cases : sequence of LoadCase
    method : "saddle_point", "null_space", "condensed" or "sparse", optional
        Default: the saddle-point system, sparse where it is large and there is one pose.

    Returns
    -------
    StaticSolution
        In a batch, NaN at poses without an answer; `outcome` says which and why.

    Raises
    ------
    MechanismError
        A load does work in a motion that nothing resists; names the joints. As the next two, at
        the single pose or where no pose of the batch has an answer.
    InconsistentConstraintsError
        Misfits that no displacement can meet.
    NumericalError
        The residual is not small.
    ModelError
        A case that names an unknown part, or an unknown method.
    """
    system = system_of(placed)
    chosen = method or default_method(system)
    solver = METHODS.get(chosen)
    if method is None and system.lone is not None:
        chosen, solver = SHARED, solve_shared
    if solver is None:
        raise ModelError("solve", f'unknown method "{chosen}".', "One of: " + ", ".join(METHODS))
    every: dict[str, Array] = {}

    def run(part: NDArray[np.intp]) -> None:
        found = _solved(system_of(system.placed[part]), cases, solver)
        for name, array in found.items():
            if name not in every:
                every[name] = np.full((system.poses, *array.shape[1:]), np.nan)
            every[name][part] = array

    with stage(f"solves for {system.topology.size:,} unknowns"):
        outcome = solve_poses(
            run, system.poses, lambda: mechanisms_under(system, lambda part: _load(part, cases))
        ).require_some()
    batch = placed.batch
    return StaticSolution(
        placed,
        tuple(case.name for case in cases),
        **{name: array.reshape((*batch, *array.shape[1:])) for name, array in every.items()},
        method=chosen,
        outcome=outcome.reshaped(batch),
    )


def _load(system: System, cases: Sequence[LoadCase]) -> Array:
    _, elastic = system.gaps(cases)
    return system.gather(system.nodal_loads(cases) + system.elastic_gap_loads(elastic))


def _solved(system: System, cases: Sequence[LoadCase], solver: Solver) -> dict[str, Array]:
    """The arrays of a `StaticSolution` at every pose of a system; any pose may raise for all."""
    system.placed.check()
    on_rows, elastic = system.gaps(cases)
    unknowns = solver(system, _load(system, cases), on_rows)
    displacements = system.expand(unknowns.displacements)
    if not np.all(np.isfinite(displacements)):
        raise NumericalError("static solution", "is not finite.", "Check the model's numbers.")
    beam_forces, beam_energy = _beams(system, displacements, cases)
    joint_forces, joint_energy = _joints(system, displacements, unknowns, elastic)
    return {
        "displacements": displacements,
        "joint_forces": joint_forces,
        "beam_forces": beam_forces,
        "strain_energy": beam_energy + joint_energy + _others(system, displacements),
        "residual": unknowns.residual,
    }


def default_method(system: System) -> str:
    """The saddle-point system, sparse where it is large and there is one pose.

    Parameters
    ----------
    system : System
    """
    return "sparse" if system.poses == 1 and system.topology.size > SPARSE_FROM else "saddle_point"


def _beams(system: System, displacements: Array, cases: Sequence[LoadCase]) -> tuple[Array, Array]:
    """End forces of whole beams in local axes (p, b, 2, 6, m) and strain energy (p, m)."""
    structure, m = system.placed.structure, len(cases)
    if not structure.beams:
        return np.zeros((system.poses, 0, 2, 6, m)), np.zeros((system.poses, m))
    local, forces = beam_end_forces(system, displacements)
    energy = 0.5 * np.einsum("psim,psim->pm", local, forces)
    for c, case in enumerate(cases):
        loads = system.line_loads(case)
        if loads is not None:
            forces[..., c] -= loads
            energy[:, c] += _fixed_end_energy(system, loads)
    counts = np.cumsum([b.elements for b in structure.beams])
    first = forces[:, np.concatenate([[0], counts[:-1]]), :6]
    last = forces[:, counts - 1, 6:]
    return np.stack([first, last], axis=2), energy


def _fixed_end_energy(system: System, loads: Array) -> Array:
    """Strain energy of line-loaded elements with their ends held, (p,).

    What the nodal displacements do not see: the integral of N²/2EA + M²/2EI + V²/2GA_s for
    clamped ends, exact by four Gauss points as moments are cubic.
    """
    structure = system.placed.structure
    beam = structure.segments[:, 0]
    length, _ = system.placed.beam_geometry
    pieces = np.array([b.elements for b in structure.beams], dtype=float)
    properties = np.moveaxis(system.placed.numbers.stiffness, -1, 0)
    ea, _, eiy, eiz, shear_y, shear_z = properties[..., beam]
    span = (length / pieces)[:, beam]
    first, second = _per_length(loads, span, shear_y, shear_z)
    points, weights = np.polynomial.legendre.leggauss(4)
    energy = np.zeros(system.poses)
    for point, weight in zip((points + 1) / 2, weights / 2, strict=True):
        x = point * span
        slope = (second - first) / span[..., None]
        carried = first * x[..., None] + slope * (x**2)[..., None] / 2
        moment_of_load = first * (x**2)[..., None] / 2 + slope * (x**3)[..., None] / 6
        normal = -loads[..., 0] + carried[..., 0]
        total = normal**2 / (2 * ea)
        for v, r, ei, shear, sign in ((1, 5, eiz, shear_z, 1.0), (2, 4, eiy, shear_y, -1.0)):
            force = -loads[..., v] + carried[..., v]
            moment = sign * -loads[..., r] - (-loads[..., v] * x + moment_of_load[..., v])
            total = total + moment**2 / (2 * ei) + force**2 * shear / (24 * ei)
        energy += (weight * span * total).sum(axis=1)
    return energy


def _per_length(loads: Array, span: Array, shear_y: Array, shear_z: Array) -> tuple[Array, Array]:
    """Load per length at both ends of elements, from their consistent loads, (p, s, 3) each."""
    first = np.zeros((*span.shape, 3))
    second = np.zeros((*span.shape, 3))
    for axis, phi in ((0, None), (1, shear_z / span**2), (2, shear_y / span**2)):
        near, far = loads[..., axis] / span, loads[..., axis + 6] / span
        # near = q/2 + a dq, far = q/2 + (1/2 − a) dq
        a = 1 / 6 if phi is None else (3 / 20 + phi / 6) / (1 + phi)
        change = (far - near) / (0.5 - 2 * a)
        first[..., axis] = 2 * (near - a * change)
        second[..., axis] = first[..., axis] + change
    return first, second


def _joints(
    system: System, displacements: Array, unknowns: Unknowns, gaps: Array
) -> tuple[Array, Array]:
    """Joint forces (p, j, 6, m) on the second nodes in joint axes, and energy (p, m)."""
    linkage = system.placed.structure.linkage
    m = displacements.shape[-1]
    forces = np.zeros((system.poses, len(linkage.joints), 6, m), dtype=displacements.dtype)
    joint, direction = system.row_owner
    forces[:, joint, direction] = -unknowns.multipliers
    tied = system.locked_rows.tied
    if tied is not None:
        # the flank of a thread turns while it pushes; what a coupling does to the joint that leads
        # is not that joint's force, and its drive's is asked for
        other = tied.others
        for k in np.flatnonzero(joint[tied.rows] == other.joint):
            pushed = unknowns.multipliers[:, tied.rows[k]]
            forces[:, other.joint[k], other.direction[k]] += tied.ratio[k] * pushed
    energy = np.zeros((system.poses, m), dtype=displacements.dtype)
    index = linkage.node_index
    for j in system.topology.elastic_joints:
        first, second = (index[n] for n in linkage.joints[j].between)
        turn = np.swapaxes(system.joint_frames[:, j], -1, -2)
        stretch = turn @ (displacements[:, second] - displacements[:, first]) - gaps[j]
        force = system.placed.numbers.joints[..., j, :, :] @ stretch
        forces[:, j] -= force
        energy += 0.5 * np.einsum("pim,pim->pm", stretch, force)
    return forces, energy


def _others(system: System, displacements: Array) -> Array:
    """Strain energy of springs and other elements, (p, m)."""
    energy = np.zeros((system.poses, displacements.shape[-1]))
    for name, nodes, stiffness in system.contributions():
        if name.startswith(("spring ", "element ")):
            u = displacements[:, nodes].reshape(
                system.poses, 6 * len(nodes), displacements.shape[-1]
            )
            energy += 0.5 * np.einsum("pim,pim->pm", u, stiffness @ u)
    return energy
