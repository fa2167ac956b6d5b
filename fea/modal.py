"""Modal model of a structure between ports: residues, and the sum over modes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.damping import Damping
from strutwork.fea.eigen import Eigen, solve_eigen
from strutwork.fea.ports import STILL, Port, port_motions
from strutwork.fea.reduction import Reduced, reduce_system
from strutwork.msa.assembly import system_of
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]

#: Share of the static compliance at every output that the kept modes carry.
STATIC_SHARE = 0.99


@dataclass(frozen=True)
class ModalModel:
    """Receptance between ports as a sum over modes, at p poses.

    H(ω) = Σ r rᵀ / (1 − ω² μ + i ω v + i η) + Σ g gᵀ / (−ω² + i ω α)

    with r = ψᵀb the motion of a flexible mode at the ports, normalised by stiffness, and g that
    of a rigid-body mode, normalised by mass.

    Parameters
    ----------
    ports : tuple of Port
    residues : (p, q, m)
        r; r² is the mode's static compliance at the port, m/N.
    square : (p, m)
        μ = 1/ω², s²; zero for motions without mass.
    rigid : (p, q, k)
        g, 1/√kg.
    damping : Damping
    """

    ports: tuple[Port, ...]
    residues: Array
    square: Array
    rigid: Array
    damping: Damping

    def __repr__(self) -> str:
        return (
            f"<ModalModel: {len(self.ports)} ports, {self.square.shape[1]} modes, "
            f"{len(self.square)} poses, {self.damping}>"
        )

    @property
    def viscous(self) -> Array:
        """v, s, (p, m)."""
        return self.damping.viscous(self.square)

    @property
    def static_compliance(self) -> Array:
        """H(0) of the flexible modes, (p, q, q)."""
        return np.asarray(self.residues @ np.swapaxes(self.residues, -1, -2))

    @property
    def mobility_of_rigid_modes(self) -> Array:
        """Σ g gᵀ, 1/kg, (p, q, q); zero where no rigid-body mode moves both ports."""
        product = self.rigid @ np.swapaxes(self.rigid, -1, -2)
        size = np.sqrt(np.einsum("pqq->pq", product))
        return np.where(np.abs(product) > STILL * size[:, :, None] * size[:, None, :], product, 0.0)

    def receptance(self, frequencies: Array) -> Array:
        """Receptance (p, f, q, q), m/N; all modes take part.

        Not finite where it has no value: at a resonance without damping, and at zero frequency
        where a rigid-body mode moves the ports.

        Parameters
        ----------
        frequencies : (f,)
            Hz.
        """
        omega = 2.0 * np.pi * np.asarray(frequencies, dtype=float)
        w = omega[None, :, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            factor = 1.0 / (
                1.0
                - w**2 * self.square[:, None, :]
                + 1j * (w * self.viscous[:, None, :] + self.damping.structural)
            )
        ports = self.residues.shape[1]
        first, second = np.triu_indices(ports)
        # one real product per part of the complex factor: matrix multiplication does the sum
        products = np.swapaxes(self.residues[:, first] * self.residues[:, second], -1, -2)
        upper = (factor.real @ products) + 1j * (factor.imag @ products)
        if self.rigid.shape[-1]:
            with np.errstate(divide="ignore", invalid="ignore"):
                moving = 1.0 / (-(omega**2) + 1j * omega * self.damping.rigid)
            inertia = self.mobility_of_rigid_modes[:, None, first, second]
            upper = upper + np.where(inertia == 0, 0.0, moving[None, :, None]) * inertia
        result = np.empty((*upper.shape[:2], ports, ports), dtype=complex)
        result[..., first, second] = upper
        result[..., second, first] = upper
        return result

    def truncated(self, highest: float) -> tuple[ModalModel, Array]:
        """The modes that matter up to a frequency, and the static residual of the others.

        Kept are all modes up to twice `highest`, and more of them by their share until they carry
        `STATIC_SHARE` of the static compliance at every port.

        Parameters
        ----------
        highest : float
            Hz.

        Returns
        -------
        model : ModalModel
        residual : (p, q, q)
            Static compliance of the modes left out, m/N.
        """
        return self.parted(self.mattering(highest))

    def mattering(self, highest: float) -> NDArray[np.bool_]:
        """Modes that `truncated` keeps, (m,).

        Parameters
        ----------
        highest : float
            Hz.
        """
        whole = np.einsum("pqm,pqm->pq", self.residues, self.residues)
        share = self.residues**2 / np.where(whole > 0, whole, 1.0)[..., None]
        in_band = self.square * (2.0 * np.pi * 2.0 * highest) ** 2 >= 1.0
        keep = np.asarray(in_band.any(axis=0))
        order = np.argsort(-share.max(axis=(0, 1)), kind="stable")
        for mode in order:
            carried = share[:, :, keep].sum(axis=-1)
            if np.all(carried >= np.where(whole > 0, STATIC_SHARE, 0.0)):
                break
            keep[mode] = True
        return keep

    def parted(self, keep: NDArray[np.bool_]) -> tuple[ModalModel, Array]:
        """Some of the modes, and the static compliance of the others, (p, q, q), m/N.

        Parameters
        ----------
        keep : (m,)
            Which modes.
        """
        rest = self.residues[:, :, ~keep]
        model = ModalModel(
            self.ports, self.residues[:, :, keep], self.square[:, keep], self.rigid, self.damping
        )
        return model, np.asarray(rest @ np.swapaxes(rest, -1, -2))


def modal_model(placed: PlacedStructure, ports: Sequence[Port], damping: Damping) -> ModalModel:
    """Modal model between ports with all modes of a structure at a batch of poses.

    Parameters
    ----------
    placed : PlacedStructure
    ports : sequence of Port
    damping : Damping

    Returns
    -------
    ModalModel

    Raises
    ------
    ModelError
        No mass, all locked, no port or one that cannot move.
    """
    reduced = reduce_system(system_of(placed))
    return modal_model_of(reduced, solve_eigen(reduced), ports, damping)


def modal_model_of(
    reduced: Reduced, eigen: Eigen, ports: Sequence[Port], damping: Damping
) -> ModalModel:
    """Modal model from an eigensolution at hand.

    Parameters
    ----------
    reduced : Reduced
        At p poses.
    eigen : Eigen
        All its modes.
    ports : sequence of Port
    damping : Damping
    """
    if not ports:
        raise ModelError("ports", "are missing.", "Name at least one port.")
    at, rigid = port_motions(reduced, ports, eigen.rigid)
    return ModalModel(tuple(ports), at @ eigen.flexibility, eigen.square, rigid, damping)
