"""Compiled code: sixteen ways to put three points, each on a circle, at given distances.

The elimination and its notation: z = exp(iφ₁), w = exp(iφ_j); with z fixed, each of the distances
12 and 13 is a quadratic A w² + B w + C in the other point's w. The product of what the distance 23
leaves over the four pairs of their roots, times (A₂C₂A₃C₃)², is a Laurent polynomial in z of
degrees −8 to 8, read off 32 points of the unit circle by Fourier's series.
"""

from __future__ import annotations

import numpy as np

from strutwork.jit import jit
from strutwork.kinematics.polynomial_roots import all_roots

#: Roots, samples of the unit circle, highest degree.
ROOTS, SAMPLES, DEGREE = 16, 32, 8
#: Corrections of a way to place the points.
POLISH = 12
#: Correction, rad, at which a way is polished; size of what is left then, of the largest term.
SMALL, LEFT = 1e-13, 1e-11
#: The same where corrections square.
QUICK = 1e-7
#: What the distance 23 may leave for another pair to be tried.
NEAR = 1e-2
#: Two ways that differ by less, rad, are one.
SAME = 1e-6
#: The size of z = exp(iφ) differs from one by less: the way is real.
REAL = 1e-7


@jit()
def _terms(centre, first, second, radius, distance, i, j, out):  # type: ignore[no-untyped-def]
    """Coefficients of |P_i − P_j|² − D²: k₀, k_i (2), k_j (2), M (2 x 2), nine in all."""
    dd = ii = ij = 0.0
    ka = kb = kc = kd = maa = mab = mba = mbb = 0.0
    for k in range(3):
        d = centre[i, k] - centre[j, k]
        dd += d * d
        ka += d * first[i, k]
        kb += d * second[i, k]
        kc += d * first[j, k]
        kd += d * second[j, k]
        maa += first[i, k] * first[j, k]
        mab += first[i, k] * second[j, k]
        mba += second[i, k] * first[j, k]
        mbb += second[i, k] * second[j, k]
    ri, rj = radius[i], radius[j]
    out[0] = dd + ri * ri + rj * rj - distance * distance
    out[1], out[2] = 2.0 * ri * ka, 2.0 * ri * kb
    out[3], out[4] = -2.0 * rj * kc, -2.0 * rj * kd
    ii = -2.0 * ri * rj
    out[5], out[6], out[7], out[8] = ii * maa, ii * mab, ii * mba, ii * mbb
    ij = abs(out[0])
    for k in range(1, 9):
        ij = max(ij, abs(out[k]))
    return ij


@jit()
def _turns(z):  # type: ignore[no-untyped-def]
    """Cosine and sine of the angle of z = exp(iφ)."""
    back = np.conj(z) * (1.0 / (z.real * z.real + z.imag * z.imag))
    return 0.5 * (z + back), -0.5j * (z - back)


@jit()
def _quadratic(t, z):  # type: ignore[no-untyped-def]
    """A, B, C of a distance in the second point's w, the first at z."""
    c, s = _turns(z)
    e0 = t[3] + t[5] * c + t[7] * s
    e1 = t[4] + t[6] * c + t[8] * s
    b = t[0] + t[1] * c + t[2] * s
    return 0.5 * (e0 - 1j * e1), b, 0.5 * (e0 + 1j * e1)


@jit()
def _pair(a, b, c):  # type: ignore[no-untyped-def]
    """Both roots of a quadratic, without cancellation."""
    root = np.sqrt(b * b - 4.0 * a * c)
    if (np.conj(b) * root).real < 0.0:
        root = -root
    q = -0.5 * (b + root)
    if q == 0.0:
        return 0j, 0j
    return q / a, c / q


@jit()
def _value(t, z, w):  # type: ignore[no-untyped-def]
    """What a distance leaves, the points at z and w."""
    c, s = _turns(z)
    u, v = _turns(w)
    return (
        t[0]
        + t[1] * c
        + t[2] * s
        + (t[3] + t[5] * c + t[7] * s) * u
        + (t[4] + t[6] * c + t[8] * s) * v
    )


