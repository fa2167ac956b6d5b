"""What decides the least dynamic stiffness: link length, offset of the tool, platform mass."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import cos, tan
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.fea import Damping
from strutwork.machines import Proposed3PPRS, ThreeLegs, VibratingLegs, dynamic_machine
from strutwork.papers.azulay_2014.link_lengths import LINK_LENGTHS
from strutwork.studies.dynamic import BAND, ONE_PERCENT, dynamic_stiffness, frequency_responses
from strutwork.studies.variables import named

Array = NDArray[Any]

#: Heights of the tool above the spherical joints to look at, m.
OFFSETS = tuple(float(e) for e in np.round(np.linspace(0.0, 0.030, 16), 6))

#: Platform masses to look at, kg.
MASSES = (0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0)


def dynamic_link_lengths(
    machine: VibratingLegs | None = None,
    lengths: Sequence[float] = LINK_LENGTHS,
    frequencies: ArrayLike | None = None,
    damping: Damping = ONE_PERCENT,
) -> xr.Dataset:
    """The proposed machine with other link lengths, the workpiece in the same place (Fig. 8).

    The paper finds that the least dynamic stiffness falls as links grow. Along z ours does; along
    x and y the offset of the tool from the height where the links' directions meet the axis
    decides more than the length, and that height changes with it.

    Parameters
    ----------
    machine : VibratingLegs, optional
        Its base a `Proposed3PPRS`; everything but the link length. Default: the calibrated set.
    lengths : sequence of float
        m.
    frequencies : (f,), optional
        Hz, as `frequency_responses`.
    damping : Damping

    Returns
    -------
    xarray.Dataset
        What `dynamic_stiffness` and `frequency_responses` give, with `link_length` along the
        dimension machine.

    Raises
    ------
    ModelError
        No lengths, another machine, or a length with which it cannot stand at home.
    """
    whole = machine or dynamic_machine("proposed-3pprs")
    base = whole.base
    if not isinstance(base, Proposed3PPRS):
        raise ModelError(
            "link lengths",
            f"are of the proposed machine, not of {type(base).__name__}.",
            "Give a machine whose base is Proposed3PPRS.",
        )
    if not lengths:
        raise ModelError("link lengths", "are none.", "Give at least one, m.")
    chosen = {
        f"proposed-3pprs L={length * 1e3:g} mm": replace(
            whole, base=replace(base, link_length=length)
        )
        for length in lengths
    }
    minima = dynamic_stiffness(chosen, damping)
    responses = frequency_responses(chosen, frequencies, damping)
    found = xr.merge([minima, responses], combine_attrs="drop_conflicts")
    found.attrs["title"] = "dynamic stiffness by link length"
    return found.assign_coords(
        link_length=named("machine", np.array(lengths, dtype=float), "m", "link length")
    )


def offset_sensitivity(
    machines: Mapping[str, VibratingLegs],
    offsets: Sequence[float] = OFFSETS,
    damping: Damping = ONE_PERCENT,
) -> xr.Dataset:
    """Least dynamic stiffness by the height e of the tool above the spherical joints.

    The spherical joints stay where they are; the platform's mass keeps its place between
    them and the tool.

    Parameters
    ----------
    machines : mapping of row to VibratingLegs
    offsets : sequence of float
        m.
    damping : Damping

    Returns
    -------
    xarray.Dataset
        Dimensions machine, offset, axis, mode; beside the variables of `dynamic_stiffness`
        `closed_form`, static stiffness along x by `closed_form_stiffness`.

    Raises
    ------
    ModelError
        No machines or no offsets.
    """

    def moved(machine: VibratingLegs, offset: float) -> VibratingLegs:
        share = machine.platform.centre / machine.tool_offset if machine.tool_offset else 0.0
        platform = replace(machine.platform, centre=share * offset)
        return replace(machine, tool_offset=offset, platform=platform)

    found = _swept(machines, "offset", offsets, moved, damping)
    formula = [[closed_form_stiffness(m.base, e) for e in offsets] for m in machines.values()]
    found["closed_form"] = named(
        ("machine", "offset"),
        np.array(formula),
        "N/m",
        "static stiffness along x of three links on rigid roots, in closed form",
    )
    return found.assign_coords(
        offset=named(
            "offset", found["offset"].to_numpy(), "m", "height of the tool above the joints"
        )
    )


def mass_sensitivity(
    machines: Mapping[str, VibratingLegs],
    masses: Sequence[float] = MASSES,
    damping: Damping = ONE_PERCENT,
) -> xr.Dataset:
    """Least dynamic stiffness by the platform's mass, of a disc of the same shape.

    Parameters
    ----------
    machines : mapping of row to VibratingLegs
    masses : sequence of float
        kg.
    damping : Damping

    Returns
    -------
    xarray.Dataset
        Dimensions machine, mass, axis, mode; the variables of `dynamic_stiffness`.

    Raises
    ------
    ModelError
        No machines or masses, or a mass that is not positive.
    """

    def heavier(machine: VibratingLegs, mass: float) -> VibratingLegs:
        return replace(machine, platform=replace(machine.platform, mass=mass))

    found = _swept(machines, "mass", masses, heavier, damping)
    return found.assign_coords(
        mass=named("mass", found["mass"].to_numpy(), "kg", "mass of the platform")
    )


def _swept(
    machines: Mapping[str, VibratingLegs],
    name: str,
    values: Sequence[float],
    change: Callable[[VibratingLegs, float], VibratingLegs],
    damping: Damping,
) -> xr.Dataset:
    if not len(values):
        raise ModelError(f"{name} sensitivity", "has no values.", "Give at least one.")
    parts = [
        dynamic_stiffness({row: change(m, value) for row, m in machines.items()}, damping, BAND)
        for value in values
    ]
    whole = xr.concat(parts, dim=name).assign_coords({name: np.array(values, dtype=float)})
    whole.attrs["title"] = f"least dynamic stiffness by {name}"
    return whole.transpose("machine", name, ...)


def closed_form_stiffness(machine: ThreeLegs, offset: float) -> float:
    """Static stiffness along x at home of three links clamped at rigid roots, N/m.

    1/Kxx = 1/(1.5 k_a cos²φ) + ((ρ − e)/ρ)²/(1.5 k_t), with ρ = R_p tan φ, φ the elevation of
    the last links, k_a = EA/L and k_t = 3EI/L³. A load along x at height ρ, where the links'
    directions meet the axis, strains the links along their length only; at any other height
    it also turns the platform about that point, which the links resist by bending about their
    hinges' plane. It leaves out shear, and what stands between link and ground: it agrees with
    beams to 2 % up to an offset of 12 mm for the Alizade machine, whose struts stand on the ground
    itself; first links make the others 2 to 15 times softer, with the peak at the same height.

    Parameters
    ----------
    machine : ThreeLegs
    offset : float
        Height e of the tool above the spherical joints, m.
    """
    placed = machine.place(machine.home())
    index = machine.linkage.node_index
    beam = machine.legs[0].beams[-1]
    start, end = (placed.positions[..., index[n], :] for n in beam.nodes)
    span = end - start
    length = float(np.linalg.norm(span))
    elevation = float(np.arctan2(span[2], np.hypot(span[0], span[1])))
    modulus, section = beam.material.youngs_modulus, beam.section
    axial = modulus * section.area / length
    bending = 3.0 * modulus * section.second_moment_z / length**3
    height = machine.platform_radius * tan(elevation)
    turning = ((height - offset) / height) ** 2 / (1.5 * bending)
    return 1.0 / (1.0 / (1.5 * axial * cos(elevation) ** 2) + turning)
