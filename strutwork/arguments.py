"""Wrong arguments in the words of the package: misspelt options, values of another type."""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cache, wraps
from importlib import import_module
from numbers import Integral, Real
from typing import Any, TypeVar, cast

from strutwork.errors import ModelError
from strutwork.names import choices, visible

C = TypeVar("C")
F = TypeVar("F", bound=Callable[..., Any])

#: What takes the options that a method hands on: "MODULE:NAME", looked up at the first call.
TAKERS: Mapping[str, tuple[str, ...]] = {
    "calibrate": ("strutwork.studies.calibration:calibrate_machine",),
    "closed_loop": ("strutwork.studies.servo_loop:loop_question",),
    "compare": ("strutwork.reports.designs.comparison:compare_designs",),
    "design": (
        "strutwork.studies.machine_design:design_machine",
        "strutwork.studies.design:Design.of",
        "strutwork.studies.design_terms:Search",
    ),
    "function": ("strutwork.studies.function:MachineFunction.of",),
    "state_space": ("strutwork.studies.servo_loop:machine_state_space",),
    "study": (
        "strutwork.studies.study:Study.of",
        "strutwork.studies.study:Study.run",
        "strutwork.studies.study_store:run_to_file",
    ),
    "survey": ("strutwork.studies.survey:survey",),
}

#: What a method gives to those itself: no options.
_GIVEN = {
    *("machine", "model", "parameters", "objectives", "answers", "servos", "inputs", "outputs"),
    *("a", "b", "grid", "around", "study", "path", "self", "cls", "standing", "where"),
}
#: Options of a method under another name than where they go.
_OWN: Mapping[str, Mapping[str, str]] = {"study": {"out": "str | Path | None"}}


def _number(value: object) -> bool:
    if getattr(value, "ndim", None) == 0:
        # a number of an array or a dataset
        return True
    return isinstance(value, Real) and not isinstance(value, bool)


def _listed(value: object) -> bool:
    return isinstance(value, Iterable) and not isinstance(value, str | bytes)


def _pair(value: object) -> bool:
    return isinstance(value, Iterable) and _listed(value) and [*map(_number, value)] == [True] * 2


def _numeric(value: object) -> bool:
    import numpy as np

    try:
        np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        return False
    return True


#: Annotations that are looked at, what they accept, and what to give; any other accepts all.
_TYPES: Mapping[str, tuple[Callable[[object], bool], str]] = {
    "int": (lambda v: isinstance(v, Integral) and not isinstance(v, bool), "a whole number"),
    "float": (_number, "a number"),
    "bool": (lambda v: type(v).__name__.startswith("bool"), "True or False"),
    "str": (lambda v: isinstance(v, str), "a text"),
    "Path": (lambda v: isinstance(v, os.PathLike | str), "a path"),
    "None": (lambda v: v is None, "None"),
    "ArrayLike": (_numeric, "a number or an array of numbers"),
    "Progress": (callable, "a function"),
    "Executor": (lambda v: hasattr(v, "map"), "an executor"),
    "Mapping": (lambda v: isinstance(v, Mapping), "a dictionary"),
    "Sequence": (_listed, "a list"),
    "Iterable": (_listed, "a list"),
    "tuple[float, float]": (_pair, "a pair of numbers"),
}

#: Classes that are known by their names.
_CLASSES = ("Constraint", "Cost", "Objective", "Parameter", "PoseList", "TaskGrid", "TaskList")

#: Annotations that stand for others.
_ALIASES: Mapping[str, str] = {
    "PoseSet": "TaskGrid | TaskList | PoseList",
    "Poses": "Mapping[str, Any] | TaskGrid | str | None",
    "Value": "float | str",
}


def explained(cls: type[C]) -> type[C]:
    """A class whose public methods refuse wrong arguments by errors that name the remedy.

    Options that do not exist are refused with the nearest names, also those that a method hands on
    to what `TAKERS` states; values are compared with simple annotations.

    Parameters
    ----------
    cls : type
    """
    for name in {n for base in cls.__mro__ for n in vars(base)}:
        method = inspect.getattr_static(cls, name)
        if not name.startswith("_") and inspect.isfunction(method):
            setattr(cls, name, checked(method))
    return cls


