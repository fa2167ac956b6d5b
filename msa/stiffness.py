"""Stiffness from the compliance at the tool, infinite where the tool cannot move.

With R the range of the compliance C: a direction d gives way when C d is not zero, and can be
followed with every other direction blocked when d lies in R. Both are decided on the
eigenvectors of C with translations and rotations made comparable by the compliance itself, so
that neither the frame nor the size nor the units of a model matter.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, SingularPoseError

Array = NDArray[Any]

#: Eigenvalues of the scaled compliance below this share of the largest are its rounding.
ROUNDING = 1e-13

#: Above this smallest eigenvalue, as a share of the trace, a compliance is inverted as it is.
SURE = 1e-9

#: Rounding of one operation, with a margin for the operations that make a 6 x 6.
EPSILON = 100 * float(np.finfo(float).eps)


def scaled(compliance: Array, length: Array | None = None) -> tuple[Array, Array]:
    """Compliance (..., 6, 6) of trace one in translation and in rotation, and the scales used.

    Parameters
    ----------
    compliance : (..., 6, 6)
        At the tool, m/N, 1/N, rad/(N·m).
    length : (...), optional
        m, multiplies rotations. Default: each block gets a trace of one by itself.

    Returns
    -------
    scaled : (..., 6, 6)
        s_i C_ij s_j; a block that is zero stays so.
    scale : (..., 6)
    """
    diagonal = np.einsum("...ii->...i", compliance)
    traces = np.stack([diagonal[..., :3].sum(axis=-1), diagonal[..., 3:].sum(axis=-1)], axis=-1)
    if length is not None:
        total = traces[..., 0] + length**2 * traces[..., 1]
        one = np.where(total > 0, total, 1.0)
        scale = np.stack([1.0 / np.sqrt(one), length / np.sqrt(one)], axis=-1)
    else:
        scale = 1.0 / np.sqrt(np.where(traces > 0, traces, 1.0))
    scale = np.repeat(scale, 3, axis=-1)
    return compliance * scale[..., :, None] * scale[..., None, :], scale


def doubtful(matrix: Array) -> NDArray[np.bool_]:
    """Whether a scaled compliance may have no inverse, (...).

    Parameters
    ----------
    matrix : (..., 6, 6)
        From `scaled`, no unit.
    """
    result = np.zeros(matrix.shape[:-2], dtype=bool)
    try:
        # the Cholesky factor of a million poses costs a tenth of their eigenvalues
        np.linalg.cholesky(matrix - SURE * np.eye(6))
    except np.linalg.LinAlgError:
        result = ~(np.linalg.eigvalsh(matrix)[..., 0] > SURE)
    return result


@dataclass(frozen=True)
class _Spectrum:
    """Eigenvalues of scaled compliances (k, 6, 6) that are no rounding, and what they span.

    `vectors` and `dropped` are the eigenvectors with the columns of the other kind zero;
    `near` is how far rounding may turn a direction that can move, as an angle.
    """

    values: Array
    vectors: Array
    dropped: Array
    scale: Array
    near: Array

    @classmethod
    def of(cls, compliance: Array) -> _Spectrum:
        matrix, scale = scaled(compliance)
        values, vectors = np.linalg.eigh(matrix)
        largest = np.maximum(values[..., -1:], 0.0)
        # a compliance has no negative eigenvalue: the size of one is that of the rounding
        level = np.maximum(ROUNDING * largest, -10.0 * values[..., :1])
        moves = values > level
        least = np.where(moves, values, np.inf).min(axis=-1)
        spread = np.where(np.isfinite(least), largest[..., 0] / least, 1.0)
        near = np.minimum(np.maximum(EPSILON * spread, 1e-10), 1e-4)
        return cls(
            np.where(moves, values, np.inf),
            vectors * moves[..., None, :],
            vectors * ~moves[..., None, :],
            scale,
            near,
        )

    @property
    def inverse(self) -> Array:
        """Stiffness of the motions that are possible, in scaled units, (k, 6, 6)."""
        return np.asarray((self.vectors / self.values[..., None, :]) @ self.vectors.mT)


def tool_stiffness(compliance: Array) -> Array:
    """Inverse of the compliance, (..., 6, 6), N/m, N, N, N·m/rad.

    Missing (NaN) where the compliance is.

    Parameters
    ----------
    compliance : (..., 6, 6)
        At the tool, m/N, 1/N, rad/(N·m).

    Raises
    ------
    SingularPoseError
        A compliance without inverse: the tool cannot move in some direction.
    """
    compliance = np.asarray(compliance, dtype=float)
    flat, known = _flat(compliance)
    rank = movable_rank(flat[known])
    if np.any(rank < 6):
        where = int(np.flatnonzero(known)[np.flatnonzero(rank < 6)[0]])
        least = int(rank.min())
        at = f" at pose {where}" if len(flat) > 1 else ""
        raise SingularPoseError(
            "tool",
            f"does not move at all in {6 - least} of its six directions{at}: its stiffness there "
            "is infinite, and the compliance has no inverse.",
            "Give the parts between tool and ground their real stiffness, or use the stiffness "
            "along each axis.",
        )
    result = np.full(flat.shape, np.nan)
    result[known] = _inverse(flat[known])
    return result.reshape(compliance.shape)


def movable_rank(compliance: Array) -> NDArray[np.intp]:
    """Number of independent directions in which the tool can move, (...).

    Parameters
    ----------
    compliance : (..., 6, 6)
        At the tool, m/N, 1/N, rad/(N·m).
    """
    compliance = np.asarray(compliance, dtype=float)
    flat, known = _flat(compliance)
    rank = np.full(len(flat), 6, dtype=np.intp)
    some = np.flatnonzero(known)[doubtful(scaled(flat[known])[0])]
    rank[some] = np.isfinite(_Spectrum.of(flat[some]).values).sum(axis=-1)
    rank[~known] = 0
    return rank.reshape(compliance.shape[:-2])


def axis_stiffness_free(compliance: Array) -> Array:
    """Stiffness along each axis with the other directions free to follow, 1/C_ii, (..., 6).

    N/m and N·m/rad. Infinite where the tool cannot move in a direction at all; missing (NaN) where
    the compliance is.

    Parameters
    ----------
    compliance : (..., 6, 6)
        At the tool, m/N, 1/N, rad/(N·m).
    """
    diagonal = np.einsum("...ii->...i", np.asarray(compliance, dtype=float))
    blocks = [_one_over(diagonal[..., :3]), _one_over(diagonal[..., 3:])]
    return np.concatenate(blocks, axis=-1)


def _one_over(flexible: Array) -> Array:
    """One over compliances of one kind (..., 3); infinite for rounding beside their sum."""
    total = np.abs(flexible).sum(axis=-1, keepdims=True)
    still = flexible <= ROUNDING * total
    return np.asarray(np.divide(1.0, flexible, out=np.full(flexible.shape, np.inf), where=~still))


def axis_stiffness_blocked(compliance: Array) -> Array:
    """Stiffness along each axis with the other directions blocked, (..., 6), N/m and N·m/rad.

    (C⁻¹)_ii where C has an inverse. Where it has none: (C⁺)_ii for an axis along which the tool can
    move alone, and infinite for any other, as blocking the others then holds this one too. Missing
    (NaN) where the compliance is.

    Parameters
    ----------
    compliance : (..., 6, 6)
        At the tool, m/N, 1/N, rad/(N·m).
    """
    compliance = np.asarray(compliance, dtype=float)
    flat, known = _flat(compliance)
    result = np.full((len(flat), 6), np.nan)
    unsure = np.zeros(len(flat), dtype=bool)
    unsure[known] = doubtful(scaled(flat[known])[0])
    sure = known & ~unsure
    result[sure] = np.einsum("...ii->...i", _inverse(flat[sure]))
    found = _Spectrum.of(flat[unsure])
    follows = np.linalg.norm(found.dropped, axis=-1) <= found.near[:, None]
    stiffness = np.einsum("kii->ki", found.inverse) * found.scale**2
    result[unsure] = np.where(follows & (stiffness > 0), stiffness, np.inf)
    return result.reshape(compliance.shape[:-1])


def movable_inverse(compliance: Array) -> Array:
    """Stiffness of the motions that the tool can make, C⁻¹ where C has an inverse, (..., 6, 6).

    In N/m, N and N·m/rad; zero across motions that locked joints hold. Missing (NaN) where the
    compliance is.

    Parameters
    ----------
    compliance : (..., 6, 6)
        At the tool, m/N, 1/N, rad/(N·m).
    """
    compliance = np.asarray(compliance, dtype=float)
    flat, known = _flat(compliance)
    result = np.full(flat.shape, np.nan)
    unsure = np.zeros(len(flat), dtype=bool)
    unsure[known] = doubtful(scaled(flat[known])[0])
    sure = known & ~unsure
    result[sure] = _inverse(flat[sure])
    found = _Spectrum.of(flat[unsure])
    result[unsure] = found.inverse * found.scale[:, :, None] * found.scale[:, None, :]
    return result.reshape(compliance.shape)


@dataclass(frozen=True)
class StiffnessEllipsoid:
    """Principal translational stiffness at the tool.

    Parameters
    ----------
    values : (..., 3)
        Principal stiffnesses, ascending, N/m; infinite where the tool cannot move, missing
        (NaN) where the compliance is.
    directions : (..., 3, 3)
        Unit vectors as columns, in the order of `values`; no unit.
    rotation : "free" or "blocked"
        Whether the tool may rotate while it is loaded.
    """

    values: Array
    directions: Array
    rotation: str

    def __repr__(self) -> str:
        return f"<StiffnessEllipsoid: rotation {self.rotation}, values in N/m>"


def stiffness_ellipsoid(compliance: Array, rotation: str = "free") -> StiffnessEllipsoid:
    """Principal directions of the translational stiffness.

    Parameters
    ----------
    compliance : (..., 6, 6)
        At the tool, m/N, 1/N, rad/(N·m).
    rotation : "free" or "blocked"
        Free: the inverse of the translational block of C. Blocked: the translational block of
        C⁻¹; where C has none, its restriction to the translations without rotation that are
        possible, infinite across them.

    Returns
    -------
    StiffnessEllipsoid

    Raises
    ------
    ModelError
        Another word for `rotation`.
    """
    if rotation not in ("free", "blocked"):
        raise ModelError("ellipsoid", f'rotation is "{rotation}".', 'Use "free" or "blocked".')
    compliance = np.asarray(compliance, dtype=float)
    flat, known = _flat(compliance)
    values = np.full((len(flat), 3), np.nan)
    vectors = np.full((len(flat), 3, 3), np.nan)
    if rotation == "free":
        flexible, turned = np.linalg.eigh(flat[known][:, :3, :3])
        values[known], vectors[known] = _one_over(flexible[:, ::-1]), turned[:, :, ::-1]
    else:
        unsure = np.zeros(len(flat), dtype=bool)
        unsure[known] = doubtful(scaled(flat[known])[0])
        sure = known & ~unsure
        values[sure], vectors[sure] = np.linalg.eigh(_inverse(flat[sure])[:, :3, :3])
        values[unsure], vectors[unsure] = _blocked_principal(flat[unsure])
    batch = compliance.shape[:-2]
    return StiffnessEllipsoid(values.reshape(*batch, 3), vectors.reshape(*batch, 3, 3), rotation)


def _blocked_principal(compliance: Array) -> tuple[Array, Array]:
    """Principal stiffness with rotations blocked of compliances without inverse, (k, 3)."""
    found = _Spectrum.of(compliance)
    # translations that have no part outside what can move
    _, outside, axes = np.linalg.svd(found.dropped[:, :3].mT)
    axes = axes.mT
    moves = outside[:, :3] <= found.near[:, None]
    inner = axes.mT @ found.inverse[:, :3, :3] @ axes * moves[:, :, None] * moves[:, None, :]
    # what cannot move stands apart, behind all that can
    behind = 2.0 * np.einsum("kii->k", inner) + 1.0
    inner[:, range(3), range(3)] += np.where(moves, 0.0, behind[:, None])
    values, turned = np.linalg.eigh(inner)
    movable = np.arange(3) < moves.sum(axis=1, keepdims=True)
    stiffness = values * found.scale[:, :1] ** 2
    return np.where(movable & (values > 0), stiffness, np.inf), axes @ turned


def _inverse(compliance: Array) -> Array:
    """Inverse of compliances (k, 6, 6) that surely have one, symmetric."""
    scale = np.sqrt(np.einsum("...ii->...i", compliance))
    outer = scale[..., :, None] * scale[..., None, :]
    inverse = np.linalg.inv(compliance / outer)
    return np.asarray((inverse + inverse.mT) / 2.0 / outer)


def _flat(compliance: Array) -> tuple[Array, NDArray[np.bool_]]:
    """One batch axis, (k, 6, 6), and where the numbers are there, (k,)."""
    flat = compliance.reshape(-1, 6, 6)
    return flat, np.asarray(np.isfinite(flat).all(axis=(1, 2)))
