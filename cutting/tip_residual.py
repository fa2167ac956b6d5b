"""What the modes left out of a tip make of it, by a few modes that stand for all of them.

Up to a frequency well below the modes left out, their receptance is R + ω² S + ..., with their
static compliance R and R weighted by μ = 1/ω_j², S. Three modes at most, one for each port, have
the same R and, up to `FAST`, the same S: S v = μ R v gives their μ. So the tip is exact at zero
frequency, and in a band below half of the frequencies left out its error is of fourth order.

Source: MacNeal (1971), Computers & Structures 1, 581, for residual flexibility; the second term is
that of Rubin (1975), AIAA Journal 13, 995.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

#: Frequency of the fastest of these modes, as a multiple of the end of the band: there it errs by
#: 1/(1 − 1/16) − 1 = 7 % of what it stands for, and what computes with it takes no smaller steps.
FAST = 4.0

#: Share of the static compliance that no mode is made for.
NOTHING = 1e-6

#: Damping ratios of equivalent modes, which have to swing and to decay.
LEAST_DAMPED, MOST_DAMPED = 1e-3, 0.9


def equivalent_modes(
    residues: Array, square: Array, whole: Array, highest: float
) -> tuple[Array, Array]:
    """Modes that stand for others: residues (q, k) and μ (k,), k at most q.

    Parameters
    ----------
    residues : (q, m)
        Of the modes left out, the square root of m/N.
    square : (m,)
        Their μ = 1/ω², s²; zero for motions without mass.
    whole : (q,)
        Static compliance of all modes at every port, m/N.
    highest : float
        Hz; the band ends here.
    """
    size = np.sqrt(np.where(whole > 0, whole, 1.0))
    scaled = residues / size[:, None]
    values, turn = np.linalg.eigh(scaled @ scaled.T)
    there = values > NOTHING
    root = turn[:, there] * np.sqrt(values[there])
    # R = root rootᵀ; in its coordinates S is symmetric, and its eigenvectors split both
    inverse = turn[:, there] / np.sqrt(values[there])
    inner = inverse.T @ ((scaled * square) @ scaled.T) @ inverse
    slow, split = np.linalg.eigh((inner + inner.T) / 2.0)
    return np.asarray(size[:, None] * (root @ split)), np.maximum(slow, _least(highest))


def equivalent_poles(
    poles: Array, left: Array, right: Array, constant: Array, whole: float, highest: float
) -> tuple[Array, Array, Array]:
    """The same of complex modes, b cᵀ/(iω − s) and conjugate: poles (k,), b and c (q, k).

    R is matched, which need not be symmetric; frequency and damping are means by static compliance.

    Parameters
    ----------
    poles : (m,)
        s of those left out, rad/s.
    left, right : (q, m)
        b and c; their products in m/(N·s).
    constant : (q, q)
        Compliance of motions without mass or dashpot, m/N.
    whole : float
        Largest static compliance of all modes at a port, m/N.
    highest : float
        Hz; the band ends here.
    """
    static = 2.0 * ((left / -poles) @ right.T).real + constant
    u, sizes, vt = np.linalg.svd(static)
    some = sizes > NOTHING * whole
    weight = 2.0 * np.linalg.norm(left, axis=0) * np.linalg.norm(right, axis=0) / np.abs(poles)
    weight = weight / max(float(weight.sum() + np.linalg.norm(constant)), np.finfo(float).tiny)
    square = max(float(weight @ (1.0 / np.abs(poles) ** 2)), _least(highest))
    ratio = float(np.clip(weight @ (-poles.real / np.abs(poles)), LEAST_DAMPED, MOST_DAMPED))
    omega = 1.0 / np.sqrt(square)
    swing = omega * np.sqrt(1.0 - ratio**2)
    root = np.sqrt(sizes[some])
    shapes = u[:, some] * root
    loads = vt[some].T * (root * omega**2 / (2j * swing))
    return np.full(len(root), -ratio * omega + 1j * swing), shapes, loads


def _least(highest: float) -> float:
    return 1.0 / (2.0 * np.pi * FAST * highest) ** 2
