"""Semi-discretisation of milling, written apart from `strutwork.cutting` to check it.

Insperger and Stépán (2004), first order in the delayed term: on each step the directional matrix is
its mean, the delayed motion that in the middle of the step. The map of a period is propagated: only
the rows of the state are multiplied, what is delayed is moved.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm, lapack

Array = NDArray[Any]


@dataclass(frozen=True)
class Cut:
    """Milling of a tip with real modes in the plane of the cut.

    Parameters
    ----------
    frequencies, ratios : (n,)
        Hz, and no unit.
    shapes : (n, 2)
        Along the feed and across it, 1/√kg.
    tangential, radial : float
        Pa.
    entry, leave : float
        rad.
    teeth : int
    lag : float
        rad/m.
    """

    frequencies: Array
    ratios: Array
    shapes: Array
    tangential: float
    radial: float
    entry: float
    leave: float
    teeth: int
    lag: float = 0.0

    def matrices(self, angles: Array, depth: float) -> Array:
        """Force by motion and depth, (..., 2, 2), by the angle of the first tooth, in slices."""
        slices = 400 if self.lag else 1
        heights = (np.arange(slices) + 0.5) / slices * depth
        total = np.zeros((*angles.shape, 2, 2))
        for tooth in range(self.teeth):
            phi = angles[..., None] + 2.0 * np.pi * tooth / self.teeth - self.lag * heights
            phi = np.mod(phi, 2.0 * np.pi)
            s, c = np.sin(phi), np.cos(phi)
            cut = (phi >= self.entry) & (phi < self.leave)
            fx = -self.tangential * c - self.radial * s
            fy = self.tangential * s - self.radial * c
            whole = np.stack([fx * s, fx * c, fy * s, fy * c], axis=-1) * cut[..., None]
            total += whole.mean(axis=-2).reshape(*angles.shape, 2, 2)
        return total


def steps_of(cut: Cut, rpm: float, depth: float, steps: int, inner: int = 8) -> tuple[Array, float]:
    """Mean directional matrix of each step (m, 2, 2), and the length of a step, s."""
    pitch = 2.0 * np.pi / cut.teeth
    at = (np.arange(steps * inner) + 0.5) / (steps * inner) * pitch
    means = cut.matrices(at, depth).reshape(steps, inner, 2, 2).mean(axis=1)
    return means, 60.0 / (rpm * cut.teeth * steps)


def transition(cut: Cut, means: Array, step: float, depth: float) -> Array:
    """The map of a period (2 n + 2 m, 2 n + 2 m): state, then motions from the newest back."""
    n, m = len(cut.frequencies), len(means)
    omega = 2.0 * np.pi * cut.frequencies
    system = np.zeros((m, 2 * n + 2, 2 * n + 2))
    system[:, :n, n : 2 * n] = np.eye(n)
    load = depth * cut.shapes @ means
    system[:, n : 2 * n, :n] = load @ cut.shapes.T - np.diag(omega**2)
    system[:, n : 2 * n, n : 2 * n] = -np.diag(2.0 * cut.ratios * omega)
    system[:, n : 2 * n, 2 * n :] = -load
    cutting = np.any(means != 0, axis=(1, 2))
    advance = np.empty((m, 2 * n, 2 * n + 2))
    if cutting.any():
        advance[cutting] = expm(system[cutting] * step)[:, : 2 * n]
    if not cutting.all():
        advance[~cutting] = expm(system[~cutting][0] * step)[: 2 * n]
    size = 2 * n + 2 * m
    # motions[i] at the beginning of step i, one period back
    back = np.zeros((m + 1, 2, size))
    back[m, :, :n] = cut.shapes.T
    for i in range(m):
        back[i, :, 2 * n + 2 * (m - 1 - i) : 2 * n + 2 * (m - i)] = np.eye(2)
    state = np.eye(2 * n, size)
    newest = np.empty((m, 2, size))
    for i in range(m):
        newest[i] = cut.shapes.T @ state[:n]
        middle = 0.5 * (back[i] + back[i + 1])
        state = advance[i, :, : 2 * n] @ state + advance[i, :, 2 * n :] @ middle
    return np.concatenate([state, newest[::-1].reshape(2 * m, size)])


def largest(cut: Cut, rpm: float, depth: float, steps: int) -> float:
    """Magnitude of the largest multiplier, no unit."""
    means, step = steps_of(cut, rpm, depth, steps)
    real, imaginary, *_ = lapack.dgeev(
        transition(cut, means, step, depth), compute_vl=0, compute_vr=0
    )
    return float(np.hypot(real, imaginary).max())


def extrapolated(cut: Cut, rpm: float, depth: float, steps: int) -> float:
    """The same from two numbers of steps, without its error of second order."""
    coarse, fine = (largest(cut, rpm, depth, k * steps) for k in (1, 2))
    return (4.0 * fine - coarse) / 3.0
