"""A study: a machine, what is varied, what is asked, over which poses; a dataset of all of it."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from strutwork.errors import ModelError
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model import Model
from strutwork.names import choices
from strutwork.source_digest import source_digest
from strutwork.studies.chunks import Arrays
from strutwork.studies.description import plain, versions
from strutwork.studies.executor import Executor
from strutwork.studies.parameter import Parameter, Varied, parameters_of, varied
from strutwork.studies.parametric import Parametric
from strutwork.studies.pose_sets import (
    PoseList,
    PoseSet,
    TaskList,
    first_pose_can_be_asked,
    settings_of,
)
from strutwork.studies.progress import Progress
from strutwork.studies.question import Question, asked, completed
from strutwork.studies.run import Chunk, Run, fill
from strutwork.studies.sample import Drawn, Sample, drawn
from strutwork.studies.standing import Stand
from strutwork.studies.study_analysis import analysed
from strutwork.studies.study_dataset import require_own_names, study_dataset
from strutwork.studies.study_machines import REDUCTIONS, Machines
from strutwork.studies.travel_answer import travel_together
from strutwork.units import ANGLE, LENGTH, quantity

#: Poses of all machines of a chunk, and machines in one.
CHUNK_POSES, CHUNK_MOST = 8192, 64

#: Reasons told apart, and what the machines with yet another share.
MOST_REASONS, OTHER = 100, "another reason"

#: Packages whose code decides a study's numbers; an edit elsewhere keeps finished parts.
CODE = ("kinematics", "meshes", "msa", "fea", "overconstraint", "flexures", "machines", "studies")


@dataclass(frozen=True)
class Study:
    """A machine, what is varied, what is asked, over which poses.

    Parameters
    ----------
    machine : Parametric
    parameters : tuple of Parameter
    sample : Sample
    answers : tuple of Question
    workspace : TaskGrid, TaskList, PoseList or None
        Poses at which each machine is asked, besides its home; None: home alone.
    reductions : tuple of str
        What is kept of the poses: "worst", "best", "mean", "home", and "poses" for all of them.

    Raises
    ------
    ModelError
        A parameter that does not exist, whose values are out of range, or with the name of
        something else in the result; an empty sample, an unknown answer or reduction; the machine
        as stated lacks what is asked for.
    """

    machine: Parametric
    parameters: tuple[Parameter, ...]
    sample: Sample
    answers: tuple[Question, ...]
    workspace: PoseSet | None = None
    reductions: tuple[str, ...] = ("worst", "mean", "home")

    def __post_init__(self) -> None:
        for name in self.reductions:
            if name not in REDUCTIONS:
                raise ModelError(
                    "reductions",
                    f'name "{name}", which is unknown.',
                    choices("Reductions", name, REDUCTIONS),
                )
        if not self.answers:
            raise ModelError("answers", "are none.", 'Ask for one, as "stiffness".')
        if not self.reductions:
            raise ModelError("reductions", "are none.", 'Name one, as "worst".')
        _ = self.drawn
        model = self.machine.origin.model
        first_pose_can_be_asked(model, self.workspace)
        for question in self.questions:
            question.of(model)
        require_own_names(self)

    @classmethod
    def of(
        cls,
        machine: object,
        parameters: Mapping[str, object] | Sequence[Parameter],
        *answers: object,
        sample: str | Sample = "",
        count: int | None = None,
        seed: int = 0,
        workspace: Mapping[str, Any] | PoseSet | None = None,
        reductions: Sequence[str] = (),
    ) -> Study:
        """A study from names and plain values.

        Parameters
        ----------
        machine : str, Path, Parametric or machine
            As `Parametric.of`.
        parameters : mapping of path to values, or sequence of Parameter
            Beside a path a list of values, or a pair (low, high) for a range; SI, or texts with
            units.
        *answers : str, Answer or Question
            Names of `strutwork.studies.question.QUESTIONS`, or answers as of a survey; stiffness
            where there is none.
        sample : str or Sample
            "grid", "list", "sobol", "latin-hypercube", "random" or "saltelli"; see `Sample`, which
            states count and seed itself.
        count : int, optional
            Machines spread over the ranges.
        seed : int
            Of the points over the ranges.
        workspace : mapping of direction to (n,), or TaskGrid, optional
            Values along each, m and rad or texts with units; the machine's own by default, {} for
            home alone.
        reductions : sequence of str
            "worst", "mean" and "home" by default; "home" alone without a workspace.

        Raises
        ------
        ModelError
            As `Study`.
        """
        found = Parametric.of(machine)
        if workspace is None:
            grid: PoseSet | None = found.origin.model.workspace
        elif isinstance(workspace, TaskGrid | TaskList | PoseList):
            grid = workspace
        else:
            grid = _grid(workspace)
        default = ("home",) if grid is None else ("worst", "mean", "home")
        return cls(
            found,
            parameters_of(parameters),
            Sample(sample, count, seed) if isinstance(sample, str) else sample,
            tuple(asked(a) for a in answers or ("stiffness",)),
            grid,
            tuple(reductions) or default,
        )

    def __repr__(self) -> str:
        names = ", ".join(p.name for p in self.varied)
        poses = 0 if self.workspace is None else len(self.workspace)
        return (
            f"<Study of {self.machine.title!r}: {len(self)} machines over {names}; {poses} poses>"
        )

    def __len__(self) -> int:
        return len(self.drawn.values)

    @cached_property
    def varied(self) -> tuple[Varied, ...]:
        """The parameters, checked, in SI."""
        return varied(self.machine, self.parameters)

    @cached_property
    def drawn(self) -> Drawn:
        """The values of the parameters, a row for each machine."""
        return drawn(self.sample, self.varied)

    @cached_property
    def questions(self) -> tuple[Question, ...]:
        """What is asked, with what is taken from the machine as it is stated."""
        every = travel_together(self.answers)
        return tuple(completed(q, self.machine.origin.model) for q in every)

    def model(self, number: int) -> Model:
        """One machine of the study.

        Parameters
        ----------
        number : int
            Of its row, counted from zero.

        Raises
        ------
        ModelError
            The machine cannot be.
        """
        return self.machines.model(number)

    @cached_property
    def machines(self) -> Machines:
        """What makes and asks the machines."""
        return Machines(
            self.machine,
            self.varied,
            self.drawn.values,
            self.questions,
            Stand(self.workspace),
            self.reductions,
        )

    @property
    def chunk(self) -> int:
        """Machines in a chunk: fewer of those that are asked at many poses."""
        poses = 1 if self.workspace is None else len(self.workspace) + 1
        return max(1, min(CHUNK_MOST, CHUNK_POSES // poses))

    def run(
        self,
        *,
        workers: int | None = None,
        progress: Progress | None = None,
        folder: Path | None = None,
        executor: Executor | None = None,
    ) -> xr.Dataset:
        """Make every machine and ask it.

        Parameters
        ----------
        workers : int, optional
            Threads; default one per processor.
        progress : callable, optional
            Called with how many machines are done, and of how many.
        folder : Path, optional
            Keeps finished chunks there; a later call with the same inputs goes on from them.
        executor : Executor, optional
            In place of threads.

        Returns
        -------
        xarray.Dataset
            A grid has a dimension for each parameter, another sample the dimension `sample`, along
            which the parameters are coordinates. Numbers are named `ANSWER_REDUCTION`; those of a
            machine that cannot be are missing (NaN), `status` and `reason` say why. Blocks give
            Sobol indices, distributions the scatter of the answers:
            `strutwork.studies.study_analysis.analysed`.

        Raises
        ------
        ModelError
            No machine of the study can be; names the reason of most.
        """
        size = self.chunk
        arrays: Arrays = {}
        words = [""]
        run = Run(workers, executor, folder, progress)
        for chunk, part in run.chunks(self.machines, len(self), size, lambda: self.key):
            words = _merged(arrays, chunk, part, words, len(self))
        if not (arrays["status"] == 0).any():
            said = Counter(words[i] for i in arrays["reason"].tolist())
            raise ModelError(
                "study",
                f"none of its {len(self)} machines can be built: {said.most_common(1)[0][0]}",
                "Change the ranges of its parameters.",
            )
        return analysed(self, study_dataset(self, arrays, words))

    @cached_property
    def settings(self) -> dict[str, Any]:
        """What the study was asked, as plain values."""
        return {
            "machine": self.machine.source or self.machine.title,
            "parameters": {p.name: p.settings for p in self.varied},
            "sample": {
                "kind": self.drawn.kind,
                "count": len(self),
                **({} if self.drawn.kind in ("grid", "list") else {"seed": self.sample.seed}),
                **({"second_order": True} if self.sample.second_order else {}),
            },
            "answers": [s for q in self.questions for s in getattr(q, "settings", [q.name])],
            "workspace": settings_of(self.workspace),
            "reductions": list(self.reductions),
        }

    @cached_property
    def inputs(self) -> str:
        """Hash of all inputs: the machine, the values, what is asked; hexadecimal."""
        model = self.machine.origin.model
        content = {
            "machine": plain(self.machine.origin.content),
            # what its files hold, as meshes of solids
            "structure": plain(model.structure),
            "parameters": {p.name: p.settings for p in self.varied},
            "values": hashlib.sha256(self.drawn.values.tobytes()).hexdigest(),
            "shape": list(self.drawn.shape),
            "answers": [[q.name, plain(q)] for q in self.questions],
            "workspace": self.settings["workspace"],
            "reductions": list(self.reductions),
        }
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()

    @property
    def code(self) -> str:
        """Hash of the numerical code; hexadecimal."""
        return source_digest(*(f"strutwork.{name}" for name in CODE))

    @cached_property
    def key(self) -> str:
        """Hash of everything that the numbers depend on; hexadecimal."""
        content = [self.inputs, self.code, versions(), self.chunk]
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _grid(workspace: Mapping[str, Any]) -> TaskGrid | None:
    """Poses of values along directions, SI or texts with units; None where there are none."""
    if not isinstance(workspace, Mapping):
        raise ModelError(
            "workspace",
            f"is a {type(workspace).__name__}.",
            'Give values along directions, as {"x": ["-50 mm", "50 mm"]}; {} for home alone.',
        )
    axes = {}
    for direction, values in workspace.items():
        kind = ANGLE if direction.startswith("r") else LENGTH
        several = [values] if isinstance(values, str) or np.ndim(values) == 0 else list(values)
        read = [quantity(_plain(v), kind, f"workspace.{direction}") for v in several]
        axes[direction] = np.array(read, dtype=float)
    return TaskGrid(axes) if axes else None


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _merged(arrays: Arrays, chunk: Chunk, part: Arrays, words: list[str], count: int) -> list[str]:
    """Put a chunk in its place; reasons are numbered anew, each once."""
    local = ["", *part.pop("reasons").tolist()]
    fresh = [w for w in dict.fromkeys(local) if w not in words]
    if len(words) + len(fresh) > MOST_REASONS:
        # numbers in them tell machines apart: a list of all would be as long as the study
        fresh = [*fresh[: max(0, MOST_REASONS - len(words) - 1)], OTHER]
    words = list(dict.fromkeys([*words, *fresh]))
    place = {w: words.index(w if w in words else OTHER) for w in local}
    for name in [n for n in part if n.endswith("reason")]:
        part[name] = np.array([place[w] for w in local], dtype=np.int32)[part[name]]
    fill(arrays, chunk, part, count)
    return words
