"""Superelements: a solid reduced to its interfaces, then an element like any other.

Craig and Bampton (1968): the static shapes of unit interface motions and the lowest modes with
the interfaces held. The residual vectors are the static answers to the inertia of the static
shapes, the next term of the expansion about zero frequency (MacNeal 1971; Rubin 1975); going on
so without modes is a Krylov basis.

The generalised coordinates of a reduced basis are no displacements, and a structure's nodes are.
So they are exchanged for the motions of a few small patches inside the solid, its monitors: as
many as the basis has shapes, chosen so that the exchange is well conditioned. The element then has
nodes alone, and mass properties, effective masses and gravity come out without exceptions.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
import scipy.linalg as sla
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.held_modes import held_modes
from strutwork.fea.monitors import check_exchange, choose_monitors
from strutwork.fea.superelement_limit import accurate_to
from strutwork.fea.tied_solid import StaticSolver, TiedSolid
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]

#: Shapes with less than this share of their size outside the others are dropped.
DEPENDENT = 1e-8

#: Misfit of a placed superelement's nodes, as a share of its size.
MISPLACED = 1e-6


@dataclass(frozen=True)
class Superelement:
    """A reduced solid.

    Parameters
    ----------
    name : str
    nodes : tuple of str
        Interface nodes, then monitors; all to be put in one body of the linkage.
    positions : (k, 3)
        Of the nodes in the mesh's frame, m.
    local_stiffness, local_mass : (6 k, 6 k)
        In the mesh's frame.
    shapes : (3 n, 6 k)
        Displacements of the field nodes per unit motion of the nodes, no unit and m/rad.
    fixed_frequencies : (m,)
        Hz, of the retained modes with the interfaces held; empty for a Krylov basis.
    solver : str
        Which factorisation ran.
    limit : float, optional
        Hz: computed when it was made, the frequency below which answers hold to 1e-4
        (`strutwork.fea.superelement_limit`). Without it, half of the cutoff counts.
    """

    name: str
    nodes: tuple[str, ...]
    positions: Array
    local_stiffness: Array
    local_mass: Array
    shapes: Array
    fixed_frequencies: Array
    solver: str
    limit: float | None = None

    def __repr__(self) -> str:
        if len(self.fixed_frequencies):
            reach = f"fixed-interface modes to {self.cutoff:.4g} Hz"
        else:
            reach = f"Krylov basis accurate to {self.accurate_to:.4g} Hz"
        return (
            f"<Superelement {self.name}: {len(self.nodes)} nodes for "
            f"{self.shapes.shape[0]} dof, {reach}>"
        )

    @property
    def cutoff(self) -> float:
        """Highest retained frequency with the interfaces held, Hz; zero for a Krylov basis."""
        return float(self.fixed_frequencies[-1]) if len(self.fixed_frequencies) else 0.0

    @property
    def accurate_to(self) -> float:
        """Frequency below which answers hold to 1e-4, Hz.

        The limit computed when it was made, else half of the cutoff; zero where neither is known.
        """
        return self.cutoff / 2.0 if self.limit is None else self.limit

    def scaled(self, factor: float) -> Superelement:
        """The same solid of the same material, `factor` times as large, exactly.

        Forces per displacement grow with the factor, masses with its cube, and lengths that turn
        rotations into displacements with the factor itself.

        Parameters
        ----------
        factor : float
            No unit, positive.
        """
        lengths = np.tile(np.repeat([1.0, factor], 3), len(self.nodes))
        pairs = np.outer(lengths, lengths)
        return replace(
            self,
            positions=factor * self.positions,
            local_stiffness=factor * pairs * self.local_stiffness,
            local_mass=factor**3 * pairs * self.local_mass,
            shapes=self.shapes * lengths,
            fixed_frequencies=self.fixed_frequencies / factor,
            limit=None if self.limit is None else self.limit / factor,
        )

    def turn(self, at: PlacedStructure) -> Array:
        """Rotation of the mesh's frame at every pose, (..., 3, 3).

        Parameters
        ----------
        at : PlacedStructure
            The structure in which it stands.

        Raises
        ------
        ModelError
            Nodes that do not stand as in the mesh.
        """
        index = at.structure.mesh_index
        placed = at.positions[..., [index[n] for n in self.nodes], :]
        mine = self.positions - self.positions.mean(axis=0)
        there = placed - placed.mean(axis=-2, keepdims=True)
        left, _, right = np.linalg.svd(np.swapaxes(there, -1, -2) @ mine)
        sign = np.ones((*left.shape[:-2], 3))
        sign[..., 2] = np.linalg.det(left @ right)
        rotation = (left * sign[..., None, :]) @ right
        miss = np.abs(there - mine @ np.swapaxes(rotation, -1, -2)).max(initial=0.0)
        if miss > MISPLACED * np.abs(mine).max():
            raise ModelError(
                f"superelement {self.name}",
                f"its nodes are {miss:.3g} m away from their places in the mesh.",
                "Place all of them by one rigid motion of `positions`.",
            )
        return np.asarray(rotation)

    def stiffness(self, at: PlacedStructure) -> Array:
        """Stiffness in global axes, (..., 6k, 6k), N/m, N, N·m/rad.

        Parameters
        ----------
        at : PlacedStructure
            The structure in which it stands.
        """
        return self._turned(self.local_stiffness, at)

    def mass(self, at: PlacedStructure) -> Array:
        """Mass in global axes, (..., 6k, 6k), kg, kg·m, kg·m².

        Parameters
        ----------
        at : PlacedStructure
            The structure in which it stands.
        """
        return self._turned(self.local_mass, at)

    def _turned(self, matrix: Array, at: PlacedStructure) -> Array:
        rotation = self.turn(at)
        if np.abs(rotation - np.eye(3)).max(initial=0.0) < 1e-14:
            return np.broadcast_to(matrix, (*rotation.shape[:-2], *matrix.shape))
        k = 2 * len(self.nodes)
        blocks = matrix.reshape(k, 3, k, 3)
        turned = np.einsum("...ij,ajbk,...lk->...aibl", rotation, blocks, rotation, optimize=True)
        return np.asarray(turned).reshape(*rotation.shape[:-2], 3 * k, 3 * k)


def superelement(
    solid: TiedSolid,
    cells: Array,
    cutoff: float | None = None,
    modes: int = 12,
    method: Literal["craig_bampton", "krylov"] = "craig_bampton",
    solver: str | None = None,
) -> Superelement:
    """Reduce a solid to its interfaces.

    Parameters
    ----------
    solid : TiedSolid
    cells : (m, k)
        Nodes of the solid's cells, k each, among which monitors are chosen.
    cutoff : float, optional
        Hz: modes with the interfaces held are retained beyond it. Answers below half of it are
        good to 1e-4. A Krylov basis has its number of shapes alone, and its limit is computed.
    modes : int
        Without a cutoff, how many modes (Krylov: shapes), rounded up to a multiple of six.
    method : "craig_bampton" or "krylov"
    solver : str, optional
        Of `factorize`.

    Returns
    -------
    Superelement

    Raises
    ------
    ModelError
        No interface, a cutoff for a Krylov basis, or more shapes than the solid has.
    NumericalError
        Shapes that motions of its monitors cannot tell apart, or only with much rounding.
    """
    if not solid.patches:
        raise ModelError(f"solid {solid.name}", "has no interface.", "Tie a patch to a node.")
    if method == "krylov" and cutoff is not None:
        raise ModelError(
            f"superelement {solid.name}",
            "has a cutoff, which a Krylov basis does not follow.",
            "Give modes, and compare accurate_to of the result with the cutoff.",
        )
    static = StaticSolver(solid, solver)
    carried = static.constraint_modes()
    nodes = np.asarray(cells, dtype=np.intp)
    if method == "krylov":
        inner = _krylov(static, carried, _sixes(modes))
        limit = accurate_to(static, carried, inner)
        return _on_monitors(static, carried, inner, nodes, np.zeros(0), limit)
    frequencies, held = _held_modes(static, cutoff, modes)
    inner, count = _with_residuals(static, carried, held)
    if inner.shape[1] >= count:
        try:
            return _on_monitors(static, carried, inner, nodes, frequencies, None)
        except NumericalError:
            # a coarse mesh may tell fewer shapes apart
            if count % 6 == 0:
                raise
    inner = inner[:, : count // 6 * 6]
    limit = min(float(frequencies[-1]) / 2.0, accurate_to(static, carried, inner))
    return _on_monitors(static, carried, inner, nodes, frequencies, limit)


def _on_monitors(
    static: StaticSolver,
    carried: Array,
    inner: Array,
    cells: NDArray[np.intp],
    frequencies: Array,
    limit: float | None,
) -> Superelement:
    """The superelement of a basis, its inner shapes exchanged for motions of monitors."""
    solid, k = static.solid, carried.shape[1]
    basis = np.concatenate([carried, inner], axis=1)
    stiffness = basis.T @ (solid.stiffness @ basis)
    mass = basis.T @ (solid.mass @ basis)
    # static shapes are in balance with interface forces alone, and inner ones do no work there
    stiffness[:k, k:] = stiffness[k:, :k] = 0.0
    shapes = solid.recovery @ basis
    places, exchange = choose_monitors(solid, shapes, cells, k)
    names = [p.interface.name for p in solid.patches]
    positions = np.array([p.position for p in solid.patches])
    if len(places):
        names += [f"{solid.name}/{i + 1}" for i in range(len(places))]
        positions = np.concatenate([positions, places])
    local_stiffness = _even(exchange.T @ stiffness @ exchange)
    local_mass = _even(exchange.T @ mass @ exchange)
    check_exchange(solid.name, (stiffness, mass), (local_stiffness, local_mass), k)
    return Superelement(
        solid.name,
        tuple(names),
        positions,
        local_stiffness,
        local_mass,
        shapes @ exchange,
        frequencies,
        static.name,
        limit,
    )


def _even(matrix: Array) -> Array:
    return np.asarray((matrix + matrix.T) / 2)


def _sixes(count: int) -> int:
    return -(-count // 6) * 6


def _held_modes(static: StaticSolver, cutoff: float | None, modes: int) -> tuple[Array, Array]:
    """Frequencies in Hz and mass-normalised modes with the interfaces held."""
    solid = static.solid
    size = solid.stiffness.shape[0]
    count = _sixes(modes)
    while True:
        if 3 * count > size:
            raise ModelError(
                f"superelement {solid.name}",
                f"{count} modes are too many for {size} coordinates.",
                "Lower the cutoff or the number of modes, or refine the mesh.",
            )
        squares, vectors = held_modes(static, count)
        frequencies = np.sqrt(squares) / (2 * np.pi)
        if cutoff is None or frequencies[-1] >= cutoff:
            break
        count *= 2
    keep = len(frequencies)
    if cutoff is not None:
        keep = min(keep, _sixes(int(np.searchsorted(frequencies, cutoff)) + 1))
    return frequencies[:keep], vectors[:, :keep]


def _with_residuals(static: StaticSolver, carried: Array, inner: Array) -> tuple[Array, int]:
    """Modes with the residual vectors, filled up to a multiple of six, and their own number.

    A monitor has six freedoms. Without one of the residual vectors the cutoff promises nothing, so
    what lacks to the multiple comes from the next term of the expansion; there may be too little.
    """
    solid = static.solid
    residual, _ = static.solve(solid.mass @ carried)
    inner = _independent(solid, inner, residual)
    count = inner.shape[1]
    if count % 6:
        further, _ = static.solve(solid.mass @ residual)
        inner = _independent(solid, inner, further)[:, : _sixes(count)]
    return inner[:, : inner.shape[1] // 6 * 6], count


def _krylov(static: StaticSolver, carried: Array, count: int) -> Array:
    """The first `count` shapes of the expansion about zero, mass-orthonormal, by stiffness."""
    solid = static.solid
    found = np.zeros((len(carried), 0))
    block = carried
    while found.shape[1] < count:
        block, _ = static.solve(solid.mass @ block)
        grown = _independent(solid, found, block)
        if grown.shape[1] == found.shape[1]:
            break
        block = grown[:, found.shape[1] :]
        found = grown
    found = found[:, : found.shape[1] // 6 * 6][:, :count]
    values, turn = sla.eigh(found.T @ (solid.stiffness @ found))
    return np.asarray(found @ turn[:, np.argsort(values)])


def _independent(solid: TiedSolid, first: Array, more: Array) -> Array:
    """`first`, mass-orthonormal, with what `more` adds, largest contributions first."""
    size = np.sqrt(np.einsum("ij,ij->j", more, solid.mass @ more))
    rest = more / np.where(size > 0, size, 1.0)
    for _ in range(2):
        rest = rest - first @ (first.T @ (solid.mass @ rest))
    gram = rest.T @ (solid.mass @ rest)
    values, turn = np.linalg.eigh(_even(gram))
    order = np.argsort(values)[::-1]
    order = order[values[order] > DEPENDENT]
    added = rest @ (turn[:, order] / np.sqrt(values[order]))
    added = added - first @ (first.T @ (solid.mass @ added))
    # rounding grew with 1/√values: one Cholesky step makes them orthonormal again
    lower = np.linalg.cholesky(_even(added.T @ (solid.mass @ added)))
    added = np.linalg.solve(lower, added.T).T
    return np.concatenate([first, added], axis=1)
