"""Exact minimum of the dynamic stiffness between two ports, with damping of any kind."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.coupled import AnyDamping, PartDamping, is_coupled
from strutwork.fea.damping import Damping, modal_ratios
from strutwork.fea.dynamic_stiffness import check_band, minimum_of
from strutwork.fea.eigen import Eigen, solve_eigen
from strutwork.fea.frf import response_at
from strutwork.fea.modal import ModalModel, modal_model_of
from strutwork.fea.peak import TOLERANCE, largest_magnitudes
from strutwork.fea.pole_peak import PoleSum, largest_on_band
from strutwork.fea.pole_residue import pole_model
from strutwork.fea.ports import Port
from strutwork.fea.reduction import Reduced, reduce_system
from strutwork.fea.rounding import UNCOUPLED, uncoupled
from strutwork.fea.validity import warn_beyond
from strutwork.msa.assembly import system_of
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]

#: A pole that decays by less than this share of its frequency is not damped.
UNDAMPED = 1e-10

#: A pole whose part in the response is a smaller share of the largest is rounding.
HEARD = 1e-12

#: Direct solutions that check the sum over poles, about; where it does not hold, those that
#: search the band, how often they are refined, and about how many peaks.
LINES, SEARCHED, ROUNDS, PEAKS = 60, 1000, 12, 4

#: How far from a resonance a line stands: an undamped one has no value there.
ASIDE = 1.0 - 1e-4

#: The sum over poles and the direct solution agree to this share of the largest magnitude.
AGREES = 1e-6


@dataclass(frozen=True)
class LeastStiffness:
    """The least dynamic stiffness 1/|H| between two ports over a band.

    Parameters
    ----------
    input, output : Port
    value : float
        N/m and the like; of the continuous curve. Infinite between ports that do not answer one
        another.
    frequency : float
        Where it is reached, Hz; the start of the band where it is infinite.
    static : float or None
        1/|H(0)|, N/m and the like; zero where a rigid-body mode takes part, None where a static
        load at the input does not move the output.
    certified : bool
        The proof that nothing in the band is lower, to 1e-6, was finished. False where the
        minimum is the least of direct solutions, refined about their highest peaks.
    """

    input: Port
    output: Port
    value: float
    frequency: float
    static: float | None
    certified: bool

    @property
    def uncoupled(self) -> bool:
        """Whether the ports do not answer one another: by symmetry, or as nothing joins them."""
        return self.value == np.inf

    def __repr__(self) -> str:
        return f"<LeastStiffness: {self.value:.4g} at {self.frequency:.4g} Hz>"


def least_dynamic_stiffness(
    placed: PlacedStructure,
    given: Port,
    output: Port,
    damping: AnyDamping,
    band: tuple[float, float],
) -> LeastStiffness:
    """Exact minimum of 1/|H| between two ports of one pose.

    Where damping leaves the modes uncoupled, from the sum over undamped modes; where it couples
    them, from the sum over poles, which is checked against direct solutions. Where that sum does
    not hold, from direct solutions alone, and not certified.

    Parameters
    ----------
    placed : PlacedStructure
    given, output : Port
    damping : damping of any kind
    band : (float, float)
        Hz.

    Returns
    -------
    LeastStiffness

    Raises
    ------
    ModelError
        Several poses, an empty band, no mass, a port that cannot move, no damping in the band.
    NumericalError
        A direct solution with a residual that is not small.

    Warns
    -----
    ValidityWarning
        The band reaches above the limit of a superelement.
    """
    check_band(*band)
    warn_beyond(placed, band[1])
    reduced = reduce_system(system_of(placed))
    if len(reduced.stiffness) != 1:
        raise ModelError("dynamic stiffness", "between ports of several poses.", "Give one pose.")
    eigen = solve_eigen(reduced)
    static, floats = _static(reduced, eigen, given, output)
    if floats and band[0] == 0:
        raise ModelError(
            "frequency band",
            "starts at zero, where a structure that floats has no stiffness.",
            "Start the band above zero, or hold the structure.",
        )
    if is_coupled(reduced, damping):
        found = _coupled(placed, reduced, eigen, (given, output), damping, band)
    else:
        simple = damping.background if isinstance(damping, PartDamping) else damping
        if simple is None:
            raise ModelError(
                "damping", "is named by parts and no part has any.", "Give a part its damping."
            )
        found = _uncoupled(reduced, eigen, (given, output), simple, band)
    size, frequency, certified = found
    if size == 0:
        return LeastStiffness(given, output, np.inf, band[0], None, certified=True)
    return LeastStiffness(given, output, 1.0 / size, frequency, static, certified)


def _static(reduced: Reduced, eigen: Eigen, given: Port, output: Port) -> tuple[float | None, bool]:
    ports = list(dict.fromkeys([given, output]))
    i, o = ports.index(given), ports.index(output)
    from strutwork.fea.damping import ModalRatio  # noqa: PLC0415 - any kind serves: H(0) has no damping

    model = modal_model_of(reduced, eigen, ports, ModalRatio(0.0))
    if model.mobility_of_rigid_modes[0, o, i] != 0:
        return 0.0, True
    compliance = model.static_compliance[0]
    size = abs(float(compliance[o, i]))
    # rounding between directions that a symmetric structure keeps apart is no compliance
    if size <= UNCOUPLED * float(np.sqrt(compliance[o, o] * compliance[i, i])):
        return None, False
    return 1.0 / size, False


def _uncoupled(
    reduced: Reduced,
    eigen: Eigen,
    ports: tuple[Port, Port],
    damping: Damping,
    band: tuple[float, float],
) -> tuple[float, float, bool]:
    given, output = ports
    low, high = (2.0 * np.pi * f for f in band)
    if given == output:
        model = modal_model_of(reduced, eigen, [given], damping)
        found = minimum_of(model, band, ())
        return 1.0 / float(found.value[0]), float(found.frequency[0]), bool(found.certified[0])
    model = modal_model_of(reduced, eigen, [given, output], damping)
    _require_damping(model)
    products = model.residues[:, :1] * model.residues[:, 1:]
    place, size, bound = largest_magnitudes(
        np.ascontiguousarray(products),
        np.ascontiguousarray(model.square),
        np.ascontiguousarray(model.viscous),
        float(damping.structural),
        np.ascontiguousarray(model.mobility_of_rigid_modes[:, :1, 1]),
        float(damping.rigid),
        low,
        high,
        TOLERANCE,
    )[0, 0]
    if _apart(model.receptance(_telling(eigen, band, place))[0]):
        return 0.0, band[0], True
    certified = bound <= size * (1.0 + 2.0 * TOLERANCE)
    return float(size), float(place) / (2.0 * np.pi), bool(certified)


def _require_damping(model: ModalModel) -> None:
    ratios = modal_ratios(model.damping, model.square)
    if not np.all(ratios[model.square > 0] > 0):
        raise _no_damping("")


def _no_damping(where: str) -> ModelError:
    return ModelError(
        "damping",
        f"is zero{where}: the dynamic stiffness falls to zero at resonance.",
        "Give a damping ratio or a loss factor.",
    )


def _coupled(
    placed: PlacedStructure,
    reduced: Reduced,
    eigen: Eigen,
    ports: tuple[Port, Port],
    damping: AnyDamping,
    band: tuple[float, float],
) -> tuple[float, float, bool]:
    given, output = ports
    both = list(dict.fromkeys(ports))
    i, o = both.index(given), both.index(output)
    low, high = (2.0 * np.pi * f for f in band)
    lines = _telling(eigen, band, high)
    lines = lines[:: max(1, len(lines) // LINES)]
    direct = response_at(placed, both, both, lines, damping, "direct").receptance
    if not direct[:, o, i].any():
        return 0.0, band[0], True
    try:
        model = pole_model(reduced, eigen, both, damping)
    except NumericalError:
        return _searched(placed, eigen, ports, damping, band)
    residues = model.left[o] * model.right[i]
    poles, constant = model.poles, complex(model.constant[o, i])
    # what a pole adds far from its resonance tells whether it is heard at all
    adds = np.abs(residues) / np.maximum(np.abs(poles), low)
    heard = adds > HEARD * adds.max()
    undamped = np.abs(poles.real) <= UNDAMPED * np.abs(poles)
    sounding = undamped & heard & (poles.imag >= low) & (poles.imag <= high) & (poles.imag > 0)
    if np.any(sounding):
        at = float(poles.imag[sounding][0]) / (2.0 * np.pi)
        raise _no_damping(f" in the mode at {at:.4g} Hz")
    kept = heard | ~undamped
    total = PoleSum(poles[kept], residues[kept], constant, float(model.moving[o, i].real))
    place, size, certified = largest_on_band(total, max(low, 1e-9 * high), high)
    frequency = place / (2.0 * np.pi)
    peak = response_at(placed, both, both, [frequency], damping, "direct").receptance
    lines, direct = np.append(lines, frequency), np.concatenate([direct, peak])
    miss = np.abs(direct - model.receptance(lines))[:, o, i]
    if not np.all(miss <= AGREES * size):
        return _searched(placed, eigen, ports, damping, band)
    return size, frequency, certified


def _telling(eigen: Eigen, band: tuple[float, float], place: float) -> Array:
    """Lines that tell what two ports answer, Hz: ends, by every resonance, `place` in rad/s."""
    natural = ASIDE * eigen.circular[0] / (2.0 * np.pi)
    inside = natural[(natural > band[0]) & (natural < band[1])]
    start = max(band[0], 1e-6 * band[1])
    return np.unique([*np.linspace(start, band[1], 15), *inside, place / (2.0 * np.pi)])


def _apart(receptance: Array) -> bool:
    return bool(uncoupled(receptance)[0, -1])


def _searched(
    placed: PlacedStructure,
    eigen: Eigen,
    ports: tuple[Port, Port],
    damping: AnyDamping,
    band: tuple[float, float],
) -> tuple[float, float, bool]:
    """The largest of direct solutions, refined about the highest of them; no proof."""
    start = max(band[0], 1e-6 * band[1])
    lines = np.unique(
        [*_telling(eigen, band, 2.0 * np.pi * band[1]), *np.linspace(start, band[1], SEARCHED)]
    )
    best, frequency = 0.0, start
    for _ in range(ROUNDS):
        found = response_at(placed, ports[:1], ports[1:], lines, damping, "direct")
        size = np.abs(found.receptance[:, 0, 0])
        if size.max() > best:
            best, frequency = float(size.max()), float(lines[size.argmax()])
        peaks = np.argsort(size)[-PEAKS:]
        lines = np.unique(
            np.concatenate(
                [
                    np.linspace(lines[max(p - 1, 0)], lines[min(p + 1, len(lines) - 1)], 9)
                    for p in peaks
                ]
            )
        )
    return best, frequency, False
