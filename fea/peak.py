"""Exact largest magnitude of a modal sum over a band, with its certificate.

Branch and bound on the frequency axis: over a cell the magnitude is bounded from its value and
slope in the middle by Taylor's theorem, so cells that cannot hold the maximum are dropped, the
others halved. What remains is a proof that nothing in the band is larger by more
than the stated tolerance; Newton's method then gives the place itself to rounding.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

#: The certificate's tolerance on the magnitude.
TOLERANCE = 1e-6

#: Cells that may wait at once.
WAITING = 4096

try:
    from strutwork.jit import jit
except ImportError:  # the same code runs without numba, slower

    def jit(*, contract: bool = False) -> Any:  # noqa: ARG001
        """Leave the function as it is."""
        return lambda function: function


@jit()
def _magnitude(omega, products, square, viscous, eta, moving, alpha):  # type: ignore[no-untyped-def]
    """|H|² and its first two derivatives by ω."""
    h0 = h1 = h2 = 0.0 + 0.0j
    for m in range(products.shape[0]):
        d = 1.0 - omega * omega * square[m] + 1j * (omega * viscous[m] + eta)
        d1 = -2.0 * omega * square[m] + 1j * viscous[m]
        d2 = -2.0 * square[m]
        inverse = 1.0 / d
        term = products[m] * inverse
        h0 += term
        h1 -= term * inverse * d1
        h2 += term * inverse * (2.0 * inverse * d1 * d1 - d2)
    if moving != 0.0:
        d = -omega * omega + 1j * omega * alpha
        d1 = -2.0 * omega + 1j * alpha
        term = moving / d
        h0 += term
        h1 -= term * d1 / d
        h2 += term * (2.0 * d1 * d1 / (d * d) + 2.0 / d)
    f0 = h0.real**2 + h0.imag**2
    f1 = 2.0 * (h0.real * h1.real + h0.imag * h1.imag)
    f2 = 2.0 * (h1.real**2 + h1.imag**2 + h0.real * h2.real + h0.imag * h2.imag)
    return f0, f1, f2


@jit()
def _cell_bound(low, high, f0, f1, products, square, viscous, eta, moving, alpha):  # type: ignore[no-untyped-def]
    """Bound of |H|² over a cell from its value and slope in the middle.

    Taylor's theorem with bounds of the derivatives of H: every term of the sum is bounded by
    its own least denominator over the cell.
    """
    first = second = 0.0
    for m in range(products.shape[0]):
        near, far = low * low * square[m], high * high * square[m]
        gap = max(0.0, near - 1.0, 1.0 - far)
        damping = low * viscous[m] + eta
        inverse = 1.0 / (gap * gap + damping * damping)
        slope = (2.0 * high * square[m]) ** 2 + viscous[m] ** 2
        size = abs(products[m]) * inverse
        first += size * np.sqrt(slope)
        second += size * (2.0 * slope * np.sqrt(inverse) + 2.0 * square[m])
    if moving != 0.0:
        inverse = 1.0 / (low**4 + (low * alpha) ** 2)
        slope = (2.0 * high) ** 2 + alpha**2
        first += abs(moving) * inverse * np.sqrt(slope)
        second += abs(moving) * inverse * (2.0 * slope * np.sqrt(inverse) + 2.0)
    half = 0.5 * (high - low)
    size = np.sqrt(f0) + first * half
    return min(size * size, f0 + abs(f1) * half + half * half * (first**2 + size * second))


@jit()
def _largest(products, square, viscous, eta, moving, alpha, low, high, starts, tolerance):  # type: ignore[no-untyped-def]
    """Place, magnitude and certified bound of the maximum over [low, high]."""
    best, place = -1.0, low
    for k in range(starts.shape[0]):
        omega = min(max(starts[k], low), high)
        value, _, _ = _magnitude(omega, products, square, viscous, eta, moving, alpha)
        if value > best:
            best, place = value, omega
    lower, upper = np.empty(WAITING), np.empty(WAITING)
    count = 0
    ends = np.sort(starts)
    previous = low
    for k in range(ends.shape[0] + 1):
        edge = high if k == ends.shape[0] else min(max(ends[k], low), high)
        if edge > previous and (count < WAITING - 1 or k == ends.shape[0]):
            lower[count], upper[count] = previous, edge
            count += 1
            previous = edge
    bound = 0.0
    steps = 0
    while count > 0 and steps < 2_000_000:
        steps += 1
        count -= 1
        a, b = lower[count], upper[count]
        middle = 0.5 * (a + b)
        value, first, second = _magnitude(middle, products, square, viscous, eta, moving, alpha)
        if value > best:
            best, place = value, middle
        limit = _cell_bound(a, b, value, first, products, square, viscous, eta, moving, alpha)
        if limit <= best * (1.0 + tolerance) ** 2 or b - a <= 1e-15 * b:
            bound = max(bound, np.sqrt(limit))
            continue
        if count + 2 > WAITING:
            bound = np.inf
            break
        # the half towards which the magnitude rises is looked at first
        if first > 0:
            lower[count], upper[count] = a, middle
            lower[count + 1], upper[count + 1] = middle, b
        else:
            lower[count], upper[count] = middle, b
            lower[count + 1], upper[count + 1] = a, middle
        count += 2
    if count > 0:
        bound = np.inf
    for _ in range(60):
        value, first, second = _magnitude(place, products, square, viscous, eta, moving, alpha)
        if second >= 0.0:
            break
        step = -first / second
        trial = min(max(place + step, low), high)
        better, _, _ = _magnitude(trial, products, square, viscous, eta, moving, alpha)
        if better < value or trial == place:
            break
        place = trial
    value, _, _ = _magnitude(place, products, square, viscous, eta, moving, alpha)
    return place, np.sqrt(max(value, best)), bound


@jit()
def largest_magnitudes(products, square, viscous, eta, moving, alpha, low, high, tolerance):  # type: ignore[no-untyped-def]
    """Largest |H| over a band for stacks of modal sums.

    Parameters
    ----------
    products : (p, d, m)
        Static contributions of the modes at d pairs of ports, m/N.
    square, viscous : (p, m)
        μ = 1/ω², s², and the coefficient of iω, s.
    eta : float
        Loss factor, no unit.
    moving : (p, d)
        Contribution of the rigid-body modes, 1/kg.
    alpha : float
        Mass-proportional damping of the rigid-body modes, 1/s.
    low, high : float
        Band, rad/s.
    tolerance : float
        Of the certificate, as a share of the magnitude.

    Returns
    -------
    result : (p, d, 3)
        Place, rad/s; magnitude; bound that no place in the band exceeds, infinite where the
        proof was not finished.
    """
    poses, pairs, modes = products.shape
    result = np.empty((poses, pairs, 3))
    starts = np.empty(modes + 2)
    for p in range(poses):
        for m in range(modes):
            starts[m] = 1.0 / np.sqrt(square[p, m]) if square[p, m] > 0 else high
        starts[modes], starts[modes + 1] = low, high
        for d in range(pairs):
            place, value, bound = _largest(
                products[p, d],
                square[p],
                viscous[p],
                eta,
                moving[p, d],
                alpha,
                low,
                high,
                starts,
                tolerance,
            )
            result[p, d, 0], result[p, d, 1], result[p, d, 2] = place, value, bound
    return result
