"""Numbers of many variants of a machine at once: what an optimiser calls for a population.

    >>> from strutwork.studies.parametric import Parametric
    >>> machine = Parametric.of("examples/machines/6-ups.toml")
    >>> variants = Variants.of(
    ...     machine,
    ...     ["sections.ram.diameter", "joints.ball*.stiffness.*"],
    ...     "stiffness", "frequency", "mass",
    ...     workspace={"x": [-0.1, 0.1]},
    ... )
    >>> found = variants.values([[0.05, 4e8], [0.06, 4e8]])
    >>> found["mass"].shape, found["stiffness_free_worst"].shape, found["status"].tolist()
    ((2,), (2, 6), [0, 0])

`Variants.of(machine, paths, *answers, workspace=None, reductions=("worst",))` takes paths of
numbers, or `Parameter` objects where several paths change together or by a factor.
`values(samples, workers=None)` takes (n, k) and returns arrays whose first axis has n entries, by
the names that a study gives them: `ANSWER_REDUCTION`. `status` is 0 where a machine was solved;
where it was not, its numbers are missing (NaN) and `why(found, i)` says the reason. Nothing is
raised for a machine that cannot be.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.studies.chunks import Arrays
from strutwork.studies.parameter import Parameter, Varied
from strutwork.studies.parametric import Parametric
from strutwork.studies.pose_sets import PoseSet
from strutwork.studies.question import Question
from strutwork.studies.run import Run, fill
from strutwork.studies.standing import Stand
from strutwork.studies.study import Study
from strutwork.studies.study_machines import Machines

Array = NDArray[Any]

#: Machines that a thread takes at once.
BLOCK = 32


@dataclass(frozen=True)
class Variants:
    """A machine, the numbers that are varied, and what is asked; made by `Variants.of`.

    Parameters
    ----------
    study : Study
        Of one machine, with everything checked.
    stand : Stand
        The poses; kept from call to call where no number moves a joint.
    """

    study: Study
    stand: Stand

    @classmethod
    def of(
        cls,
        machine: object,
        paths: Sequence[str | Parameter],
        *answers: object,
        workspace: Mapping[str, Any] | PoseSet | None = None,
        reductions: Sequence[str] = ("worst",),
    ) -> Variants:
        """Variants of a machine.

        Parameters
        ----------
        machine : str, Path, Parametric or machine
            As `strutwork.studies.parametric.Parametric.of`.
        paths : sequence of k str or Parameter
            The values and ranges of a `Parameter` are checked and not used.
        *answers, workspace, reductions
            As `Study.of`; without a workspace the machine's own, {} for home alone.

        Raises
        ------
        ModelError
            As `Study.of`.
        """
        found = Parametric.of(machine)
        asked = []
        for path in paths:
            if isinstance(path, Parameter):
                asked.append(path)
                continue
            # the value that the machine states is one that it can have
            asked.append(Parameter(path, values=(found.matching(path)[0].value,)))
        kept = tuple(reductions)
        home = isinstance(workspace, Mapping) and not workspace
        study = Study.of(
            found, asked, *answers, workspace=workspace, reductions=("home",) if home else kept
        )
        return cls(study, Stand(study.workspace))

    @property
    def varied(self) -> tuple[Varied, ...]:
        """The k parameters, with their units."""
        return self.study.varied

    @property
    def questions(self) -> tuple[Question, ...]:
        """What each machine is asked."""
        return self.study.questions

    def values(self, samples: ArrayLike, workers: int | None = None) -> Arrays:
        """Make n machines and ask each.

        Parameters
        ----------
        samples : (n, k)
            Of the parameters, each in its unit, SI; factors where it is relative. Any unit.
        workers : int, optional
            Threads; default one per processor.

        Returns
        -------
        dict of str to (n, ...)
            As the module states, with `status`, `reason` (index into `reasons`, 0 for none),
            `reasons`, `poses_kept`.

        Raises
        ------
        ModelError
            Samples of another shape, or not finite.
        """
        table = np.asarray(samples, dtype=float)
        width = len(self.varied)
        if table.ndim != 2 or table.shape[1] != width or not np.isfinite(table).all():
            raise ModelError(
                "samples",
                f"have the shape {table.shape}, or values that are not finite.",
                f"Give a row of {width} finite numbers for each machine.",
            )
        machines = Machines(
            self.study.machine,
            self.varied,
            table,
            self.questions,
            self.stand,
            self.study.reductions,
        )
        if not len(table):
            return {}
        whole: Arrays = {}
        words = [""]
        run = Run(workers)
        # a folder of `computed_on` keeps studies, not populations: who searches keeps these
        for chunk, part in run.unkept.chunks(machines, len(table), BLOCK, str):
            local = ["", *part.pop("reasons").tolist()]
            words += [w for w in dict.fromkeys(local) if w not in words]
            place = np.array([words.index(w) for w in local], dtype=np.int32)
            part["reason"] = place[part["reason"]]
            fill(whole, chunk, part, len(table))
        return whole | {"reasons": np.array(words)}


def why(found: Arrays, number: int) -> str:
    """Why a machine has no numbers; empty where it has.

    Parameters
    ----------
    found : dict of str to (n, ...)
        From `Variants.values`.
    number : int
        Of its row.
    """
    return str(found["reasons"][found["reason"][number]])
