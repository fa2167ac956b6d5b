"""A builder of structures for the tests, written apart from the model-file reader.

Nodes that beams or rigid bodies tie together become one body of the linkage; the second node
of a joint is created where the first one stands.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.kinematics import DIRECTIONS, GROUND, Body, Joint, Linkage, Placement, axes_frame
from strutwork.kinematics.coupling import Coupling
from strutwork.msa import (
    Beam,
    LineLoad,
    LoadCase,
    Material,
    PlacedStructure,
    PointMass,
    Section,
    Spring,
    Structure,
    rectangle,
    tube,
)

Array = NDArray[Any]

STEEL = Material.isotropic(205e9, 0.29, density=7870.0, name="steel")
TUBE = tube(0.019, 0.014, name="tube19")
BAR = rectangle(0.02, 0.05, name="bar")
Z = (0.0, 0.0, 1.0)


class Model:
    """A structure in the making; positions and axes may carry leading pose axes."""

    def __init__(self, tool: str | None = None) -> None:
        self.positions: dict[str, Array] = {}
        self.axes: dict[str, Array] = {}
        self.beams: list[Beam] = []
        self.groups: dict[str, tuple[str, ...]] = {}
        self.grounded: list[str] = []
        self.joints: list[Joint] = []
        self.couplings: tuple[Coupling, ...] = ()
        self.springs: list[Spring] = []
        self.masses: list[PointMass] = []
        self.tool = tool

    def nodes(self, **positions: ArrayLike) -> None:
        self.positions |= {n: np.asarray(p, dtype=float) for n, p in positions.items()}

    def ground(self, **positions: ArrayLike) -> None:
        self.nodes(**positions)
        self.grounded += positions

    def beam(
        self,
        name: str,
        first: str,
        second: str,
        section: Section = TUBE,
        material: Material = STEEL,
        **options: Any,
    ) -> None:
        self.beams.append(Beam(name, (first, second), material, section, **options))

    def rigid(self, name: str, *nodes: str) -> None:
        self.groups[name] = nodes

    def joint(
        self,
        name: str,
        kind: str,
        between: tuple[str, str],
        axis: ArrayLike = Z,
        second_axis: ArrayLike | None = None,
        **options: Any,
    ) -> None:
        """A joint; a node that does not exist yet is made where the other stands."""
        for node, other in (between, between[::-1]):
            if node not in self.positions:
                self.positions[node] = self.positions[other]
        self.axes[name] = axes_frame(axis, second_axis, f"joint {name}")
        self.joints.append(Joint(name, kind, between, **options))

    def support(self, node: str, *locks: str, **options: Any) -> None:
        """A joint "support NODE" to a ground node of its own; all directions by default."""
        foot = f"{node}.ground"
        self.positions[foot] = self.positions[node]
        self.grounded.append(foot)
        if locks or "stiffness" in options:
            self.joint(f"support {node}", "support", (foot, node), locks=locks, **options)
        else:
            self.joint(f"support {node}", "fixed", (foot, node), **options)

    def turned(self, rotation: Array, shift: ArrayLike = (0.0, 0.0, 0.0)) -> Model:
        """The same structure in another frame; of springs only isotropic ones can turn."""
        result = Model(self.tool)
        result.positions = {n: p @ rotation.T + shift for n, p in self.positions.items()}
        result.axes = {name: rotation @ axes for name, axes in self.axes.items()}
        result.groups, result.grounded = self.groups, self.grounded
        result.joints, result.couplings = self.joints, self.couplings
        for spring in self.springs:
            parts = spring.diagonal.reshape(2, 3)
            assert np.ptp(parts, axis=1).max() == 0.0, f"{spring.name} is not isotropic"
        result.springs = self.springs
        for mass in self.masses:
            inertia = rotation @ np.asarray(mass.inertia) @ rotation.T
            result.masses.append(
                replace(
                    mass,
                    inertia=tuple(tuple(row) for row in ((inertia + inertia.T) / 2).tolist()),
                    offset=vector(rotation @ mass.offset),
                )
            )
        for beam in self.beams:
            up = beam.orientation
            if not isinstance(up, str):
                up = vector(rotation @ (self.default_orientation(beam) if up is None else up))
            offsets = (
                vector(rotation @ beam.offsets[0]),
                vector(rotation @ beam.offsets[1]),
            )
            result.beams.append(replace(beam, orientation=up, offsets=offsets))
        return result

    def default_orientation(self, beam: Beam) -> Array:
        """Global z, or global y for a beam along z, as the model file says."""
        span = self.positions[beam.nodes[1]] - self.positions[beam.nodes[0]]
        span = span + np.subtract(beam.offsets[1], beam.offsets[0])
        along = np.hypot(span[..., 0], span[..., 1]) < 1e-6 * np.linalg.norm(span, axis=-1)
        return np.array([0.0, 1.0, 0.0]) if np.any(along) else np.array(Z)

    def bodies(self) -> tuple[tuple[Body, ...], tuple[Body, ...]]:
        """Bodies of the linkage, and rigid groups inside flexible ones."""
        label = {n: n for n in self.positions}

        def root(n: str) -> str:
            while label[n] != n:
                n = label[n]
            return n

        for tied in [*self.groups.values(), *(b.nodes for b in self.beams)]:
            for n in tied[1:]:
                label[root(n)] = root(tied[0])
        flexible = {root(b.nodes[0]) for b in self.beams}
        bodies = [Body(GROUND, tuple(self.grounded))]
        for r in dict.fromkeys(root(n) for n in self.positions):
            members = tuple(n for n in self.positions if root(n) == r)
            named = [g for g, nodes in self.groups.items() if root(nodes[0]) == r]
            if len(members) > 1 and not set(members) <= set(self.grounded):
                rigid = named and r not in flexible
                bodies.append(Body(named[0] if rigid else f"frame of {r}", members))
        inner = tuple(Body(g, nodes) for g, nodes in self.groups.items())
        return tuple(bodies), tuple(b for b in inner if root(b.nodes[0]) in flexible)

    def structure(self) -> Structure:
        bodies, inner = self.bodies()
        linkage = Linkage(
            tuple(self.positions), bodies, tuple(self.joints), self.tool, self.couplings
        )
        return Structure(linkage, tuple(self.beams), tuple(self.springs), inner, tuple(self.masses))

    def placement(self) -> Placement:
        arrays = [*self.positions.values()]
        batch = np.broadcast_shapes(
            *(p.shape[:-1] for p in arrays), *(a.shape[:-2] for a in self.axes.values())
        )
        positions = np.stack([np.broadcast_to(p, (*batch, 3)) for p in arrays], axis=-2)
        frames = [np.broadcast_to(self.axes[j.name], (*batch, 3, 3)) for j in self.joints]
        stacked = np.stack(frames, axis=-3) if frames else np.zeros((*batch, 0, 3, 3))
        return Placement(positions, stacked, np.zeros((*batch, 0)))

    def place(self) -> PlacedStructure:
        return self.structure().at(self.placement())


def vector(values: ArrayLike) -> tuple[float, float, float]:
    x, y, z = (float(v) for v in np.asarray(values))
    return x, y, z


def wrench(name: str, node: str, *components: float) -> LoadCase:
    """A case of one nodal load; missing components are zero."""
    six = (*components, *(0.0,) * (6 - len(components)))
    return LoadCase(name, wrenches=((node, six),))  # type: ignore[arg-type]


def turned_case(case: LoadCase, rotation: Array) -> LoadCase:
    """The same loads in another frame; misfits are in joint axes and stay."""

    def pair(six: ArrayLike) -> Any:
        return tuple((np.asarray(six).reshape(2, 3) @ rotation.T).ravel().tolist())

    return LoadCase(
        case.name,
        tuple((node, pair(six)) for node, six in case.wrenches),
        tuple(
            LineLoad(one.beam, vector(rotation @ one.first), vector(rotation @ one.second))
            for one in case.line_loads
        ),
        None if case.gravity is None else vector(rotation @ case.gravity),
        case.gaps,
    )


def every_direction(value: float) -> dict[str, float]:
    return dict.fromkeys(DIRECTIONS, value)


def cantilever(section: Section = BAR, length: float = 0.6, **options: Any) -> Model:
    """A beam along x, held at "root", with its tool at "tip"."""
    model = Model("tip")
    model.nodes(root=(0, 0, 0), tip=(length, 0, 0))
    model.beam("beam", "root", "tip", section, **options)
    model.support("root")
    return model


def cantilever_compliance(beam: Beam, length: float) -> Array:
    """Closed-form compliance (6, 6) at the tip of a cantilever along its local x axis."""
    e, g, nu = (
        beam.material.youngs_modulus,
        beam.material.shear_modulus,
        beam.material.poissons_ratio,
    )
    section = beam.section
    iy, iz = section.second_moment_y, section.second_moment_z
    areas = section.shear_area(nu) if beam.shear else None
    slip_y, slip_z = (length / (g * a) for a in areas) if areas else (0.0, 0.0)
    c = np.diag(
        [
            length / (e * section.area),
            length**3 / (3 * e * iz) + slip_y,
            length**3 / (3 * e * iy) + slip_z,
            length / (g * section.torsion_constant),
            length / (e * iy),
            length / (e * iz),
        ]
    )
    c[1, 5] = c[5, 1] = length**2 / (2 * e * iz)
    c[2, 4] = c[4, 2] = -(length**2) / (2 * e * iy)
    return c
