"""Numbers of a path with a star, in groups that vary independently of one another."""

from __future__ import annotations

import re
from collections.abc import Sequence

from strutwork.machines.model_numbers import Number
from strutwork.studies.parametric import Parametric


def groups(
    machine: Parametric, paths: Sequence[str]
) -> tuple[tuple[str, str, tuple[Number, ...]], ...]:
    """The numbers of paths, grouped by what stands for their first star.

    `joints.ball*.stiffness.*` gives a group for each joint, in which the directions change
    together.

    Parameters
    ----------
    machine : Parametric
    paths : sequence of str

    Returns
    -------
    tuple of (name, match, numbers)
        The path with its first star replaced, what replaced it, and what it changes. A path without
        a star is a group of its own.

    Raises
    ------
    ModelError
        As `Parametric.matching`.
    """
    names: dict[str, tuple[str, str]] = {}
    found: dict[str, dict[str, Number]] = {}
    for path in paths:
        head, star, tail = path.partition("*")
        pattern = re.compile(re.escape(head) + "(.*?)" + ".*".join(map(re.escape, tail.split("*"))))
        for number in machine.matching(path):
            match = pattern.fullmatch(number.path) if star else None
            words = match[1] if match else ""
            # directions of one joint that several paths name stay together
            key = head + words
            names.setdefault(key, (path.replace("*", words, 1), words or path))
            found.setdefault(key, {})[number.path] = number
    return tuple((*names[key], tuple(numbers.values())) for key, numbers in found.items())
