"""Frequency response between ports."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.coupled import AnyDamping, PartDamping, damped_matrices, is_coupled
from strutwork.fea.damping import LossFactor
from strutwork.fea.eigen import Eigen, solve_eigen
from strutwork.fea.modal import modal_model_of
from strutwork.fea.modal_truncation import truncated_receptance
from strutwork.fea.ports import Port
from strutwork.fea.reduction import Reduced, reduce_system
from strutwork.fea.rounding import uncoupled
from strutwork.fea.validity import warn_beyond
from strutwork.msa.assembly import system_of
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]

#: Frequency lines solved at once by the direct method.
LINES = 64

#: Bytes of a stack of matrices, one for each line.
STACKED = 2**28

#: Largest error of a direct solution, as a share of its largest displacement, that is let pass.
CERTAIN = 1e-6

Method = Literal["modal", "all_modes", "direct"]


@dataclass(frozen=True)
class FrequencyResponse:
    """Receptances (ISO 7626: displacement per force) between ports.

    Parameters
    ----------
    frequencies : (f,)
        Hz.
    receptance : (..., f, o, i)
        Complex, m/N and the like, peak per peak; zero between ports that do not answer one
        another but for rounding (`strutwork.fea.rounding`).
    outputs, inputs : tuple of Port
    static_compliance : (..., o, i)
        At zero frequency, m/N and the like; infinite where a rigid-body mode takes part.
    damping : str
        What damps, in words.
    method : str
        Which solver ran.
    kept_modes : int
        Flexible modes in the sum; zero for the direct method.
    static_share : float
        Least share of the static compliance at any port that the kept modes carry before the
        static residual makes it whole.
    truncation_error : (..., f, o, i)
        Bound of the error by taking the other modes for static, m/N and the like; zero without
        truncation. At most `TRUNCATED` of the pair's largest receptance over the lines, so that
        it may be a larger share between resonances.
    """

    frequencies: Array
    receptance: Array
    outputs: tuple[Port, ...]
    inputs: tuple[Port, ...]
    static_compliance: Array
    damping: str
    method: str
    kept_modes: int
    static_share: float
    truncation_error: Array = field(default_factory=lambda: np.zeros(()))

    def __repr__(self) -> str:
        return (
            f"<FrequencyResponse: {len(self.frequencies)} lines, {len(self.outputs)} x "
            f"{len(self.inputs)} receptances, {self.method}, {self.damping}>"
        )

    @property
    def mobility(self) -> Array:
        """Velocity per force, iωH, (..., f, o, i), m/(N·s)."""
        return np.asarray(1j * self._omega * self.receptance)

    @property
    def accelerance(self) -> Array:
        """Acceleration per force, −ω²H, (..., f, o, i), 1/kg."""
        return np.asarray(-(self._omega**2) * self.receptance)

    @property
    def dynamic_stiffness(self) -> Array:
        """1/|H| of every pair of ports, (..., f, o, i), N/m."""
        return np.asarray(1.0 / np.abs(self.receptance))

    @property
    def _omega(self) -> Array:
        return 2.0 * np.pi * self.frequencies[:, None, None]


def frequency_response(
    placed: PlacedStructure,
    inputs: Sequence[Port],
    outputs: Sequence[Port],
    frequencies: ArrayLike,
    damping: AnyDamping,
    method: Method = "modal",
) -> FrequencyResponse:
    """Receptances at a batch of poses.

    Parameters
    ----------
    placed : PlacedStructure
    inputs, outputs : sequence of Port
        Where it is loaded and observed.
    frequencies : (f,)
        Hz, not negative.
    damping : damping of any kind
    method : "modal", "all_modes" or "direct"
        Modal superposition with static residual and as many modes as hold it to 1e-3 of every
        pair's largest receptance over the lines, all modes, or a solution at every line. Damping
        that couples the modes is always solved in all of them together.

    Returns
    -------
    FrequencyResponse

    Raises
    ------
    ModelError
        No port, negative frequencies, a port that cannot move, no mass, an unknown method.
    NumericalError
        A response that is not finite: no damping at a resonance, or a floating structure at
        zero frequency.

    Warns
    -----
    ValidityWarning
        A line above the limit of a superelement.
    """
    found = response_at(placed, inputs, outputs, frequencies, damping, method)
    warn_beyond(placed, float(found.frequencies.max()))
    return found


def response_at(
    placed: PlacedStructure,
    inputs: Sequence[Port],
    outputs: Sequence[Port],
    frequencies: ArrayLike,
    damping: AnyDamping,
    method: Method = "modal",
) -> FrequencyResponse:
    """`frequency_response`, for steps of another solver that warns itself.

    Errors as `frequency_response`.

    Parameters
    ----------
    placed : PlacedStructure
    inputs, outputs : sequence of Port
        Where it is loaded and observed.
    frequencies : (f,)
        Hz, not negative.
    damping : damping of any kind
    method : "modal", "all_modes" or "direct"
    """
    lines = np.asarray(frequencies, dtype=float)
    if lines.ndim != 1 or not len(lines) or np.any(~np.isfinite(lines)) or np.any(lines < 0):
        raise ModelError("frequencies", "are empty or negative.", "Give frequencies in Hz.")
    if not inputs or not outputs:
        raise ModelError("ports", "are missing.", "Name at least one input and one output.")
    if method not in ("modal", "all_modes", "direct"):
        raise ModelError("method", f'"{method}" is unknown.', "modal, all_modes or direct.")
    reduced = reduce_system(system_of(placed))
    eigen = solve_eigen(reduced)
    ports = tuple(dict.fromkeys([*outputs, *inputs]))
    rows = [ports.index(p) for p in outputs]
    columns = [ports.index(p) for p in inputs]
    coupled = is_coupled(reduced, damping)
    kept, share, used = 0, 1.0, str(method)
    error: Array | None = None
    if isinstance(damping, PartDamping) and not coupled:
        if damping.background is None:
            raise ModelError(
                "damping", "is named by parts and no part has any.", "Give a part its damping."
            )
        simple = damping.background
    else:
        simple = damping  # type: ignore[assignment]
    if method == "direct" or coupled:
        response = _direct(reduced, eigen, ports, lines, damping)
        used = "direct"
    else:
        model = modal_model_of(reduced, eigen, ports, simple)
        kept = model.square.shape[1]
        if method == "modal":
            response, error, part, keep = truncated_receptance(model, lines)
            kept = int(keep.sum())
            diagonal = np.einsum("pii->pi", model.static_compliance)
            carried = np.einsum("pii->pi", part)
            share = float(
                (carried / np.where(diagonal > 0, diagonal, 1.0)).min(
                    where=diagonal > 0, initial=1.0
                )
            )
        else:
            response = model.receptance(lines)
    if not np.all(np.isfinite(response)):
        raise NumericalError(
            "frequency response",
            "is not finite at some line.",
            "Give damping, or omit zero frequency where the structure floats.",
        )
    apart = uncoupled(response)
    error = np.zeros(response.shape) if error is None else error
    response, error = (
        np.where(apart[:, None], 0.0, values)[:, :, rows][..., columns]
        for values in (response, error)
    )
    static = np.where(apart, 0.0, _static(reduced, eigen, ports))[:, rows][..., columns]
    batch = placed.batch
    return FrequencyResponse(
        lines,
        response.reshape((*batch, *response.shape[1:])),
        tuple(outputs),
        tuple(inputs),
        static.reshape((*batch, *static.shape[1:])),
        str(damping),
        used,
        kept,
        share,
        error.reshape((*batch, *error.shape[1:])),
    )


def _static(reduced: Reduced, eigen: Eigen, ports: Sequence[Port]) -> Array:
    """Static compliance (p, q, q), infinite where a rigid-body mode takes part."""
    model = modal_model_of(reduced, eigen, ports, LossFactor(0.0))
    return np.where(model.mobility_of_rigid_modes == 0, model.static_compliance, np.inf)


def _direct(
    reduced: Reduced, eigen: Eigen, ports: Sequence[Port], lines: Array, damping: AnyDamping
) -> Array:
    """Solve (K + iD + iωC − ω²M) u = f at every line, (p, f, q, q), with its residual."""
    matrices = damped_matrices(reduced, eigen, damping)
    at = np.stack([port.on(reduced) for port in ports], axis=1)
    load = np.swapaxes(at, -1, -2)
    # a coordinate that floats has mass where it has no stiffness
    middle = (2.0 * np.pi * float(np.median(lines))) ** 2
    diagonal = np.einsum("pii->pi", matrices.stiffness + middle * matrices.mass)
    scale = 1.0 / np.sqrt(np.where(diagonal > 0, diagonal, diagonal.max()))
    outer = scale[:, :, None] * scale[:, None, :]
    k, m, c, d = (
        x * outer
        for x in (matrices.stiffness, matrices.mass, matrices.viscous, matrices.structural)
    )
    scaled = (load * scale[..., None]).astype(complex)
    result = np.empty((len(at), len(lines), len(ports), len(ports)), dtype=complex)
    # of a large structure one line at a time: a stack of its matrices would not fit
    step = max(1, min(LINES, STACKED // (16 * k.size)))
    for start in range(0, len(lines), step):
        w = 2.0 * np.pi * lines[None, start : start + step, None, None]
        dynamic = (k + 1j * d)[:, None] + 1j * w * c[:, None] - w**2 * m[:, None]
        try:
            solution = np.linalg.solve(dynamic, scaled[:, None])
            # what is left, solved for again, is the error of the solution before it
            correction = np.linalg.solve(dynamic, scaled[:, None] - dynamic @ solution)
        except np.linalg.LinAlgError as error:
            raise NumericalError(
                "frequency response",
                "a line coincides with a resonance without damping.",
                "Give damping, or move the line.",
            ) from error
        largest = np.abs(solution).max(axis=-2, initial=0.0)
        off = np.abs(correction).max(axis=-2, initial=0.0)
        share = np.divide(off, largest, out=np.zeros_like(off), where=largest > 0)
        if not share.max(initial=0.0) <= CERTAIN:
            line = int(np.argmax(np.nan_to_num(share, nan=np.inf).max(axis=(0, 2))))
            raise NumericalError(
                "frequency response",
                f"the direct solution at {lines[start + line]:.6g} Hz is accurate to "
                f"{share.max():.2g} of its largest displacement only.",
                "Its stiffnesses or masses differ too much, or there is hardly any damping "
                "there; omit that line.",
            )
        solution += correction
        result[:, start : start + step] = np.swapaxes(scaled.real, -1, -2)[:, None] @ solution
    return result