@jit()
def _slopes(t, z, w):  # type: ignore[no-untyped-def]
    """Value, and its derivatives by the two angles."""
    c, s = _turns(z)
    u, v = _turns(w)
    e0, e1 = t[3] + t[5] * c + t[7] * s, t[4] + t[6] * c + t[8] * s
    f0, f1 = t[1] + t[5] * u + t[6] * v, t[2] + t[7] * u + t[8] * v
    value = t[0] + t[1] * c + t[2] * s + e0 * u + e1 * v
    size = abs(t[0]) + abs(t[1] * c) + abs(t[2] * s) + abs(e0 * u) + abs(e1 * v)
    return value, f1 * c - f0 * s, e1 * u - e0 * v, size


@jit()
def _laurent(terms, turns, out):  # type: ignore[no-untyped-def]
    """The polynomial's coefficients, degrees −8 to 8; the largest of the others over theirs."""
    samples = np.empty(SAMPLES, np.complex128)
    for n in range(SAMPLES):
        z = turns[n]
        a2, b2, c2 = _quadratic(terms[0], z)
        a3, b3, c3 = _quadratic(terms[1], z)
        w2, v2 = _pair(a2, b2, c2)
        w3, v3 = _pair(a3, b3, c3)
        product = (a2 * c2 * a3 * c3) ** 2
        for w in (w2, v2):
            for v in (w3, v3):
                product *= _value(terms[2], w, v)
        samples[n] = product
    largest = others = 0.0
    for k in range(SAMPLES):
        total = 0j
        for n in range(SAMPLES):
            total += samples[n] * np.conj(turns[(k * n) % SAMPLES])
        degree = k if k < SAMPLES // 2 else k - SAMPLES
        size = abs(total)
        if -DEGREE <= degree <= DEGREE:
            out[degree + DEGREE] = total
            largest = max(largest, size)
        else:
            others = max(others, size)
    return others / largest


@jit()
def _polished(terms, way):  # type: ignore[no-untyped-def]
    """Newton's method on the three angles, complex; what is left of the largest term."""
    left = before = np.inf
    for _ in range(POLISH):
        p, pz, pw, ps = _slopes(terms[0], way[0], way[1])
        q, qz, qv, qs = _slopes(terms[1], way[0], way[2])
        r, rw, rv, rs = _slopes(terms[2], way[1], way[2])
        left = max(abs(p) / ps, abs(q) / qs, abs(r) / rs)
        whole = -pz * qv * rw - pw * qz * rv
        if whole == 0.0 or not np.isfinite(left):
            return left
        # of pz and pw, of qz and qv, of rw and rv: each distance sees two angles
        d0 = (-qv * rw * p - pw * rv * q + pw * qv * r) / whole
        d1 = (-qz * rv * p + pz * rv * q - pz * qv * r) / whole
        d2 = (qz * rw * p - pz * rw * q - pw * qz * r) / whole
        size = max(abs(d0), abs(d1), abs(d2))
        if not np.isfinite(size):
            return np.inf
        # a long step is cut: the sine and cosine are far from straight there
        cut = 1.0 if size <= 0.5 else 0.5 / size
        way[0] *= np.exp(-1j * cut * d0)
        way[1] *= np.exp(-1j * cut * d1)
        way[2] *= np.exp(-1j * cut * d2)
        # corrections square: what the next one would leave is rounding
        if size <= SMALL or (size <= QUICK and size <= 1e-2 * before):
            return 0.0
        before = size
    return left


