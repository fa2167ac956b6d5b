"""Depths that are stable at every spindle speed, for many feed directions at once.

With λ an eigenvalue of the mean directional matrix times the receptance, the zero-order border
(`strutwork.cutting.zero_order`) is the depth 1/(2 Re λ). The least depth is at the largest real
part over frequency, whichever family it belongs to.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.cutting.process import Process
from strutwork.cutting.tip_dynamics import TipDynamics
from strutwork.cutting.tip_response import Frame
from strutwork.errors import ModelError
from strutwork.fea.pole_residue import PoleModel

Array = NDArray[Any]

#: Times that the best line's neighbourhood is divided, and into so many lines.
ZOOMS, ZOOMED = 3, 17

#: Singular values of a directional matrix below this share of the largest are rounding.
NO_RANK = 1e-12


@dataclass(frozen=True)
class AbsoluteLimits:
    """Depths that are stable at every spindle speed.

    Parameters
    ----------
    feeds : (k,)
        Angles of the feed from the process's own towards its normal, rad.
    depth : (k,)
        m; infinite where no frequency of the band limits it.
    frequencies : (k,)
        Of chatter, Hz; NaN where there is none.
    """

    feeds: Array
    depth: Array
    frequencies: Array

    def __repr__(self) -> str:
        return f"<AbsoluteLimits: {len(self.feeds)} feeds, least {1e3 * self.depth.min():.4g} mm>"


def turned_matrices(process: Process, frame: Frame, feeds: ArrayLike) -> Array:
    """Mean directional matrices (k, 3, 3), Pa, in the axes of the ports, by the feed's angle.

    Parameters
    ----------
    process : Process
    frame : Frame
        Axes of the process in those of the ports.
    feeds : (k,)
        rad.
    """
    turns = np.array([Frame.feed(float(a)).matrix @ frame.matrix for a in np.ravel(feeds)])
    return np.asarray(np.swapaxes(turns, -1, -2) @ process.directional.average @ turns)


def absolute_limits(
    tip: TipDynamics,
    process: Process,
    frame: Frame,
    band: tuple[float, float],
    feeds: ArrayLike = (0.0,),
) -> AbsoluteLimits:
    """Depths that are stable at every speed, by feed direction.

    Lines lie dense at the resonances, and the neighbourhood of the best is divided until the
    depth is certain to about 1e-8.

    Parameters
    ----------
    tip : TipDynamics
        In the axes of its ports.
    process : Process
    frame : Frame
        Axes of the process in those of the ports.
    band : (float, float)
        Hz.
    feeds : (k,)
        Angles of the feed, rad.

    Raises
    ------
    ModelError
        No mode in the band, a process with damping by the flank, a tip that moves in no direction
        that changes the chip.
    """
    if process.damping is not None:
        raise ModelError(
            "absolute limits",
            "leave process damping out, and the process has it.",
            "Give the process without its damping.",
        )
    angles = np.ravel(np.asarray(feeds, dtype=float))
    largest = _largest_real(turned_matrices(process, frame, angles))
    lines = tip.lines(band)
    value = largest(tip.response(lines)[:, None])
    if not np.any(value):
        raise ModelError(
            "tip of the tool",
            "moves in no direction that changes the chip.",
            "Check the axis of the tool and the feed.",
        )
    k = np.arange(len(angles))
    best = value.argmax(axis=0)
    top, at = value[best, k], lines[best]
    low = lines[np.maximum(best - 1, 0)]
    high = lines[np.minimum(best + 1, len(lines) - 1)]
    share = np.linspace(0.0, 1.0, ZOOMED)
    peak = at
    for _ in range(ZOOMS):
        some = low[:, None] + share * (high - low)[:, None]
        h = tip.response(some.ravel()).reshape(len(angles), ZOOMED, 3, 3)
        finer = largest(np.swapaxes(h, 0, 1))
        best = finer.argmax(axis=0)
        value = finer[best, k]
        inner = np.clip(best, 1, ZOOMED - 2)
        apex = _apex(*(finer[inner + i, k] for i in (-1, 0, 1)))
        peak = some[k, best] + apex * (some[:, 1] - some[:, 0]) * (best == inner)
        at = np.where(value >= top, some[k, best], at)
        top = np.maximum(top, value)
        low = some[k, np.maximum(best - 1, 0)]
        high = some[k, np.minimum(best + 1, ZOOMED - 1)]
    # of a smooth top the apex of the last parabola, whose frequency is certain to more digits
    value = np.einsum("kk->k", largest(tip.response(peak)[:, None]))
    at = np.where(value >= top, peak, at)
    top = np.maximum(top, value)
    limited = top > 0
    return AbsoluteLimits(
        angles,
        np.where(limited, 0.5 / np.where(limited, top, 1.0), np.inf),
        np.where(limited, at, np.nan),
    )


def limiting_mode(tip: TipDynamics, matrix: ArrayLike, frequency: float) -> float:
    """Natural frequency of the mode with the largest share in the border, Hz.

    Where damping couples the modes, that of the pole nearest to the chatter frequency.

    Parameters
    ----------
    tip : TipDynamics
    matrix : (3, 3)
        Mean directional matrix in the axes of the ports, Pa.
    frequency : float
        Of chatter, Hz.
    """
    model = tip.model
    if isinstance(model, PoleModel):
        return float(tip.natural[np.argmin(np.abs(tip.natural - frequency))])
    moving = np.array(tip.moving)
    b = np.asarray(matrix, dtype=float)[moving[:, None], moving]
    h = tip.response(np.array([frequency]))[0][moving[:, None], moving]
    values, right = np.linalg.eig(b @ h)
    top = int(np.argmax(values.real))
    left = np.linalg.inv(right)[top]
    square, residues = model.square[0], model.residues[0]
    omega = 2.0 * np.pi * frequency
    swing = 1.0 - omega**2 * square + 1j * (omega * model.viscous[0] + model.damping.structural)
    shares = ((left @ b @ residues) * (right[:, top] @ residues) / swing).real
    heavy = square > 0
    return float(tip.natural[int(np.argmax(shares[heavy]))])


def _apex(before: Array, here: Array, after: Array) -> Array:
    """Place of a parabola's top beside its middle point, in steps, (k,)."""
    bend = before - 2.0 * here + after
    flat = bend >= 0
    return np.asarray(np.where(flat, 0.0, 0.5 * (before - after) / np.where(flat, 1.0, bend)))


def _largest_real(matrices: Array) -> Callable[[Array], Array]:
    """Largest real part (f, k) of the eigenvalues of matrices times a receptance (f, k, 3, 3)."""
    left, size, right = np.linalg.svd(matrices)
    rank = int((size > NO_RANK * size[:, :1]).sum(axis=1).max())
    # the eigenvalues other than zero are those of the smaller product
    left, right = left[:, :, :rank] * size[:, None, :rank], right[:, :rank]

    def largest(receptance: Array) -> Array:
        small = right @ receptance @ left
        if rank == 1:
            return np.asarray(small[..., 0, 0].real)
        if rank == 2:
            half = 0.5 * (small[..., 0, 0] + small[..., 1, 1])
            det = small[..., 0, 0] * small[..., 1, 1] - small[..., 0, 1] * small[..., 1, 0]
            root = np.sqrt(half**2 - det)
            return np.asarray(half.real + np.abs(root.real))
        return np.asarray(np.linalg.eigvals(small).real.max(axis=-1))

    return largest
