"""One rule of trust for every solver: refine, estimate the error, and withhold what is not sure.

The equilibrium is taken part by part (`strutwork.msa.nodal`) and its residual is solved for again:
the correction is the error of the solution before it, whatever the solver (Higham 2002, ch. 12).
Where the first correction is not tiny, residuals are taken in extended precision, in which the
stiffness of the parts has not lost the soft directions beside the stiff ones; each step then gains
as many digits as the condition leaves.

The measure, here and wherever statics are judged: the error of a load case, or of a column of a
compliance, as a share of the case's own largest displacement, rotations times the structure's
length; never of the load or of the largest stiffness, beside which a soft direction is nothing. Up
to `TRUSTED` an answer is given. The compiled kernel estimates the same of its own answer, pose by
pose, by one wrench that loads all six directions (`strutwork.msa.compiled`): a pose of which it is
not sure to a tenth of that comes here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import NumericalError
from strutwork.msa.assembly import System, system_of
from strutwork.msa.diagnosis import check_residual
from strutwork.msa.nodal import unbalanced

Array = NDArray[Any]

#: An approximate inverse: unknowns and multipliers for a load (p, n, m) and gaps (p, r, m) at the
#: poses of an index.
Inverse = Callable[[Array, Array, Any], tuple[Array, Array]]

#: First correction, as a share of the largest, up to which doubles alone are trusted.
SURE = 1e-11

#: Residual, as a share of the largest force of a part, up to which doubles alone are trusted.
BALANCED = 1e-9

#: Error as a share of the largest displacement or force above which a solution is withheld.
TRUSTED = 1e-8

#: Residual, as a share of the largest force of a part, above which a solution is withheld. A stiff
#: part between nodes that soft ones move far takes its force from a small difference: such forces
#: may keep six digits where the displacements keep all.
HELD = 1e-6

#: Steps of refinement in extended precision, and the correction at which they end.
STEPS, ENOUGH = 25, 1e-12

#: Displacements below this share of load over largest stiffness are as good as none.
STILL = 1e-4

#: Forces of a misfit below this share of largest stiffness times displacement are as good as none:
#: a misfit that only moves parts leaves the rounding of forces that cancel.
SLACK = 1e-10


@dataclass(frozen=True)
class Unknowns:
    """Solution of a system.

    Parameters
    ----------
    displacements : (p, n, m)
        Of the rigid clusters at their reference nodes, m and rad; in extended precision where a
        pose needed it.
    multipliers : (p, r, m)
        Of the constraint rows, N and N·m; where rows are redundant, the least in balance.
    residual : (p,)
        Largest residual of the equilibrium, as a share of the largest force of a part; no unit.
    error : (p,)
        Estimated error, as a share of the largest displacement and the largest force of a case; no
        unit.
    """

    displacements: Array
    multipliers: Array
    residual: Array
    error: Array


@dataclass(frozen=True)
class _State:
    """A solution on its way, its residuals, and the error of the one before."""

    unknowns: Array
    multipliers: Array
    force: Array
    gap: Array
    share: Array
    change: Array

    def at(self, poses: Any) -> _State:
        """A copy at some poses."""
        return _State(*(np.array(v[poses]) for v in self._values()))

    def put(self, poses: Any, state: _State) -> None:
        """Take the values of another state at some poses."""
        for mine, value in zip(self._values(), state._values(), strict=True):
            mine[poses] = value

    def _values(self) -> tuple[Array, ...]:
        return tuple(getattr(self, f.name) for f in fields(self))


def solve_trusted(system: System, inverse: Inverse, load: Array, gaps: Array) -> Unknowns:
    """Solve by an approximate inverse and refine until the error is known to be small.

    Parameters
    ----------
    system : System
    inverse : callable
        `Inverse`: unknowns and multipliers for a load and gaps at the poses of an index.
    load : (p, n, m)
        F on the unknowns, N and N·m.
    gaps : (p, r, m)
        g, m and rad.

    Raises
    ------
    NumericalError
        The corrections do not become small, or the parts are not in balance: states the pose.
    """
    every = slice(None)
    first = inverse(load, gaps, every)
    state = _corrected(system, inverse, _start(system, first, load, gaps), load, gaps, every)
    doubtful = ~((state.change <= SURE) & (state.share <= BALANCED))
    u, multipliers = state.unknowns, state.multipliers
    residual, error = state.share.astype(float), state.change.astype(float)
    if np.any(doubtful):
        index = np.flatnonzero(doubtful)
        part = system if len(index) == system.poses else system_of(system.placed[index])
        found = _extended(
            part, inverse, (u[index], multipliers[index]), load[index], gaps[index], index
        )
        u = u.astype(np.longdouble)
        u[index] = found.unknowns
        multipliers = multipliers.copy()
        multipliers[index] = found.multipliers
        residual[index], error[index] = found.share, found.change
    _withhold(system, error)
    check_residual(residual, np.ones_like(residual), "static solution", HELD)
    return Unknowns(u, multipliers, residual, error)


def _extended(
    system: System,
    inverse: Inverse,
    start: tuple[Array, Array],
    load: Array,
    gaps: Array,
    index: NDArray[np.intp],
) -> _State:
    """Refine with residuals in extended precision until the corrections are small or stop."""
    wide = np.longdouble
    u, multipliers = (x.astype(wide) for x in start)
    load, gaps = load.astype(wide), gaps.astype(wide)
    state = _start(system, (u, multipliers), load, gaps)
    ended = state.at(slice(None))
    left = np.arange(system.poses)
    before = np.full(system.poses, np.inf)
    for _ in range(STEPS):
        state = _corrected(system, inverse, state, load[left], gaps[left], index[left])
        # a correction that does not halve shows the last digits that can be had
        going = (state.change > ENOUGH) & (state.change < 0.5 * before)
        ended.put(left, state)
        if not np.any(going):
            break
        before = state.change[going]
        # one pose that takes many steps does not keep the others
        if not np.all(going):
            system = system_of(system.placed[np.flatnonzero(going)])
            left, state = left[going], state.at(going)
    return ended


def _start(system: System, solution: tuple[Array, Array], load: Array, gaps: Array) -> _State:
    force, gap, _ = unbalanced(system, *solution, load, gaps)
    nothing = np.full(system.poses, np.inf)
    return _State(*solution, force, gap, nothing, nothing)


def _corrected(
    system: System, inverse: Inverse, state: _State, load: Array, gaps: Array, index: Any
) -> _State:
    """One step of refinement; its change is the error of the solution before."""
    moved, held = inverse(state.force.astype(float), state.gap.astype(float), index)
    u, multipliers = state.unknowns + moved, state.multipliers + held
    force, gap, carried = unbalanced(system, u, multipliers, load, gaps)
    d = _unit(system, system.topology.size)[..., None]
    given = np.abs(load * d).max(axis=1, initial=0.0)
    drawn = np.abs(gaps).max(axis=1, initial=0.0)
    stiffest = _largest_stiffness(system)[:, None]
    still = STILL * (
        np.divide(given, stiffest, out=np.zeros_like(given), where=stiffest > 0) + drawn
    )
    largest = np.abs(u / d).max(axis=1, initial=0.0) + still
    r = np.where(system.row_owner[1] < 3, 1.0, system.turn_scale[:, None])[..., None]
    forces = np.maximum(np.maximum(carried, given), np.abs(multipliers * r).max(axis=1, initial=0))
    forces = forces + SLACK * stiffest * largest * (drawn > 0)
    changes = [_share(moved / d, largest), _share(held * r, forces)]
    return _State(
        u,
        multipliers,
        force,
        gap,
        np.maximum(_share(force * d, forces), _share(gap, largest)),
        np.maximum(*changes),
    )


def _share(part: Array, whole: Array) -> Array:
    """Largest entry of a column (p, n, m) as a share of its scale (p, m), (p,)."""
    size = np.abs(part).max(axis=1, initial=0.0)
    share = np.divide(size, whole, out=np.zeros_like(size + whole), where=whole > 0)
    return np.asarray(share.max(axis=1, initial=0.0))


def _unit(system: System, count: int) -> Array:
    """One for translations, one over the characteristic length for rotations, (p, n)."""
    block = np.ones((system.poses, 6))
    block[:, 3:] = system.turn_scale[:, None]
    return np.tile(block, (1, count // 6))


def _largest_stiffness(system: System) -> Array:
    """Largest diagonal entry of the stiffness in units of displacement, (p,)."""
    d = _unit(system, system.topology.size)
    if system.poses == 1:
        diagonal = system.sparse_stiffness.diagonal()[None]
    elif system.lone is not None:
        diagonal = _diagonal(system)
    else:
        diagonal = np.einsum("pii->pi", system.stiffness)
    return np.asarray((np.abs(diagonal) * d**2).max(axis=1, initial=0.0))


def _diagonal(system: System) -> Array:
    """Diagonal of the stiffness, (p, n), without the matrix."""
    found = np.zeros((system.poses, system.topology.size))
    for _, nodes, part in system.contributions():
        dofs, moves = system.dofs(nodes)
        block = system.carried(nodes, part)
        for first in range(0, len(dofs), 6):
            for second in range(0, len(dofs), 6):
                # ends in one cluster meet on its diagonal
                if moves[first] and dofs[first] == dofs[second]:
                    own = block[:, first : first + 6, second : second + 6]
                    found[:, dofs[first : first + 6]] += np.einsum("pii->pi", own)
    return found


def _withhold(system: System, error: Array) -> None:
    bad = np.flatnonzero(~(error <= TRUSTED))
    if not len(bad):
        return
    where = f" at pose {bad[0]}" if system.poses > 1 else ""
    raise NumericalError(
        "static solution",
        f"corrections do not get below {error[bad[0]]:.2g} of the largest displacement or force"
        f"{where}, above {TRUSTED:g}: the solution is withheld.",
        "The structure is nearly a mechanism there, or its stiffnesses differ too much.",
    )
