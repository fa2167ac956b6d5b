"""Which numbers measurements do not tell apart, and what of them they do determine."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.names import listed
from strutwork.studies.experiment import Experiment
from strutwork.studies.identifiability import Identifiability

Array = NDArray[Any]

#: Weights of a combination below this share of its largest take no part in it.
SMALL = 0.05

#: Weights that differ by less, as a share, are those of a law.
SAME = 0.02

#: Factor by which a number is moved along a law to see whether the measurements notice.
MOVED = 1.3

#: Sum of the squared residuals may change by so much, as a share of what the same move alone does.
UNNOTICED = 1e-3


@dataclass(frozen=True)
class Undetermined:
    """Numbers that the measurements do not tell apart.

    Parameters
    ----------
    names : tuple of str
        Those that take part.
    law : str
        What the measurements determine of them, as in `1/a + 1/b`; empty where nothing simple is.
    words : str
        The sentence for a reader.
    """

    names: tuple[str, ...]
    law: str
    words: str

    def to_dict(self) -> dict[str, Any]:
        """Plain values."""
        return {"names": list(self.names), "law": self.law, "words": self.words}


def undetermined(
    experiment: Experiment, point: Array, identified: Identifiability
) -> tuple[Undetermined, ...]:
    """Name the groups of unknowns of which the measurements determine combinations only.

    Parameters
    ----------
    experiment : Experiment
    point : (g,)
        Best scaled numbers, no unit.
    identified : Identifiability
        Of the measurements alone.
    """
    null = identified.directions[identified.rank :]
    if not len(null):
        return ()
    return tuple(
        _group(experiment, point, rows, members) for rows, members in _groups(_sparse(null))
    )


def _sparse(null: Array) -> Array:
    """The same space by rows with as many zeros as Gauss and Jordan find."""
    rows = null.copy()
    done: list[int] = []
    for i in range(len(rows)):
        free = [k for k in range(rows.shape[1]) if k not in done]
        k = free[int(np.argmax(np.abs(rows[i, free])))]
        rows[i] /= rows[i, k]
        for j in range(len(rows)):
            if j != i:
                rows[j] -= rows[j, k] * rows[i]
        done.append(k)
    return np.asarray(rows / np.abs(rows).max(axis=1, keepdims=True))


def _groups(rows: Array) -> list[tuple[Array, list[int]]]:
    """Rows that share an unknown together."""
    left = list(range(len(rows)))
    found = []
    takes = np.abs(rows) > SMALL
    while left:
        some = [left.pop(0)]
        members = takes[some[0]].copy()
        while near := [i for i in left if np.any(takes[i] & members)]:
            some += near
            left = [i for i in left if i not in near]
            members |= takes[near].any(axis=0)
        found.append((rows[some][:, members], np.flatnonzero(members).tolist()))
    return found


def _group(experiment: Experiment, point: Array, rows: Array, members: list[int]) -> Undetermined:
    names = tuple(experiment.names[k] for k in members)
    if len(members) == 1:
        words = f"The measurements do not determine {names[0]}: it hardly changes them."
        return Undetermined(names, "", words)
    values = experiment.values(point)[members]
    law = _law(experiment, point, rows, members, values, names)
    if law:
        words = f"The measurements do not tell {listed(names)} apart: they determine only {law}."
        return Undetermined(names, law, words)
    if len(rows) == len(members):
        words = f"The measurements determine none of {listed(names)}."
        return Undetermined(names, "", words)
    steps = [
        f"{name} by {_percent(w)}" for name, w in zip(names, rows[0], strict=True) if abs(w) > SMALL
    ]
    words = (
        f"The measurements do not tell {listed(names)} apart: they hardly change when "
        f"{listed(steps)} change together"
        + (f", and in {len(rows) - 1} more ways" if len(rows) > 1 else "")
        + "."
    )
    return Undetermined(names, "", words)


def _percent(weight: float) -> str:
    return f"{'+' if weight > 0 else '−'}{10 * abs(weight):.1f} %"


def _law(
    experiment: Experiment,
    point: Array,
    rows: Array,
    members: list[int],
    values: Array,
    names: Sequence[str],
) -> str:
    """What is determined of the group, where it is a sum, a product or ratios of its numbers."""
    logs = all(experiment.unknowns[k].parameter.scale == "log" for k in members)
    if not logs:
        return ""
    if len(rows) == 1 and np.allclose(rows[0], rows[0, 0], rtol=SAME) and len(members) > 1:
        text = f"{names[0]} / {names[1]}" if len(members) == 2 else f"ratios of {listed(names)}"
        return text if _unnoticed(experiment, point, members, lambda v: v * MOVED) else ""
    if len(rows) != len(members) - 1:
        return ""
    # the one direction that is determined is the gradient of the law in logarithms
    gradient = np.linalg.svd(rows)[2][-1]
    gradient = gradient / gradient[int(np.abs(gradient).argmax())]
    for text, law, solved in _laws(values, names):
        same = law / law[int(np.abs(gradient).argmax())]
        near = np.allclose(gradient, same, rtol=SAME, atol=SAME)
        if near and _unnoticed(experiment, point, members, solved):
            return text
    return ""


def _laws(values: Array, names: Sequence[str]) -> list[tuple[str, Array, Callable[[Array], Array]]]:
    """Each law with its gradient in logarithms, and numbers moved along it."""

    def series(v: Array) -> Array:
        left = np.sum(1.0 / v) - np.sum(1.0 / (MOVED * v[:-1]))
        return np.array([*(MOVED * v[:-1]), 1.0 / left])

    def parallel(v: Array) -> Array:
        return np.array([*(v[:-1] / MOVED), np.sum(v) - np.sum(v[:-1] / MOVED)])

    def product(v: Array) -> Array:
        return np.array([*(MOVED * v[:-1]), v[-1] / MOVED ** (len(v) - 1)])

    return [
        (" + ".join(f"1/{n}" for n in names), 1.0 / values, series),
        (" + ".join(names), values, parallel),
        (" × ".join(names), np.ones(len(values)), product),
    ]


def _unnoticed(
    experiment: Experiment, point: Array, members: list[int], along: Callable[[Array], Array]
) -> bool:
    """Whether measurements stay as they are along a law, and change where one moves alone."""
    here = experiment.values(point)

    def change(values: Array) -> float:
        if not np.all(np.isfinite(values)) or np.any(values <= 0):
            return np.inf
        moved = here.copy()
        moved[members] = values
        return sum(
            float(np.sum(((a - b) / m.scatter) ** 2))
            for m, a, b in zip(
                experiment.measurements,
                experiment.computed(moved),
                experiment.computed(here),
                strict=True,
            )
        )

    alone = here[members].copy()
    alone[0] *= MOVED
    return change(along(here[members])) <= UNNOTICED * max(change(alone), 1e-12)
