"""The result of a design as a dataset: every machine that was judged, and the front."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

import strutwork
from strutwork.errors import ModelError
from strutwork.machines.model_file import file_text
from strutwork.studies.description import versions
from strutwork.studies.design import Design
from strutwork.studies.design_judged import FEASIBLE, STATUS, Judged
from strutwork.studies.design_search import Generation, front_of
from strutwork.studies.parametric import Tables
from strutwork.studies.variables import named

Array = NDArray[Any]

MACHINE, FRONT = "machine", "front"

#: Names that a parameter may not have.
_TAKEN = {
    *(MACHINE, FRONT, "parameter", "reason_text", "status", "reason", "generation"),
    *("poses_reached", "share"),
}


class Archive:
    """All machines of a search so far, and which of them no other one beats.

    Parameters
    ----------
    design : Design

    Raises
    ------
    ModelError
        The model file is gone; a parameter with the name of something else in the dataset.
    """

    def __init__(self, design: Design) -> None:
        self.design = design
        self._require_own_names()
        self.parts: list[Generation] = []
        self.count = 0
        self._front = np.zeros(0, dtype=np.intp)
        self._targets = np.zeros((0, len(design.objectives)))
        file = design.machine.source if isinstance(design.machine.origin, Tables) else ""
        self.text = file_text(Path(file)) if file else ""

    @property
    def front(self) -> NDArray[np.intp]:
        """Numbers of the machines of the front, (f,), in order of the first objective."""
        return self._front

    def add(self, generation: Generation) -> None:
        """Take a generation in.

        Parameters
        ----------
        generation : Generation
        """
        good = np.flatnonzero(generation.judged.status == FEASIBLE)
        numbers = np.concatenate([self._front, good + self.count])
        targets = self.design.targets(generation.judged)[good]
        targets = np.concatenate([self._targets, targets])
        best = front_of(targets)
        self._front, self._targets = numbers[best], targets[best]
        self.parts.append(generation)
        self.count += len(generation.shares)

    def dataset(self) -> xr.Dataset:
        """Everything, with units and what it was made of."""
        design, parts = self.design, self.parts
        reasons = [r for p in parts for r in p.judged.reasons]
        words = list(dict.fromkeys(["", *reasons]))
        samples = np.concatenate([p.samples for p in parts])
        values = np.concatenate([p.judged.values for p in parts])
        flag = {
            "flag_values": np.arange(len(STATUS), dtype=np.int8),
            "flag_meanings": " ".join(STATUS),
        }

        def along(array: Sequence[Any] | Array, unit: str, meaning: str, **more: Any) -> Any:
            return named(MACHINE, np.asarray(array), unit, meaning, **more)

        status = np.concatenate([p.judged.status for p in parts])
        made = {
            "status": along(status, "1", "what became of the machine", **flag),
            "reason": along(
                [words.index(r) for r in reasons] or np.zeros(0, int), "1", "index into reason_text"
            ),
            "generation": along(
                np.concatenate([np.full(len(p.shares), p.number + 1) for p in parts]),
                "1",
                "generation in which the machine was made, from one",
            ),
            "poses_reached": along(
                np.concatenate([p.judged.reached for p in parts]),
                "1",
                "share of the poses that the machine reaches",
            ),
            "share": named(
                (MACHINE, "parameter"),
                np.concatenate([p.shares for p in parts]),
                "1",
                "place of the machine in the range or list of each parameter",
            ),
            FRONT: named(
                FRONT, self._front, "1", "machines that no other one beats in every objective"
            ),
        }
        goals = {o.quantity.name: o.goal for o in design.objectives}
        for i, quantity in enumerate(design.quantities):
            goal = {"goal": goals[quantity.name]} if quantity.name in goals else {}
            currency = quantity.name == "cost" and design.cost.currency
            more = {**goal, **({"currency": currency} if currency else {})}
            stated = float(design.stated.values[0, i])
            made[quantity.variable] = along(
                values[:, i], quantity.unit, quantity.meaning, stated=stated, **more
            )
        coordinates: dict[str, Any] = {"reason_text": words}
        names = [_variable(p.name) for p in design.varied]
        coordinates["parameter"] = names
        for i, p in enumerate(design.varied):
            coordinates[names[i]] = along(
                samples[:, i],
                p.unit or "1",
                p.meaning,
                paths=json.dumps([n.path for n in p.numbers]),
                stated=float(design.stated_values[i]),
                relative=int(p.relative),
            )
        return xr.Dataset(made, coords=coordinates, attrs=self._attributes())

    def _require_own_names(self) -> None:
        names = [_variable(p.name) for p in self.design.varied]
        taken = {*_TAKEN, *(q.variable for q in self.design.quantities)}
        for name, p in zip(names, self.design.varied, strict=True):
            if name in taken or names.count(name) > 1:
                raise ModelError(
                    f"parameter {p.name}",
                    "has the name of something else in the result.",
                    "Give it another name.",
                )

    def _attributes(self) -> dict[str, Any]:
        design = self.design
        # with it a machine of the front can be written wherever the result is read
        text = {"model_file": self.text} if self.text else {}
        return {
            "title": f"design of {design.machine.title}",
            "Conventions": "CF-1.11",
            "source": f"strutwork {strutwork.__version__}",
            "settings": json.dumps(design.settings, ensure_ascii=False),
            "generations": len(self.parts),
            "asked_generations": design.search.rounds,
            "method": design.search.words,
            "design_key": design.key,
            "versions": json.dumps(versions()),
            **text,
        }


def _variable(name: str) -> str:
    """A name that a NetCDF file can list among its coordinates."""
    return re.sub(r"[\s/]", "_", name)


def judged_of(dataset: xr.Dataset, design: Design, number: int) -> tuple[Array, Judged] | None:
    """A generation of a result: its shares (n, k) and what was found; None where it has none.

    Parameters
    ----------
    dataset : xarray.Dataset
        As `Archive.dataset` makes.
    design : Design
        The same.
    number : int
        Of the generation, from zero.
    """
    rows = np.flatnonzero(dataset["generation"].to_numpy() == number + 1)
    if not rows.size:
        return None
    texts = [str(t) for t in dataset["reason_text"].to_numpy()]
    values = np.stack([dataset[q.variable].to_numpy()[rows] for q in design.quantities], axis=1)
    judged = Judged(
        values,
        dataset["status"].to_numpy()[rows].astype(np.int8),
        dataset["poses_reached"].to_numpy()[rows],
        tuple(texts[int(i)] for i in dataset["reason"].to_numpy()[rows]),
    )
    return dataset["share"].to_numpy()[rows], judged
