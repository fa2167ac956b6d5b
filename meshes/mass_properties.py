"""Volume, mass, centre of mass and inertia of a mesh."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes.mesh import Mesh

Array = NDArray[Any]


@dataclass(frozen=True, repr=False)
class MassProperties:
    """Mass properties of a body.

    Parameters
    ----------
    volume : float
        m³.
    mass : float
        kg.
    centre : (3,)
        Centre of mass, m.
    inertia : (3, 3)
        Inertia tensor about the centre of mass, kg m².
    """

    volume: float
    mass: float
    centre: Array
    inertia: Array

    def __repr__(self) -> str:
        centre = ", ".join(f"{v:.6g}" for v in self.centre)
        return f"MassProperties({self.volume:.6g} m³, {self.mass:.6g} kg, centre ({centre}) m)"

    def to_dict(self) -> dict[str, Any]:
        """The numbers with their units in the names."""
        return {
            "volume_m3": self.volume,
            "mass_kg": self.mass,
            "centre_m": self.centre.tolist(),
            "inertia_kg_m2": self.inertia.tolist(),
        }

    def principal_inertias(self) -> Array:
        """Principal moments of inertia, ascending, kg m², (3,)."""
        return np.asarray(np.linalg.eigvalsh(self.inertia))


def mass_properties(mesh: Mesh, density: float | Mapping[str, float]) -> MassProperties:
    """Mass properties by quadrature over the cells, exact for their shape functions.

    Parameters
    ----------
    mesh : Mesh
    density : float or mapping of region to float
        kg/m³.

    Raises
    ------
    ModelError
        A density that is not positive, or a region without one.
    """
    densities = _densities(mesh, density)
    # about the middle of the mesh: far from the origin digits would be lost
    origin = mesh.bounds.mean(axis=0)
    volume, mass = 0.0, 0.0
    first, second = np.zeros(3), np.zeros((3, 3))
    for block in mesh.blocks:
        # x² det J
        at, weights = block.type.quadrature(block.type.mass_degree)
        places = mesh.points[block.nodes] - origin
        jacobians = np.einsum("qnd,mnc->mqdc", block.type.gradient(at), places)
        volumes = np.linalg.det(jacobians) * weights
        masses = densities[block.region][:, None] * volumes
        inside = np.einsum("qn,mnc->mqc", block.type.shape(at), places)
        volume += float(volumes.sum())
        mass += float(masses.sum())
        first += np.einsum("mq,mqc->c", masses, inside)
        second += np.einsum("mq,mqc,mqd->cd", masses, inside, inside)
    return from_moments(volume, mass, origin, first, second)


def from_moments(
    volume: float, mass: float, origin: Array, first: Array, second: Array
) -> MassProperties:
    """Mass properties from moments of mass about a point.

    Parameters
    ----------
    volume : float
        m³.
    mass : float
        kg.
    origin : (3,)
        The point, m.
    first : (3,)
        ∫ x dm, kg·m.
    second : (3, 3)
        ∫ x xᵀ dm, kg·m².
    """
    arm = first / mass
    about = second - mass * np.outer(arm, arm)
    inertia = np.trace(about) * np.eye(3) - about
    return MassProperties(volume, mass, origin + arm, (inertia + inertia.T) / 2.0)


def _densities(mesh: Mesh, density: float | Mapping[str, float]) -> Array:
    given = density if isinstance(density, Mapping) else dict.fromkeys(mesh.regions, density)
    missing = [repr(name) for name in mesh.regions if name not in given]
    if missing:
        raise ModelError(
            f"mesh {mesh.name}",
            f"no density is given for region {', '.join(missing)}.",
            "Give one for each region, in kg/m³.",
        )
    for name, value in given.items():
        if not (isfinite(value) and value > 0):
            raise ModelError(
                f"mesh {mesh.name}, region {name!r}",
                f"its density is {value!r} kg/m³.",
                "Give a positive number.",
            )
    return np.array([given[name] for name in mesh.regions], dtype=float)
