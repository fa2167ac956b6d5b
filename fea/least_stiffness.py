"""Exact minimum of the dynamic stiffness between two ports, with damping of any kind."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fea.coupled import AnyDamping, PartDamping, is_coupled
from fea.damping import Damping, modal_ratios
from fea.dynamic_stiffness import check_band, minimum_of
from fea.eigen import Eigen, solve_eigen
from fea.frf import frequency_response
from fea.modal import ModalModel, modal_model_of
from fea.peak import TOLERANCE, largest_magnitudes
from fea.pole_peak import PoleSum, largest_on_band
from fea.pole_residue import pole_model
from fea.ports import Port
from fea.reduction import Reduced, reduce_system
from msa.assembly import system_of
from msa.structure import PlacedStructure
from strutwork.errors import ModelError, NumericalError

Array = NDArray[Any]

#: A pole that decays by less than this share of its frequency is not damped.
UNDAMPED = 1e-10

#: A pole whose part in the response is a smaller share of the largest is rounding.
HEARD = 1e-12

#: The sum over poles and the direct solution agree to this share of the largest magnitude.
AGREES = 1e-6


@dataclass(frozen=True)
class LeastStiffness:
    """The least dynamic stiffness 1/|H| between two ports over a band.

    Parameters
    ----------
    input, output : Port
    value : float
        N/m and the like; of the continuous curve.
    frequency : float
        Where it is reached, Hz.
    static : float or None
        1/|H(0)|; zero where a rigid-body mode takes part, None where a static load at the
        input does not move the output.
    certified : bool
        The proof that nothing in the band is lower, to 1e-6, was finished.
    """

    input: Port
    output: Port
    value: float
    frequency: float
    static: float | None
    certified: bool

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
    them, from the sum over poles, which is checked against a direct solution.

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
        The sum over poles does not agree with the direct solution.
    """
    check_band(*band)
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
    if not size > 0:
        raise ModelError(
            f"{given} to {output}",
            "have no response to one another: the stiffness between them is infinite.",
            "Choose an output that the input moves.",
        )
    return LeastStiffness(given, output, 1.0 / size, frequency, static, certified)


def _static(reduced: Reduced, eigen: Eigen, given: Port, output: Port) -> tuple[float | None, bool]:
    ports = list(dict.fromkeys([given, output]))
    i, o = ports.index(given), ports.index(output)
    from fea.damping import ModalRatio  # noqa: PLC0415 - any kind serves: H(0) has no damping

    model = modal_model_of(reduced, eigen, ports, ModalRatio(0.0))
    if model.mobility_of_rigid_modes[0, o, i] != 0:
        return 0.0, True
    compliance = model.static_compliance[0]
    size = abs(float(compliance[o, i]))
    # rounding between directions that a symmetric structure keeps apart is no compliance
    if size <= 1e-12 * float(np.sqrt(compliance[o, o] * compliance[i, i])):
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
    certified = bound <= size * (1.0 + 2.0 * TOLERANCE)
    return float(size), float(place) / (2.0 * np.pi), bool(certified)


def _require_damping(model: ModalModel) -> None:
    ratios = modal_ratios(model.damping, model.square)
    if not np.all(ratios[model.square > 0] > 0):
        raise _no_damping("")


def _no_damping(where: str) -> ModelError:
    return ModelError(
        "damping",
        f"is zero{where}: the dynamic stiffness falls to nothing at resonance.",
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
    model = pole_model(reduced, eigen, both, damping)
    i, o = both.index(given), both.index(output)
    low, high = (2.0 * np.pi * f for f in band)
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
    poles, residues = poles[kept], residues[kept]
    total = PoleSum(poles, residues, constant, float(model.moving[o, i].real))
    place, size, certified = largest_on_band(total, max(low, 1e-9 * high), high)
    frequency = place / (2.0 * np.pi)
    lines = np.unique(np.append(np.linspace(max(band[0], 1e-6 * band[1]), band[1], 15), frequency))
    direct = frequency_response(placed, [given], [output], lines, damping, "direct").receptance
    if not np.all(np.abs(direct[:, 0, 0] - model.receptance(lines)[:, o, i]) <= AGREES * size):
        raise NumericalError(
            "dynamic stiffness",
            "the sum over poles does not agree with the direct solution.",
            "Change the damping by a little: two poles may fall together.",
        )
    return size, frequency, certified
