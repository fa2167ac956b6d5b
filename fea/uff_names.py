"""Names of nodes within the 40 characters that a universal file has for them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from hashlib import sha256

from strutwork.fea.uff import UniversalFile
from strutwork.names import visible

#: Group names of data set 2467 have this many characters.
LONGEST_NAME = 40

#: Digits of the hash that end a name cut short; 4e9 names are told apart.
DIGITS = 8


def fits(name: str) -> bool:
    """Whether a name can be written as it is, and read back.

    Parameters
    ----------
    name : str
    """
    # -1 parts data sets
    return (
        0 < len(name) <= LONGEST_NAME
        and name == name.strip()
        and name.isprintable()
        and name != "-1"
    )


def fitted_names(names: Iterable[str]) -> dict[str, str]:
    """What each name is written as: itself where it fits, else its start and a hash of the whole.

    Parameters
    ----------
    names : iterable of str

    Returns
    -------
    dict of str to str
        Different for different names, and the same in every file: `a name of a node too lo~0f3c…`
        ends in the first eight digits of the SHA-256 of its UTF-8.
    """
    given = list(dict.fromkeys(names))
    found = {name: name for name in given if fits(name)}
    taken = set(found)
    for name in given:
        if name in found:
            continue
        seed = name
        while (label := _label(name, seed)) in taken:
            # a name that looks like the label of another keeps it
            seed += "~"
        found[name] = label
        taken.add(label)
    return found


def with_fitted_names(content: UniversalFile) -> UniversalFile:
    """The same content with the names that a file can hold.

    Parameters
    ----------
    content : UniversalFile
    """
    to = fitted_names(content.nodes)
    if all(name == written for name, written in to.items()):
        return content
    return replace(
        content,
        functions=tuple(
            replace(f, output=(to[f.output[0]], f.output[1]), input=(to[f.input[0]], f.input[1]))
            for f in content.functions
        ),
        modes=tuple(replace(m, nodes=tuple(to[n] for n in m.nodes)) for m in content.modes),
        positions={to[n]: place for n, place in content.positions.items()},
        lines=tuple((to[a], to[b]) for a, b in content.lines),
    )


def _label(name: str, seed: str) -> str:
    start = visible(name).strip()[: LONGEST_NAME - DIGITS - 1]
    start = "".join(c if c.isprintable() else "_" for c in start)
    digest = sha256(seed.encode("utf-8", "surrogateescape")).hexdigest()
    return f"{start}~{digest[:DIGITS]}"
