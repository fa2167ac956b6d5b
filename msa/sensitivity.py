"""Derivatives of the compliance and stiffness at the tool, and of displacements and joint forces.

The saddle-point matrix M is symmetric, so the adjoint of the six unit wrenches is their own
solution Z = M⁻¹ F, and ∂C/∂p = −Zᵀ (∂M/∂p) Z (Haug, Choi, Komkov 1986, section 1.2): one solution
serves every parameter. A displacement or joint force s = Gᵀ M⁻¹ F takes one more, with G loaded.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, State
from strutwork.msa.assembly import System, system_of
from strutwork.msa.changes import PlacedChange
from strutwork.msa.loads import LoadCase
from strutwork.msa.movable import always_movable, movable_directions, tool_length
from strutwork.msa.part_forms import Fields, FormBuilder
from strutwork.msa.rigid_map import rigid_map
from strutwork.msa.solve import METHODS, Method, default_method
from strutwork.msa.stiffness import (
    axis_stiffness_blocked,
    axis_stiffness_free,
    doubtful,
    movable_inverse,
    scaled,
)
from strutwork.msa.structure import PlacedStructure
from strutwork.msa.tool_load_rates import tool_load_rates

Array = NDArray[Any]


@dataclass(frozen=True)
class ComplianceSensitivity:
    """Compliance at the tool and its derivatives at p poses.

    Parameters
    ----------
    parameters : tuple of g str
    compliance : (p, 6, 6)
        m/N, 1/N, rad/(N·m).
    rates : (g, p, 6, 6)
        ∂C/∂p, m/N, 1/N, rad/(N·m) per unit of each parameter.
    """

    parameters: tuple[str, ...]
    compliance: Array
    rates: Array

    def __repr__(self) -> str:
        return (
            f"<ComplianceSensitivity: {len(self.parameters)} parameters, "
            f"{len(self.compliance)} poses>"
        )

    @property
    def free(self) -> Array:
        """∂(1/C_ii)/∂p, (g, p, 6), N/m and N·m/rad per unit; NaN where there is no finite one."""
        stiffness = axis_stiffness_free(self.compliance)
        finite = np.where(np.isfinite(stiffness), stiffness, np.nan)
        return np.asarray(-(finite**2) * np.einsum("gpii->gpi", self.rates))

    @property
    def blocked(self) -> Array:
        """∂(C⁻¹)_ii/∂p, (g, p, 6), N/m and N·m/rad per unit; NaN where the stiffness is infinite.

        Where the tool cannot move in some directions, with these held as they are.
        """
        stiffness = axis_stiffness_blocked(self.compliance)
        inverse = movable_inverse(self.compliance)
        rates = -np.einsum("pij,gpjk,pki->gpi", inverse, self.rates, inverse, optimize=True)
        return np.where(np.isfinite(stiffness), rates, np.nan)


def compliance_sensitivity(
    placed: PlacedStructure, changes: Sequence[PlacedChange], method: Method | None = None
) -> ComplianceSensitivity:
    """Compliance at the tool and its derivatives, from one solution at every pose.

    Parameters
    ----------
    placed : PlacedStructure
        At poses (...); made one batch axis of p poses.
    changes : sequence of PlacedChange
        At the same poses, one axis.
    method : str, optional
        As `solve`.

    Returns
    -------
    ComplianceSensitivity

    Raises
    ------
    ModelError
        No tool.
    MechanismError, NumericalError
        As `solve`, at any of the poses.
    """
    system = system_of(placed)
    system.placed.check()
    load = system.tool_load()
    gaps = np.zeros((system.poses, len(system.row_labels), 6))
    found = METHODS[method or default_method(system)](system, load, gaps)
    compliance = np.swapaxes(load, -1, -2) @ found.displacements.astype(float)
    compliance = (compliance + np.swapaxes(compliance, -1, -2)) / 2.0
    fields = Fields(found.displacements.astype(float), found.multipliers.astype(float))
    rates = -FormBuilder(system, changes).forms(fields).elastic
    turned = tool_load_rates(system, changes)
    if turned is not None:
        own = np.swapaxes(turned, -1, -2) @ fields.unknowns
        rates = rates + own + np.swapaxes(own, -1, -2)
    _keep_movable(system, compliance)
    return ComplianceSensitivity(tuple(c.name for c in changes), compliance, rates)


def _keep_movable(system: System, compliance: Array) -> None:
    """Leave out what rounding adds in directions in which the tool cannot move."""
    if always_movable(system):
        return
    some = np.flatnonzero(doubtful(scaled(compliance, tool_length(system))[0]))
    if not some.size:
        return
    found = movable_directions(system_of(system.placed[some]))
    locked = found.rank < 6
    compliance[some[locked]] = found[locked].projected(compliance[some[locked]])


@dataclass(frozen=True)
class StaticQuantity:
    """A displacement of a node, or the force of a joint, under a load case.

    Parameters
    ----------
    kind : "displacement" or "joint_force"
    part : str
        Node or joint.
    direction : str
        Global axes for a displacement, joint axes for a force on the joint's second node.
    case : LoadCase

    Raises
    ------
    ModelError
        Another kind or direction.
    """

    kind: str
    part: str
    direction: str
    case: LoadCase

    def __post_init__(self) -> None:
        if self.kind not in ("displacement", "joint_force"):
            raise ModelError(
                f"quantity {self.kind}", "is not known.", "Say displacement or joint_force."
            )
        if self.direction not in DIRECTIONS:
            raise ModelError(
                f"quantity {self.kind} of {self.part}",
                f'has the unknown direction "{self.direction}".',
                "Directions are " + ", ".join(DIRECTIONS) + ".",
            )


@dataclass(frozen=True)
class StaticSensitivity:
    """Static quantities and their derivatives at p poses.

    Parameters
    ----------
    quantities : tuple of q StaticQuantity
    parameters : tuple of g str
    values : (p, q)
        m, rad, N or N·m.
    rates : (g, p, q)
        m, rad, N or N·m per unit of each parameter.
    """

    quantities: tuple[StaticQuantity, ...]
    parameters: tuple[str, ...]
    values: Array
    rates: Array


def static_sensitivity(
    placed: PlacedStructure,
    changes: Sequence[PlacedChange],
    quantities: Sequence[StaticQuantity],
    method: Method | None = None,
) -> StaticSensitivity:
    """Displacements and joint forces with their derivatives, from two solutions at every pose.

    The first solves the load cases, the second the quantities' own loads: a unit force for a
    displacement, a unit misfit for the force of a locked joint (Maxwell and Betti).

    Parameters
    ----------
    placed : PlacedStructure
        At poses (...); made one batch axis of p poses.
    changes : sequence of PlacedChange
        At the same poses, one axis.
    quantities : sequence of StaticQuantity
    method : str, optional
        As `solve`.

    Raises
    ------
    ModelError
        An unknown node or joint, or a free joint direction, which carries no force.
    InconsistentConstraintsError
        The force of a joint that rigid parts leave undetermined.
    MechanismError, NumericalError
        As `solve`.
    """
    system = system_of(placed)
    system.placed.check()
    cases = _cases(quantities)
    of_case = [cases.index(q.case) for q in quantities]
    on_rows, elastic = system.gaps(cases)
    load = system.gather(system.nodal_loads(cases) + system.elastic_gap_loads(elastic))
    solver = METHODS[method or default_method(system)]
    loaded = solver(system, load, on_rows)
    asked, missed = _own_loads(system, quantities)
    adjoint = solver(system, asked, missed)
    u, y = (x.displacements.astype(float) for x in (loaded, adjoint))
    held, other = (x.multipliers.astype(float) for x in (loaded, adjoint))
    m = len(cases)
    fields = Fields(np.concatenate([u, y], axis=-1), np.concatenate([held, other], axis=-1))
    builder = FormBuilder(system, changes)
    forms = builder.forms(fields).elastic[:, :, :m, m:]
    values = np.einsum("pnq,pnq->pq", asked, u[..., of_case])
    values = values + np.einsum("prq,prq->pq", missed, held[..., of_case])
    values = values - _own_gaps(system, quantities, elastic)
    rates = -np.stack([forms[:, :, c, q] for q, c in enumerate(of_case)], axis=-1)
    rates += _load_rates(system, changes, cases, y)[:, :, of_case, range(len(of_case))]
    rates += _direct_rates(builder, quantities, u, of_case, elastic)
    return StaticSensitivity(tuple(quantities), tuple(c.name for c in changes), values, rates)


def _cases(quantities: Sequence[StaticQuantity]) -> list[LoadCase]:
    """The load cases, each once; they are mappings inside and have no hash."""
    found: list[LoadCase] = []
    for quantity in quantities:
        if quantity.case not in found:
            found.append(quantity.case)
    return found


def _joint(system: System, quantity: StaticQuantity) -> tuple[int, int, State]:
    linkage = system.placed.structure.linkage
    if quantity.part not in linkage.joint_index:
        raise ModelError(
            f"joint {quantity.part}", "is not in the structure.", "Name one of its joints."
        )
    j, d = linkage.joint_index[quantity.part], DIRECTIONS.index(quantity.direction)
    state = State(int(linkage.states()[j, d]))
    if state == State.FREE:
        raise ModelError(
            f"joint {quantity.part}",
            f"is free in {quantity.direction}: it carries no force there.",
            "Name a locked or elastic direction.",
        )
    return j, d, state


def _own_loads(system: System, quantities: Sequence[StaticQuantity]) -> tuple[Array, Array]:
    """Load on the unknowns (p, n, q) and on the rows (p, r, q) of which quantities are the work."""
    structure, q = system.placed.structure, len(quantities)
    nodal = np.zeros((system.poses, len(structure.mesh_nodes), 6, q))
    rows = np.zeros((system.poses, len(system.row_labels), q))
    tied = system.locked_rows.tied
    for k, quantity in enumerate(quantities):
        if quantity.kind == "displacement":
            if quantity.part not in structure.mesh_index:
                raise ModelError(
                    f"node {quantity.part}", "is not in the structure.", "Name one of its nodes."
                )
            node = structure.mesh_index[quantity.part]
            nodal[:, node, DIRECTIONS.index(quantity.direction), k] = 1.0
            continue
        j, d, state = _joint(system, quantity)
        if state == State.ELASTIC:
            joint = structure.linkage.joints[j]
            push = system.joint_frames[:, j] @ joint.stiffness_matrix[d]
            first, second = (structure.mesh_index[n] for n in joint.between)
            nodal[:, first, :, k] += push
            nodal[:, second, :, k] -= push
            continue
        owner, direction = system.row_owner
        rows[:, np.flatnonzero((owner == j) & (direction == d)), k] = -1.0
        if tied is not None:
            other = tied.others
            # a helical joint's flank turns while it pushes
            same = (other.joint == j) & (other.direction == d) & (owner[tied.rows] == j)
            rows[:, tied.rows[same], k] += tied.ratio[same]
    return system.gather(nodal), rows


def _own_gaps(system: System, quantities: Sequence[StaticQuantity], elastic: Array) -> Array:
    """What misfits of elastic directions take off their forces, (q,)."""
    cases = _cases(quantities)
    result = np.zeros(len(quantities))
    for k, quantity in enumerate(quantities):
        if quantity.kind == "joint_force":
            j, d, state = _joint(system, quantity)
            if state == State.ELASTIC:
                matrix = system.placed.structure.linkage.joints[j].stiffness_matrix
                result[k] = -float(matrix[d] @ elastic[j, :, cases.index(quantity.case)])
    return result


def _load_rates(
    system: System, changes: Sequence[PlacedChange], cases: Sequence[LoadCase], y: Array
) -> Array:
    """Work of the change of the loads on the adjoint, (g, p, c, q)."""
    result = np.zeros((len(changes), system.poses, len(cases), y.shape[-1]))
    heavy = any(case.gravity is not None for case in cases)
    joints = any(case.gaps for case in cases)
    for i, change in enumerate(changes):
        if change.systems is not None:
            sides = change.systems
        elif heavy or joints:
            placement = system.placed.placement
            above, below = (
                system_of(PlacedStructure(s, placement))
                for s in (change.change.above, change.change.below)
            )
            sides = (above, below)
        else:
            continue
        loads = []
        for side in sides:
            _, elastic = side.gaps(cases)
            nodal = side.nodal_loads(cases) + side.elastic_gap_loads(elastic)
            loads.append(side.gather(nodal))
        rate = (loads[0] - loads[1]) / change.change.width
        result[i] = np.swapaxes(rate, -1, -2) @ y
    return result


def _direct_rates(
    builder: FormBuilder,
    quantities: Sequence[StaticQuantity],
    u: Array,
    of_case: Sequence[int],
    elastic: Array,
) -> Array:
    """Change of the quantities with the displacements held, (g, p, q)."""
    system = builder.system
    structure, p = system.placed.structure, system.poses
    result = np.zeros((len(builder.changes), p, len(quantities)))
    blocks = u.reshape(p, -1, 6, u.shape[-1])
    padded = np.concatenate([blocks, np.zeros((p, 1, 6, u.shape[-1]))], axis=1)
    at = padded.swapaxes(0, 1)
    for k, quantity in enumerate(quantities):
        c = of_case[k]
        d = DIRECTIONS.index(quantity.direction)
        if quantity.kind == "displacement":
            node = structure.mesh_index[quantity.part]
            vertex = structure.vertex_of_node[node]
            for i, change in enumerate(builder.changes):
                if change.geometry is not None:
                    turned = rigid_map(change.geometry.nodes[:, node])
                    # rigid_map adds the identity, which no arm changes
                    moved = turned @ padded[:, vertex, :, c, None] - padded[:, vertex, :, c, None]
                    result[i, :, k] += moved[:, d, 0]
            continue
        j, d, state = _joint(system, quantity)
        if state != State.ELASTIC:
            continue
        stretch, rates = builder.joint_stretch(j, at)
        gap = elastic[j, :, c]
        matrix = structure.linkage.joints[j].stiffness_matrix
        for i, change in enumerate(builder.changes):
            own = change.change.numbers.joints[j, d]
            result[i, :, k] -= (stretch[..., c] - gap) @ own + rates[i, ..., c] @ matrix[d]
    return result
