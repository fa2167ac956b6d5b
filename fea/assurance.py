"""Assurance criteria: how alike two shapes, two spans of shapes or two responses are."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError

Array = NDArray[Any]

#: Directions of a span below this share of the largest are rounding.
SPAN_RANK = 1e-8


def mac(first: ArrayLike, second: ArrayLike) -> Array:
    """Modal assurance criterion |aᴴb|² / (aᴴa · bᴴb) of every pair of shapes.

    Allemang, The modal assurance criterion, Sound and Vibration 37 (2003).

    Parameters
    ----------
    first, second : (m, k), (n, k)
        Shapes as rows, real or complex, any unit.

    Returns
    -------
    mac : (m, n)
        From 0 to 1; unchanged when a shape is multiplied by any complex number.

    Raises
    ------
    ModelError
        Shapes of different lengths, a zero shape, a number that is not finite.
    """
    a, b = _shapes(first), _shapes(second)
    if a.shape[1] != b.shape[1]:
        raise ModelError(
            "shapes", f"have {a.shape[1]} and {b.shape[1]} entries.", "Give common directions."
        )
    return np.asarray(np.minimum(np.abs(a.conj() @ b.T) ** 2, 1.0))


def _shapes(rows: ArrayLike) -> Array:
    a = np.atleast_2d(np.asarray(rows))
    if not np.all(np.isfinite(a)):
        raise ModelError("shapes", "contain a number that is not finite.", "Leave it out.")
    # the largest entry first: the square of a tiny number would vanish, that of a huge one be none
    largest = np.maximum(np.abs(a.real), np.abs(a.imag)).max(axis=1, keepdims=True, initial=0.0)
    if np.any(largest == 0):
        raise ModelError("shapes", "contain one that is zero everywhere.", "Leave it out.")
    a = a / largest
    return np.asarray(a / np.linalg.norm(a, axis=1, keepdims=True))


def subspace_mac(first: ArrayLike, second: ArrayLike) -> float:
    """Squared cosine of the largest principal angle between two spans of shapes.

    One where the spans are the same (or the smaller lies in the larger), however the shapes
    within them are chosen; for two single shapes it is the MAC. Björck and Golub, Numerical
    methods for computing angles between linear subspaces, Math. Comp. 27 (1973).

    Parameters
    ----------
    first, second : (m, k), (n, k)
        Shapes as rows, real or complex, any unit.

    Raises
    ------
    ModelError
        As `mac`.
    """
    cosines = np.linalg.svd(_span(first).conj().T @ _span(second), compute_uv=False)
    return float(min(cosines[-1] ** 2, 1.0))


def _span(rows: ArrayLike) -> Array:
    """Orthonormal columns of the span of shapes."""
    left, values, _ = np.linalg.svd(_shapes(rows).T, full_matrices=False)
    return np.asarray(left[:, values > SPAN_RANK * values[0]])


def in_span(shapes: ArrayLike, span: ArrayLike) -> Array:
    """Share of each shape that lies in the span of others, squared, (m,).

    Parameters
    ----------
    shapes : (m, k)
        Shapes as rows, any unit.
    span : (n, k)
        The others as rows, any unit.
    """
    parts = _span(span).conj().T @ _shapes(shapes).T
    return np.asarray(np.minimum((np.abs(parts) ** 2).sum(axis=0), 1.0))


def frac(first: ArrayLike, second: ArrayLike) -> float:
    """Frequency response assurance criterion |Σ h₁* h₂|² / (Σ|h₁|² Σ|h₂|²), from 0 to 1.

    Heylen and Lammens, FRAC: a consistent way of comparing frequency response functions,
    International Conference on Identification in Engineering Systems (1996).

    Parameters
    ----------
    first, second : (f,)
        Responses on the same lines, complex, any unit.

    Raises
    ------
    ModelError
        As `mac`.
    """
    return float(mac(np.asarray(first)[None], np.asarray(second)[None])[0, 0])
