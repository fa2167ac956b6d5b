"""Poles of closed loops, each with what swings in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eig, matrix_balance

from strutwork.fea.state_space import StateSpace

Array = NDArray[Any]

#: Growth of a pole by its size, above which it counts as unstable and not as rounding.
GROWTH = 1e-9

#: Parts with this share of the largest take part in a pole alike.
ALIKE = 0.9


@dataclass(frozen=True)
class LoopPole:
    """A pole, or the one with positive imaginary part of a pair.

    Parameters
    ----------
    value : complex
        s, 1/s.
    part : str
        What takes part most: a mode with the motors held, or a drive; several where they take
        part alike, as the two motors of a gantry.
    share : float
        Of it or them in the pole, no unit.
    """

    value: complex
    part: str
    share: float

    @property
    def frequency(self) -> float:
        """|s| / 2π, Hz."""
        return abs(self.value) / (2.0 * np.pi)

    @property
    def damping(self) -> float:
        """−Re s / |s|; 1 where it creeps, negative where it grows."""
        return -self.value.real / abs(self.value) if self.value else 0.0

    @property
    def stable(self) -> bool:
        """Whether it decays."""
        return self.value.real < -GROWTH * abs(self.value) and self.value != 0


def loop_poles(closed: StateSpace, parts: Sequence[str]) -> tuple[LoopPole, ...]:
    """Poles by rising frequency; of a pair the upper one.

    The share of a state in a pole is that of the products of its entries in the left and right
    eigenvectors (Pérez-Arriaga, Verghese and Schweppe 1982).

    Parameters
    ----------
    closed : StateSpace
    parts : sequence of str
        To which part each state belongs.
    """
    balanced, _ = matrix_balance(closed.a)
    values, left, right = eig(balanced, left=True)
    products = np.abs(left.conj() * right)
    names = list(dict.fromkeys(parts))
    whose = np.array([names.index(part) for part in parts])
    shares = np.stack([products[whose == i].sum(axis=0) for i in range(len(names))])
    shares = shares / shares.sum(axis=0)
    upper = np.flatnonzero(values.imag >= 0)
    order = upper[np.argsort(np.abs(values[upper]), kind="stable")]
    found = []
    for k in order:
        alike = np.flatnonzero(shares[:, k] >= ALIKE * shares[:, k].max())
        part = " and ".join(names[i] for i in alike)
        found.append(LoopPole(complex(values[k]), part, float(shares[alike, k].sum())))
    return tuple(found)
