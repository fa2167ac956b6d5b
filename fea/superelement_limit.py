"""Up to which frequency a reduced solid answers like the full one, whatever is attached to it.

With the motions q of its interfaces given, the full solid moves by u = C q + x, where C are the
static shapes and x = λ (K₀ − λ M₀)⁻¹ M C q is what inertia adds with the interfaces held, λ = ω².
The reduced solid has every C q and of x only its part in the inner basis. With e the part of x
outside of that basis, orthogonal in energy, the Rayleigh quotient of u − e in any structure is at
most λ (1 + s / (1 − 2 s)), with the share

    s(λ) = eᵀ K e / (λ uᵀ M u),

because springs attached add energy that e does not change and masses only lower s. Near a held
frequency x is that mode, and s is its share outside of the basis. So s has no poles, and half of
its largest value over q is the relative error of a frequency of the structure at λ, to first order.

x is computed without a factorisation at λ: from the lowest held modes, and for all higher ones from
the expansion in powers of λ, whose ratio is at most a quarter where the limit is sought.

Sources: Craig and Bampton (1968), AIAA Journal 6, 1313, for C and x; Jakobsson, Bengzon and Larson
(2011), International Journal for Numerical Methods in Engineering 86, 829, for errors of component
modes from what the bases leave out.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.linalg as sla
from numpy.typing import NDArray

from strutwork.fea.held_modes import held_modes
from strutwork.fea.tied_solid import StaticSolver

Array = NDArray[Any]

#: Relative error of a frequency up to the limit.
FREQUENCY_SHARE = 1e-4

#: Share of energy let pass: half of what the first order allows, for modes that err together.
ENERGY_SHARE = FREQUENCY_SHARE

#: Terms of the expansion for the higher modes.
TERMS = 4

#: Lines at which the share is computed before the limit is enclosed between two of them.
LINES = 200

#: Bisections between these two.
BISECTIONS = 12

#: Held modes computed beyond the number of inner shapes: one of these the basis cannot have.
MORE = 6


def accurate_to(static: StaticSolver, carried: Array, inner: Array) -> float:
    """Frequency in Hz below which a reduced solid's answers hold to `FREQUENCY_SHARE`.

    At most half of the highest held frequency that is computed, which are a few more than the
    inner shapes; infinite where the interfaces hold the entire solid.

    Parameters
    ----------
    static : StaticSolver
        Of the solid with c coordinates.
    carried : (c, k)
        Static shapes of unit interface motions, no unit and m/rad.
    inner : (c, n)
        Independent shapes with the interfaces held, of any unit.
    """
    size, k = carried.shape
    if size <= k:
        return float("inf")
    count = min(inner.shape[1] + MORE, max((size - k) // 3, 1))
    share = _Share(static, carried, inner, count)
    highest = float(share.squares[-1]) / 4.0
    squares = np.linspace(0.0, np.sqrt(highest), LINES + 1)[1:] ** 2
    squares = np.unique(np.concatenate([squares, share.squares[share.squares < highest]]))
    good = 0.0
    for square in squares:
        if share.at(square) > ENERGY_SHARE:
            good = _last_good(share, good, square)
            break
        good = square
    return float(np.sqrt(good) / (2.0 * np.pi))


def _last_good(share: _Share, good: float, bad: float) -> float:
    """The largest λ between two, in (rad/s)², at which the share is let pass."""
    for _ in range(BISECTIONS):
        middle = ((np.sqrt(good) + np.sqrt(bad)) / 2.0) ** 2
        good, bad = (middle, bad) if share.at(middle) <= ENERGY_SHARE else (good, middle)
    return good


class _Share:
    """s(λ), the largest over all interface motions and over held modes at λ."""

    def __init__(self, static: StaticSolver, carried: Array, inner: Array, count: int) -> None:
        solid = static.solid
        # motions of one mass, so that the small matrices are well scaled
        carried = carried / np.sqrt(np.einsum("ij,ij->j", carried, solid.mass @ carried))
        push = solid.mass @ carried
        self.squares, modes = held_modes(static, count)
        self._pull = modes.T @ push
        heavy = solid.mass @ modes
        blocks, block = [modes], carried - modes @ self._pull
        for _ in range(TERMS):
            block, _ = static.solve(solid.mass @ block)
            block = block - modes @ (heavy.T @ block)
            blocks.append(block)
        # powers of λ by the highest mode's, for columns of one size
        rich = np.concatenate([b * self.squares[-1] ** i for i, b in enumerate(blocks)], axis=1)
        every = np.concatenate([carried, rich], axis=1)
        self._mass = every.T @ (solid.mass @ every)
        outside = rich
        if inner.shape[1]:
            stiff = solid.stiffness @ inner
            gram = sla.cho_factor(inner.T @ stiff)
            for _ in range(2):
                outside = outside - inner @ sla.cho_solve(gram, stiff.T @ outside)
        self._outside = outside.T @ (solid.stiffness @ outside)

    def at(self, square: float) -> float:
        """The share s at λ in (rad/s)², no unit."""
        m, k = self._pull.shape
        shares = self._outside.diagonal()[:m] / self.squares
        mode = float(shares[self.squares == square].max(initial=0.0))
        # modes' amplitudes a with (λ_j/λ − 1) a = p q: finite also where λ is λ_j
        rows = np.concatenate([-self._pull, np.diag(self.squares / square - 1.0)], axis=1)
        sizes = np.linalg.norm(rows, axis=1, keepdims=True)
        rows /= np.where(sizes > 0, sizes, 1.0)
        free = sla.null_space(rows)
        ratio = square / self.squares[-1]
        powers = ratio ** np.arange(1.0, TERMS + 1.0)
        # all further terms are at most a geometric series of the last
        powers[-1] /= 1.0 - ratio
        motion, amplitudes = free[:k], free[k:]
        shape = np.concatenate([amplitudes, *(p * motion for p in powers)], axis=0)
        lost = shape.T @ self._outside @ shape
        shape = np.concatenate([motion, shape], axis=0)
        moved = square * (shape.T @ self._mass @ shape)
        values = sla.eigh((lost + lost.T) / 2.0, (moved + moved.T) / 2.0, eigvals_only=True)
        return max(mode, float(values[-1]))
