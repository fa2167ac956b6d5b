"""Temperatures in solids of a machine, and what they load their interfaces with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.model_solid_element import SolidElement
from strutwork.names import choices
from strutwork.stages import stage

if TYPE_CHECKING:
    from strutwork.fea.solid import Solid
    from strutwork.fea.solid_heat import HeatedSolid, HeatedSurface
    from strutwork.fea.solid_source import SolidSource

Array = NDArray[Any]
Vector = tuple[float, float, float]

#: How far a face may stand out of a box, as a share of the mesh's diagonal.
BOX_SLACK = 1e-6


@dataclass(frozen=True)
class HeatFlow:
    """Part of a solid's surface with a temperature or a flow of heat.

    Parameters
    ----------
    node, patch : str or None
        Interface node, or patch of the mesh; one of node, patch and box is given.
    box : (low, high) or None
        In the mesh's frame, m: all faces within it.
    normal : (3,) or None
        Of the faces in the box.
    change, film, surroundings, flux, power
        As of `strutwork.fea.solid_heat.HeatedSurface`, K, W/(m² K), K, W/m², W.
    """

    node: str | None = None
    patch: str | None = None
    box: tuple[Vector, Vector] | None = None
    normal: Vector | None = None
    change: float | None = None
    film: float | None = None
    surroundings: float = 0.0
    flux: float = 0.0
    power: float = 0.0


@dataclass(frozen=True)
class SolidField:
    """Change of temperature in a solid where the model file places it, after a long time.

    Parameters
    ----------
    change : float
        At `at`, K.
    gradient : (3,)
        Global axes, K/m.
    at : (3,) or None
        m, global axes; the centre of mass by default.
    axis : (3,)
        Of a profile, global axes, any length.
    places, changes : tuple of float
        Of the profile: distances from the origin along the axis, ascending, m, and what is added
        to the change there, K. Straight between them, constant outside.
    flows : tuple of HeatFlow
        Steady conduction between them, in place of all above.
    conductivities : mapping of material to float
        W/(m K); needed for flows.

    Raises
    ------
    ModelError
        A profile whose places do not rise or whose numbers differ, or flows beside a field.
    """

    change: float = 0.0
    gradient: Vector = (0.0, 0.0, 0.0)
    at: Vector | None = None
    axis: Vector = (0.0, 0.0, 1.0)
    places: tuple[float, ...] = ()
    changes: tuple[float, ...] = ()
    flows: tuple[HeatFlow, ...] = ()
    conductivities: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if len(self.places) != len(self.changes) or np.any(np.diff(self.places) <= 0):
            raise ModelError(
                "temperature profile",
                f"has {len(self.places)} places and {len(self.changes)} changes, or places that "
                "do not rise.",
                "Give a change for every place, and the places in ascending order.",
            )
        if self.places and not np.linalg.norm(self.axis) > 0:
            raise ModelError("temperature profile", "has an axis of no length.", "Give a vector.")
        if self.flows and (self.change or any(self.gradient) or self.places):
            raise ModelError(
                "temperatures",
                "give a solid a field of temperature beside surfaces, from which it follows.",
                "Give the surfaces, or change, gradient and profile.",
            )

    @property
    def is_linear(self) -> bool:
        """Whether the temperature is linear in the coordinates."""
        return not (self.places or self.flows)


@dataclass(frozen=True, eq=False)
class SolidHeat:
    """What a change of temperature does to a reduced solid.

    Parameters
    ----------
    part : str
    load : (6 k,)
        On its nodes, global axes where the model file places it, N and N·m.
    per_kelvin : (6 k,)
        Of one kelvin everywhere, N/K and N·m/K.
    lowest, highest : float
        Change of the temperature over the solid, K.
    surface : (p,)
        Change of the temperature at the `points` of the solid's surface, K.
    conducted : bool
        Whether it follows from steady conduction.
    """

    part: str
    load: Array
    per_kelvin: Array
    lowest: float
    highest: float
    surface: Array
    conducted: bool = False

    @property
    def note(self) -> str:
        """Range of the temperature, where it is not one number."""
        if self.highest == self.lowest:
            return ""
        by = f"by {self.lowest:.3g} to {self.highest:.3g} K"
        if self.conducted:
            return f"Steady conduction changes the temperature of {self.part} {by}."
        return f"The temperature of {self.part} changes {by}."


def solid_heat(
    element: SolidElement, heat: SolidField, coefficients: Mapping[str, float]
) -> SolidHeat:
    """The load of a temperature on a solid of a model file.

    Exact where the solid has one coefficient of expansion and the temperature is linear. The mesh
    carries what is not linear, and all of a solid of several coefficients.

    Parameters
    ----------
    element : SolidElement
        With its source.
    heat : SolidField
    coefficients : mapping of material to float
        Of expansion, 1/K, for all its materials.

    Raises
    ------
    ModelError
        A surface that the solid has not, a material without conductivity, or flows that fix no
        temperature.
    """
    from strutwork.fea.free_expansion import linear_load  # noqa: PLC0415

    source = element.source
    if source is None:
        raise ModelError(
            f"solid {element.name}",
            "is not kept as a mesh, so a temperature has nothing to act on.",
            "Read it from a model file.",
        )
    alphas = {r: coefficients[m.name] for r, m in source.materials}
    solid, interfaces = source.solid(), source.interfaces
    centre = element.weighed[1] if heat.at is None else np.asarray(heat.at, dtype=float)
    about = (centre - element.translation) @ element.rotation
    gradient = np.asarray(heat.gradient, dtype=float) @ element.rotation
    of_one = len(set(alphas.values())) == 1
    alpha = next(iter(alphas.values()))

    def exact(change: float, slope: Array) -> Array:
        return linear_load(solid, interfaces, element.reduced, alpha * change, alpha * slope, about)

    if heat.is_linear and of_one:
        surface = changes = heat.change + (element.points - centre) @ np.asarray(heat.gradient)
        load, unit = exact(heat.change, gradient), exact(1.0, np.zeros(3))
    else:
        with stage(f"heats solid {element.name}"):
            heated, changes = _meshed(element, source, heat, about, gradient)
            surface = changes[element.surface]
            if of_one:
                # the mesh carries only what is not linear
                arms = heated.points - about
                terms = np.concatenate([np.ones((len(arms), 1)), arms], axis=1)
                fit = np.linalg.lstsq(terms, changes, rcond=None)[0]
                rest = heated.load(element.reduced, changes - terms @ fit, alphas)
                load, unit = rest + exact(float(fit[0]), fit[1:]), exact(1.0, np.zeros(3))
            else:
                load = heated.load(element.reduced, changes, alphas)
                unit = heated.load(element.reduced, np.ones(len(changes)), alphas)
    return SolidHeat(
        element.name,
        _turned(load, element.rotation),
        _turned(unit, element.rotation),
        float(changes.min()),
        float(changes.max()),
        surface,
        bool(heat.flows),
    )


def _turned(load: Array, rotation: Array) -> Array:
    return np.asarray((load.reshape(-1, 3) @ rotation.T).ravel())


def _meshed(
    element: SolidElement, source: SolidSource, heat: SolidField, about: Array, gradient: Array
) -> tuple[HeatedSolid, Array]:
    """The solid assembled, and the changes of temperature at its nodes."""
    from strutwork.fea.solid_heat import HeatedSolid  # noqa: PLC0415

    solid, surfaces = _surfaces(element, source, source.solid(), heat)
    heated = HeatedSolid(solid, source.interfaces)
    points = heated.points
    if surfaces:
        conductivities = {
            region: _conductivity(element.name, material.name, heat.conductivities)
            for region, material in source.materials
        }
        changes = heated.steady(conductivities, surfaces)
    else:
        changes = heat.change + (points - about) @ gradient
        if heat.places:
            along = np.asarray(heat.axis, dtype=float)
            along = along / np.linalg.norm(along)
            at = (points @ element.rotation.T + element.translation) @ along
            changes = changes + np.interp(at, heat.places, heat.changes)
    return heated, changes


def _conductivity(part: str, material: str, known: Mapping[str, float]) -> float:
    value = known.get(material)
    if value is None:
        raise ModelError(
            f"temperature of {part}",
            f"follows from conduction, and its material {material} has no conductivity.",
            f'Add it to [conductivity], as in {material} = "50 W/m/K".',
        )
    return value


def _surfaces(
    element: SolidElement, source: SolidSource, solid: Solid, heat: SolidField
) -> tuple[Solid, list[HeatedSurface]]:
    """The solid with patches for all boxes, and its heated surfaces."""
    from strutwork.fea.solid_heat import HeatedSurface  # noqa: PLC0415
    from strutwork.meshes.selection import patches  # noqa: PLC0415

    tied = {i.name: i.patch for i in source.interfaces}
    known = dict(source.patches)
    boxes, found = {}, []
    slack = BOX_SLACK * float(np.linalg.norm(solid.mesh.extent))
    for number, flow in enumerate(heat.flows):
        part = f"temperature of {element.name}, surface {number + 1}"
        if sum(v is not None for v in (flow.node, flow.patch, flow.box)) != 1:
            raise ModelError(
                part, "names no place, or several.", "Give one of node, patch and box."
            )
        if flow.box is not None:
            name = f"box of surface {number + 1}"
            low, high = flow.box
            boxes[name] = ([v - slack for v in low], [v + slack for v in high], flow.normal)
        elif flow.node is not None:
            if flow.node not in tied:
                raise ModelError(
                    part,
                    f'names the node "{flow.node}", which the solid does not have.',
                    choices("Nodes", flow.node, tied),
                )
            name = tied[flow.node]
        else:
            name = str(flow.patch)
            if name not in known:
                raise ModelError(
                    part, f'names the unknown patch "{name}".', choices("Patches", name, known)
                )
        found.append(
            HeatedSurface(name, flow.change, flow.film, flow.surroundings, flow.flux, flow.power)
        )
    if boxes:
        solid = replace(solid, mesh=patches(solid.mesh, boxes))
    return solid, found
