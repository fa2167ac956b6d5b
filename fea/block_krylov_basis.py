"""A growing basis, orthonormal in the energy of a structure."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.errors import NumericalError

Array = NDArray[Any]

#: Squared share of a vector that must be new for it to enter the basis.
NEW = 1e-14

#: Energy, beside one, below which it is negative beyond rounding.
NEGATIVE = 1e-6


class EnergyBasis:
    """Vectors orthonormal in the energy K + shift M, with their products.

    Parameters
    ----------
    stiffness, mass : (n, n) sparse
        N/m and kg, symmetric.
    shift : float
        rad²/s²; the energy is that of K + shift M.
    most : int
        Vectors that it can hold.
    """

    def __init__(
        self, stiffness: sp.csc_array, mass: sp.csc_array, shift: float, most: int
    ) -> None:
        n = stiffness.shape[0]
        self.stiffness, self.mass = sp.csc_array(stiffness), sp.csc_array(mass)
        self.shift, self.most, self.size = shift, min(most, n), 0
        #: Whether vectors had no place: answers may then lie beyond the basis.
        self.truncated = False
        self._room = [np.empty((n, self.most), order="F") for _ in range(3)]

    @property
    def vectors(self) -> Array:
        """V, (n, size)."""
        return self._room[0][:, : self.size]

    @property
    def force(self) -> Array:
        """K V, (n, size)."""
        return self._room[1][:, : self.size]

    @property
    def push(self) -> Array:
        """M V, (n, size)."""
        return self._room[2][:, : self.size]

    def energy(self, block: Array) -> Array:
        """(K + shift M) times some motions, (n, k), N and N·m.

        Parameters
        ----------
        block : (n, k)
            m and rad.
        """
        force = self.stiffness @ block
        return np.asarray(force + self.shift * (self.mass @ block) if self.shift else force)

    def grow(self, loads: Array, block: Array) -> slice:
        """Add what is new in the answers to some loads; returns where it stands.

        Parameters
        ----------
        loads : (n, k)
            N, N·m.
        block : (n, k)
            The answers (K + shift M)⁻¹ loads, or near them, m and rad.
        """
        # the energy of an answer, but for the sign where the expansion is not at zero
        before = np.abs(np.einsum("ij,ij->j", loads, block))
        if not np.all(np.isfinite(before)):
            raise NumericalError(
                "Krylov reduction",
                "encountered numbers out of range.",
                "Check the units of the matrices.",
            )
        block = block[:, before > 0] / np.sqrt(before[before > 0])
        start = self.size
        for _ in range(2):
            known = self.vectors
            weights = self.force.T @ block + self.shift * (self.push.T @ block)
            block -= known @ weights
        for _ in range(2):
            force, push = self.stiffness @ block, self.mass @ block
            gram = block.T @ force + self.shift * (block.T @ push)
            values, turn = np.linalg.eigh((gram + gram.T) / 2.0)
            if values.min(initial=0.0) < -NEGATIVE:
                raise NumericalError(
                    "stiffness", "is not positive.", "Check supports, springs and preloads."
                )
            fresh = values > NEW
            turn = turn[:, fresh] / np.sqrt(values[fresh])
            block = block @ turn
            if not fresh.any() or values[fresh].min() > 1e-4 * values.max():
                force, push = force @ turn, push @ turn
                break
        else:
            force, push = self.stiffness @ block, self.mass @ block
        stop = min(start + block.shape[1], self.most)
        self.truncated |= stop < start + block.shape[1] and stop < len(block)
        for room, part in zip(self._room, (block, force, push), strict=True):
            room[:, start:stop] = part[:, : stop - start]
        self.size = stop
        return slice(start, stop)
