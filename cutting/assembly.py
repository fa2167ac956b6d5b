"""Assembly of the map of a tooth period from the modes of the tip and the process."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.cutting.directional import Directional
from strutwork.cutting.elements import gauss, response_weights
from strutwork.cutting.period_map import Damped, PeriodMap, diagonal
from strutwork.cutting.process import Process
from strutwork.cutting.spans import Span, spans_of
from strutwork.cutting.tip_modes import TipModes
from strutwork.errors import ModelError, NumericalError

Array = NDArray[Any]

#: Unknowns of a map at most.
LARGEST = 1200

#: Directions in which the tip moves less than this share of its largest motion do not count.
STILL = 1e-12


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
        Nodes of the longest element beyond half its length in radians of the fastest mode; what
        is shorter has as many as resolve it like that one.

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
    return assembly(modes, process).at(speed, depth, margin)


@dataclass(frozen=True)
class Assembly:
    """What the maps of a cut share at all speeds and depths.

    Parameters
    ----------
    modes : TipModes
    process : Process
    chip : Directional
        Of the process, N/m² by chip thickness.
    basis : (3, d)
        Directions of the chip, no unit.
    """

    modes: TipModes
    process: Process
    chip: Directional
    basis: Array

    @property
    def fastest(self) -> float:
        """Largest magnitude of a pole, rad/s."""
        return float(np.abs(self.modes.poles).max())

    def at(self, speed: float, depth: float, margin: int) -> PeriodMap:
        """The map at a spindle speed, as `period_map`.

        Parameters
        ----------
        speed : float
            Turns per second, Hz.
        depth : float
            m.
        margin : int

        Raises
        ------
        NumericalError
            A speed so low that the map would be beyond its largest size.
        """
        chip, basis, poles, loads = self.chip, self.basis, self.modes.poles, self.modes.loads
        spans = spans_of(chip, self.fastest, speed, depth, margin)
        nodes = sum(span.order for span in spans)
        unknowns = nodes * basis.shape[1]
        if unknowns > LARGEST:
            raise NumericalError(
                "period map",
                f"has {unknowns} unknowns at {60 * speed:g} rpm, more than {LARGEST}.",
                "Ask for higher speeds, or leave out modes of high frequency.",
            )
        period = chip.pitch / (2.0 * np.pi * speed)
        times = np.concatenate([s.start + 0.5 * s.length * (gauss(s.order)[0] + 1) for s in spans])
        within, to_end = _integrals(poles, spans, times, period)
        shapes = self.modes.shapes @ basis
        swing = np.exp(poles[:, None] * times)
        angles = 2.0 * np.pi * speed * times
        chip_at = chip.at(angles, depth) @ basis
        # what the chip drives in each mode, (n, m, d): fewer products than by forces along 3 axes
        driven = (loads @ chip_at.transpose(1, 0, 2).reshape(3, -1)).reshape(len(loads), nodes, -1)
        plain = PeriodMap(
            _motion(shapes, within, driven),
            _state_part(shapes, swing),
            _turned(np.exp(poles * period)),
            _at_end(to_end, driven),
        )
        flank = self.process.flank(speed)
        if flank is None:
            return plain
        forced = np.broadcast_to(loads[:, None, :], (len(poles), nodes, 3))
        moving = shapes * poles[:, None]
        velocity = _motion(moving, within, forced)
        # a load moves a tip at once only where residues are complex
        velocity += np.kron(np.eye(nodes), 2.0 * (shapes.T @ loads).real)
        damped = Damped(
            velocity,
            _state_part(moving, swing),
            _blocks(chip_at),
            _blocks(flank.at(angles, depth) @ basis),
            _motion(shapes, within, forced),
            _at_end(to_end, forced),
        )
        return replace(plain, damped=damped)


def assembly(modes: TipModes, process: Process) -> Assembly:
    """What the maps of a cut share.

    Parameters
    ----------
    modes : TipModes
    process : Process

    Raises
    ------
    ModelError
        No mode moves the tip in a direction of the chip.
    """
    chip = process.directional
    return Assembly(modes, process, chip, chip_directions(modes, chip))


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
    known: dict[tuple[int, float], Array] = {}
    for span in spans:
        last = first + span.order
        # elements of one length, as both ramps of a helix, share their weights
        key = (span.order, span.length)
        if key not in known:
            known[key] = response_weights(poles, *key)
        weights = known[key]
        end = span.start + span.length
        within[:, first:last, first:last] = weights[:, :-1]
        later = np.exp(poles[:, None] * (times[last:] - end))
        within[:, last:, first:last] = later[:, :, None] * weights[:, None, -1]
        to_end[:, first:last] = np.exp(poles * (period - end))[:, None] * weights[:, -1]
        first = last
    return within, to_end


def _motion(shapes: Array, within: Array, driven: Array) -> Array:
    """Sum over modes and their conjugates of loads (n, m, c) at the nodes, (m d, m c)."""
    n, m, c = driven.shape
    moved = (within[..., None] * driven[:, None]).reshape(n, m * m * c)
    total = 2.0 * (shapes.real.T @ moved.real - shapes.imag.T @ moved.imag)
    return np.asarray(total.reshape(-1, m, m * c).transpose(1, 0, 2).reshape(-1, m * c))


def _at_end(to_end: Array, driven: Array) -> Array:
    """State at the end by loads (n, m, c) at the nodes, (2 n, m c)."""
    ends = (to_end[:, :, None] * driven).reshape(len(to_end), -1)
    return np.concatenate([ends.real, ends.imag])


def _turned(swing: Array) -> Array:
    """Real and imaginary parts of the modes' state, each times a number of its mode, (2 n, 2 n)."""
    n = len(swing)
    found = np.zeros((2 * n, 2 * n))
    diagonal(found[:n, :n])[:] = diagonal(found[n:, n:])[:] = swing.real
    diagonal(found[n:, :n])[:] = swing.imag
    diagonal(found[:n, n:])[:] = -swing.imag
    return found


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
