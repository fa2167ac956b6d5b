"""Response of the tool to loads anywhere that vary in time: cutting, and a ground that moves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.coupled import AnyDamping, PartDamping, damped_matrices, is_coupled
from strutwork.fea.eigen import Eigen, solve_eigen
from strutwork.fea.reduction import Reduced, reduce_system
from strutwork.msa.assembly import system_of
from strutwork.msa.nodal_response import relative_motion
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]

#: Rigid-body motions that a load drives by less, as a share, count as not driven.
STILL = 1e-9

#: Frequency lines solved at once where the damping couples the modes.
LINES = 64


@dataclass(frozen=True)
class LoadResponse:
    """What makes the tool's motion of loads, at one pose.

    Parameters
    ----------
    reduced : Reduced
    eigen : Eigen
    outputs : (6, c)
        Relative motion of the tool per coordinate.
    loads : (c, m)
        Loads on the coordinates, N and N·m.
    damping : damping of any kind
    """

    reduced: Reduced
    eigen: Eigen
    outputs: Array
    loads: Array
    damping: AnyDamping

    def __repr__(self) -> str:
        return f"<LoadResponse: {self.loads.shape[1]} loads, {self.damping}>"

    @property
    def modes(self) -> Array:
        """Frequencies of the modes with mass, ascending, Hz, (k,)."""
        finite = self.eigen.circular[0][self.eigen.finite[0]]
        return np.sort(finite) / (2.0 * np.pi)

    def at(self, frequencies: Array) -> Array:
        """Complex motion of the tool per load, (f, 6, m), m and rad.

        Parameters
        ----------
        frequencies : (f,)
            Hz.
        """
        omega = 2.0 * np.pi * np.asarray(frequencies, dtype=float)
        if is_coupled(self.reduced, self.damping):
            return self._direct(omega)
        damping = self.damping
        if isinstance(damping, PartDamping):
            if damping.background is None:
                raise ModelError(
                    "damping", "is named by parts and no part has any.", "Give a part its damping."
                )
            damping = damping.background
        shapes, square = self.eigen.flexibility[0], self.eigen.square
        w = omega[:, None]
        lag = w * damping.viscous(square)[0] + damping.structural
        factor = 1.0 / (1.0 - w**2 * square[0] + 1j * lag)
        observed, driven = self.outputs @ shapes, shapes.T @ self.loads
        return np.asarray(np.einsum("ok,fk,km->fom", observed, factor, driven, optimize=True))

    def _direct(self, omega: Array) -> Array:
        found = damped_matrices(self.reduced, self.eigen, self.damping)
        k, m, c, d = (x[0] for x in (found.stiffness, found.mass, found.viscous, found.structural))
        result = np.empty((len(omega), 6, self.loads.shape[1]), dtype=complex)
        for start in range(0, len(omega), LINES):
            w = omega[start : start + LINES, None, None]
            dynamic = (k + 1j * d)[None] + 1j * w * c - w**2 * m
            motion = np.linalg.solve(dynamic, self.loads[None].astype(complex))
            result[start : start + LINES] = self.outputs @ motion
        return result


def load_response(
    placed: PlacedStructure, loads: Array, damping: AnyDamping, against: str | None = None
) -> LoadResponse:
    """Response of the tool to loads at the mesh nodes.

    Parameters
    ----------
    placed : PlacedStructure
        At one pose, with a tool.
    loads : (n, 6, m)
        Amplitudes at the mesh nodes, global axes, N and N·m.
    damping : damping of any kind
    against : str, optional
        Node of the workpiece; the ground by default.

    Raises
    ------
    ModelError
        No mass, no tool, or a load that drives a motion that nothing holds.
    """
    system = system_of(placed)
    reduced = reduce_system(system)
    eigen = solve_eigen(reduced)
    on = system.gather(loads[None])[0]
    coordinates = reduced.basis[0].T @ on
    driven = np.abs(eigen.rigid[0].T @ coordinates)
    size = np.abs(eigen.rigid[0]).T @ np.abs(coordinates)
    if np.any(driven > STILL * size.max(initial=1e-300)):
        raise ModelError(
            "structure",
            "moves freely under the load: nothing holds it.",
            "Support it, spring it to the ground, or hold its drives.",
        )
    wanted = relative_motion(system.placed, against)[0]
    motions = system.expand(reduced.basis)[0]
    outputs = np.einsum("oni,nic->oc", wanted, motions)
    return LoadResponse(reduced, eigen, np.asarray(outputs), coordinates, damping)
