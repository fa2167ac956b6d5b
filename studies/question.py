"""What a study asks each of its machines, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.dynamic_stiffness import check_band
from strutwork.fea.ports import tool_ports
from strutwork.machines.model import Model
from strutwork.msa import PlacedStructure
from strutwork.msa.mass import total_mass
from strutwork.names import choices
from strutwork.outcome import Outcome
from strutwork.studies.accuracy_answer import VolumetricAccuracy, drive_errors
from strutwork.studies.amplification_answer import Amplification
from strutwork.studies.answers import Answer, Assembly, Column, Stiffness, Vibration
from strutwork.studies.covering_band import band_of
from strutwork.studies.dynamic import ONE_PERCENT
from strutwork.studies.frequency_answer import HomeFrequency
from strutwork.studies.model_damping import model_damping
from strutwork.studies.models_together import masses
from strutwork.studies.stability_answer import Stability
from strutwork.studies.standing import Standing
from strutwork.studies.transmission_answer import Transmission
from strutwork.studies.travel_answer import TRAVEL, TravelAsked

Array = NDArray[Any]


class Question(Protocol):
    """Makes the answer of one machine: its tolerances, damping and loads may be what varies."""

    @property
    def name(self) -> str:
        """As a study file names it."""

    def of(self, model: Model) -> Answer:
        """What asks this machine.

        Parameters
        ----------
        model : Model

        Raises
        ------
        ModelError
            The machine lacks what is asked for.
        """


@dataclass(frozen=True)
class Asked:
    """A question by its name.

    Parameters
    ----------
    name : str
    band : (float, float) or None
        Hz, of vibration.
    count : int
        Frequencies, of vibration.

    Raises
    ------
    ModelError
        As `strutwork.fea.dynamic_stiffness.check_band`.
    """

    name: str
    band: tuple[float, float] | None = None
    count: int = 6

    def __post_init__(self) -> None:
        # of every machine alike: said once, before any is made
        if self.band is not None:
            check_band(*self.band)

    def of(self, model: Model) -> Answer:
        """As `QUESTIONS` makes it.

        Parameters
        ----------
        model : Model
        """
        return QUESTIONS[self.name](self, model)


@dataclass(frozen=True)
class Fixed:
    """An answer that is the same object for every machine.

    Parameters
    ----------
    answer : Answer
    """

    answer: Answer

    @property
    def name(self) -> str:
        """Its class."""
        return type(self.answer).__name__.lower()

    def of(self, model: Model) -> Answer:  # noqa: ARG002
        """The answer itself.

        Parameters
        ----------
        model : Model
            Not looked at.
        """
        return self.answer


@dataclass(frozen=True)
class Mass:
    """Mass of all that moves and is modelled, at home: beams may be as long as a slider is out.

    Parameters
    ----------
    model : Model
    columns : tuple of Column
    """

    model: Model = field(repr=False)
    columns: tuple[Column, ...] = (Column("mass", "kg", "mass of all parts", (), "largest"),)

    @property
    def coordinates(self) -> Mapping[str, tuple[Any, ...]]:
        """None."""
        return {}

    def __call__(self, placed: PlacedStructure) -> tuple[dict[str, Array], Outcome]:
        """Of a flat batch: the same at each pose."""
        value = float(np.ravel(total_mass(self.model.placed))[0])
        poses = placed.batch
        return {"mass": np.full(poses, value)}, Outcome.good(poses)

    @staticmethod
    def of_many(standing: Sequence[tuple[Model, Standing] | None]) -> Array:
        """As `strutwork.studies.models_together.masses`, (n,), kg.

        Parameters
        ----------
        standing : sequence of n (Model, Standing) or None
        """
        return masses(standing)


def _stiffness(_: Asked, model: Model) -> Answer:
    model.require_tool()
    return Stiffness()


def _vibration(asked: Asked, model: Model) -> Answer:
    tool = model.require_tool()
    if asked.band is None:
        raise ModelError("vibration", "has no band.", "Give one, Hz.")
    preload = None if model.preload is None else model.case(model.preload)
    damping = model_damping(model) or ONE_PERCENT
    return Vibration(tool, damping, asked.band, asked.count, preload)


def _accuracy(_: Asked, model: Model) -> Answer:
    return VolumetricAccuracy(model.tolerances, drive_errors(model))


#: What can be asked, and how it is made.
QUESTIONS: Mapping[str, Callable[[Asked, Model], Answer]] = {
    "stiffness": _stiffness,
    "vibration": _vibration,
    "frequency": lambda _, model: HomeFrequency(model),
    "assembly": lambda _, model: Assembly.of(model),
    "accuracy": _accuracy,
    "stability": lambda _, model: Stability.of(model),
    "transmission": lambda _, model: Transmission.of(model),
    "amplification": lambda _, model: Amplification.of(model),
    "mass": lambda _, model: Mass(model),
}


def asked(what: object) -> Question:
    """A question from its name, an answer or a question.

    Parameters
    ----------
    what : str, Answer or Question

    Raises
    ------
    ModelError
        An unknown name.
    """
    if isinstance(what, str):
        travel = TravelAsked.read(what)
        if travel is not None:
            return travel
        if what not in QUESTIONS:
            raise ModelError(
                "answers",
                f'ask for "{what}", which is unknown.',
                choices("Answers", what, [*QUESTIONS, TRAVEL]),
            )
        return Asked(what)
    if hasattr(what, "of") and hasattr(what, "name"):
        return what
    if hasattr(what, "columns") and callable(what):
        return Fixed(what)  # type: ignore[arg-type]
    raise ModelError(
        "answers",
        f"hold a {type(what).__name__}.",
        "Give names of answers, or those of strutwork.studies.answers.",
    )


def completed(question: Question, model: Model) -> Question:
    """A question with what it takes from the machine as it is stated, the same for all samples.

    Parameters
    ----------
    question : Question
    model : Model
        Without a change.

    Raises
    ------
    ModelError
        No elastic mode to find the band of, or what the machine lacks.
    """
    if not isinstance(question, Asked) or question.name != "vibration" or question.band is not None:
        return question
    model.require_tool()
    band = band_of(model.vibrating, tool_ports(model.structure.linkage), question.count)
    if band is None:
        raise ModelError("structure", "has no elastic mode.", "Give it mass and elastic parts.")
    return Asked(question.name, (band.low, band.high), question.count)
