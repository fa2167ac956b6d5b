"""The map of a motion of the tip over one tooth period, by spectral elements.

Between cuts the modes swing freely, which is exact. While a tooth cuts, the motion of the tip along
the directions of the chip is known at the nodes of elements; the modes' response to the load is
integrated with their own exponentials (`strutwork.cutting.elements`). The map takes the state of
the modes at the beginning of a period, and the motion in the period before, to the next: its
eigenvalues are the characteristic multipliers, and the cut is stable where all are smaller than 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

from strutwork.errors import NumericalError

Array = NDArray[Any]


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
        implicit = np.asarray(-depth * kernel, order="F")
        diagonal(implicit)[:] += 1.0
        right = np.zeros((size, states + size), order="F")
        right[:, :states] = free
        diagonal(right[:, states:])[:] = -1.0
        _, _, gap, info = lapack.dgesv(implicit, right, overwrite_a=1, overwrite_b=1)
        if info:
            raise NumericalError("period map", "is singular.", "Take another depth of cut.")
        found = np.empty((states + size, states + size), order="F")
        found[:states] = depth * (drive @ gap)
        found[:states, :states] += decay
        found[states:] = gap
        diagonal(found[states:, states:])[:] += 1.0
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


def diagonal(square: Array) -> Array:
    """View of the diagonal (n,) that can be written to.

    Parameters
    ----------
    square : (n, n)
        Of any unit.
    """
    return np.asarray(np.einsum("ii->i", square))
