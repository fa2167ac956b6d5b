"""Answers about a machine, each found once: in place, by a process beside, or in an earlier run."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Generic, Protocol, TypeVar, overload

from strutwork.errors import StrutworkError

T = TypeVar("T")

#: What a question may end with, beside an answer: the same wherever it is asked.
ENDS = (StrutworkError, ArithmeticError, MemoryError, OSError, RuntimeWarning)

_FOUND = "outcomes of answers"


@dataclass(frozen=True)
class Outcome:
    """What came of a question.

    Parameters
    ----------
    value : object
        The answer.
    error : Exception or None
        Why there is none.
    warned : tuple of Warning
        What the work warned of.
    """

    value: Any = None
    error: Exception | None = None
    warned: tuple[Warning, ...] = ()

    def get(self) -> Any:
        """The answer.

        Raises
        ------
        Exception
            There is none: that error.
        """
        for warning in self.warned:
            warnings.warn(warning, stacklevel=3)
        if self.error is not None:
            raise self.error
        return self.value


class Source(Protocol):
    """Where answers come from."""

    def ask(self, name: str, find: Callable[[], Any]) -> Outcome:
        """What came of a question, by `find` where nobody else answers."""


class answer(Generic[T]):  # noqa: N801 - used as `cached_property` is
    """A property that asks the `source` of its owner, once; an error is kept like an answer."""

    def __init__(self, ask: Callable[[Any], T]) -> None:
        self.find = ask
        self.name = ask.__name__
        self.__doc__ = ask.__doc__

    @overload
    def __get__(self, instance: None, owner: type) -> answer[T]: ...
    @overload
    def __get__(self, instance: object, owner: type) -> T: ...
    def __get__(self, instance: Any, owner: type) -> Any:
        """The answer; of the class the property itself."""
        if instance is None:
            return self
        found: dict[str, Outcome] = vars(instance).setdefault(_FOUND, {})
        outcome = found.get(self.name)
        if outcome is None:

            def find() -> T:
                return self.find(instance)

            source: Source | None = instance.source
            outcome = outcome_of(find) if source is None else source.ask(self.name, find)
            # what was warned of is said once
            found[self.name] = replace(outcome, warned=())
        return outcome.get()


def outcome_of(find: Callable[[], Any]) -> Outcome:
    """Answer a question here and now."""
    with warnings.catch_warnings(record=True) as seen:
        try:
            value, error = find(), None
        except ENDS as ended:
            value, error = None, ended
    said = [w.message for w in seen if isinstance(w.message, Warning)]
    return Outcome(value, error, tuple(said))
