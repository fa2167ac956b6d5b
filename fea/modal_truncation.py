"""A receptance from few modes with a bound of what the others are wrong by when taken for static.

Mode j at ω adds r rᵀ f_j(ω) with f_j = 1/(1 − ω² μ + i ω v + i η). Left out, it is replaced by its
static part, f_j(0), so that the error of a pair of ports is at most Σ |r_o| |r_i| |f_j(ω) − f_j(0)|
over the modes left out: all of them are known, and the sum is exact but for its signs.

Source: Ewins (2000), Modal Testing, for residuals of modes out of range.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.fea.modal import ModalModel
from strutwork.fea.rounding import uncoupled

Array = NDArray[Any]

#: Largest error of a receptance, as a share of its largest absolute value over the lines.
TRUNCATED = 1e-3


def truncation_error(left_out: ModalModel, lines: Array) -> Array:
    """Bound of the error of modes that are taken for static, (p, f, q, q), m/N and the like.

    Parameters
    ----------
    left_out : ModalModel
        Of these modes.
    lines : (f,)
        Hz.
    """
    size = np.abs(left_out.residues)
    weighted = size[:, None] * _change(left_out, lines)[:, :, None, :]
    return np.asarray(weighted @ np.swapaxes(size, -1, -2)[:, None])


def truncated_receptance(
    model: ModalModel, lines: Array
) -> tuple[Array, Array, Array, NDArray[np.bool_]]:
    """Receptance from the modes that it takes to hold to `TRUNCATED`.

    To the modes that `ModalModel.truncated` keeps come those with the largest errors until what is
    left is small beside every receptance, also between ports that hardly answer one another.

    Parameters
    ----------
    model : ModalModel
        With all modes.
    lines : (f,)
        Hz.

    Returns
    -------
    receptance : (p, f, q, q)
        Complex, m/N and the like.
    error : (p, f, q, q)
        Its bound, of the same units.
    carried : (p, q, q)
        Static compliance of the kept modes.
    keep : (m,) of bool
    """
    keep = model.mattering(float(lines.max()))
    turned = 1.0 + 1j * model.damping.structural
    while True:
        kept, residual = model.parted(keep)
        response = kept.receptance(lines) + (residual / turned)[:, None]
        error = truncation_error(model.parted(~keep)[0], lines)
        peak = np.abs(response).max(axis=1)
        # between ports apart there is no answer that an error could be compared with
        peak = np.where(uncoupled(response) | ~(peak > 0), np.inf, peak)
        if keep.all() or not np.any(error.max(axis=1) > TRUNCATED * peak):
            return response, error, kept.static_compliance, keep
        rest = np.flatnonzero(~keep)
        size = np.abs(model.residues[:, :, rest])
        largest = _change(model.parted(~keep)[0], lines).max(axis=1)
        pairs = size[:, :, None] * size[:, None] * largest[:, None, None]
        shares = (pairs / peak[..., None]).max(axis=(0, 1, 2))
        order = np.argsort(shares)
        # half of what is let pass: the peaks change a little with the modes
        small = np.cumsum(shares[order]) <= TRUNCATED / 2.0
        add = rest[order[~small]]
        keep = keep.copy()
        keep[add if len(add) else rest] = True


def _change(model: ModalModel, lines: Array) -> Array:
    """|f(ω) − f(0)| of every mode, (p, f, m), no unit."""
    w = 2.0 * np.pi * np.asarray(lines)[None, :, None]
    eta = model.damping.structural
    moving = -(w**2) * model.square[:, None] + 1j * w * model.viscous[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.abs(moving / ((1.0 + moving + 1j * eta) * (1.0 + 1j * eta))))
