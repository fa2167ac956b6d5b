"""Dynamic stiffness: definitions, and its exact minimum over a band."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.damping import Damping, LossFactor, modal_ratios
from strutwork.fea.modal import ModalModel, modal_model
from strutwork.fea.peak import TOLERANCE, largest_magnitudes
from strutwork.fea.ports import Port
from strutwork.fea.validity import warn_beyond
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]


#: Least singular value of a receptance of unit size below which its ports depend on each other.
DEPENDENT = 1e-13


@dataclass(frozen=True)
class MinimumDynamicStiffness:
    """The least driving-point dynamic stiffness over a band.

    Parameters
    ----------
    ports : tuple of Port
    value : (..., q)
        min 1/|H_ii| over the band, other directions free, N/m or N·m/rad.
    frequency : (..., q)
        Where it is reached, Hz.
    static : (..., q)
        1/H_ii(0), N/m; zero where a rigid-body mode moves the port.
    lower, upper : (..., q)
        The two-sided bound 2ζ√(1−ζ²)·static and 2ζ·min 1/r², of the modes in the band, N/m.
    certified : (..., q) of bool
        True where the proof that nothing in the band is lower, to 1e-6, was finished.
    """

    ports: tuple[Port, ...]
    value: Array
    frequency: Array
    static: Array
    lower: Array
    upper: Array
    certified: NDArray[np.bool_]

    def __repr__(self) -> str:
        return (
            f"<MinimumDynamicStiffness: {len(self.ports)} ports, batch {self.value.shape[:-1]}, "
            f"{'certified' if self.certified.all() else 'not certified'}, N/m>"
        )


#: Highest frequency of a band, Hz: no machine vibrates up there, and the fourth power of ω
#: still keeps its digits beside any stiffness.
HIGHEST = 1e9


def check_band(low: float, high: float) -> None:
    """Check a frequency band.

    Parameters
    ----------
    low, high : float
        Its ends, Hz.

    Raises
    ------
    ModelError
        A band that is empty, negative, not finite or ends above `HIGHEST`.
    """
    if not (np.isfinite(low) and np.isfinite(high)) or low < 0 or high <= low:
        raise ModelError(
            "frequency band",
            f"goes from {low:g} to {high:g} Hz.",
            "Give two frequencies, the second larger than the first and neither negative.",
        )
    if high > HIGHEST:
        raise ModelError(
            "frequency band",
            f"goes up to {high:g} Hz, where nothing vibrates.",
            f"Let it end at {HIGHEST:g} Hz or below; machines vibrate below 1e5 Hz.",
        )


def minimum_dynamic_stiffness(
    placed: PlacedStructure, ports: Sequence[Port], damping: Damping, band: tuple[float, float]
) -> MinimumDynamicStiffness:
    """Exact minimum of the driving-point dynamic stiffness at a batch of poses.

    Of the continuous curve with all modes, not of a frequency grid.

    Parameters
    ----------
    placed : PlacedStructure
    ports : sequence of Port
    damping : Damping
    band : (float, float)
        Hz.

    Returns
    -------
    MinimumDynamicStiffness

    Raises
    ------
    ModelError
        An empty band, no mass, a port that cannot move, no damping.
    NumericalError
        The result breaks the two-sided bound.

    Warns
    -----
    ValidityWarning
        The band reaches above the limit of a superelement.
    """
    check_band(*band)
    warn_beyond(placed, band[1])
    model = modal_model(placed, ports, damping)
    return minimum_of(model, band, placed.batch)


def minimum_of(
    model: ModalModel, band: tuple[float, float], batch: tuple[int, ...] | None = None
) -> MinimumDynamicStiffness:
    """The minimum from a modal model at hand.

    Parameters
    ----------
    model : ModalModel
        At p poses.
    band : (float, float)
        Hz.
    batch : tuple of int, optional
        Shape of the poses' axes in the result; by default (p,).
    """
    check_band(*band)
    ratios = modal_ratios(model.damping, model.square)
    if not np.all(ratios[model.square > 0] > 0):
        raise ModelError(
            "damping",
            "is zero: the dynamic stiffness falls to zero at resonance.",
            "Give a damping ratio or a loss factor.",
        )
    low, high = (2.0 * np.pi * f for f in band)
    products = model.residues**2
    moving = np.einsum("pqq->pq", model.mobility_of_rigid_modes)
    if np.any(moving > 0) and low == 0:
        raise ModelError(
            "frequency band",
            "starts at zero, where a structure that floats has no stiffness.",
            "Start the band above zero, or hold the structure.",
        )
    found = largest_magnitudes(
        np.ascontiguousarray(products),
        np.ascontiguousarray(model.square),
        np.ascontiguousarray(model.viscous),
        float(model.damping.structural),
        np.ascontiguousarray(moving),
        float(model.damping.rigid),
        low,
        high,
        TOLERANCE,
    )
    static = products.sum(axis=-1)
    free = moving == 0
    value, frequency = 1.0 / found[..., 1], found[..., 0] / (2.0 * np.pi)
    lower, upper = _bounds(model, ratios, products, static, low, high)
    broken = free & ((value < lower * (1 - 1e-9)) | (value > upper * (1 + 1e-9)))
    if np.any(broken):
        pose = int(np.argwhere(broken)[0][0])
        raise NumericalError(
            "minimum dynamic stiffness",
            f"violates its two-sided bound at pose {pose}.",
            "This is a fault of the solver: please report the model.",
        )
    shape = (len(model.square),) if batch is None else batch
    q = len(model.ports)

    def shaped(array: Array) -> Array:
        return np.asarray(array).reshape((*shape, q))

    return MinimumDynamicStiffness(
        model.ports,
        shaped(value),
        shaped(frequency),
        shaped(np.where(free, 1.0 / np.where(free, static, 1.0), 0.0)),
        shaped(np.where(free, lower, 0.0)),
        shaped(upper),
        shaped(found[..., 2] <= found[..., 1] * (1 + 2 * TOLERANCE)),
    )


def _bounds(
    model: ModalModel, ratios: Array, products: Array, static: Array, low: float, high: float
) -> tuple[Array, Array]:
    """2ζ√(1−ζ²)·static with the least ζ, and 2ζ·min 1/r² over the modes in the band."""
    massive = model.square > 0
    least = np.where(massive, ratios, np.inf).min(axis=1, initial=np.inf)
    if isinstance(model.damping, LossFactor):
        # without a flexible mode that has mass nothing is magnified
        shrink = np.where(np.isfinite(least), 2.0 * least, 1.0)
    else:
        # a mode damped beyond 1/√2 has no peak: its magnitude never exceeds the static one
        shrink = np.where(
            least < np.sqrt(0.5),
            2.0 * least * np.sqrt(1 - np.minimum(least, 0.7071067811865475) ** 2),
            1.0,
        )
    with np.errstate(divide="ignore"):
        omega = 1.0 / np.sqrt(model.square)
    at_peak = np.full(products.shape, np.inf)
    np.divide(2.0 * ratios[:, None, :], products, out=at_peak, where=products > 1e-290)
    inside = (massive & (omega >= low) & (omega <= high))[:, None, :]
    upper = np.where(inside, at_peak, np.inf).min(axis=-1, initial=np.inf)
    return shrink[:, None] / np.where(static > 0, static, np.inf), upper


def blocked_dynamic_stiffness(receptance: Array) -> Array:
    """|Z_ii| with Z = H⁻¹: the other ports held, (..., q), N/m.

    Parameters
    ----------
    receptance : (..., q, q)
        H between the ports, complex, m/N.

    Raises
    ------
    ModelError
        Ports that do not move independently.
    """
    size = np.sqrt(np.abs(np.einsum("...ii->...i", receptance)))
    outer = size[..., :, None] * size[..., None, :]
    scaled = receptance / np.where(outer > 0, outer, 1.0)
    if np.any(np.linalg.svd(scaled, compute_uv=False)[..., -1] <= DEPENDENT):
        raise ModelError(
            "ports",
            "do not move independently: one cannot be held while another moves.",
            "Leave a port out.",
        )
    impedance = np.linalg.inv(receptance)
    return np.asarray(np.abs(np.einsum("...ii->...i", impedance)))


def worst_direction(receptance: Array) -> tuple[Array, Array]:
    """Least dynamic stiffness over all directions of the ports, 1/σ_max(H).

    Parameters
    ----------
    receptance : (..., q, q)
        Usually between the three translations of one node, complex, m/N.

    Returns
    -------
    stiffness : (...)
        N/m.
    direction : (..., q)
        Complex unit vector of the load that moves most.
    """
    _, values, right = np.linalg.svd(receptance)
    return 1.0 / values[..., 0], right[..., 0, :].conj()
