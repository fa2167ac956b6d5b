"""Names that differ by their numbers alone, and rows that differ by their names alone."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

#: So many names are listed one by one.
LISTED = 3

#: Shown where the members of a group have different values.
DIFFERS = "one for each"


def pattern(name: str) -> str:
    """A name with every number as one mark: names alike have the same."""
    return re.sub(r"\d+", "#", name)


def label(names: Sequence[str]) -> str:
    """Names alike in a few words.

    >>> label(["strut 1"]), label(["leg1/slide", "leg2/slide"])
    ('strut 1', 'leg1/slide, leg2/slide')
    >>> label([f"mount {k}" for k in range(1, 13)])
    'mount 1 to mount 12 (12)'
    """
    if len(names) <= LISTED:
        return ", ".join(names)
    return f"{names[0]} to {names[-1]} ({len(names)})"


def word(names: Sequence[str]) -> str:
    """What names alike have in common, as several: `mounts` for mount 1 to mount 12.

    Empty where they have no word before their number in common.

    >>> word(["mount 1", "mount 2"]), word(["leg1/slide", "leg2/slide"]), word(["1", "2"])
    ('mounts', 'slide of the legs', '')
    """
    if len(names) < 2 or len({pattern(name) for name in names}) > 1:
        return ""
    before, *rest = re.split(r"\d+", names[0])
    stem, after = (re.sub(r"[\W_]+", " ", part).strip() for part in (before, "#".join(rest)))
    # a letter is no word
    if len(stem) < 3:
        return ""
    several = stem if stem.endswith("s") else f"{stem}s"
    return f"{after} of the {several}" if after else several


@dataclass(frozen=True)
class Alike:
    """Things alike.

    Parameters
    ----------
    names : tuple of str
    cells : tuple of str
        What they have in common; `DIFFERS` where a loose cell does not agree.
    """

    names: tuple[str, ...]
    cells: tuple[str, ...]

    @property
    def label(self) -> str:
        """Their names in a few words."""
        return label(self.names)


def grouped(rows: Mapping[str, Sequence[str]], loose: Sequence[int] = ()) -> tuple[Alike, ...]:
    """Rows put together whose names and cells are alike, in the order of their first.

    Parameters
    ----------
    rows : mapping of name to cells
    loose : sequence of int
        Cells that may differ within a group.

    >>> rows = {"rod 1": ["steel"], "rod 2": ["steel"], "rod 3": ["brass"]}
    >>> [(g.label, g.cells) for g in grouped(rows)]
    [('rod 1, rod 2', ('steel',)), ('rod 3', ('brass',))]
    """
    found: dict[tuple[str, ...], list[str]] = {}
    for name, cells in rows.items():
        tight = [c for i, c in enumerate(cells) if i not in loose]
        found.setdefault((pattern(name), *tight), []).append(name)
    groups = []
    for names in found.values():
        columns = zip(*(rows[name] for name in names), strict=True)
        cells = tuple(c[0] if len(set(c)) == 1 else DIFFERS for c in columns)
        groups.append(Alike(tuple(names), cells))
    return tuple(groups)
