"""Elements of the cuts of a tooth period, and the nodes that each of them requires."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import jv

from strutwork.cutting.directional import Directional

Array = NDArray[Any]

#: Nodes of an element at most; a longer one is cut.
ORDER = 40

#: Nodes of an element at least: the load on it is a line.
LEAST = 2

#: Margin of the longest element at least.
LEAST_MARGIN = 6


@dataclass(frozen=True)
class Span:
    """One element of a period.

    Parameters
    ----------
    start, length : float
        s, from the entry of a tooth.
    order : int
        Nodes.
    """

    start: float
    length: float
    order: int


def spans_of(
    chip: Directional, fastest: float, speed: float, depth: float, margin: int
) -> list[Span]:
    """Elements of the cuts of a period, in the order of time.

    Parameters
    ----------
    chip : Directional
    fastest : float
        Largest magnitude of a pole, rad/s.
    speed : float
        Turns per second, Hz.
    depth : float
        m.
    margin : int
        Nodes of the longest element beyond half its length in radians of the fastest mode.
    """
    turning = 2.0 * np.pi * speed
    found = []
    for start, stop in pairwise(chip.breaks(depth).tolist()):
        if not chip.cuts(0.5 * (start + stop), depth):
            continue
        length = (stop - start) / turning
        pieces = int(np.ceil((0.5 * fastest * length + 1e-9) / (ORDER - 12)))
        order = int(np.ceil(0.5 * fastest * length / pieces)) + margin
        length /= pieces
        found += [Span(start / turning + k * length, length, order) for k in range(pieces)]
    return _lightened(found, 0.5 * fastest + turning)


def first_margin(
    chip: Directional, fastest: float, speed: float, depth: float, tolerance: float
) -> int:
    """The least margin that may bring multipliers within a tolerance.

    Gauss nodes integrate twice the degree of the polynomial that they carry, so that a multiplier
    errs by about the square of what is left of the motion.

    Parameters
    ----------
    chip : Directional
    fastest : float
        Largest magnitude of a pole, rad/s.
    speed : float
        Turns per second, Hz.
    depth : float
        m.
    tolerance : float
        Relative.
    """
    spans = spans_of(chip, fastest, speed, depth, 0)
    length = max(span.length for span in spans)
    least = int(np.ceil(0.5 * fastest * length))
    radians = (0.5 * fastest + 2.0 * np.pi * speed) * length
    margin = LEAST_MARGIN
    while abs(jv(least + margin, radians)) > 0.3 * np.sqrt(tolerance) and margin < ORDER:
        margin += 1
    return margin


def _lightened(spans: list[Span], half: float) -> list[Span]:
    """Short elements with as few nodes as resolve them like the longest one.

    On −1 to 1 the oscillation exp(i x t) leaves 2 J_p(x) as the first Chebyshev coefficient that
    p nodes do not carry. x is half the length in radians of the fastest mode and of the
    directional matrix, which has twice the angle of the cutter. A ramp, where a helix enters or
    leaves the cut, is often a tenth of the cut, and takes the same coefficient with half the nodes.
    """
    longest = max(spans, key=lambda span: span.length)
    if all(span.length > 0.99 * longest.length for span in spans):
        return spans
    allowed = abs(float(jv(longest.order, half * longest.length)))
    found = []
    for span in spans:
        # both ramps have one length but for rounding, and one table then serves them
        length = round(span.length / longest.length, 12) * longest.length
        order, left = 0, 1.0
        # (x/2)^p / p! is not below J_p(x)
        while order < LEAST or (left > allowed and order < span.order):
            order += 1
            left *= 0.5 * half * length / order
        found.append(Span(span.start, length, min(order, span.order)))
    return found
