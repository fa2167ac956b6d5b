"""Mass: consistent beam mass with rotary inertia, point masses, and what they add up to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.msa.assembly import System, system_of
from strutwork.msa.beam import to_global
from strutwork.msa.point_mass import mass_axes, mass_numbers
from strutwork.msa.structure import PlacedStructure, rigid_map

if TYPE_CHECKING:
    import scipy.sparse as sp

Array = NDArray[Any]


def local_mass(length: Array, properties: Array, inertia: Array) -> Array:
    """Consistent mass of beams in local axes, with rotary inertia.

    Integrals over the beam's static shape functions, which contain the shear flexibility Φ
    (Przemieniecki 1968, section 11.4; Friedman and Kosmatka 1993), by four Gauss points, exact.

    Parameters
    ----------
    length : (...)
        m.
    properties : (6, ...)
        As `Beam.properties`: N, N·m² and m².
    inertia : (4, ...)
        ρA, ρ(Iy + Iz), ρIy, ρIz: kg/m and kg·m.

    Returns
    -------
    mass : (..., 12, 12)
    """
    mass = np.zeros((*length.shape, 12, 12), dtype=length.dtype)
    per_length, polar, about_y, about_z = inertia
    for i, value in ((0, per_length), (3, polar)):
        mass[..., i, i] = mass[..., i + 6, i + 6] = value * length / 3.0
        mass[..., i, i + 6] = mass[..., i + 6, i] = value * length / 6.0
    points, weights = np.polynomial.legendre.leggauss(4)
    for v, r, shear, rotary, sign in (
        (1, 5, properties[5], about_z, 1.0),
        (2, 4, properties[4], about_y, -1.0),
    ):
        phi = shear / length**2
        dofs = np.array([v, r, v + 6, r + 6])
        signs = np.array([1.0, sign, 1.0, sign])
        block = np.zeros((*length.shape, 4, 4), dtype=length.dtype)
        for point, weight in zip((points + 1) / 2, weights / 2, strict=True):
            x = point
            shape = np.stack(
                [
                    1 - 3 * x**2 + 2 * x**3 + phi * (1 - x),
                    length * (x - 2 * x**2 + x**3 + phi / 2 * (x - x**2)),
                    3 * x**2 - 2 * x**3 + phi * x,
                    length * (x**3 - x**2 - phi / 2 * (x - x**2)),
                ],
                axis=-1,
            )
            turn = np.stack(
                [
                    6 * (x**2 - x) / length,
                    1 - 4 * x + 3 * x**2 + phi * (1 - x),
                    -6 * (x**2 - x) / length,
                    3 * x**2 - 2 * x + phi * x,
                ],
                axis=-1,
            )
            share = (weight * length / (1 + phi) ** 2)[..., None, None]
            block += share * (
                np.asarray(per_length)[..., None, None] * shape[..., :, None] * shape[..., None, :]
                + np.asarray(rotary)[..., None, None] * turn[..., :, None] * turn[..., None, :]
            )
        mass[..., dofs[:, None], dofs] = block * np.outer(signs, signs)
    return mass


def lumped_mass(length: Array, inertia: Array) -> Array:
    """Half the mass at either end and no rotary inertia, local axes, (..., 12, 12).

    Parameters
    ----------
    length : (...)
        m.
    inertia : (4, ...)
        As `local_mass` takes it: kg/m and kg·m.
    """
    mass = np.zeros((*length.shape, 12, 12), dtype=length.dtype)
    for i in (0, 1, 2, 6, 7, 8):
        mass[..., i, i] = inertia[0] * length / 2.0
    return mass


def beam_inertia(placed: PlacedStructure) -> Array:
    """ρA, ρ(Iy + Iz), ρIy, ρIz of every beam, (4, ..., b), kg/m and kg·m.

    Parameters
    ----------
    placed : PlacedStructure
        With b beams.

    Raises
    ------
    ModelError
        A material without density.
    """
    for beam in placed.structure.beams:
        if beam.material.density is None:
            raise ModelError(
                f"material {beam.material.name}",
                f'has no density, and beam "{beam.name}" needs its mass.',
                "Give the material a density.",
            )
    return np.moveaxis(placed.numbers.inertia, -1, 0)


def segment_mass(placed: PlacedStructure) -> Array:
    """Mass of every beam element at its two mesh nodes, global axes, (..., s, 12, 12).

    In kg, kg·m and kg·m².

    Parameters
    ----------
    placed : PlacedStructure
    """
    structure = placed.structure
    length, axes = placed.beam_geometry
    beam = structure.segments[:, 0]
    pieces = np.array([b.elements for b in structure.beams], dtype=float)
    properties = np.moveaxis(placed.numbers.stiffness, -1, 0)
    inertia = beam_inertia(placed)
    span = (length / pieces)[..., beam]
    local = local_mass(span, properties[..., beam], inertia[..., beam])
    lumped = np.array([b.mass == "lumped" for b in structure.beams])[beam]
    if lumped.any():
        local = np.where(lumped[:, None, None], lumped_mass(span, inertia[..., beam]), local)
    mass = to_global(axes[..., beam, :, :], local)
    offsets = placed.segment_offsets
    if not np.any(offsets):
        return mass
    carry = np.zeros((*offsets.shape[:-2], 12, 12))
    for k in (0, 1):
        carry[..., 6 * k : 6 * k + 6, 6 * k : 6 * k + 6] = rigid_map(offsets[..., k, :])
    return np.asarray(np.swapaxes(carry, -1, -2) @ mass @ carry)


def point_mass_matrix(mass: float | Array, inertia: Array, offset: Array) -> Array:
    """Mass of a rigid body at a node from which its centre stands off, (..., 6, 6).

    In kg, kg·m and kg·m².

    Parameters
    ----------
    mass : (...)
        kg.
    inertia : (..., 3, 3)
        About the centre, kg·m².
    offset : (..., 3)
        From the node to the centre, m.
    """
    carried = rigid_map(offset)
    centre = np.zeros(carried.shape)
    centre[..., :3, :3] = np.asarray(mass)[..., None, None] * np.eye(3)
    centre[..., 3:, 3:] = inertia
    return np.asarray(np.swapaxes(carried, -1, -2) @ centre @ carried)


def mass_contributions(system: System) -> list[tuple[str, NDArray[np.intp], Array]]:
    """Parts that have mass: name, mesh nodes (k,), mass (p, 6k, 6k) in global axes.

    In kg, kg·m and kg·m².

    Parameters
    ----------
    system : System
    """
    placed, structure = system.placed, system.placed.structure
    found: list[tuple[str, NDArray[np.intp], Array]] = []
    if structure.beams:
        mass = segment_mass(placed)
        found += [
            (f"beam {structure.beams[beam].name}", np.array([a, b]), mass[:, s])
            for s, (beam, a, b) in enumerate(structure.segments)
        ]
    for item, numbers in zip(structure.masses, mass_numbers(placed), strict=True):
        matrix = point_mass_matrix(*numbers)
        turn = np.zeros((system.poses, 6, 6))
        turn[:, :3, :3] = turn[:, 3:, 3:] = mass_axes(item, placed)
        whole = turn @ matrix @ np.swapaxes(turn, -1, -2)
        found.append((f"mass at {item.node}", np.array([structure.mesh_index[item.node]]), whole))
    for element in structure.elements:
        if hasattr(element, "mass"):
            nodes = np.array([structure.mesh_index[n] for n in element.nodes])
            found.append((f"element {element.name}", nodes, element.mass(placed)))
    return found


def mass_matrix(system: System) -> Array:
    """Mass on the unknowns of a system, dense, (p, n, n); made once and kept with the system.

    Parameters
    ----------
    system : System
        At p poses, with n unknowns.
    """
    kept = system.__dict__
    if "_mass" not in kept:
        n = system.topology.size
        matrix = np.zeros((system.poses, n, n))
        for _, nodes, part in mass_contributions(system):
            system.add_part(matrix, nodes, part)
        # a frozen dataclass keeps derived data in its __dict__, as cached_property does
        kept["_mass"] = matrix
    return np.asarray(kept["_mass"])


def sparse_mass(system: System) -> sp.csc_array:
    """Mass on the unknowns of a batch of one, sparse, (n, n).

    Parameters
    ----------
    system : System
        At one pose.
    """
    return system.sparse_sum(mass_contributions(system))


@dataclass(frozen=True)
class MassProperties:
    """Mass of a structure at a batch of poses, with what stands on ground nodes.

    Parameters
    ----------
    total : (...)
        kg.
    centre : (..., 3)
        m.
    inertia : (..., 3, 3)
        About the centre, global axes, kg·m².
    """

    total: Array
    centre: Array
    inertia: Array

    def __repr__(self) -> str:
        return f"<MassProperties: total {np.mean(self.total):.4g} kg, batch {self.total.shape}>"


def total_mass(placed: PlacedStructure) -> Array:
    """Total mass at a batch of poses, (...), kg; zero where there is none.

    Parameters
    ----------
    placed : PlacedStructure

    Raises
    ------
    ModelError
        A material without density.
    """
    return np.asarray(_rigid_mass(system_of(placed))[:, 0, 0].reshape(placed.batch))


def _rigid_mass(system: System) -> Array:
    """Mass of the whole moved as one rigid body about the origin, (p, 6, 6)."""
    total = np.zeros((system.poses, 6, 6))
    positions = system.placed.positions
    for _, nodes, part in mass_contributions(system):
        carry = np.concatenate([rigid_map(positions[:, n]) for n in nodes], axis=-2)
        total += np.swapaxes(carry, -1, -2) @ part @ carry
    return total


def mass_properties(placed: PlacedStructure) -> MassProperties:
    """Total mass, centre and inertia, from the same matrices that vibrate.

    The one place where a structure is weighed: beams, superelements, bodies and point masses.

    Parameters
    ----------
    placed : PlacedStructure

    Raises
    ------
    ModelError
        A material without density, or no mass at all.
    """
    system = system_of(placed)
    total = _rigid_mass(system)
    mass = total[:, 0, 0]
    if np.any(mass <= 0):
        raise ModelError("structure", "has no mass.", "Give densities or point masses.")
    moment = np.stack(
        [total[:, 4, 2] * -1.0, total[:, 5, 0] * -1.0, total[:, 3, 1] * -1.0], axis=-1
    )
    centre = moment / mass[:, None]
    outer = centre[:, :, None] * centre[:, None, :]
    square = np.einsum("pi,pi->p", centre, centre)[:, None, None] * np.eye(3)
    inertia = total[:, 3:, 3:] - mass[:, None, None] * (square - outer)
    batch = placed.batch
    return MassProperties(
        mass.reshape(batch), centre.reshape((*batch, 3)), inertia.reshape((*batch, 3, 3))
    )
