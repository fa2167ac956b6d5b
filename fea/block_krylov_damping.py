"""What damps a large model: shares of K and M, matrices, and single dampers at ports."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.errors import ModelError

Array = NDArray[Any]


@dataclass(frozen=True)
class MatrixDamping:
    """Damping of the dynamic stiffness K + iD + iωC − ω²M.

    C = mass_rate M + stiffness_time K + viscous + P diag(dashpots) Pᵀ and
    D = loss_factor K + structural + P diag(losses) Pᵀ.

    Parameters
    ----------
    loss_factor : float
        Structural damping of everything, no unit.
    mass_rate, stiffness_time : float
        Rayleigh's factors, 1/s and s.
    ports : (n, r) or None
        Directions P in which single dampers act, as displacements per unit of their stretch, no
        unit.
    dashpots, losses : (r,) or None
        Their viscous factors, N·s/m, and structural stiffnesses, N/m.
    viscous, structural : (n, n) sparse or None
        Any others, symmetric, N·s/m and N/m.

    Raises
    ------
    ModelError
        A factor that is negative or not finite, or dampers without ports.
    """

    loss_factor: float = 0.0
    mass_rate: float = 0.0
    stiffness_time: float = 0.0
    ports: Array | None = None
    dashpots: Array | None = None
    losses: Array | None = None
    viscous: sp.csc_array | None = None
    structural: sp.csc_array | None = None

    def __post_init__(self) -> None:
        for name in ("loss_factor", "mass_rate", "stiffness_time"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value >= 0):
                raise ModelError(f"damping, {name}", f"is {value!r}.", "Give zero or more.")
        count = 0 if self.ports is None else self.ports.shape[1]
        for name in ("dashpots", "losses"):
            given = getattr(self, name)
            if given is not None and np.shape(given) != (count,):
                raise ModelError(
                    f"damping, {name}",
                    f"has the shape {np.shape(given)}, for {count} ports.",
                    "Give one number for each column of ports.",
                )

    def __str__(self) -> str:
        parts = [
            f"{word} {value:g}"
            for word, value in (
                ("loss factor", self.loss_factor),
                ("mass rate, 1/s,", self.mass_rate),
                ("stiffness time, s,", self.stiffness_time),
            )
            if value
        ]
        if self.ports is not None:
            parts.append(f"{self.ports.shape[1]} single dampers")
        if self.viscous is not None or self.structural is not None:
            parts.append("damping matrices")
        return ", ".join(parts) or "none"

    @property
    def proportional(self) -> bool:
        """Whether the undamped modes stay uncoupled."""
        return self.ports is None and self.viscous is None and self.structural is None

    @property
    def takes_power(self) -> bool:
        """Whether no single damper feeds power in."""
        given = (x for x in (self.dashpots, self.losses) if x is not None)
        return all(bool(np.all(np.asarray(x) >= 0)) for x in given)

    def apply(self, stiffness: Array, mass: Array, at: Array) -> tuple[Array, Array]:
        """C x and D x, (n, k) each.

        Parameters
        ----------
        stiffness : (n, k)
            K x, N.
        mass : (n, k)
            M x, kg·m.
        at : (n, k)
            x, m and rad.
        """
        c = self.mass_rate * mass + self.stiffness_time * stiffness
        d = self.loss_factor * stiffness
        if self.ports is not None:
            stretch = self.ports.T @ at
            if self.dashpots is not None:
                c = c + self.ports @ (np.asarray(self.dashpots)[:, None] * stretch)
            if self.losses is not None:
                d = d + self.ports @ (np.asarray(self.losses)[:, None] * stretch)
        if self.viscous is not None:
            c = c + self.viscous @ at
        if self.structural is not None:
            d = d + self.structural @ at
        return c, d