def checked(function: F) -> F:
    """A function that refuses wrong arguments by `ModelError`.

    Parameters
    ----------
    function : callable
        Whose annotations are texts, as `from __future__ import annotations` makes them.
    """
    name = function.__name__
    signature = inspect.signature(function)
    kinds = {p.kind for p in signature.parameters.values()}
    open_ended = inspect.Parameter.VAR_KEYWORD in kinds

    @wraps(function)
    def call(*args: Any, **options: Any) -> Any:
        known = _named(signature.parameters.values())
        if open_ended and name in TAKERS:
            known = known | _handed_on(name)
        if name in TAKERS or not open_ended:
            for option in options:
                if option not in known:
                    raise ModelError(
                        name,
                        f'has no option "{visible(option)}".',
                        choices("Options", option, [k for k in known if k != "self"], 30),
                    )
        try:
            bound = signature.bind(*args, **options)
        except TypeError as error:
            # a missing argument, or one too many
            plain = [p.replace(annotation=p.empty) for p in signature.parameters.values()]
            words = ", ".join(str(p) for p in plain if p.name != "self")
            raise ModelError(name, f"is called with {error}.", f"Call {name}({words}).") from error
        for key, value in bound.arguments.items():
            kind, annotation = signature.parameters[key].kind, signature.parameters[key].annotation
            if kind in _PLAIN:
                _check(name, key, value, known[key])
            elif kind is inspect.Parameter.VAR_POSITIONAL:
                for entry in value:
                    _check(name, key, entry, annotation)
            else:
                for option, entry in value.items():
                    _check(name, option, entry, known.get(option, annotation))
        return function(*args, **options)

    return cast("F", call)


_PLAIN = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)


def _named(parameters: Iterable[inspect.Parameter]) -> dict[str, str]:
    return {p.name: str(p.annotation) for p in parameters if p.kind in _PLAIN}


@cache
def _handed_on(name: str) -> dict[str, str]:
    """Options of those that a method hands them to, with their annotations."""
    found: dict[str, str] = dict(_OWN.get(name, {}))
    for place in TAKERS[name]:
        module, _, path = place.partition(":")
        taker: Any = import_module(module)
        for part in path.split("."):
            taker = getattr(taker, part)
        own = _named(inspect.signature(taker).parameters.values())
        found |= {k: v for k, v in own.items() if k not in _GIVEN and k not in found}
    return found


@dataclass(frozen=True)
class _Wrong:
    """A value that no part of its annotation accepts.

    Parameters
    ----------
    place : str
        Within the argument, as ``["x"]``.
    value : object
    wanted : tuple of str
        What to give.
    """

    place: str
    value: object
    wanted: tuple[str, ...]


def _check(name: str, key: str, value: object, annotation: str) -> None:
    wrong = _wrong(value, annotation)
    if wrong is None:
        return
    said = visible(repr(wrong.value))
    said = said if len(said) < 60 else f"{said[:57]}..."
    kind = type(wrong.value).__name__
    what = "None" if wrong.value is None else f"{_article(kind)} {kind}, {said},"
    raise ModelError(
        f"{key}{wrong.place}",
        f"is {what} in {name}.",
        f"Give {' or '.join(dict.fromkeys(wrong.wanted))}.",
    )


def _article(word: str) -> str:
    return "an" if word[0] in "aeiouAEIOU" else "a"


def _wrong(value: object, annotation: str) -> _Wrong | None:
    """What is wrong with a value; None where a part of the union accepts it or is not known."""
    found = []
    for one in _parts(annotation, "|"):
        problem = _wrong(value, _ALIASES[one]) if one in _ALIASES else _not_one(value, one)
        if problem is None:
            return None
        found.append(problem)
    # what comes nearest is right but for one of its entries
    within = [w for w in found if w.place]
    if within:
        return within[0]
    return _Wrong("", value, tuple(words for w in found for words in w.wanted)) if found else None


def _not_one(value: object, one: str) -> _Wrong | None:
    if one in _CLASSES:
        named = one in (c.__name__ for c in type(value).__mro__)
        return None if named else _Wrong("", value, (f"{_article(one)} {one}",))
    head, bracket, inner = one.partition("[")
    kind = one if one in _TYPES else head
    if kind not in _TYPES:
        return None
    accepts, words = _TYPES[kind]
    if not accepts(value):
        return _Wrong("", value, (words,))
    if not bracket or kind == one:
        return None
    arguments = _parts(inner.removesuffix("]"), ",")
    if isinstance(value, Mapping):
        for key, entry in value.items():
            if _wrong(key, arguments[0]) is not None:
                return _Wrong(f"[{key!r}]", key, ("keys that are texts",))
            problem = _wrong(entry, arguments[-1])
            if problem is not None:
                return _Wrong(f"[{key!r}]{problem.place}", problem.value, problem.wanted)
    # others may be read but once
    elif isinstance(value, list | tuple):
        for number, entry in enumerate(value):
            problem = _wrong(entry, arguments[0])
            if problem is not None:
                return _Wrong(f"[{number}]{problem.place}", problem.value, problem.wanted)
    return None


def _parts(annotation: str, mark: str) -> list[str]:
    """The parts of an annotation between marks that stand in no bracket."""
    parts, depth = [""], 0
    for sign in annotation:
        depth += (sign == "[") - (sign == "]")
        if sign == mark and not depth:
            parts.append("")
        else:
            parts[-1] += sign
    return [p.strip() for p in parts]
