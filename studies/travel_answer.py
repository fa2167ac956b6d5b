"""How far the joints of a machine travel over its poses: strokes of drives, turns of joints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.model import Model
from strutwork.msa import PlacedStructure
from strutwork.outcome import Outcome
from strutwork.studies.answers import Answer, Column
from strutwork.studies.dataset_units import LabelledUnits
from strutwork.studies.joint_selection import JointCoordinate, coordinates_of

Array = NDArray[Any]

#: Name of the question; behind a colon may follow which joints.
TRAVEL = "travel"
#: The array of the answer, and its dimension.
COLUMN, DIM = "joint_coordinate", "joint"
#: In the dataset of a study: from the least to the greatest coordinate.
TRAVELLED = f"{COLUMN}_travel"


@dataclass(frozen=True)
class JointTravel:
    """Coordinates of joints at each pose, of which the ends and their distance are kept.

    Parameters
    ----------
    coordinates_asked : tuple of k JointCoordinate
    home : (k,) or None
        Where a machine has formulas of its own: its coordinates at home, m or rad. These give
        angles between -180 and 180 degrees, and a joint whose home lies near these ends passes
        them: its angles are then counted from home the shorter way.
    """

    coordinates_asked: tuple[JointCoordinate, ...]
    home: Array | None = None

    @classmethod
    def of(cls, model: Model, selected: Sequence[str] = ()) -> JointTravel:
        """Of a machine's joints.

        Parameters
        ----------
        model : Model
        selected : sequence of str
            As `strutwork.studies.joint_selection.coordinates_of`.

        Raises
        ------
        ModelError
            As `strutwork.studies.joint_selection.coordinates_of`.
        """
        found = coordinates_of(model, selected)
        if model.closed_form is None:
            return cls(found)
        return cls(found, np.array([float(c.values(model.placement)) for c in found]))

    @cached_property
    def columns(self) -> tuple[Column, ...]:
        """The coordinates."""
        units = LabelledUnits("m or rad", tuple(c.unit for c in self.coordinates_asked))
        return (Column(COLUMN, units, "coordinate of the joint", (DIM,), ends=True),)

    @property
    def coordinates(self) -> Mapping[str, tuple[Any, ...]]:
        """The joints with their directions."""
        return {DIM: tuple(c.label for c in self.coordinates_asked)}

    def __call__(self, placed: PlacedStructure) -> tuple[dict[str, Array], Outcome]:
        """Of a flat batch.

        Parameters
        ----------
        placed : PlacedStructure
        """
        placement = placed.placement
        found = np.stack([c.values(placement) for c in self.coordinates_asked], axis=-1)
        if self.home is not None:
            for k, one in enumerate(self.coordinates_asked):
                # several turns are counted as they are
                if one.turns and np.abs(found[:, k]).max(initial=0.0) <= np.pi:
                    away = found[:, k] - self.home[k]
                    found[:, k] -= 2.0 * np.pi * np.round(away / (2.0 * np.pi))
        return {COLUMN: found}, Outcome.good(placed.batch)


@dataclass(frozen=True)
class TravelAsked:
    """The question for the travel of some joints.

    Parameters
    ----------
    selected : tuple of str
        As `strutwork.studies.joint_selection.coordinates_of`; none for all joints.
    """

    selected: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """As a study file names the question."""
        return TRAVEL

    @property
    def settings(self) -> list[str]:
        """As a study file writes it."""
        return [f"{TRAVEL}:{s}" for s in self.selected] or [TRAVEL]

    def of(self, model: Model) -> Answer:
        """What asks this machine.

        Parameters
        ----------
        model : Model
        """
        return JointTravel.of(model, self.selected)

    @classmethod
    def read(cls, text: str) -> TravelAsked | None:
        """The question from its name; None where the text asks for something else.

        Parameters
        ----------
        text : str
            "travel", or "travel:JOINT" or "travel:JOINT:DIRECTION".

        Raises
        ------
        ModelError
            A colon with nothing behind it.
        """
        head, colon, joint = text.partition(":")
        if head != TRAVEL:
            return None
        if colon and not joint.strip(":"):
            raise ModelError("answers", f'ask for "{text}".', f'Name a joint: "{TRAVEL}:JOINT:z".')
        return cls((joint,) if colon else ())


def travel_together(questions: Sequence[Any]) -> tuple[Any, ...]:
    """Questions of which those for travel are one, in the place of the first of them.

    Parameters
    ----------
    questions : sequence of Question
    """
    travel = [q for q in questions if isinstance(q, TravelAsked)]
    if len(travel) < 2:
        return tuple(questions)
    every = any(not q.selected for q in travel)
    names = () if every else tuple(dict.fromkeys(s for q in travel for s in q.selected))
    one = TravelAsked(names)
    first = travel[0]
    return tuple(
        one if q is first else q for q in questions if q is first or not isinstance(q, TravelAsked)
    )
