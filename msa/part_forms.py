"""Derivatives of the work that fields of displacement do on the parts a parameter changes.

With M the matrix of the saddle-point system and z = (u, λ) fields at hand, what a parameter p does
to an answer is a sum of zᵀ (∂M/∂p) z over the parts that p changes: no system is solved. The parts'
matrices are taken at p + iε with ε so small that its square is nothing beside a double: the
imaginary part is the derivative to the last digits (Squire and Trapp 1998).

A beam's work is taken from the motion of its second end relative to the first carried rigidly
along, so that a part which moves far and strains little loses no digits.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.msa.assembly import System
from strutwork.msa.beam import local_stiffness
from strutwork.msa.changes import PlacedChange, Touched, touched
from strutwork.msa.mass import local_mass, lumped_mass
from strutwork.msa.part_geometry import PartGeometry
from strutwork.msa.part_numbers import PartNumbers
from strutwork.msa.rigid_map import rigid_map

Array = NDArray[Any]

#: The imaginary step.
STEP = 1e-40

#: Numbers in the largest array of a chunk of parts.
LARGEST = 4_000_000


@dataclass(frozen=True)
class Fields:
    """Fields of displacement with the multipliers that hold the constraint rows.

    Parameters
    ----------
    unknowns : (p, n, m)
        Of the clusters, m and rad, real.
    multipliers : (p, r, m)
        Of the rows, N and N·m.
    """

    unknowns: Array
    multipliers: Array


@dataclass(frozen=True)
class Forms:
    """Derivatives of bilinear forms between m fields for g parameters.

    Parameters
    ----------
    stiffness, rows, mass, structural, viscous : (g, p, m, m)
        uᵀ (∂K/∂p) u and the like, for the rows λᵀ (∂A/∂p) u + uᵀ (∂A/∂p)ᵀ λ; per unit of the
        parameter: J, J, J·s², J and J·s for fields in m and rad.
    """

    stiffness: Array
    rows: Array
    mass: Array
    structural: Array
    viscous: Array

    @property
    def elastic(self) -> Array:
        """Stiffness and rows together, (g, p, m, m), J per unit of the parameter."""
        return self.stiffness + self.rows


@dataclass(frozen=True)
class FormBuilder:
    """Makes the forms of some parameters at a batch of poses.

    Parameters
    ----------
    system : System
        At p poses.
    changes : sequence of g PlacedChange
        At the same poses.
    """

    system: System
    changes: Sequence[PlacedChange]

    @cached_property
    def _base(self) -> PartGeometry:
        return PartGeometry.of(self.system)

    @cached_property
    def _numbers(self) -> PartNumbers:
        return PartNumbers.of(self.system.placed.structure)

    @property
    def moves(self) -> bool:
        """Whether any of the parameters moves a part."""
        return any(change.geometry is not None for change in self.changes)

    def _rates(self, name: str) -> list[Array | None]:
        """Rates of places by part, (b, p, ...)."""
        found = []
        for change in self.changes:
            where = change.geometry
            found.append(None if where is None else np.swapaxes(getattr(where, name), 0, 1))
        return found

    def _of_numbers(self, name: str) -> list[Array | None]:
        return [getattr(change.change.numbers, name) for change in self.changes]

    def _at(self, which: Touched, name: str) -> Array:
        """Places of the touched parts, (k, p, ...)."""
        base = np.swapaxes(getattr(self._base, name), 0, 1)
        return which.moved(base, self._rates(name), STEP)

    def forms(
        self,
        fields: Fields,
        mass: bool = False,
        loss: Array | None = None,
        joint_loss: Array | None = None,
    ) -> Forms:
        """The forms of fields at hand.

        Parameters
        ----------
        fields : Fields
            m of them.
        mass : bool
            Whether those of the mass are wanted.
        loss : (b,), optional
            One for each beam whose material's loss factor acts, no unit; None: no part has a
            damping of its own.
        joint_loss : (j,), optional
            Loss factors of the joints, no unit.
        """
        g, p, m = len(self.changes), self.system.poses, fields.unknowns.shape[-1]
        result = Forms(*(np.zeros((g, p, m, m)) for _ in range(5)))
        vertices = fields.unknowns.reshape(p, -1, 6, m)
        # one cluster of zeros at the end, which the ground's index −1 finds
        still = np.zeros((p, 1, 6, m))
        at = np.concatenate([vertices, still], axis=1).swapaxes(0, 1).astype(float)
        self._beams(at, result, mass, loss)
        self._joints(at, fields.multipliers.astype(float), result, joint_loss)
        self._springs(at, result)
        if mass:
            self._masses(at, result)
        self._elements(at, result, mass, loss is not None)
        return result

    def _chunks(self, which: Touched, size: int) -> list[Touched]:
        per = max(1, LARGEST // max(size, 1))
        return [
            Touched(which.parameter[i : i + per], which.part[i : i + per])
            for i in range(0, len(which), per)
        ]

    def _beams(self, at: Array, result: Forms, mass: bool, loss: Array | None) -> None:
        structure = self.system.placed.structure
        segments = structure.segments
        if not len(segments):
            return
        beam = segments[:, 0]
        numbers = {
            name: [None if r is None else r[beam] for r in self._of_numbers(name)]
            for name in ("stiffness", "inertia", "loss")
        }
        places = {name: self._rates(name) for name in ("span", "up", "ends")}
        kinds = [*numbers.values(), *places.values()]
        every = touched([list(r) for r in zip(*kinds, strict=True)], len(segments))
        lumped = np.array([b.mass == "lumped" for b in structure.beams])[beam]
        ends = structure.vertex_of_node[segments[:, 1:]]
        m = at.shape[-1]
        for some in self._chunks(every, self.system.poses * max(m * m, 12 * m, 144)):
            s = some.part
            span = self._at(some, "span")
            axes, length = _axes(span, self._at(some, "up"))
            arms = self._at(some, "ends")
            first, second = (
                rigid_map(arms[:, :, k]) @ at[ends[s, k]] for k in (0, 1)
            )  # (k, p, 6, m)
            properties = some.moved(self._numbers.stiffness[beam], numbers["stiffness"], STEP)
            columns = np.moveaxis(properties, -1, 0)[..., None]
            bend = local_stiffness(length, columns)[..., 6:, 6:]
            strain = _turned(axes, second - rigid_map(span) @ first)
            work = np.swapaxes(strain, -1, -2) @ (bend @ strain)
            np.add.at(result.stiffness, some.parameter, work.imag / STEP)
            if loss is not None:
                factor = some.moved(self._numbers.loss[beam], numbers["loss"], STEP) * loss[beam[s]]
                lossy = factor[:, None, None, None] * work
                np.add.at(result.structural, some.parameter, lossy.imag / STEP)
            if mass:
                inertia = some.moved(self._numbers.inertia[beam], numbers["inertia"], STEP)
                rows = np.moveaxis(inertia, -1, 0)[..., None]
                own = local_mass(length, columns, rows)
                own = np.where(lumped[s][:, None, None, None], lumped_mass(length, rows), own)
                both = np.concatenate([_turned(axes, first), _turned(axes, second)], axis=-2)
                work = np.swapaxes(both, -1, -2) @ (own @ both)
                np.add.at(result.mass, some.parameter, work.imag / STEP)

    def _joints(
        self, at: Array, multipliers: Array, result: Forms, joint_loss: Array | None
    ) -> None:
        structure, linkage = self.system.placed.structure, self.system.placed.structure.linkage
        count = len(linkage.joints)
        if not count:
            return
        held = self._held(multipliers)
        matrices, dashpots = self._of_numbers("joints"), self._of_numbers("dashpots")
        places = [self._rates("frames"), self._rates("joints")]
        some = touched([list(r) for r in zip(matrices, dashpots, *places, strict=True)], count)
        index = structure.mesh_index
        pairs = [[index[n] for n in joint.between] for joint in linkage.joints]
        ends = structure.vertex_of_node[np.array(pairs, dtype=np.intp)]
        if len(some):
            stretch = self._stretch(some, at, ends)
            matrix = some.moved(self._numbers.joints, matrices, STEP)[:, None]
            crosswise = np.swapaxes(stretch, -1, -2)
            work = crosswise @ (matrix @ stretch)
            np.add.at(result.stiffness, some.parameter, work.imag / STEP)
            if joint_loss is not None:
                lossy = joint_loss[some.part][:, None, None, None] * work.imag / STEP
                np.add.at(result.structural, some.parameter, lossy)
            carried = np.swapaxes(held[some.part], -1, -2) @ stretch
            carried = carried + np.swapaxes(carried, -1, -2)
            np.add.at(result.rows, some.parameter, carried.imag / STEP)
            if np.any(self._numbers.dashpots):
                drag = some.moved(self._numbers.dashpots, dashpots, STEP)[:, None, :, None]
                np.add.at(
                    result.viscous, some.parameter, (crosswise @ (drag * stretch)).imag / STEP
                )
        tied = self.system.locked_rows.tied
        if tied is None:
            return
        other = tied.others
        for i, rate in enumerate(self._of_numbers("ratios")):
            if rate is None or not np.any(rate):
                continue
            for t, change in enumerate(rate):
                one = Touched(np.array([i]), other.joint[t : t + 1])
                along = self._stretch(one, at, ends).real[0, :, other.direction[t]]
                work = multipliers[:, tied.rows[t], :, None] * along[:, None, :]
                result.rows[i] -= change * (work + np.swapaxes(work, -1, -2))

    def joint_stretch(self, joint: int, at: Array) -> tuple[Array, Array]:
        """Motion in a joint, (p, 6, m), and its rates (g, p, 6, m) with the clusters held.

        Parameters
        ----------
        joint : int
            Its index.
        at : (v + 1, p, 6, m)
            Displacements of the clusters, m and rad, with zeros at the end.
        """
        structure = self.system.placed.structure
        index, joints = structure.mesh_index, structure.linkage.joints
        pairs = [[index[n] for n in one.between] for one in joints]
        ends = structure.vertex_of_node[np.array(pairs, dtype=np.intp)]
        g = len(self.changes)
        every = Touched(np.arange(g), np.full(g, joint))
        found = self._stretch(every, at, ends)
        return found[0].real, found.imag / STEP

    def _stretch(self, some: Touched, at: Array, ends: NDArray[np.intp]) -> Array:
        """Motion of the second node relative to the first in joint axes, (k, p, 6, m)."""
        arms = self._at(some, "joints")
        first, second = (rigid_map(arms[:, :, k]) @ at[ends[some.part, k]] for k in (0, 1))
        return _turned(np.swapaxes(self._at(some, "frames"), -1, -2), second - first)

    def _held(self, multipliers: Array) -> Array:
        """Multipliers in the axes of the joints whose motion they hold, (j, p, 6, m)."""
        system = self.system
        joint, direction = system.row_owner
        count = len(system.placed.structure.linkage.joints)
        held = np.zeros((count, system.poses, 6, multipliers.shape[-1]))
        held[joint, :, direction] = np.swapaxes(multipliers, 0, 1)
        tied = system.locked_rows.tied
        if tied is not None:
            for t, row in enumerate(tied.rows):
                j, d = tied.others.joint[t], tied.others.direction[t]
                held[j, :, d] -= tied.ratio[t] * multipliers[:, row]
        return held

    def _springs(self, at: Array, result: Forms) -> None:
        structure = self.system.placed.structure
        springs = structure.springs
        if not springs:
            return
        numbers = self._of_numbers("springs")
        places = [self._rates("axes"), self._rates("springs")]
        some = touched([list(r) for r in zip(numbers, *places, strict=True)], len(springs))
        if not len(some):
            return
        index = structure.mesh_index
        pairs = [[index[s.nodes[0]], index[s.nodes[-1]]] for s in springs]
        ends = structure.vertex_of_node[np.array(pairs, dtype=np.intp)]
        arms = self._at(some, "springs")
        first, second = (rigid_map(arms[:, :, k]) @ at[ends[some.part, k]] for k in (0, 1))
        alone = np.array([len(s.nodes) == 1 for s in springs])[some.part]
        moved = np.where(alone[:, None, None, None], second, second - first)
        stretch = _turned(np.swapaxes(self._at(some, "axes"), -1, -2), moved)
        values = some.moved(self._numbers.springs, numbers, STEP)[:, None, :, None]
        work = np.swapaxes(stretch, -1, -2) @ (values * stretch)
        np.add.at(result.stiffness, some.parameter, work.imag / STEP)

    def _masses(self, at: Array, result: Forms) -> None:
        structure = self.system.placed.structure
        if not structure.masses:
            return
        numbers = self._of_numbers("masses")
        places = [self._rates("turns"), self._rates("masses")]
        some = touched([list(r) for r in zip(numbers, *places, strict=True)], len(structure.masses))
        if not len(some):
            return
        vertex = structure.vertex_of_node[[structure.mesh_index[m.node] for m in structure.masses]]
        moved = rigid_map(self._at(some, "masses")) @ at[vertex[some.part]]
        local = _turned(np.swapaxes(self._at(some, "turns"), -1, -2), moved)
        values = some.moved(self._numbers.masses, numbers, STEP)
        centre = rigid_map(values[:, 10:])[:, None] @ local
        along, about = centre[..., :3, :], centre[..., 3:, :]
        inertia = values[:, 1:10].reshape(-1, 1, 3, 3)
        work = values[:, :1, None, None] * (np.swapaxes(along, -1, -2) @ along)
        work = work + np.swapaxes(about, -1, -2) @ (inertia @ about)
        np.add.at(result.mass, some.parameter, work.imag / STEP)

    def _elements(self, at: Array, result: Forms, mass: bool, lossy: bool) -> None:
        """Elements of other kinds, by central differences of their own matrices."""
        structure = self.system.placed.structure
        for i, change in enumerate(self.changes):
            for e, element in enumerate(structure.elements):
                if change.systems is None:
                    if e not in change.change.elements:
                        continue
                    placed = self.system.placed
                    sides = [(s, placed) for s in (change.change.above, change.change.below)]
                else:
                    sides = [(s.placed.structure, s.placed) for s in change.systems]
                nodes = [structure.mesh_index[n] for n in element.nodes]
                work: list[Array] = []
                heavy: list[Array] = []
                for side, placed in sides:
                    own: Any = side.elements[e]
                    arms, places = placed.arms[:, nodes], placed.positions[:, nodes]
                    vertex = structure.vertex_of_node[nodes]
                    moved = rigid_map(arms) @ at[vertex].swapaxes(0, 1)
                    # rigid motion with the first node costs no energy, and its rounding none either
                    carried = rigid_map(places - places[:, :1]) @ moved[:, :1]
                    shape = (self.system.poses, -1, at.shape[-1])
                    strain = (moved - carried).reshape(shape)
                    k = np.asarray(own.stiffness(placed))
                    work.append(np.swapaxes(strain, -1, -2) @ (k @ strain))
                    if mass and hasattr(own, "mass"):
                        whole = moved.reshape(shape)
                        heavy.append(
                            np.swapaxes(whole, -1, -2) @ (np.asarray(own.mass(placed)) @ whole)
                        )
                width = change.change.width
                result.stiffness[i] += (work[0] - work[1]) / width
                if lossy:
                    above, below = (
                        (getattr(s.elements[e], "loss_factor", None) or 0.0) * w
                        for (s, _), w in zip(sides, work, strict=True)
                    )
                    result.structural[i] += (above - below) / width
                if heavy:
                    result.mass[i] += (heavy[0] - heavy[1]) / width


def _axes(span: Array, up: Array) -> tuple[Array, Array]:
    """Axes of beams as rows and their lengths, as `beam_axes`, for complex numbers too."""
    length = np.sqrt((span * span).sum(-1))
    x = span / length[..., None]
    z = up - (up * x).sum(-1, keepdims=True) * x
    z = z / np.sqrt((z * z).sum(-1, keepdims=True))
    return np.stack([x, np.cross(z, x), z], axis=-2), length


def _turned(axes: Array, twists: Array) -> Array:
    """Twists (..., 6, m) in axes (..., 3, 3) that are given as rows."""
    return np.concatenate([axes @ twists[..., :3, :], axes @ twists[..., 3:, :]], axis=-2)
