"""Which combinations of parameters data determine: the singular values of the Jacobian."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

#: Share of a parameter's unit direction that may lie in undetermined combinations.
SHARE = 1e-2


@dataclass(frozen=True, repr=False)
class Identifiability:
    """Singular values and vectors of residuals over scaled parameters.

    Parameters
    ----------
    names : (p,) of str
        Parameters.
    jacobian : (t, p)
        Change of each residual, in uncertainties, per unit of a scaled parameter, no unit: for a
        parameter on a logarithmic scale, per factor e.
    singular_values : (p,)
        Of the Jacobian, no unit, descending; zero where there are fewer targets than parameters.
    directions : (p, p)
        Row i: the combination of parameters that belongs to singular value i; unit vectors.
    threshold : float
        Share of the largest singular value below which a combination is not determined.
    """

    names: tuple[str, ...]
    jacobian: Array
    singular_values: Array
    directions: Array
    threshold: float

    def __repr__(self) -> str:
        return f"<Identifiability: {self.rank} of {len(self.names)} combinations determined>"

    @property
    def rank(self) -> int:
        """Number of combinations that are determined."""
        values = self.singular_values
        return int(np.sum(values > self.threshold * values[0])) if values[0] > 0 else 0

    @property
    def undetermined(self) -> tuple[dict[str, float], ...]:
        """Combinations that the data leave free: weights by parameter, unit length."""
        return tuple(
            {n: float(w) for n, w in zip(self.names, row, strict=True)}
            for row in self.directions[self.rank :]
        )

    @property
    def determined(self) -> tuple[str, ...]:
        """Parameters that do not take part in any undetermined combination."""
        free = (self.directions[self.rank :] ** 2).sum(axis=0)
        return tuple(n for n, share in zip(self.names, free, strict=True) if share < SHARE)

    @property
    def standard_errors(self) -> Array:
        """Of the scaled parameters, (p,), to first order: relative errors on a logarithmic scale.

        Infinite for a parameter that is not determined.
        """
        rank = self.rank
        inverse = self.directions[:rank] / self.singular_values[:rank, None]
        errors = np.sqrt((inverse**2).sum(axis=0))
        known = np.isin(self.names, self.determined)
        return np.where(known, errors, np.inf)

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers."""
        return {
            "jacobian": self.jacobian.tolist(),
            "singular_values": self.singular_values.tolist(),
            "directions": self.directions.tolist(),
            "threshold": self.threshold,
            "rank": self.rank,
            "undetermined": list(self.undetermined),
            "determined": list(self.determined),
        }


def identifiability(
    jacobian: Array, names: tuple[str, ...], threshold: float = 1e-3
) -> Identifiability:
    """Singular value decomposition of a Jacobian.

    Parameters
    ----------
    jacobian : (t, p)
        Of residuals in uncertainties over scaled parameters, no unit.
    names : (p,) of str
    threshold : float
        Share of the largest singular value below which a combination is not determined.

    Returns
    -------
    Identifiability
    """
    _, values, rows = np.linalg.svd(jacobian, full_matrices=True)
    padded = np.zeros(len(names))
    padded[: len(values)] = values
    # the largest weight of a combination is positive, so that runs can be compared
    largest = np.abs(rows).argmax(axis=1)
    signs = np.sign(rows[np.arange(len(rows)), largest])
    return Identifiability(names, jacobian, padded, rows * signs[:, None], threshold)
