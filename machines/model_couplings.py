"""Couplings from the tables of a model file."""

from __future__ import annotations

from math import pi

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.coupling import Coordinate, Coupling
from strutwork.machines.model_motion_schema import CouplingTable
from strutwork.machines.model_schema import ModelTable


def couplings_of(tables: ModelTable) -> tuple[Coupling, ...]:
    """The couplings of a file.

    Parameters
    ----------
    tables : ModelTable

    Raises
    ------
    ModelError
        A coordinate that is not written JOINT:DIRECTION, neither or both of `ratio` and
        `per_turn`, a ratio of a turn to a way, or what `Coupling` refuses.
    """
    return tuple(_coupling(table) for table in tables.couplings)


def _coupling(table: CouplingTable) -> Coupling:
    part = f"coupling {table.name}"
    first, second = (_coordinate(part, text) for text in table.between)
    if (table.ratio is None) == (table.per_turn is None):
        raise ModelError(
            part,
            "has neither ratio nor per_turn, or both.",
            "Give ratio, or per_turn where the first rotates and the second slides.",
        )
    turns = [direction.startswith("r") for _, direction in (first, second)]
    if table.per_turn is not None:
        if turns != [True, False]:
            raise ModelError(
                part,
                (
                    "has per_turn, but its coordinates are not first a rotation and then a "
                    "translation."
                ),
                "Write the rotation first; for two of the same kind give ratio.",
            )
        return Coupling(table.name, first, second, table.per_turn / (2.0 * pi))
    if turns[0] != turns[1]:
        raise ModelError(
            part,
            f"has a plain ratio between {':'.join(first)} and {':'.join(second)}, a rotation and "
            "a translation.",
            'Write the rotation first and give per_turn, as in "10 mm".',
        )
    return Coupling(table.name, first, second, table.ratio or 0.0)


def _coordinate(part: str, text: str) -> Coordinate:
    joint, colon, direction = text.rpartition(":")
    if not colon or not joint or direction not in DIRECTIONS:
        raise ModelError(
            part,
            f'names "{text}", which is not a joint coordinate.',
            'Write JOINT:DIRECTION, as in "motor:rz".',
        )
    return joint, direction
