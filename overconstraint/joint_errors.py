"""Errors of joints beside their tolerances: of drives, and play."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isfinite
from typing import Literal

import numpy as np

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, State
from strutwork.msa.structure import PlacedStructure
from strutwork.names import choices
from strutwork.overconstraint.sources import Block, MisfitSources, misfit_sources
from strutwork.overconstraint.tolerance import Tolerance
from strutwork.overconstraint.unit_sets import Interval

#: How each kind falls within its range: a drive anywhere, a joint with play at either stop.
KINDS = {"drive error": "uniform", "play": "surface"}


@dataclass(frozen=True)
class JointError:
    """An error of one joint direction, to either side alike.

    Parameters
    ----------
    kind : "drive error" or "play"
    joint, direction : str
        A direction that is locked, elastic or driven.
    size : float
        Half of its range, m or rad: of a play what it leaves to either side of its middle.

    Raises
    ------
    ModelError
        An unknown kind or direction, a size that is not positive.
    """

    kind: Literal["drive error", "play"]
    joint: str
    direction: str
    size: float

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise ModelError(
                self.name, f'has the unknown kind "{self.kind}".', f"Kinds: {', '.join(KINDS)}."
            )
        if self.direction not in DIRECTIONS:
            raise ModelError(
                self.name,
                f'names the unknown direction "{self.direction}".',
                "Directions are " + ", ".join(DIRECTIONS) + ".",
            )
        if not (isfinite(self.size) and self.size > 0):
            raise ModelError(self.name, f"is {self.size:g}.", "Give a positive size, or omit it.")

    @property
    def name(self) -> str:
        """As in `play of hinge:x`."""
        return f"{self.kind} of {self.joint}:{self.direction}"


def error_sources(
    placed: PlacedStructure,
    tolerances: Sequence[Tolerance] = (),
    errors: Sequence[JointError] = (),
) -> MisfitSources:
    """Misfits that tolerances, drive errors and play cause together.

    Parameters
    ----------
    placed : PlacedStructure
    tolerances : sequence of Tolerance
    errors : sequence of JointError

    Returns
    -------
    MisfitSources
        Its tolerances are those given, then one for every error, by its name.

    Raises
    ------
    ModelError
        As `misfit_sources`; an error of an unknown joint, in a free direction, or given twice.
    """
    found = misfit_sources(placed, tolerances)
    if not errors:
        return found
    linkage = placed.structure.linkage
    names = [error.name for error in errors]
    columns = list(found.columns)
    for error in errors:
        if error.joint not in linkage.joint_index:
            raise ModelError(
                error.name,
                f'names the unknown joint "{error.joint}".',
                choices("Joints", error.joint, linkage.joint_index),
            )
        states = linkage.states()[linkage.joint_index[error.joint]]
        if states[DIRECTIONS.index(error.direction)] == State.FREE:
            raise ModelError(
                error.name,
                "is in a direction that is free: it does not move the tool.",
                "Name a locked, elastic or driven direction of the joint.",
            )
        if names.count(error.name) > 1:
            raise ModelError(error.name, "is given twice.", "Give it once.")
        if (error.joint, error.direction) not in columns:
            columns.append((error.joint, error.direction))
    batch, old, k = placed.batch, len(found.columns), found.parameters
    whole = np.zeros((*batch, len(columns), k + len(errors)))
    whole[..., :old, :k] = found.map
    mean = np.zeros((*batch, len(columns)))
    mean[..., :old] = found.mean
    blocks, named = list(found.blocks), list(found.tolerances)
    for n, error in enumerate(errors):
        whole[..., columns.index((error.joint, error.direction)), k + n] = error.size
        blocks.append(Block(len(named), Interval(), k + n))
        named.append(
            Tolerance(
                error.name,
                "length",
                (error.joint,),
                size=error.size,
                distribution=KINDS[error.kind],
            )
        )
    return replace(
        found,
        tolerances=tuple(named),
        blocks=tuple(blocks),
        columns=tuple(columns),
        map=whole,
        mean=mean,
    )
