"""The map of a motion of the tip over one tooth period, by spectral elements.

Between cuts the modes swing freely, which is exact. While a tooth cuts, the motion of the tip along
the directions of the chip is known at the nodes of elements; the modes' response to the load is
integrated with their own exponentials (`strutwork.cutting.elements`). The map takes the state of
the modes at the beginning of a period, and the motion in the period before, to the next: its
eigenvalues are the characteristic multipliers, and the cut is stable where all are smaller than 1.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

from strutwork.cutting.directional import Directional
from strutwork.cutting.elements import gauss, response_weights
from strutwork.cutting.process import Process
from strutwork.cutting.spans import Span, spans_of
from strutwork.cutting.tip_modes import TipModes
from strutwork.errors import ModelError, NumericalError

Array = NDArray[Any]

#: Unknowns of a map at most.
LARGEST = 1200

#: Directions in which the tip moves less than this share of its largest motion do not count.
STILL = 1e-12


@dataclass(frozen=True)
class Damped:
    """What the flank adds, whose load is proportional to velocity.

    Parameters
    ----------
    velocity : (m d, 3 m)
        Velocity at the nodes by load, m/(N·s).
    velocity_free : (m d, 2 n)
        Velocity at the nodes by the state at the beginning, 1/s.
    chip, flank : (3 m, m d)
        Directional matrices, N/m² by chip thickness and N·s/m² by velocity.
    kernel : (m d, 3 m)
        Motion at the nodes by load, m/N.
    drive : (2 n, 3 m)
        State at the end by load, m/N.
    """

    velocity: Array
    velocity_free: Array
    chip: Array
    flank: Array
    kernel: Array
    drive: Array

    def at(self, depth: float, free: Array, decay: Array) -> tuple[Array, Array, Array, Array]:
        """Kernel (m d, m d), free motion, decay and drive of a map with the flank.

        Parameters
        ----------
        depth : float
            m.
        free : (m d, 2 n)
            Without the flank, no unit.
        decay : (2 n, 2 n)
            Without the flank, no unit.
        """
        implicit = np.eye(len(free)) - depth * self.velocity @ self.flank
        by_state = np.linalg.solve(implicit, self.velocity_free)
        by_chip = np.linalg.solve(implicit, depth * (self.velocity @ self.chip))
        load_state = self.flank @ by_state
        load = self.chip + self.flank @ by_chip
        return (
            self.kernel @ load,
            free + depth * (self.kernel @ load_state),
            decay + depth * (self.drive @ load_state),
            self.drive @ load,
        )


@dataclass(frozen=True)
class PeriodMap:
    """Matrices of a period at one spindle speed; of a helical cutter at one depth as well.

    With m nodes, d directions of the chip and n modes.

    Parameters
    ----------
    kernel : (m d, m d)
        Motion at the nodes by regenerative load, 1/m.
    free : (m d, 2 n)
        Motion at the nodes by the state at the beginning, no unit.
    decay : (2 n, 2 n)
        State at the end by that at the beginning, no unit.
    drive : (2 n, m d)
        State at the end by regenerative load, 1/m.
    damped : Damped or None
        Of a process with damping by the flank.
    """

    kernel: Array
    free: Array
    decay: Array
    drive: Array
    damped: Damped | None = None

    def matrix(self, depth: float) -> Array:
        """The map (2 n + m d, 2 n + m d) at a depth of cut, no unit.

        Parameters
        ----------
        depth : float
            m.
        """
        kernel, free, decay, drive = self.kernel, self.free, self.decay, self.drive
        if self.damped is not None:
            kernel, free, decay, drive = self.damped.at(depth, free, decay)
        size, states = len(kernel), len(decay)
        right = np.empty((size, states + size), order="F")
        right[:, :states] = free
        right[:, states:] = -np.eye(size)
        _, _, gap, info = lapack.dgesv(np.eye(size) - depth * kernel, right, overwrite_b=1)
        if info:
            raise NumericalError("period map", "is singular.", "Take another depth of cut.")
        found = np.empty((states + size, states + size), order="F")
        found[:states] = depth * (drive @ gap)
        found[:states, :states] += decay
        found[states:] = gap
        found[states:, states:] += np.eye(size)
        return found

    def multipliers(self, depth: float) -> Array:
        """Characteristic multipliers (2 n + m d,), complex, no unit.

        Parameters
        ----------
        depth : float
            m.

        Raises
        ------
        NumericalError
            They do not come out finite.
        """
        matrix = self.matrix(depth)
        if not np.all(np.isfinite(matrix)):
            raise NumericalError(
                "period map",
                f"is beyond all numbers at a depth of {1e3 * depth:g} mm.",
                "Ask for smaller depths of cut.",
            )
        real, imaginary, _, _, info = lapack.dgeev(
            matrix, compute_vl=0, compute_vr=0, overwrite_a=1
        )
        if info:
            raise NumericalError(
                "multipliers", "do not converge.", "Ask for smaller depths or higher speeds."
            )
        return np.asarray(real + 1j * imaginary)

    def largest(self, depth: float) -> complex:
        """The multiplier of largest magnitude, with imaginary part zero or more.

        Parameters
        ----------
        depth : float
            m.
        """
        found = self.multipliers(depth)
        worst = complex(found[np.argmax(np.abs(found))])
        return complex(worst.real, abs(worst.imag))


def period_map(
    modes: TipModes, process: Process, speed: float, depth: float, margin: int
) -> PeriodMap:
    """Assemble the map at a spindle speed.

    Parameters
    ----------
    modes : TipModes
    process : Process
    speed : float
        Turns per second, Hz.
    depth : float
        m; where teeth are straight the map holds for every depth.
    margin : int
        Nodes of an element beyond half its length in radians of the fastest mode.

    Returns
    -------
    PeriodMap

    Raises
    ------
    ModelError
        No mode moves the tip in a direction of the chip.
    NumericalError
        A speed so low that the map would be beyond its largest size.
    """
    chip, flank = process.directional, process.flank(speed)
    spans = spans_of(chip, float(np.abs(modes.poles).max()), speed, depth, margin)
    basis = chip_directions(modes, chip)
    nodes = sum(span.order for span in spans)
    if nodes * basis.shape[1] > LARGEST:
        raise NumericalError(
            "period map",
            f"has {nodes * basis.shape[1]} unknowns at {60 * speed:g} rpm, more than {LARGEST}.",
            "Ask for higher speeds, or leave out modes of high frequency.",
        )
    period = chip.pitch / (2.0 * np.pi * speed)
    times = np.concatenate([s.start + 0.5 * s.length * (gauss(s.order)[0] + 1) for s in spans])
    poles = modes.poles
    within, to_end = _integrals(poles, spans, times, period)
    shapes = modes.shapes @ basis
    kernel = _real(np.einsum("ra,rc->rac", shapes, modes.loads), within)
    free = _state_part(shapes, np.exp(poles[:, None] * times))
    last = np.exp(poles * period)
    decay = np.block(
        [[np.diag(last.real), np.diag(-last.imag)], [np.diag(last.imag), np.diag(last.real)]]
    )
    ends = to_end[:, :, None] * modes.loads[:, None, :]
    drive = np.concatenate([ends.real, ends.imag]).reshape(2 * len(poles), 3 * nodes)
    angles = 2.0 * np.pi * speed * times
    chip_at = _blocks(chip.at(angles, depth) @ basis)
    plain = PeriodMap(kernel @ chip_at, free, decay, drive @ chip_at)
    if flank is None:
        return plain
    moving = shapes * poles[:, None]
    velocity = _real(np.einsum("ra,rc->rac", moving, modes.loads), within)
    # a load moves a tip at once only where residues are complex
    at_once = 2.0 * np.einsum("ra,rc->ac", shapes, modes.loads).real
    velocity += np.kron(np.eye(nodes), at_once)
    velocity_free = _state_part(moving, np.exp(poles[:, None] * times))
    flank_at = _blocks(flank.at(angles, depth) @ basis)
    return replace(plain, damped=Damped(velocity, velocity_free, chip_at, flank_at, kernel, drive))


def chip_directions(modes: TipModes, chip: Directional) -> Array:
    """Unit vectors (3, d), no unit, along which the tip moves and changes the chip.

    Parameters
    ----------
    modes : TipModes
    chip : Directional

    Raises
    ------
    ModelError
        There is none.
    """
    rows = chip.terms.reshape(-1, 3)
    _, size, axes = np.linalg.svd(rows, full_matrices=False)
    seen = axes[size > STILL * size[0]].T
    moved = seen.T @ np.concatenate([modes.shapes.real, modes.shapes.imag]).T
    left, size, _ = np.linalg.svd(moved, full_matrices=False)
    whole = max(float(np.abs(modes.shapes).max()), np.finfo(float).tiny)
    kept = left[:, size > STILL * whole]
    if not kept.shape[1]:
        raise ModelError(
            "modes of the tip",
            "move it in no direction that changes the chip.",
            "Give a mode across the cut, or check the axes of the process.",
        )
    return np.asarray(seen @ kept)


def _integrals(poles: Array, spans: list[Span], times: Array, period: float) -> tuple[Array, Array]:
    """Response of each mode at the nodes (n, m, m), and at the end (n, m), to unit loads, s."""
    nodes = len(times)
    within = np.zeros((len(poles), nodes, nodes), dtype=complex)
    to_end = np.empty((len(poles), nodes), dtype=complex)
    first = 0
    for span in spans:
        last = first + span.order
        weights = response_weights(poles, span.order, span.length)
        end = span.start + span.length
        within[:, first:last, first:last] = weights[:, :-1]
        later = np.exp(poles[:, None] * (times[last:] - end))
        within[:, last:, first:last] = later[:, :, None] * weights[:, None, -1]
        to_end[:, first:last] = np.exp(poles * (period - end))[:, None] * weights[:, -1]
        first = last
    return within, to_end


def _real(dyads: Array, within: Array) -> Array:
    """Sum over modes and their conjugates, (m d, 3 m)."""
    n, d, c = dyads.shape
    m = within.shape[-1]
    flat, square = dyads.reshape(n, d * c), within.reshape(n, m * m)
    total = 2.0 * (square.real.T @ flat.real - square.imag.T @ flat.imag)
    return np.asarray(total.reshape(m, m, d, c).transpose(0, 2, 1, 3).reshape(m * d, m * c))


def _state_part(shapes: Array, swing: Array) -> Array:
    """Motion at the nodes by real and imaginary parts of the modes' state, (m d, 2 n)."""
    parts = 2.0 * np.einsum("ra,rm->mar", shapes, swing).reshape(-1, len(shapes))
    return np.concatenate([parts.real, -parts.imag], axis=1)


def _blocks(matrices: Array) -> Array:
    """Matrices (m, 3, d) along the diagonal of (3 m, m d)."""
    m, rows, columns = matrices.shape
    found = np.zeros((m, rows, m, columns))
    found[np.arange(m), :, np.arange(m)] = matrices
    return found.reshape(m * rows, m * columns)
