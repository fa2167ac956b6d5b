"""Synthetic measurements: noisy responses of a perturbed model, where no measured data exist.

The paper's modal test of the prototype (Azulay 2014, section 5, Fig. 12) is not printed in
numbers. What is made here stands in its place to exercise the comparison of a model with a
measurement, and is labelled synthetic wherever it goes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.fea import FrequencyResponse, ModalRatio, Port, frequency_response, modes
from strutwork.machines import Prototype3PPPRS
from strutwork.msa import PlacedStructure
from strutwork.studies.dynamic import at_home

Array = NDArray[Any]

#: How far the perturbed model's parameters may lie from the model's, as a share of each.
SPREAD: Mapping[str, float] = MappingProxyType(
    {
        "youngs_modulus": 0.03,
        "drive_stiffness": 0.10,
        "platform_mass": 0.05,
        "spindle_mass": 0.10,
        "damping_ratio": 0.30,
    }
)

#: How far each curvilinear stage may stand from its place, rad; it parts the pairs of equal
#: frequencies that a symmetric machine has.
STAGE_SPREAD = 0.01


@dataclass(frozen=True)
class SyntheticMeasurement:
    """A measurement that was calculated, not measured.

    Parameters
    ----------
    response : FrequencyResponse
        With noise; its `method` says that it is synthetic, and the seed.
    mode_frequencies : (m,)
        Hz, without noise, as an identification would find them.
    mode_shapes : (m, o)
        At the outputs, mass-normalised, with noise, m/√kg.
    damping_ratio : float
        Of every mode.
    truth : mapping of str to float
        The perturbed parameters, as factors of the model's; stage angles in rad.
    noise : float
    seed : int
    """

    response: FrequencyResponse
    mode_frequencies: Array
    mode_shapes: Array
    damping_ratio: float
    truth: Mapping[str, float]
    noise: float
    seed: int

    #: What stands on everything made of it.
    label = "synthetic"

    def __repr__(self) -> str:
        return (
            f"<SyntheticMeasurement: seed {self.seed}, {len(self.response.frequencies)} lines, "
            f"{len(self.response.outputs)} x {len(self.response.inputs)} receptances in m/N, "
            f"{len(self.mode_frequencies)} modes>"
        )


def prototype_outputs() -> tuple[Port, ...]:
    """Where an accelerometer would sit: tool, platform, middles of the links; three axes each."""
    nodes = (
        "tool",
        *(f"platform/P{i}" for i in (1, 2, 3)),
        *(f"leg{i}/link/2" for i in (1, 2, 3)),
    )
    return tuple(Port(node, axis) for node in nodes for axis in "xyz")


#: Where a hammer would strike: the tool along x and z, as in the paper's Fig. 12.
INPUTS = (Port("tool", "x"), Port("tool", "z"))


def synthetic_measurement(
    machine: Prototype3PPPRS | None = None,
    frequencies: ArrayLike | None = None,
    outputs: Sequence[Port] | None = None,
    inputs: Sequence[Port] = INPUTS,
    *,
    damping_ratio: float = 0.01,
    noise: float = 0.02,
    count: int = 10,
    seed: int = 2014,
) -> SyntheticMeasurement:
    """Noisy responses of the prototype with parameters that differ from the model's.

    Parameters
    ----------
    machine : Prototype3PPPRS, optional
        The model that is to be compared with the measurement.
    frequencies : (f,), optional
        Hz. Default: 20 to 400 Hz in steps of 0.25 Hz.
    outputs, inputs : sequence of Port
        Default: `prototype_outputs()` and `INPUTS`.
    damping_ratio : float
        Of the model; the measurement's differs by up to `SPREAD`.
    noise : float
        Standard deviation as a share of each line's value; a tenth of it, as a share of the
        root mean square over the lines, is a floor.
    count : int
        Modes to list.
    seed : int
        The same seed gives the same measurement.

    Returns
    -------
    SyntheticMeasurement

    Raises
    ------
    ModelError
        A noise that is negative, or errors of the model as `strutwork.fea.frequency_response`.
    """
    if not (np.isfinite(noise) and noise >= 0):
        raise ModelError("noise", f"is {noise!r}.", "Give zero or a positive share.")
    model = machine or Prototype3PPPRS()
    lines = np.arange(20.0, 400.125, 0.25) if frequencies is None else np.asarray(frequencies)
    random = np.random.default_rng(seed)
    truth = {name: 1.0 + spread * random.uniform(-1.0, 1.0) for name, spread in SPREAD.items()}
    stages = STAGE_SPREAD * random.uniform(-1.0, 1.0, 3)
    placed = at_home(_perturbed(model, truth, stages))
    ratio = damping_ratio * truth["damping_ratio"]
    points = tuple(outputs or prototype_outputs())
    exact = frequency_response(placed, inputs, points, lines, ModalRatio(ratio), "all_modes")
    found, shapes = _shapes(placed, points, count)
    return SyntheticMeasurement(
        replace(
            exact,
            receptance=_noisy(exact.receptance, noise, random),
            method=f"synthetic measurement, seed {seed}",
        ),
        found,
        shapes + noise * _size(shapes, 1) * random.standard_normal(shapes.shape),
        ratio,
        MappingProxyType(truth | {f"stage {i + 1}": float(a) for i, a in enumerate(stages)}),
        noise,
        seed,
    )


def _perturbed(
    machine: Prototype3PPPRS, truth: Mapping[str, float], stages: Array
) -> Prototype3PPPRS:
    material = machine.material
    factor = truth["youngs_modulus"]
    drive = machine.drive_stiffness
    first, second, third = (float(a + b) for a, b in zip(machine.stage_angles, stages, strict=True))
    return replace(
        machine,
        material=replace(
            material,
            youngs_modulus=factor * material.youngs_modulus,
            shear_modulus=factor * material.shear_modulus,
        ),
        drive_stiffness=None if drive is None else truth["drive_stiffness"] * drive,
        platform=replace(machine.platform, mass=truth["platform_mass"] * machine.platform.mass),
        spindle_mass=truth["spindle_mass"] * machine.spindle_mass,
        stage_angles=(first, second, third),
    )


def _shapes(placed: PlacedStructure, points: Sequence[Port], count: int) -> tuple[Array, Array]:
    """Frequencies (m,) and mode shapes at ports (m, o)."""
    found = modes(placed, count)
    index = placed.structure.mesh_index
    columns = []
    for port in points:
        motion = found.shapes[:, index[port.node]]
        if port.against is not None:
            motion = motion - found.shapes[:, index[port.against]]
        columns.append(motion @ port.vector)
    return found.frequencies, np.stack(columns, axis=-1)


def _size(values: Array, axis: int) -> Array:
    """Root mean square along an axis, which is kept."""
    return np.asarray(np.sqrt((np.abs(values) ** 2).mean(axis=axis, keepdims=True)))


def _noisy(response: Array, noise: float, random: np.random.Generator) -> Array:
    """Noise in proportion to each value, and a floor for each pair of ports."""

    def complex_normal() -> Array:
        real, imaginary = random.standard_normal((2, *response.shape))
        return np.asarray((real + 1j * imaginary) / np.sqrt(2.0))

    floor = 0.1 * noise * _size(response, 0)
    return np.asarray(response * (1.0 + noise * complex_normal()) + floor * complex_normal())
