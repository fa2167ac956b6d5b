"""Parts of a compliance budget put together: directions of a joint, and parts alike by name."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

#: What parts are called, one and several.
KINDS = {
    "beam": ("beam", "beams"),
    "drive": ("drive", "drives"),
    "joint": ("joint", "joints"),
    "spring": ("spring", "springs"),
    "element": ("solid", "solids"),
}


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
        Of the tool's displacement.
    """

    kind: str
    members: tuple[str, ...]
    share: float

    @property
    def label(self) -> str:
        """`the drive ram`, or `the drives ram1 to ram6`."""
        one, several = KINDS.get(self.kind, ("part", "parts"))
        if len(self.members) == 1:
            return f"the {one} {self.members[0]}"
        return f"the {several} {self.members[0]} to {self.members[-1]}"

    @property
    def ending(self) -> str:
        """Of a verb after the label: one part gives, several give."""
        return "s" if len(self.members) == 1 else ""

    @property
    def pronoun(self) -> str:
        """`it makes`, or `they make`."""
        return "it makes" if len(self.members) == 1 else "they make"


def part_groups(shares: Mapping[str, float]) -> tuple[PartGroup, ...]:
    """Groups of parts, the largest share first.

    Parameters
    ----------
    shares : mapping of str to float
        Of `strutwork.msa.ComplianceBudget`: `beam ram1`, `drive slide:z`, `joint ball2:x`.

    >>> budget = {"drive leg1:z": 0.2, "drive leg2:z": 0.1}
    >>> budget |= {"joint ball:x": 0.3, "joint ball:y": 0.4}
    >>> [(g.label, round(g.share, 3)) for g in part_groups(budget)]
    [('the joint ball', 0.7), ('the drives leg1 to leg2', 0.3)]
    """
    members: dict[tuple[str, str], dict[str, float]] = {}
    for part, share in shares.items():
        kind, _, name = part.partition(" ")
        if kind in {"drive", "joint"}:
            name = name.rpartition(":")[0]
        alike = members.setdefault((kind, re.sub(r"\d+", "#", name)), {})
        alike[name] = alike.get(name, 0.0) + share
    groups = [PartGroup(kind, tuple(m), sum(m.values())) for (kind, _), m in members.items()]
    return tuple(sorted(groups, key=lambda g: -g.share))
