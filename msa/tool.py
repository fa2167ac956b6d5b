"""Compliance and stiffness at the tool."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from msa.assembly import System, system_of
from msa.compiled import available, compiled_compliance, program_of
from msa.solve import METHODS, default_method
from msa.structure import PlacedStructure
from strutwork.errors import ModelError, NumericalError, SingularPoseError

Array = NDArray[Any]

ToolMethod = Literal["compiled", "saddle_point", "null_space", "condensed", "sparse"]

#: A compliance below this share of the largest of its kind is the rounding of a rigid direction.
RIGID = 1e-14

#: A compliance below this, in m/N or rad/(N m), is rounding wherever it stands.
NOTHING = 1e-25

#: Poses from which the compiled kernel is worth loading.
COMPILED_FROM = 256

#: Poses solved at once by the dense solvers: keeps a stack of frames within some megabytes.
CHUNK = 128


def tool_compliance(
    placed: PlacedStructure, method: ToolMethod | None = None, workers: int = 1
) -> Array:
    """Compliance at the tool centre point.

    Solves the system for six unit wrenches (Azulay 2014, eq. 37); never inverts a part of the
    stiffness.

    Parameters
    ----------
    placed : PlacedStructure
    method : str, optional
        "compiled", or as `solve`. Default: compiled for `COMPILED_FROM` poses and more where
        the kernel applies, else as `solve`. Poses that the compiled kernel cannot vouch for
        are solved again by the saddle-point system.
    workers : int
        Threads of the compiled kernel.

    Returns
    -------
    compliance : (..., 6, 6)
        Twist per unit wrench; blocks in m/N, 1/N, 1/N, rad/(N·m). Symmetric.

    Raises
    ------
    MechanismError
        The structure moves freely under one of the wrenches; names the joints that let it.
    ModelError
        No tool, an unknown method, or a structure that the compiled kernel does not take.
    NumericalError
        The residual is not small.
    """
    system = system_of(placed)
    if method not in (None, "compiled", *METHODS):
        raise ModelError(
            "tool_compliance",
            f'unknown method "{method}".',
            "One of: compiled, " + ", ".join(METHODS),
        )
    program = None
    if method == "compiled" or (method is None and system.poses >= COMPILED_FROM):
        program = program_of(system) if available() else None
        if program is None and method == "compiled":
            raise ModelError(
                "tool_compliance",
                "the compiled kernel does not take this structure, or numba is not installed.",
                "Leave the method out.",
            )
    if program is None:
        result = _stacked(system, method)
    else:
        result, doubtful = compiled_compliance(system, program, workers)
        if np.any(doubtful):
            again = system_of(system.placed[doubtful])
            result[doubtful] = _stacked(again, "saddle_point")
    return result.reshape(*placed.batch, 6, 6)


def _stacked(system: System, method: ToolMethod | None) -> Array:
    """Compliance through the stacked dense solvers, or the sparse one, (p, 6, 6)."""
    chosen = method or default_method(system)
    result = np.zeros((system.poses, 6, 6))
    for start in range(0, system.poses, CHUNK):
        part = system_of(system.placed[start : start + CHUNK])
        part.placed.check()
        load = part.tool_load()
        gaps = np.zeros((part.poses, len(part.row_labels), 6))
        unknowns = METHODS[chosen](part, load, gaps)
        result[start : start + CHUNK] = np.swapaxes(load, -1, -2) @ unknowns.displacements
    gap = np.abs(result - np.swapaxes(result, -1, -2)).max(axis=(1, 2), initial=0.0)
    size = np.abs(result).max(axis=(1, 2), initial=0.0)
    if not np.all(gap <= 1e-6 * size):
        raise NumericalError(
            "tool compliance", "is not symmetric to 1e-6.", "The structure is badly conditioned."
        )
    return np.asarray((result + np.swapaxes(result, -1, -2)) / 2.0)


def tool_stiffness(compliance: Array) -> Array:
    """Inverse of the compliance, (..., 6, 6), N/m, N, N, N·m/rad.

    Raises
    ------
    SingularPoseError
        A compliance without inverse: the tool cannot move in some direction.
    """
    # a direction that cannot move has the rounding of zero on the diagonal, of either sign
    scale = np.sqrt(np.maximum(np.einsum("...ii->...i", compliance), 0.0))
    if np.any(scale <= 0) or not np.all(np.isfinite(scale)):
        raise SingularPoseError(
            "tool",
            "does not move at all under some wrench: its stiffness is infinite.",
            "Give the parts between tool and ground their real stiffness.",
        )
    outer = scale[..., :, None] * scale[..., None, :]
    try:
        inverse = np.linalg.inv(compliance / outer)
    except np.linalg.LinAlgError as error:
        raise SingularPoseError(
            "tool", "has a singular compliance.", "It cannot move in one direction."
        ) from error
    return np.asarray((inverse + np.swapaxes(inverse, -1, -2)) / 2.0 / outer)


def axis_stiffness_free(compliance: Array) -> Array:
    """Stiffness along each axis with the other directions free to follow, 1/C_ii, (..., 6).

    Infinite where the tool cannot move in a direction at all.
    """
    flexible = np.einsum("...ii->...i", compliance)
    blocks = [_inverse(flexible[..., :3]), _inverse(flexible[..., 3:])]
    return np.concatenate(blocks, axis=-1)


def _inverse(flexible: Array) -> Array:
    """One over compliances of one kind; infinite for what is rounding beside the largest."""
    largest = np.abs(flexible).max(axis=-1, keepdims=True)
    moves = (flexible > RIGID * largest) & (flexible > NOTHING)
    return np.asarray(np.divide(1.0, flexible, out=np.full(flexible.shape, np.inf), where=moves))


def axis_stiffness_blocked(compliance: Array) -> Array:
    """Stiffness along each axis with the other directions blocked, (C⁻¹)_ii, (..., 6)."""
    return np.asarray(np.einsum("...ii->...i", tool_stiffness(compliance)))


@dataclass(frozen=True)
class StiffnessEllipsoid:
    """Principal translational stiffness at the tool.

    Parameters
    ----------
    values : (..., 3)
        Principal stiffnesses, ascending, N/m; infinite where the tool cannot move.
    directions : (..., 3, 3)
        Unit vectors as columns, in the order of `values`.
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
    rotation : "free" or "blocked"
        Free: the inverse of the translational block of C. Blocked: the translational block of
        C⁻¹.

    Returns
    -------
    StiffnessEllipsoid

    Raises
    ------
    ModelError
        Another word for `rotation`.
    """
    if rotation not in ("free", "blocked"):
        raise ModelError("ellipsoid", f'rotation is "{rotation}".', 'Say "free" or "blocked".')
    if rotation == "free":
        values, vectors = np.linalg.eigh(compliance[..., :3, :3])
        return StiffnessEllipsoid(_inverse(values[..., ::-1]), vectors[..., ::-1], rotation)
    values, vectors = np.linalg.eigh(tool_stiffness(compliance)[..., :3, :3])
    return StiffnessEllipsoid(values, vectors, rotation)
