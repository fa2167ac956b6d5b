"""Parts of a compliance budget put together: directions of a joint, and parts alike by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.kinematics import DIRECTIONS
from strutwork.reports.alike import label, pattern, word

#: What parts are called, one and several.
KINDS = {
    "beam": ("beam", "beams"),
    "drive": ("drive", "drives"),
    "joint": ("joint", "joints"),
    "spring": ("spring", "springs"),
    "element": ("solid", "solids"),
}

#: Groups told apart in a chart where these leave little.
LARGEST = 7

#: Name of what is left when the largest are told apart.
REST = "all others"


@dataclass(frozen=True)
class PartGroup:
    """Parts of one kind whose names differ by their numbers alone.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    members : tuple of str
        Names as the user gave them.
    share : float
        Of the tool's displacement; of several forces the largest.
    rows : tuple of str
        Names in the budget.
    shares : (...)
        Of each force.
    """

    kind: str
    members: tuple[str, ...]
    share: float
    rows: tuple[str, ...] = ()
    shares: NDArray[Any] | float = 0.0

    @property
    def label(self) -> str:
        """`the drive ram`, or `the drives ram1 to ram6`."""
        one, several = KINDS.get(self.kind, ("part", "parts"))
        if len(self.members) == 1:
            return f"the {one} {self.members[0]}"
        return f"the {several} {self.members[0]} to {self.members[-1]}"

    @property
    def title(self) -> str:
        """`ram`, or of several `rams`: as a chart and a table name them."""
        return word(self.members) or label(self.members)

    @property
    def ending(self) -> str:
        """Of a verb after the label: one part gives, several give."""
        return "s" if len(self.members) == 1 else ""

    @property
    def pronoun(self) -> str:
        """`it makes`, or `they make`."""
        return "it makes" if len(self.members) == 1 else "they make"


def part_groups(shares: Mapping[str, ArrayLike]) -> tuple[PartGroup, ...]:
    """Groups of parts, the largest share first.

    Parameters
    ----------
    shares : mapping of str to (...)
        Of `strutwork.msa.ComplianceBudget`: `beam ram1`, `drive slide:z`, `joint ball2:x`; one
        number, or one for each force.

    >>> budget = {"drive leg1:z": 0.2, "drive leg2:z": 0.1}
    >>> budget |= {"joint ball:x": 0.3, "joint ball:y": 0.4}
    >>> [(g.label, g.title, round(g.share, 3)) for g in part_groups(budget)]
    [('the joint ball', 'ball', 0.7), ('the drives leg1 to leg2', 'legs', 0.3)]
    """
    members: dict[tuple[str, str], dict[str, list[str]]] = {}
    for part in shares:
        kind, name, _ = split(part)
        alike = members.setdefault((kind, pattern(name)), {})
        alike.setdefault(name, []).append(part)
    groups = []
    for (kind, _), named in members.items():
        rows = tuple(row for rows in named.values() for row in rows)
        total = np.sum([np.asarray(shares[row], dtype=float) for row in rows], axis=0)
        groups.append(PartGroup(kind, tuple(named), float(np.max(total)), rows, total))
    return tuple(sorted(groups, key=lambda g: -g.share))


def split(part: str) -> tuple[str, str, str]:
    """Kind, name and direction of a part of a budget; no direction where it has none.

    >>> split("joint mount 4:z"), split("beam arm")
    (('joint', 'mount 4', 'z'), ('beam', 'arm', ''))
    """
    kind, _, name = part.partition(" ")
    stem, mark, direction = name.rpartition(":")
    if kind in {"drive", "joint"} and mark and direction in DIRECTIONS:
        return kind, stem, direction
    return kind, name, ""


def titles(groups: tuple[PartGroup, ...]) -> tuple[str, ...]:
    """Names of groups, each another: with the kind of part where two would be the same."""
    plain = [group.title for group in groups]
    found = []
    for group, title in zip(groups, plain, strict=True):
        kind = KINDS.get(group.kind, ("part", "parts"))[len(group.members) > 1]
        found.append(f"{kind} {title}" if plain.count(title) > 1 else title)
    return tuple(found)


def told_apart(shares: Mapping[str, ArrayLike], most: int = LARGEST) -> dict[str, NDArray[Any]]:
    """The largest shares by name, and the rest as one that is nowhere the largest.

    Parameters
    ----------
    shares : mapping of str to (n,)
        Percent, of n forces.
    most : int
        So many are told apart; more where the rest would hide a larger share than the largest.

    >>> shares = {"a": [50.0], "b": [20.0], "c": [18.0], "d": [12.0]}
    >>> {name: float(v[0]) for name, v in told_apart(shares, 1).items()}
    {'a': 50.0, 'all others': 50.0}
    >>> list(told_apart(shares | {"a": [10.0], "e": [40.0]}, 1))
    ['e', 'b', 'all others']
    """
    values = {name: np.atleast_1d(np.asarray(v, dtype=float)) for name, v in shares.items()}
    order = sorted(values, key=lambda name: -float(values[name].max()))
    number = min(most, len(order))
    while number < len(order):
        rest = np.sum([values[name] for name in order[number:]], axis=0)
        largest = np.max([values[name] for name in order[:number]], axis=0)
        if np.all(rest <= largest):
            break
        number += 1
    found = {name: values[name] for name in order[:number]}
    if number < len(order):
        found[REST] = np.sum([values[name] for name in order[number:]], axis=0)
    return found
