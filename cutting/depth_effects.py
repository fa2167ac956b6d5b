"""Which part and which mode limit the depth of a cut: derivatives of the absolute limit.

The limit is 1/(2 Re λ) at the frequency at which Re λ is largest, λ an eigenvalue of B H with B the
mean directional matrix and H the receptance at the tip. A part that is made stiffer changes H, and
the frequency stays (the envelope theorem). With w and v the left and right eigenvectors,
∂λ = wᵀ B ∂H v / wᵀv and ∂H = −Xᵀ (∂Z) X, X the motion of the structure under unit forces at the
tip: no system is solved again. Where damping is proportional to stiffness, or a constant ratio, the
effects of all parts add up to one, as shares of a compliance budget do.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.cutting.tip_dynamics import tip_ports
from strutwork.fea.coupled import AnyDamping, PartDamping, damped_matrices
from strutwork.fea.damping import ModalRatio, Rayleigh
from strutwork.fea.eigen import solve_eigen
from strutwork.fea.reduction import reduce_system
from strutwork.kinematics import DIRECTIONS
from strutwork.msa import PlacedStructure, system_of
from strutwork.msa.assembly import System

Array = NDArray[Any]


@dataclass(frozen=True)
class DepthEffects:
    """What limits the depth of a cut at a pose.

    Parameters
    ----------
    parts : tuple of q str
        As in `strutwork.msa.compliance_budget`: "beam …", "joint …:direction", "drive …:direction".
    effects : (q,)
        Share by which the depth grows per share by which a part's stiffness does, no unit.
    modes : (m,)
        Frequencies of the undamped modes, Hz, ascending.
    shares : (m,)
        Of each mode in the limit, no unit; what motions without mass add is missing.
    """

    parts: tuple[str, ...]
    effects: Array
    modes: Array
    shares: Array

    def __repr__(self) -> str:
        return f"<DepthEffects: {len(self.parts)} parts, {self.limiting_mode:.5g} Hz limits>"

    @property
    def limiting_mode(self) -> float:
        """Frequency of the mode with the largest share, Hz."""
        return float(self.modes[int(np.argmax(self.shares))])

    def to_dict(self) -> dict[str, float]:
        """Effect by part."""
        return dict(zip(self.parts, self.effects.tolist(), strict=True))

    def raised(self, part: str, stiffer: float = 0.1) -> float:
        """By which share the depth grows where one part is made stiffer, no unit.

        Parameters
        ----------
        part : str
        stiffer : float
            By this share, no unit.
        """
        return float((1.0 + stiffer) ** self.to_dict()[part] - 1.0)


def depth_effects(
    placed: PlacedStructure,
    node: str,
    damping: AnyDamping,
    matrix: ArrayLike,
    frequency: float,
    against: str | None = None,
) -> DepthEffects:
    """Effects of parts and modes on the absolute limit of a cut.

    What a part does to the forces of a preload is left out.

    Parameters
    ----------
    placed : PlacedStructure
        One pose.
    node : str
        Where the tool cuts.
    damping : damping of any kind
    matrix : (3, 3)
        Mean directional matrix in global axes, Pa (`strutwork.cutting.turned_matrices`).
    frequency : float
        Of chatter at the limit, Hz.
    against : str or None
        A node of the workpiece, relative to which the tool moves.

    Raises
    ------
    ModelError
        As `strutwork.cutting.tip_dynamics`.
    """
    system = system_of(placed)
    reduced = reduce_system(system)
    eigen = solve_eigen(reduced)
    ports, moving = tip_ports(reduced, node, against)
    load = np.stack([port.on(reduced)[0] for port in ports], axis=1)
    omega = 2.0 * np.pi * frequency
    damped = damped_matrices(reduced, eigen, damping)
    dynamic = damped.stiffness + 1j * (damped.structural + omega * damped.viscous)
    motion = np.linalg.solve((dynamic - omega**2 * damped.mass)[0], load)
    b = np.asarray(matrix, dtype=float)[np.array(moving)[:, None], np.array(moving)]
    values, right = np.linalg.eig(b @ (load.T @ motion))
    left = np.linalg.inv(right)
    top = int(np.argmax(values.real))
    size = float(values[top].real)
    # fields under the forces of both eigenvectors; left times right is one
    pair = motion @ np.stack([left[top] @ b, right[:, top]], axis=1)
    finite = eigen.finite[0]
    circular = eigen.circular[0][finite]
    shapes = eigen.flexibility[0][:, finite] * circular
    own = shapes.T @ (damped.mass[0] @ pair)
    shares = ((left[top] @ b @ load.T @ shapes) * own[:, 1]).real / size
    background = damping.background if isinstance(damping, PartDamping) else damping
    weight: Array | None = None
    if isinstance(background, ModalRatio):
        total = circular[:, None] + circular
        weight = 2j * omega * background.ratio * np.outer(own[:, 0], own[:, 1]) / total
    factor = 1.0 + 1j * (0.0 if background is None else background.structural)
    if isinstance(background, Rayleigh):
        factor += 1j * omega * background.beta
    work = _Work(system, reduced.basis[0] @ pair, reduced.basis[0] @ shapes, weight)
    found = work.of_parts(factor, _loss_factors(system, damping))
    order = np.argsort(circular)
    return DepthEffects(
        tuple(found),
        np.array([v.real for v in found.values()]) / size,
        circular[order] / (2.0 * np.pi),
        shares[order],
    )


def _loss_factors(system: System, damping: AnyDamping) -> dict[str, float]:
    """Loss factors of parts beside those of the background, by the names of parts."""
    if not isinstance(damping, PartDamping):
        return {}
    structure = system.placed.structure
    found = {f"joint {name}": factor for name, factor in damping.joints.items()}
    if damping.materials:
        found |= {f"beam {b.name}": b.material.loss_factor or 0.0 for b in structure.beams}
        for element in structure.elements:
            found[f"element {element.name}"] = getattr(element, "loss_factor", None) or 0.0
    return found


class _Work:
    """xᵃ ∂Z xᵇ of parts whose stiffness grows, from two fields and the modes."""

    def __init__(self, system: System, pair: Array, shapes: Array, weight: Array | None) -> None:
        self._system = system
        self._pair = _expanded(system, pair.real) + 1j * _expanded(system, pair.imag)
        self._weight = weight
        self._shapes = None if weight is None else _expanded(system, shapes)

    def _dyad(self, nodes: NDArray[np.intp], factor: complex, turn: Array | None) -> Array:
        """xᵇ xᵃᵀ at some nodes, with what constant damping ratios add, (6 k, 6 k).

        `turn` (6, 6): of two nodes the motion of the second relative to the first, in such axes.
        """

        def at(field: Array) -> Array:
            if turn is None:
                return np.asarray(field[nodes].reshape(-1, field.shape[-1]))
            return np.asarray(turn @ (field[nodes[1]] - field[nodes[0]]))

        two = at(self._pair)
        found = factor * np.outer(two[:, 1], two[:, 0])
        if self._shapes is not None and self._weight is not None:
            some = at(self._shapes)
            found = found + some @ self._weight.T @ some.T
        return np.asarray(found)

    def of_parts(self, factor: complex, loss: dict[str, float]) -> dict[str, complex]:
        """By part, J/N² and the like."""
        system = self._system
        found: dict[str, complex] = {}
        for name, nodes, stiffness in system.contributions():
            if name.startswith("joint "):
                continue
            dyad = self._dyad(nodes, factor + 1j * loss.get(name, 0.0), None)
            found[name] = found.get(name, 0.0) + complex(np.sum(stiffness[0] * dyad.T))
        linkage = system.placed.structure.linkage
        for j in system.topology.elastic_joints:
            joint = linkage.joints[j]
            nodes = np.array([linkage.node_index[n] for n in joint.between])
            turn = system.joint_frames[0, j].T
            own = factor + 1j * loss.get(f"joint {joint.name}", 0.0)
            work = joint.stiffness_matrix @ self._dyad(nodes, own, turn)
            for d, direction in enumerate(DIRECTIONS):
                if np.any(joint.stiffness_matrix[d]):
                    kind = "drive" if direction in joint.driven else "joint"
                    found[f"{kind} {joint.name}:{direction}"] = complex(work[d, d])
        return found


def _expanded(system: System, fields: Array) -> Array:
    """Motion of the mesh nodes (n, 6, m) by fields (c, m) on the unknowns."""
    return np.asarray(system.expand(fields[None])[0])
