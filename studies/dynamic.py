"""Modes, least dynamic stiffness and frequency responses of machines at home, side by side."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.fea import Damping, ModalRatio, Port, ports
from strutwork.fea.dynamic_stiffness import check_band, minimum_of
from strutwork.fea.eigen import solve_eigen
from strutwork.fea.modal import ModalModel, modal_model_of
from strutwork.fea.modes import lowest
from strutwork.fea.reduction import reduce_system
from strutwork.machines import Machine
from strutwork.msa import PlacedStructure, system_of
from strutwork.studies.description import machine_name, versions
from strutwork.studies.variables import AXES, named

Array = NDArray[Any]

#: Hz; holds every mode that decides a minimum of the four machines of Azulay et al. 2014.
BAND = (1.0, 5000.0)

#: The paper's equivalent damping of 1 %, read as a viscous ratio (section 3.3.2).
ONE_PERCENT = ModalRatio(0.01)

#: Modes that a study lists.
MODES = 6

#: Hz; a usual step of a harmonic analysis, to show what a grid makes of a minimum.
GRID_STEP = 5.0


def tool_ports(machine: Machine) -> tuple[Port, ...]:
    """The three translations of the tool.

    Parameters
    ----------
    machine : Machine

    Raises
    ------
    ModelError
        The machine has no tool.
    """
    return ports.tool_ports(machine.linkage)


def modal_data(
    placed: PlacedStructure, ports: tuple[Port, ...], damping: Damping, count: int = MODES
) -> tuple[Array, ModalModel]:
    """Lowest elastic frequencies, Hz (p, count), and the modal model, of one eigensolution.

    Parameters
    ----------
    placed : PlacedStructure
        With one batch axis of p poses.
    ports : tuple of Port
    damping : Damping
    count : int
        Frequencies.

    Raises
    ------
    ModelError
        No mass, all locked, fewer modes than `count`.
    """
    reduced = reduce_system(system_of(placed))
    eigen = solve_eigen(reduced)
    # a rod that spins between its balls is no first frequency
    frequencies, _ = lowest(replace(eigen, rigid=eigen.rigid[..., :0]), count)
    if not np.all(np.isfinite(frequencies)):
        raise ModelError(
            "modes", f"are fewer than {count}.", "Divide the beams, or list fewer modes."
        )
    return frequencies, modal_model_of(reduced, eigen, ports, damping)


def at_home(machine: Machine) -> PlacedStructure:
    """The machine's structure at its home pose.

    Parameters
    ----------
    machine : Machine
    """
    return machine.structure.at(machine.place(machine.home()))


def grid_minimum(model: ModalModel, band: tuple[float, float], step: float = GRID_STEP) -> Array:
    """Least 1/|H_ii| on a grid of frequencies, (p, q), N/m: what a harmonic sweep shows.

    Parameters
    ----------
    model : ModalModel
        At p poses, between q ports.
    band : (float, float)
        Hz.
    step : float
        Hz: its multiples in the band are the grid.

    Raises
    ------
    ModelError
        A step that is not positive, or a band without a multiple of it.
    """
    check_band(*band)
    if not (np.isfinite(step) and step > 0):
        raise ModelError("grid step", f"is {step!r}.", "Give a positive number, Hz.")
    lines = np.arange(np.ceil(band[0] / step), np.floor(band[1] / step) + 1) * step
    if not lines.size:
        raise ModelError("grid step", "is longer than the band.", "Give a smaller step, Hz.")
    least = np.full(model.residues.shape[:2], np.inf)
    # in pieces: thousands of lines of a batch would not fit in memory at once
    for piece in np.array_split(lines, max(1, len(lines) // 256)):
        h = np.abs(np.einsum("pfii->pfi", model.receptance(piece)))
        least = np.minimum(least, (1.0 / h).min(axis=1))
    return least


def dynamic_stiffness(
    machines: Mapping[str, Machine],
    damping: Damping = ONE_PERCENT,
    band: tuple[float, float] = BAND,
    *,
    grid_step: float = GRID_STEP,
    count: int = MODES,
) -> xr.Dataset:
    """First frequencies and least driving-point dynamic stiffness at the tool, at home.

    Parameters
    ----------
    machines : mapping of row to Machine
        Their structures need mass.
    damping : Damping
    band : (float, float)
        Hz.
    grid_step : float
        Hz; of the frequency grid whose minimum stands beside the exact one.
    count : int
        Modes to list.

    Returns
    -------
    xarray.Dataset
        Dimensions machine, mode, axis; every variable states its unit.

    Raises
    ------
    ModelError
        No machines, no mass, a wrong band or step.
    """
    if not machines:
        raise ModelError("machines", "are none.", "Give at least one.")
    parts: dict[str, list[Array]] = {}
    for machine in machines.values():
        frequencies, model = modal_data(at_home(machine), tool_ports(machine), damping, count)
        found = minimum_of(model, band)
        for name, values in {
            "natural_frequency": frequencies,
            "minimum_dynamic_stiffness": found.value,
            "minimum_frequency": found.frequency,
            "static_stiffness": found.static,
            "lower_bound": found.lower,
            "upper_bound": found.upper,
            "certified": found.certified,
            "grid_minimum": grid_minimum(model, band, grid_step),
        }.items():
            parts.setdefault(name, []).append(values[0])
    long_names = {
        "natural_frequency": "natural frequency",
        "minimum_dynamic_stiffness": "least driving-point dynamic stiffness 1/|H_ii| in the band",
        "minimum_frequency": "frequency of the least dynamic stiffness",
        "static_stiffness": "static stiffness with the other directions free, 1/H_ii(0)",
        "lower_bound": "2 zeta sqrt(1 - zeta^2) times the static stiffness",
        "upper_bound": "2 zeta times the least modal stiffness of the modes in the band",
        "certified": "whether the proof that nothing in the band is lower was completed",
        "grid_minimum": f"least 1/|H_ii| on a frequency grid of {grid_step:g} Hz",
    }
    units = {"natural_frequency": "Hz", "minimum_frequency": "Hz", "certified": "1"}
    variables = {
        name: named(
            ("machine", "mode" if name == "natural_frequency" else "axis"),
            np.stack(values),
            units.get(name, "N/m"),
            long_names[name],
        )
        for name, values in parts.items()
    }
    return xr.Dataset(
        variables,
        coords={"machine": list(machines), "axis": list(AXES), "mode": np.arange(1, count + 1)},
        attrs=_attributes("dynamic stiffness at home", machines, damping)
        | {"band": f"{band[0]:g} to {band[1]:g} Hz", "grid_step": f"{grid_step:g} Hz"},
    )


def frequency_responses(
    machines: Mapping[str, Machine],
    frequencies: ArrayLike | None = None,
    damping: Damping = ONE_PERCENT,
) -> xr.Dataset:
    """Driving-point receptances at the tool along x, y and z, at home, with all modes.

    The content of Figs. 8 and 10 of Azulay et al. 2014.

    Parameters
    ----------
    machines : mapping of row to Machine
    frequencies : (f,), optional
        Hz. Default: 1200 from 5 to 5000 Hz, evenly on a logarithmic scale, and beside them the
        frequencies at which a response of a machine is largest, so that no peak is cut.
    damping : Damping

    Returns
    -------
    xarray.Dataset
        Dimensions machine, axis, frequency: real and imaginary part and magnitude of the
        displacement per force, peak per peak.

    Raises
    ------
    ModelError
        No machines, frequencies that are not positive and ascending, no mass.
    """
    if not machines:
        raise ModelError("machines", "are none.", "Give at least one.")
    models = {
        row: modal_data(at_home(machine), tool_ports(machine), damping, 1)[1]
        for row, machine in machines.items()
    }
    if frequencies is None:
        grid = np.geomspace(5.0, BAND[1], 1200)
        peaks = [minimum_of(model, BAND).frequency.ravel() for model in models.values()]
        lines = np.unique(np.concatenate([grid, *peaks]))
    else:
        lines = np.atleast_1d(np.asarray(frequencies, dtype=float))
        if lines.ndim != 1 or not np.all(lines > 0) or not np.all(np.diff(lines) > 0):
            raise ModelError(
                "frequencies", "are not positive and ascending.", "Give a list of them, Hz."
            )
    response = np.stack(
        [np.einsum("fii->if", model.receptance(lines)[0]) for model in models.values()]
    )
    dims = ("machine", "axis", "frequency")
    return xr.Dataset(
        {
            "receptance_real": named(dims, response.real, "m/N", "real part of the receptance"),
            "receptance_imaginary": named(
                dims, response.imag, "m/N", "imaginary part of the receptance"
            ),
            "receptance_magnitude": named(
                dims, np.abs(response), "m/N", "displacement per force, peak per peak"
            ),
        },
        coords={
            "machine": list(machines),
            "axis": list(AXES),
            "frequency": named("frequency", lines, "Hz", "frequency"),
        },
        attrs=_attributes("frequency responses at home", machines, damping),
    )


def _attributes(study: str, machines: Mapping[str, Machine], damping: Damping) -> dict[str, str]:
    return {
        "title": study,
        "Conventions": "CF-1.11",
        "machines": ", ".join(dict.fromkeys(machine_name(m) for m in machines.values())),
        "damping": str(damping),
        "versions": json.dumps(versions()),
    }
