"""The error family: every message names the part, says what is wrong and what to do."""

from __future__ import annotations

from strutwork.names import visible


class StrutworkError(Exception):
    """Base of all errors raised on purpose.

    As text, hidden characters of names are written out: a message acts on no terminal.

    Parameters
    ----------
    part : str
        The joint, node, field or file that the message is about.
    problem : str
        What is wrong with it, with the value that was given.
    remedy : str
        What the reader can do about it.
    """

    def __init__(self, part: str, problem: str, remedy: str = "") -> None:
        self.part = part
        self.problem = problem
        self.remedy = remedy
        super().__init__(part, problem, remedy)

    def __str__(self) -> str:
        text = f"{visible(self.part)}: {self.problem}" if self.part else self.problem
        return visible(f"{text}\n{self.remedy}" if self.remedy else text, lines=True)


class ModelError(StrutworkError):
    """The description of the structure or the study is wrong."""


class OutputError(ModelError):
    """A result cannot be written to the folder, the disk or standard output."""


class UnitError(ModelError):
    """A quantity has a unit of another dimension than its field."""


class MechanismError(StrutworkError):
    """The structure moves freely under the load; the message names the unconstrained joints."""


class InconsistentConstraintsError(StrutworkError):
    """Locked directions contradict one another: no displacement satisfies all of them."""


class UnreachableError(StrutworkError):
    """A pose outside the reach of the machine."""


class SingularPoseError(StrutworkError):
    """A pose at which the machine loses or gains a degree of freedom."""


class ContactError(StrutworkError):
    """A contact that preload should keep closed is open; the message names the bearing."""


class NumericalError(StrutworkError):
    """A result failed its own check (residual, symmetry, finiteness) and was withheld."""


class StudyError(StrutworkError):
    """Chunks of a study that could not be computed; the message says what is kept, and where."""


class ClusterError(StrutworkError):
    """A cluster that does not answer, lost its workers, or has other versions than this process."""


class StudyWarning(UserWarning):
    """A study goes on, or can go on, although something in it failed or was interrupted."""


class UnverifiedWarning(UserWarning):
    """A number failed its own check and was withheld, while the others stand."""


class ModelWarning(UserWarning):
    """Something in a model that is probably a mistake and yet can be computed."""


class ValidityWarning(ModelWarning):
    """A model is used beyond the range in which it was shown to hold."""


class ProportionWarning(ModelWarning):
    """Dimensions are out of proportion: probably a length is not in metres."""


class PoseWarning(UserWarning):
    """Some poses of a batch were not solved; the message counts them by reason."""


class CacheWarning(UserWarning):
    """Something that is kept for later runs cannot be kept or read; the result is not affected."""
