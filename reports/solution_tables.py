"""Tables of a static solution as they are shown: rounding is 0."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.machines.extent import model_size
from strutwork.msa import system_of
from strutwork.reports.model_solution import ModelSolution
from strutwork.reports.numbers import CANCELLED, ROUNDING, six_without_rounding

Array = NDArray[Any]

#: Titles of the tables of forces, what their rows are called, and their key.
FORCE_TABLES = (
    ("Reactions on the structure", "node", "reactions"),
    ("Joint forces on the second node, joint axes", "joint", "joint_forces"),
    ("Spring forces, global axes", "spring", "spring_forces"),
    ("Forces on the beams, beam axes", "beam", "beam_forces"),
)


def shown_tables(solution: ModelSolution, number: int) -> dict[str, dict[str, Array]]:
    """Displacements and forces of a load case by part, SI, with 0 for what is only rounding.

    Forces are compared with the largest of the whole case, not of their own table: reactions
    that cancel are rounding of the loads.

    Returns
    -------
    dict
        Keys "displacements" and those of `FORCE_TABLES`; (6,) by name of the part.
    """
    name = solution.statics.cases[number]
    case = solution.to_dict()["cases"][name]
    length = model_size(solution.model)
    tables: dict[str, Mapping[str, Any]] = {key: case[key] for _, _, key in FORCE_TABLES[:3]}
    tables["beam_forces"] = beam_ends(case["beam_forces"])
    given = [wrench for _, wrench in solution.model.cases[number].wrenches]
    forces = [six for table in tables.values() for six in table.values()]
    every = np.array([*forces, *given], dtype=float).reshape(-1, 6)
    forced = _forced(solution, number, length)
    every = np.concatenate([every, [[forced] * 3 + [forced * length] * 3]])
    result = {
        key: dict(
            zip(table, six_without_rounding(list(table.values()), length, every), strict=True)
        )
        for key, table in tables.items()
    }
    moved = case["displacements"]
    still = _least_motion(solution, every, length) * np.array([1.0] * 3 + [1.0 / length] * 3)
    shown = six_without_rounding(list(moved.values()), 1.0 / length)
    low = np.abs(shown) <= still
    result["displacements"] = dict(zip(moved, np.where(low, 0.0, shown), strict=True))
    return result


def beam_ends(forces: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Forces on both ends of the beams in one table."""
    return {
        f"{beam}, at its {word} end": both[end]
        for beam, both in forces.items()
        for word, end in (("first", "from"), ("second", "to"))
    }


def _forced(solution: ModelSolution, number: int, length: float) -> float:
    """Force, N, beside which those of settlements and gaps are rounding: stiffness times motion.

    A structure that gives way to them without strain answers with what is left of this product.
    """
    return (
        CANCELLED / ROUNDING * _stiffest(solution, length) * _largest_gap(solution, number, length)
    )


def _largest_gap(solution: ModelSolution, number: int, length: float) -> float:
    """Largest settlement or misfit of a case, m; turns at the structure's size."""
    gaps = solution.model.cases[number].gaps.items()
    return max(
        (abs(v) * (length if direction.startswith("r") else 1.0) for (_, direction), v in gaps),
        default=0.0,
    )


def shown_energy(solution: ModelSolution, number: int) -> float:
    """Strain energy of a load case, J, with 0 for what is only rounding.

    Beside that of the stiffest part if it took the largest settlement or gap alone.
    """
    length = model_size(solution.model)
    energy = float(solution.statics.strain_energy[number])
    most = _stiffest(solution, length) * _largest_gap(solution, number, length) ** 2
    return energy if energy > CANCELLED * most else 0.0


def _least_motion(solution: ModelSolution, forces: Array, length: float) -> float:
    """Displacement, m, below which nothing that is loaded can move: force over stiffness.

    Where rigid joints take a load alone, a solution holds rounding of this size.
    """
    stiffest = _stiffest(solution, length)
    largest = (
        np.abs(forces[:, :3]).max(initial=0.0) + np.abs(forces[:, 3:]).max(initial=0.0) / length
    )
    return float(ROUNDING * largest / stiffest) if stiffest else 0.0


def _stiffest(solution: ModelSolution, length: float) -> float:
    """Largest stiffness of any part, N/m; rotations at the structure's size."""
    stiffest = 0.0
    for _, _, part in system_of(solution.model.placed).contributions():
        diagonal = np.abs(np.einsum("pii->pi", part)).reshape(-1, 6)
        stiffest = max(stiffest, diagonal[:, :3].max(), diagonal[:, 3:].max() / length**2)
    return float(stiffest)
