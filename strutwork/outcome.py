"""What became of every pose of a batch: solved, or why not."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import MechanismError, ModelError, PoseWarning, StrutworkError

#: Reasons told apart; poses with yet another one share the last.
MOST_REASONS = 100

#: Poses that fail one after the other on the model itself, none solved, before it is blamed.
MODEL_AT_FAULT = 32

_WHERE = re.compile(r" at pose (\d+|\([\d, ]+\))")
#: What was measured at one pose.
_MEASURED = re.compile(r"\b\d+(\.\d+)?e[+-]?\d+\b")


@dataclass(frozen=True)
class Outcome:
    """Which poses of a batch were solved; the values of the others are missing (NaN).

    Parameters
    ----------
    status : (...) of int16
        0 where the pose was solved, else 1 + index into `reasons`.
    reasons : tuple of str
        Why poses were not solved, each once.
    errors : tuple of StrutworkError
        For each reason the error of the first pose met with it, without the pose's number.
    """

    status: NDArray[np.int16]
    reasons: tuple[str, ...] = ()
    errors: tuple[StrutworkError, ...] = ()

    def __repr__(self) -> str:
        good = int(np.count_nonzero(self.solved))
        return f"<Outcome: {good} of {self.status.size} poses solved>"

    @classmethod
    def good(cls, batch: tuple[int, ...]) -> Outcome:
        """Every pose solved.

        Parameters
        ----------
        batch : tuple of int
            Shape of the batch of poses.
        """
        return cls(np.zeros(batch, dtype=np.int16))

    def __getitem__(self, index: Any) -> Outcome:
        """The outcome of the poses selected by `index`."""
        return replace(self, status=np.asarray(self.status[index]))

    @property
    def solved(self) -> NDArray[np.bool_]:
        """True where the pose was solved, (...)."""
        return np.asarray(self.status == 0)

    def reason(self, index: int | tuple[int, ...] = ()) -> str:
        """Why the pose at `index` was not solved; empty where it was.

        Parameters
        ----------
        index : int or tuple of int
            Of the pose in the batch; () for a single pose.
        """
        code = int(self.status[index])
        return self.reasons[code - 1] if code else ""

    def counts(self) -> dict[str, int]:
        """Number of poses by reason."""
        number = np.bincount(self.status.ravel(), minlength=len(self.reasons) + 1)[1:]
        return {w: int(n) for w, n in zip(self.reasons, number, strict=True) if n}

    def of_kind(self, kind: type[StrutworkError]) -> NDArray[np.bool_]:
        """True where a pose failed with an error of that kind, (...).

        Parameters
        ----------
        kind : type of StrutworkError
            Subclasses count as well.
        """
        codes = [i + 1 for i, e in enumerate(self.errors) if isinstance(e, kind)]
        return np.asarray(np.isin(self.status, codes))

    def reshaped(self, batch: tuple[int, ...]) -> Outcome:
        """The same with other batch axes.

        Parameters
        ----------
        batch : tuple of int
            The new shape, of as many poses.
        """
        return replace(self, status=self.status.reshape(batch))

    def require_some(self) -> Outcome:
        """Return the outcome itself unless no pose at all was solved.

        Raises
        ------
        StrutworkError
            The error of the first pose.
        """
        if self.status.size and not self.solved.any():
            raise self._error()
        return self

    def require_all(self) -> Outcome:
        """Return the outcome itself when every pose was solved.

        Raises
        ------
        StrutworkError
            The error of the first pose that was not.
        """
        if not self.solved.all():
            raise self._error()
        return self

    def _error(self) -> StrutworkError:
        """The error of the first pose without an answer, with its place in this batch."""
        first = tuple(int(i) for i in np.argwhere(~self.solved)[0])
        error = self.errors[int(self.status[first]) - 1]
        if self.status.size == 1:
            return error
        place = first[0] if len(first) == 1 else first
        made = type(error)(error.part, f"at pose {place}: {error.problem}", error.remedy)
        made.__cause__ = error.__cause__
        return made

    def warn(self, what: str, stacklevel: int = 2) -> None:
        """Warn, with counts and reasons, where poses of `what` have no answer.

        Parameters
        ----------
        what : str
            What has no answer; begins the message.
        stacklevel : int
            As `warnings.warn` counts it, 1 for the caller of this method.

        Warns
        -----
        PoseWarning
        """
        lost = int(np.count_nonzero(~self.solved))
        if not lost:
            return
        counts = sorted(self.counts().items(), key=lambda item: -item[1])
        listed = "; ".join(f"{number}: {reason}" for reason, number in counts[:5])
        more = f"; {len(counts) - 5} more reasons" if len(counts) > 5 else ""
        warnings.warn(
            f"{what}: no result at {lost} of {self.status.size} poses, which are NaN: "
            f"{listed}{more}.",
            PoseWarning,
            stacklevel=stacklevel + 1,
        )


def solve_poses(
    run: Callable[[NDArray[np.intp]], None],
    count: int,
    hopeless: Callable[[], tuple[NDArray[np.bool_], StrutworkError]] | None = None,
) -> Outcome:
    """Solve a stack of poses as a whole, and where that fails find the poses at fault.

    Parameters
    ----------
    run : callable
        Solves the poses of the indices it is given and keeps their numbers; raises a
        StrutworkError for all of them when one has no answer.
    count : int
        Number of poses p.
    hopeless : callable, optional
        Called once, when the stack fails: which poses (p,) are known to have no answer, and
        their error. Saves finding thousands one by one.

    Returns
    -------
    Outcome
        (p,).

    Raises
    ------
    ModelError
        The model is wrong whatever the pose.
    """
    status = np.zeros(count, dtype=np.int16)
    reasons: dict[str, int] = {}
    errors: list[StrutworkError] = []

    def mark(part: NDArray[Any], error: StrutworkError) -> None:
        words = reason_of(error)
        if words not in reasons:
            if len(reasons) >= MOST_REASONS:
                words = next(reversed(reasons))
            else:
                reasons[words] = len(reasons) + 1
                # the number in the text is that of the stack that was solved, not of the batch
                bare = type(error)(error.part, _WHERE.sub("", error.problem), error.remedy)
                bare.__cause__ = error.__cause__
                errors.append(bare)
        status[part] = reasons[words]

    # no pose at all is solved too: the arrays then have their shapes
    pending = [np.arange(count)]
    solved = model = 0
    while pending:
        part = pending.pop()
        try:
            run(part)
        except StrutworkError as error:
            if not part.size:
                raise
            if part.size == 1:
                mark(part, error)
                model += isinstance(error, ModelError)
                if (
                    isinstance(error, ModelError)
                    and not solved
                    and model == min(MODEL_AT_FAULT, count)
                ):
                    raise
            elif hopeless is not None and not isinstance(error, ModelError):
                bad, blamed = hopeless()
                hopeless = None
                if bad.any():
                    mark(bad, blamed)
                # parts that wait have not been looked at either
                pending = [kept for p in [*pending, part] if (kept := p[~bad[p]]).size]
            else:
                pending += [half for half in np.array_split(part, 2)[::-1] if half.size]
        else:
            solved += part.size
    return Outcome(status, tuple(reasons), tuple(errors))


def reason_of(error: StrutworkError) -> str:
    """An error in one line that poses with the same fault share.

    Without the number of the pose it was met at and without what was measured there; of a
    mechanism without the joints that move. `Outcome.errors` has all of it for the first such pose.

    Parameters
    ----------
    error : StrutworkError
        Met at one pose.
    """
    if isinstance(error, MechanismError):
        return "the structure moves freely under its load"
    problem = _MEASURED.sub("…", _WHERE.sub("", error.problem)).rstrip(".")
    return f"{error.part}: {problem}" if error.part else problem
