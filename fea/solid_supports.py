"""Supports of a solid: directions of nodes held still or displaced by a known amount."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import InconsistentConstraintsError, MechanismError, ModelError
from strutwork.fea.solid_matrices import SolidMatrices

Array = NDArray[Any]
AXES = "xyz"


@dataclass(frozen=True, repr=False)
class Supports:
    """Known displacements.

    Parameters
    ----------
    dofs : (k,) int
        Degrees of freedom 3 i + c, ascending.
    values : (k,)
        m.
    """

    dofs: NDArray[np.int64]
    values: Array

    def __repr__(self) -> str:
        moved = int(np.count_nonzero(self.values))
        return f"Supports({len(self.dofs)} degrees of freedom held, {moved} of them displaced)"


def supports(
    matrices: SolidMatrices, held: Mapping[str, str | Mapping[str, float | ArrayLike]]
) -> Supports:
    """Supports by the names of node sets and patches.

    Parameters
    ----------
    matrices : SolidMatrices
    held : mapping
        From a node set or patch to the directions held, as `"xyz"` or `"z"`, or to the displacement
        of each, as `{"x": 0.0, "z": -1e-3}`, m; one number, or (k,) for its k nodes.

    Returns
    -------
    Supports

    Raises
    ------
    ModelError
        No node set or patch of that name, a direction that is not x, y or z, displacements
        that are not finite.
    InconsistentConstraintsError
        Two of them displace a common node differently.
    """
    dofs, values, owners = [], [], []
    for name, directions in held.items():
        part = f"solid {matrices.solid.name}, support {name!r}"
        nodes = matrices.nodes_of_set(name)
        wanted = dict.fromkeys(directions, 0.0) if isinstance(directions, str) else directions
        for direction, value in wanted.items():
            if direction not in {*AXES}:
                raise ModelError(part, f"holds {direction!r}.", "Use the directions x, y and z.")
            amount = np.asarray(value, dtype=float)
            if amount.shape not in {(), (len(nodes),)} or not np.isfinite(amount).all():
                raise ModelError(
                    part,
                    f"its displacement along {direction} is {np.asarray(value).tolist()!r}.",
                    f"Give one number, or one for each of the {len(nodes)} nodes.",
                )
            dofs.append(3 * nodes + AXES.index(direction))
            values.append(np.broadcast_to(amount, nodes.shape))
            owners += [name] * len(nodes)
    if not dofs:
        return Supports(np.zeros(0, np.int64), np.zeros(0))
    flat, amounts = np.concatenate(dofs), np.concatenate(values)
    unique, first, which = np.unique(flat, return_index=True, return_inverse=True)
    differs = np.flatnonzero(amounts != amounts[first][which])
    if len(differs):
        there = int(differs[0])
        dof = int(flat[there])
        raise InconsistentConstraintsError(
            f"solid {matrices.solid.name}",
            f"supports {owners[int(first[which[there]])]!r} and {owners[there]!r} displace node "
            f"{dof // 3} along {AXES[dof % 3]} by {amounts[first[which[there]]]:.6g} and "
            f"{amounts[there]:.6g} m.",
            "Give both the same displacement, or remove the node from one.",
        )
    return Supports(unique, amounts[first])


def free_rigid_motions(matrices: SolidMatrices, dofs: NDArray[np.int64]) -> Array:
    """Rigid motions that held degrees of freedom allow, (6, r), about the origin.

    An orthonormal basis when rotations are measured by the displacement at the distance of
    the solid's size from its middle.

    Parameters
    ----------
    matrices : SolidMatrices
    dofs : (k,)
        Degrees of freedom held, 3 i + c.
    """
    centre = matrices.points.mean(axis=0)
    size = float(np.linalg.norm(matrices.mesh.extent)) / 2.0
    scale = np.array([1.0] * 3 + [1.0 / size] * 3)
    rows = matrices.rigid_modes(centre)[dofs] * scale
    # the Gram matrix would square the tolerance: triangularise instead
    triangle = np.linalg.qr(rows, mode="r") if len(rows) > 6 else rows
    _, singular, right = np.linalg.svd(np.vstack([triangle, np.zeros((6, 6))]))
    motions = (right[singular <= 1e-9 * max(singular[0], 1.0)] * scale).T
    # the translation of the origin
    motions[:3] -= np.cross(motions[3:], centre, axis=0)
    return np.asarray(motions)


def require_held(matrices: SolidMatrices, dofs: NDArray[np.int64]) -> None:
    """Refuse supports that let the solid move.

    Parameters
    ----------
    matrices : SolidMatrices
    dofs : (k,)
        Degrees of freedom held, 3 i + c.

    Raises
    ------
    MechanismError
        Says which rigid motions are free.
    """
    free = free_rigid_motions(matrices, dofs)
    if free.shape[1]:
        raise MechanismError(
            f"solid {matrices.solid.name}",
            f"nothing holds it against {'; '.join(_described(matrices, free))}.",
            "Hold more directions of a node set or patch.",
        )


def _described(matrices: SolidMatrices, free: Array) -> list[str]:
    """Translations first, then rotations about axes that pass near the middle of the solid."""
    size = float(np.linalg.norm(matrices.mesh.extent)) / 2.0
    centre = matrices.points.mean(axis=0)
    # combinations without rotation, and the others
    _, singular, right = np.linalg.svd(free[3:] * size)
    rank = int(np.count_nonzero(singular > 1e-9))
    translations = free[:3] @ right[rank:].T
    told = [f"translation along {_direction(t)}" for t in _aligned(translations).T]
    turns = free @ right[:rank].T
    if rank:
        # axis by axis where the axes are free one by one
        turns = turns @ np.linalg.pinv(turns[3:]) @ _aligned(turns[3:])
    for turn in turns.T:
        axis = turn[3:] / np.linalg.norm(turn[3:])
        velocity = (turn[:3] + np.cross(turn[3:], centre)) / np.linalg.norm(turn[3:])
        # free translations may be added at will
        if translations.size:
            velocity -= translations @ np.linalg.lstsq(translations, velocity, rcond=None)[0]
        point = centre + np.cross(axis, velocity)
        place = ", ".join(f"{v:.4g}" for v in np.round(point, 12) + 0.0)
        told.append(f"rotation about {_direction(axis)} through ({place}) m")
    return told


def _aligned(vectors: Array) -> Array:
    """A basis of the space of three-vectors (3, r), of global axes as far as they are in it."""
    if vectors.shape[1] == 0:
        return vectors
    basis, singular, _ = np.linalg.svd(vectors, full_matrices=False)
    basis = basis[:, singular > 1e-9 * singular[0]]
    inside = np.linalg.norm(basis, axis=1) > 1 - 1e-9
    axes = np.eye(3)[:, inside]
    left = basis - axes @ (axes.T @ basis)
    rest, size, _ = np.linalg.svd(left, full_matrices=False)
    return np.asarray(np.hstack([axes, rest[:, size > 1e-6]]))


def _direction(vector: Array) -> str:
    unit = vector / np.linalg.norm(vector)
    largest = int(np.argmax(np.abs(unit)))
    if abs(unit[largest]) > 1 - 1e-9:
        return AXES[largest]
    # a line has no sense: the first entry that counts is positive, whatever rounding has made of it
    first = unit[int(np.argmax(np.abs(unit) > 1e-6))]
    shown = np.round(unit * np.sign(first), 9) + 0.0
    return f"({', '.join(f'{v:.3g}' for v in shown)})"
