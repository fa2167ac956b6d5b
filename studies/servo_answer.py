"""Controlled drives over poses: damping and stiffness with the servos in the loop."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.fea.preload import preloaded
from strutwork.machines.model import Model
from strutwork.msa import LoadCase, PlacedStructure
from strutwork.outcome import Outcome, solve_poses
from strutwork.studies.answers import Column
from strutwork.studies.servo_loop import LoopQuestion

Array = NDArray[Any]


@dataclass(frozen=True)
class ControlledDrives:
    """Poles and least dynamic stiffness with the drives' controllers in the loop.

    Parameters
    ----------
    question : LoopQuestion
        Its ports all move.
    preload : LoadCase or None
        Under which the machine vibrates; its forces are those at each pose.
    """

    question: LoopQuestion = field(repr=False)
    preload: LoadCase | None = None

    @classmethod
    def of(cls, model: Model, question: LoopQuestion) -> ControlledDrives:
        """Of a model, for the ports that move where it stands.

        Parameters
        ----------
        model : Model
        question : LoopQuestion

        Raises
        ------
        StrutworkError
            As `LoopQuestion.ask`.
        """
        ports = question.ask(model.vibrating).ports
        asked = LoopQuestion(
            question.servos, ports, question.damping, question.band, question.modes
        )
        return cls(asked, None if model.preload is None else model.case(model.preload))

    @property
    def columns(self) -> tuple[Column, ...]:
        """Decay of the slowest motion, and stiffnesses at the ports."""
        return (
            Column(
                "decay",
                "1/s",
                "rate at which the slowest motion decays; negative if it grows",
                (),
                "least",
            ),
            Column("decay_frequency", "Hz", "frequency of that motion"),
            Column("unstable", "1", "1 where the closed loop is unstable, 0 elsewhere"),
            Column(
                "servo_stiffness",
                "N/m for translations, N m/rad for rotations",
                "least dynamic stiffness with the servos in the loop; missing where it is unstable",
                ("port",),
                "least",
            ),
            Column(
                "locked_stiffness",
                "N/m for translations, N m/rad for rotations",
                "least dynamic stiffness with the drives locked",
                ("port",),
                "least",
            ),
        )

    @property
    def coordinates(self) -> Mapping[str, tuple[Any, ...]]:
        """The ports by name."""
        return {"port": tuple(str(port) for port in self.question.ports)}

    def __call__(self, placed: PlacedStructure) -> tuple[dict[str, Array], Outcome]:
        """Of a flat batch.

        Parameters
        ----------
        placed : PlacedStructure
        """
        poses, ports = placed.batch[0], len(self.question.ports)
        found = {c.name: np.full((poses, *(ports for _ in c.dims)), np.nan) for c in self.columns}

        def some(index: NDArray[np.intp]) -> None:
            for k in index:
                one = placed[[k]]
                one = one if self.preload is None else preloaded(one, self.preload)
                for name, value in self._one(one).items():
                    found[name][k] = value

        return found, solve_poses(some, poses)

    def _one(self, placed: PlacedStructure) -> dict[str, Any]:
        loop, band = self.question.ask(placed), self.question.band
        worst = loop.slowest
        locked = loop.least_locked(band)
        result: dict[str, Any] = {
            "decay": -worst.value.real,
            "decay_frequency": worst.frequency,
            "unstable": 0.0 if loop.stable else 1.0,
        }
        if loop.stable:
            result["servo_stiffness"] = [one.value for one in loop.least(band)]
        if locked is not None:
            result["locked_stiffness"] = [one.value for one in locked]
        return result
