"""A structure in its modes with the motors held, and in the displacements of its motors.

The unknowns are u = Φ η + G g + T x: the modes with the motors held (η, and g of rigid-body
modes), and the shape T that the structure takes when one motor has moved by one unit and the
others hold (Craig and Bampton 1968; MacNeal 1971 for the static part of modes left out). The
motors' displacements x are coordinates of their own, so a motor that is held for ever gives the
structure whose drives are locked, with its own modes and damping.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.coupled import AnyDamping, PartDamping, part_matrices
from strutwork.fea.eigen import solve_eigen
from strutwork.fea.geometric import geometric_stiffness
from strutwork.fea.motor_shapes import Motor, free_shapes, motor_rows, strained_shapes
from strutwork.fea.poles import split_massless
from strutwork.fea.reduction import AllLockedError, reduce_system
from strutwork.msa.assembly import System, system_of
from strutwork.msa.mass import mass_matrix
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]


@dataclass(frozen=True)
class DrivenModes:
    """Coordinates of one pose: k modes, r rigid-body modes, q motors; then d delayed motions.

    Parameters
    ----------
    system : System
        With n unknowns.
    motors : tuple of Motor
    frequencies : (k,)
        With the motors held, Hz.
    shapes : (n, k + r + q)
        Φ and G, 1/√kg, and T, no unit or m/rad.
    mass, damping, stiffness : (k + r + q, k + r + q)
        kg, N·s/m and N/m, with rad for m of rotations; modes have unit mass.
    late : (n, d)
        Motions without mass that dashpots delay, of unit strain energy, 1/√(N/m).
    late_damping : (d, d)
        Of theirs, s.
    late_pull : (d, k + r + q)
        What the others' rates do to them, √(N/m)·s for those in m.
    prompt : (n, s)
        Motions that follow at once, of unit strain energy: those without mass, and the modes
        left out; 1/√(N/m).
    left_out : (n, l)
        Modes left out, of unit strain energy, 1/√(N/m).
    left_out_square : (l,)
        1/ω² of theirs, s².
    equivalent : bool
        Whether a loss factor was replaced by viscous damping with the same loss at resonance.
    """

    system: System
    motors: tuple[Motor, ...]
    frequencies: Array
    shapes: Array
    mass: Array
    damping: Array
    stiffness: Array
    late: Array
    late_damping: Array
    late_pull: Array
    prompt: Array
    left_out: Array
    left_out_square: Array
    equivalent: bool

    def __repr__(self) -> str:
        return (
            f"<DrivenModes: {len(self.frequencies)} of {self.count} modes, "
            f"{len(self.motors)} motors>"
        )

    @property
    def count(self) -> int:
        """Number of modes with mass that there are, those left out included."""
        return len(self.frequencies) + int(self.left_out.shape[1])


def driven_modes(
    placed: PlacedStructure,
    motors: Sequence[Motor],
    damping: AnyDamping,
    modes: int | None = None,
    highest: float | None = None,
) -> DrivenModes:
    """Bring a structure to modes and motors.

    The damping of the structure acts on its vibration with the motors held; dashpots of joints
    resist every motion. A loss factor has no equation in time and is replaced by viscous damping
    with the same loss at each resonance.

    Parameters
    ----------
    placed : PlacedStructure
        One pose.
    motors : sequence of Motor
    damping : damping of any kind
    modes : int, optional
        Number of flexible modes to keep, the lowest.
    highest : float, optional
        Where `modes` is not given: keep those up to this frequency, Hz; all of them without it.

    Returns
    -------
    DrivenModes

    Raises
    ------
    ModelError
        Several poses, a motor that is not driven or has nothing to move, no mass.
    """
    system = system_of(placed)
    if system.poses != 1:
        raise ModelError("state space", f"of {system.poses} poses.", "Give one pose.")
    if modes is not None and modes < 1:
        raise ModelError("state space", f"with {modes} modes.", "Keep at least one.")
    n = system.topology.size
    try:
        reduced = reduce_system(system)
        eigen = solve_eigen(reduced)
        flexible = reduced.basis[0] @ eigen.flexibility[0]
        square = eigen.square[0]
        rigid = reduced.basis[0] @ eigen.rigid[0]
    except AllLockedError:
        # a rigid machine moves by its drives alone
        if not motors:
            raise
        flexible, square, rigid = np.zeros((n, 0)), np.zeros(0), np.zeros((n, 0))
    rigid = rigid[:, np.any(rigid, axis=0)]
    massive = square > 0
    circular = 1.0 / np.sqrt(square[massive])
    shapes = flexible[:, massive] * circular
    keep = _kept(circular, modes, highest)
    mass = mass_matrix(system)[0]
    shift, braced = _motor_shapes(system, motors, flexible, rigid, mass)
    columns = np.concatenate([shapes[:, keep], rigid, shift], axis=1)
    own = columns.shape[1] - len(motors)
    inertia = columns.T @ mass @ columns
    # modes are orthonormal but for rounding
    inertia[:own, :own] = np.eye(own)
    inertia[own:, own:] += np.diag([m.inertia for m in motors])
    stiff = np.zeros_like(inertia)
    stiff[: len(circular[keep]), : len(circular[keep])] = np.diag(circular[keep] ** 2)
    stiff[own:, own:] = braced
    drag, equivalent = _background(system, damping, columns, circular[keep], own)
    late, prompt = np.zeros((n, 0)), flexible[:, ~massive]
    pull: Array = np.zeros((0, n))
    if isinstance(damping, PartDamping):
        viscous = part_matrices(system, damping)[0][0]
        viscous = viscous - _across_motors(system, motors, np.eye(n))
        longest = float(1.0 / circular.min()) if len(circular) else 0.0
        late, prompt = split_massless(prompt, viscous, longest)
        pull = late.T @ viscous
        drag += columns.T @ viscous @ columns + _across_motors(system, motors, columns, own)
    rest = flexible[:, massive][:, ~keep]
    return DrivenModes(
        system,
        tuple(motors),
        circular[keep] / (2.0 * np.pi),
        columns,
        inertia,
        drag,
        stiff,
        late,
        pull @ late,
        pull @ columns,
        np.concatenate([prompt, rest], axis=1),
        rest,
        square[massive][~keep],
        equivalent,
    )


def _background(
    system: System, damping: AnyDamping, columns: Array, circular: Array, own: int
) -> tuple[Array, bool]:
    """Damping of the modes, and whether a loss factor is in it.

    Of the coordinates, the first are the modes of the circular frequencies; `own` are no motors.
    """
    k = len(circular)
    drag = np.zeros((columns.shape[1],) * 2)
    background = damping.background if isinstance(damping, PartDamping) else damping
    equivalent = False
    if background is not None:
        viscous = background.viscous(circular**-2.0) * circular**2
        drag[:k, :k] = np.diag(viscous + background.structural * circular)
        drag[k:own, k:own] = background.rigid * np.eye(own - k)
        equivalent = background.structural > 0
    if isinstance(damping, PartDamping):
        structural = part_matrices(system, damping)[1][0]
        lossy = columns[:, :k] / np.sqrt(circular)
        drag[:k, :k] += lossy.T @ structural @ lossy
        equivalent = equivalent or bool(np.any(structural))
    return drag, equivalent


def _kept(circular: Array, modes: int | None, highest: float | None) -> NDArray[np.bool_]:
    if modes is not None:
        return np.arange(len(circular)) < modes
    if highest is None:
        return np.ones(len(circular), dtype=bool)
    return np.asarray(circular <= 2.0 * np.pi * highest)


def _motor_shapes(
    system: System, motors: Sequence[Motor], flexible: Array, rigid: Array, mass: Array
) -> tuple[Array, Array]:
    """T (n, q), and the stiffness against the motors, (q, q), zero where nothing braces them.

    From any shapes T₀ that keep the constraints, with r the forces that they leave unbalanced,
    T = T₀ − ψ ψᵀ r is in balance, and the work of r on ψ is the strain that it saves.
    """
    if not motors:
        return np.zeros((system.topology.size, 0)), np.zeros((0, 0))
    rows, springs = motor_rows(system, motors)
    preload = None
    if system.placed.stiffening is not None:
        preload = geometric_stiffness(system)[0]
    shift = free_shapes(system.placed, motors)
    if shift is not None:
        braced = np.zeros((len(motors), len(motors)))
        if preload is not None:
            # without strain the preload alone pushes
            left = preload @ shift
            saved = flexible.T @ left
            braced = shift.T @ left - saved.T @ saved
            shift = shift - flexible @ saved
    else:
        held = np.flatnonzero(springs == 0)
        shift = np.zeros((system.topology.size, len(motors)))
        if len(held):
            shift[:, held] = strained_shapes(system.placed, [motors[int(i)] for i in held])
        stiffness = system.stiffness[0] if preload is None else system.stiffness[0] + preload
        push = rows.T * springs
        left = stiffness @ shift - push
        saved = flexible.T @ left
        across = shift.T @ push
        braced = shift.T @ stiffness @ shift - across - across.T + np.diag(springs)
        braced = braced - saved.T @ saved
        shift = shift - flexible @ saved
    if rigid.shape[1]:
        shift = shift - rigid @ (rigid.T @ mass @ shift)
    return shift, 0.5 * (braced + braced.T)


def _across_motors(
    system: System, motors: Sequence[Motor], columns: Array, own: int | None = None
) -> Array:
    """Dashpots in the elastic directions of motors, with the motors held or moving.

    Like the spring they stand beside, they are between the motor and what it drives.
    """
    rows, springs = motor_rows(system, motors)
    linkage = system.placed.structure.linkage
    size = columns.shape[1]
    found = np.zeros((size, size))
    for i, motor in enumerate(motors):
        joint = linkage.joints[linkage.joint_index[motor.joint]]
        dashpot = float(joint.damping.get(motor.direction, 0.0))
        if not springs[i] or not dashpot:
            continue
        row = rows[i] @ columns
        if own is not None:
            row[own + i] -= 1.0
        found += dashpot * np.outer(row, row)
    return found


def without_motors(found: DrivenModes) -> DrivenModes:
    """The same structure with all its motors held.

    Parameters
    ----------
    found : DrivenModes
    """
    own = len(found.mass) - len(found.motors)
    return replace(
        found,
        motors=(),
        shapes=found.shapes[:, :own],
        mass=found.mass[:own, :own],
        damping=found.damping[:own, :own],
        stiffness=found.stiffness[:own, :own],
        late_pull=found.late_pull[:, :own],
    )
