"""Where the answers of a report come from: earlier runs, processes beside, or this one."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from strutwork.errors import ModelError
from strutwork.machines.model import Model
from strutwork.reports.answer_store import AnswerStore, answers_folder, model_key
from strutwork.reports.answers import Outcome, outcome_of
from strutwork.reports.beside import Beside, Group, processors
from strutwork.reports.subject import Subject
from strutwork.studies.progress import Progress, silent

#: How long questions take, roughly, in s of one processor; one that is not named counts 1. The
#: share of the work that is done is shown by these, for their number says little of the time.
SIZES = {
    "vibration": 20,
    "reversals": 20,
    "vibration_survey": 10,
    "accuracy_survey": 10,
    "stiffness_survey": 10,
    "singular_plane": 10,
    "modes": 10,
    "assembly_survey": 5,
    "stability_survey": 5,
    "cut": 5,
}

#: What takes less is not kept for later runs, s of a processor.
WORTH = 0.2


@dataclass(frozen=True)
class Kept:
    """Answers of earlier runs, else found here and kept.

    Parameters
    ----------
    store : AnswerStore or None
    """

    store: AnswerStore | None = None

    def ask(self, name: str, find: Callable[[], Any]) -> Outcome:
        """What came of a question."""
        known = None if self.store is None else self.store.read(name)
        if known is not None:
            return known
        begun = time.process_time()
        outcome = outcome_of(find)
        if self.store is not None and time.process_time() - begun > WORTH:
            self.store.write(name, outcome)
        return outcome

    def asked(self, name: str, find: Callable[[], Any]) -> Any:
        """The answer to a question."""
        return self.ask(name, find).get()

    def has(self, names: Iterable[str]) -> bool:
        """Whether the answers to some questions lie there."""
        return self.store is not None and all(self.store.has(name) for name in names)


@dataclass(frozen=True)
class Gathered:
    """Answers of processes beside this one, where one of them is asked.

    Parameters
    ----------
    kept : Kept
    beside : Beside
    told : callable
        How much of the questions is answered, in the units of `SIZES`.
    """

    kept: Kept
    beside: Beside
    told: Progress = silent

    def ask(self, name: str, find: Callable[[], Any]) -> Outcome:
        """What came of a question."""
        found = self.beside.get(name, self.tell)
        return self.kept.ask(name, find) if found is None else found

    def tell(self) -> None:
        """Say how far the processes are."""
        self.told(_size(self.beside.found), _size(self.beside.asked))


def _size(names: Iterable[str]) -> int:
    return sum(SIZES.get(name, 1) for name in names)


@contextmanager
def answering(
    subject: Subject, more: Group | None = None, *, fresh: bool = False
) -> Iterator[Subject]:
    """A subject whose answers come from earlier runs, or from processes beside this one.

    Parameters
    ----------
    subject : Subject
    more : mapping, optional
        Questions that its report asks beside those about the machine: each is asked alone, and
        its name tells it from those of other reports.
    fresh : bool
        Whether everything is found anew.

    Yields
    ------
    Subject
        Of the same machine. Its processes end with the block.
    """
    kept = Kept(store_of(subject.model, fresh=fresh))
    quiet = replace(subject, progress=None, source=kept)
    groups: list[Group] = [
        {name: partial(kept.asked, name, find)} for name, find in (more or {}).items()
    ]
    groups += [{name: partial(getattr, quiet, name) for name in some} for some in questions(quiet)]
    groups = [group for group in groups if not kept.has(group)]
    workers = min(processors(), len(groups))
    if workers < 2:
        yield replace(subject, source=kept)
        return
    # what all need is there before they part
    _ = quiet.check, quiet.solution
    beside = Beside(groups, workers)
    told = silent if subject.progress is None else subject.progress("answers")
    try:
        yield replace(quiet, source=Gathered(kept, beside, told))
    finally:
        beside.end()


def store_of(model: Model, *, fresh: bool = False) -> AnswerStore | None:
    """Where the answers about a model are kept; None where they cannot be."""
    try:
        return store_at(model_key(model), fresh=fresh)
    except ModelError:
        # it holds what has no hash, such as a function of the user's own
        return None


def store_at(key: str, *, fresh: bool = False) -> AnswerStore | None:
    """Where answers with a key are kept; None where the user has no cache folder."""
    folder = answers_folder()
    return None if folder is None else AnswerStore(folder, key, fresh)


def questions(subject: Subject) -> list[tuple[str, ...]]:
    """Names of the long answers that a report of a subject needs, the longest groups first.

    Those of a group need one another; the groups are independent.
    """
    model = subject.model
    tool, space = model.tool is not None, model.workspace is not None
    moves = tool and bool(model.structure.linkage.driven)
    groups: list[tuple[str, ...]] = []
    if tool and space:
        groups.append(("workspace", "largest_box"))
        over = ["stiffness_survey", "first_changes"]
        if model.tolerances:
            over.append("assembly_survey")
        if model.tolerances or subject.accuracy_answer.errors:
            over.append("accuracy_survey")
        groups.append(tuple(over))
    if moves:
        groups.append(("singular_distance", "singular_plane"))
    if subject.vibrates:
        groups.append(("vibration", "vibration_survey") if tool and space else ("vibration",))
    if not subject.cannot_cut:
        groups.append(("cut", "stability_survey") if tool and space else ("cut",))
    if moves and space:
        if subject.reversal_plane is not None:
            groups.append(("reversals",))
        groups.append(("standard_motion",))
    if moves:
        groups.append(("modes",))
    if model.tolerances:
        groups.append(("tolerances",))
    return groups