@jit()
def _gaps(terms, z, pairs, gaps):  # type: ignore[no-untyped-def]
    """The four pairs of the other points' places at z, and what the distance 23 leaves of each."""
    a2, b2, c2 = _quadratic(terms[0], z)
    a3, b3, c3 = _quadratic(terms[1], z)
    second, third = _pair(a2, b2, c2), _pair(a3, b3, c3)
    for m in range(4):
        w, v = second[m // 2], third[m % 2]
        pairs[m, 0], pairs[m, 1] = w, v
        gaps[m] = np.inf
        if w != 0.0 and v != 0.0:
            value, _, _, size = _slopes(terms[2], w, v)
            gap = abs(value) / size
            if np.isfinite(gap):
                gaps[m] = gap


@jit()
def _known(way, some, found):  # type: ignore[no-untyped-def]
    """Whether a way is among those found."""
    for other in range(found):
        same = True
        for c in range(3):
            gap, size = way[c] - some[other, c], some[other, c]
            square = gap.real * gap.real + gap.imag * gap.imag
            if square > SAME * SAME * (size.real * size.real + size.imag * size.imag):
                same = False
                break
        if same:
            return True
    return False


@jit()
def _all_ways(terms, roots, some):  # type: ignore[no-untyped-def]
    """Ways by the roots of the polynomial, each once; their number."""
    gaps, pairs = np.empty(4), np.empty((4, 2), np.complex128)
    way = np.empty(3, np.complex128)
    found = 0
    for z in roots:
        if z == 0.0 or not np.isfinite(z.real + z.imag):
            continue
        _gaps(terms, z, pairs, gaps)
        # several ways may have one angle, as in a machine that is its own mirror image, or of
        # equal legs at home: every pair that nearly fits, and the best one
        for attempt in range(4):
            m = int(np.argmin(gaps))
            if gaps[m] == np.inf or (attempt > 0 and gaps[m] > NEAR):
                break
            gaps[m] = np.inf
            way[0], way[1], way[2] = z, pairs[m, 0], pairs[m, 1]
            left = _polished(terms, way)
            if left <= LEFT and found < len(some) and not _known(way, some, found):
                some[found] = way
                found += 1
    return found


@jit()
def circle_ways(circles, ways, real, count, others):  # type: ignore[no-untyped-def]
    """All ways of n poses: real ones first, by their first angle.

    Parameters
    ----------
    circles : (n, 11, 3)
        Of the three circles centres, and the unit vectors from which and to which the angles
        count, three rows each; radii; distances between the points 1 and 2, 1 and 3, 2 and 3.
    ways : (n, 16, 3) complex
        exp(iφ), to be filled.
    real, count : (n,) of int
        How many are real, and how many there are in all; count is −1 where they were not found.
    others : (n,)
        Largest coefficient that must be zero over the largest one.
    """
    turns = np.empty(SAMPLES, np.complex128)
    for n in range(SAMPLES):
        turns[n] = np.exp(2j * np.pi * n / SAMPLES)
    terms = np.empty((3, 9))
    poly = np.empty(2 * DEGREE + 1, np.complex128)
    roots = np.empty(ROOTS, np.complex128)
    some = np.empty((2 * ROOTS, 3), np.complex128)
    keys = np.empty(2 * ROOTS)
    for p in range(len(circles)):
        at = circles[p]
        for row, (i, j) in enumerate(((0, 1), (0, 2), (1, 2))):
            size = _terms(at[:3], at[3:6], at[6:9], at[9], at[10, row], i, j, terms[row])
            for k in range(9):
                terms[row, k] /= size
        others[p] = _laurent(terms, turns, poly)
        settled = all_roots(poly, roots)
        found = _all_ways(terms, roots, some)
        count[p] = found if settled and found <= ROOTS else -1
        # the real ones first, each kind by its first angle
        real[p] = 0
        for k in range(found):
            away = 0.0
            for c in range(3):
                away = max(away, abs(abs(some[k, c]) - 1.0))
            keys[k] = np.angle(some[k, 0]) + (0.0 if away <= REAL else 10.0)
            real[p] += away <= REAL
        order = np.argsort(keys[:found])
        for k in range(ROOTS):
            if k < found:
                ways[p, k] = some[order[k]]
            else:
                ways[p, k] = np.nan
