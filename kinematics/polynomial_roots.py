"""Compiled code: all roots of a polynomial at once, by Aberth's method."""

from __future__ import annotations

import numpy as np

from strutwork.jit import jit

#: Corrections of all roots.
TURNS = 60


@jit()
def _guess(poly, roots):  # type: ignore[no-untyped-def]
    """Roots on circles by the Newton polygon, the upper hull of log |coefficient| over degree."""
    n = len(poly) - 1
    logs = np.empty(n + 1)
    for k in range(n + 1):
        size = abs(poly[k])
        logs[k] = np.log(size) if size > 0.0 else -1e300
    hull = np.empty(n + 1, np.int64)
    count = 0
    for k in range(n + 1):
        while count >= 2:
            i, j = hull[count - 2], hull[count - 1]
            if (logs[j] - logs[i]) * (k - i) > (logs[k] - logs[i]) * (j - i):
                break
            count -= 1
        hull[count] = k
        count += 1
    for m in range(count - 1):
        i, j = hull[m], hull[m + 1]
        radius = np.exp((logs[i] - logs[j]) / (j - i))
        for k in range(i, j):
            angle = 2.0 * np.pi * ((k - i) / (j - i) + m / n) + 0.7
            roots[k] = radius * (np.cos(angle) + 1j * np.sin(angle))


@jit()
def _ratio(poly, x):  # type: ignore[no-untyped-def]
    """p′/p at x, and whether p is rounding there; by the reversed polynomial outside of one."""
    n = len(poly) - 1
    outside = abs(x) > 1.0
    y = 1.0 / x if outside else x
    value, slope = 0j, 0j
    size = 0.0
    for d in range(n + 1):
        c = poly[d] if outside else poly[n - d]
        slope = slope * y + value
        value = value * y + c
        size = size * abs(y) + abs(c)
    if abs(value) <= 4e-15 * size:
        return 0j, True
    ratio = slope / value
    return ((n - y * ratio) * y if outside else ratio), False


@jit()
def all_roots(poly, roots):  # type: ignore[no-untyped-def]
    """All roots of a polynomial.

    Parameters
    ----------
    poly : (n + 1,) complex
        Coefficients, the constant first.
    roots : (n,) complex
        To be filled.

    Returns
    -------
    bool
        Whether all have settled.
    """
    n = len(poly) - 1
    _guess(poly, roots)
    done = np.zeros(n, np.bool_)
    for _ in range(TURNS):
        for k in range(n):
            if done[k]:
                continue
            x = roots[k]
            ratio, zero = _ratio(poly, x)
            if zero:
                done[k] = True
                continue
            others = 0j
            for m in range(n):
                if m != k:
                    gap = x - roots[m]
                    size = gap.real * gap.real + gap.imag * gap.imag
                    others += np.conj(gap) * (1.0 / size) if size > 0.0 else 1e300 + 0j
            step = 1.0 / (ratio - others)
            finite = np.isfinite(step.real + step.imag)
            if finite:
                roots[k] = x - step
            done[k] = not finite or abs(step) <= 1e-14 * abs(x)
        if done.all():
            return True
    return False
