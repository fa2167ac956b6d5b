"""Mutants of model files, each made from its number alone."""

from __future__ import annotations

import random
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.model_files import SAMPLE, toml

ROOT = Path(__file__).parents[2]

#: Larger files only take longer: what they hold stands in small ones too.
LARGEST_SEED = 20_000

Place = tuple[Any, Any]
Mutation = Callable[[Any, random.Random], object]

NUMBERS = (
    *(0, 0.0, -0.0, 1, -1, 2, 1e-300, 5e-324, 1e-30, 1e-9, 1e9, 1e30, 1e150, 1e300, -1e300),
    *(1.7976931348623157e308, float("inf"), float("-inf"), float("nan"), 10**400, -(2**63)),
)
WORDS = (
    *("", " ", "x", "all", "none", "TCP", "0", "1e300 m", "-3 mm", "nan", "inf m", "5 kg", "1 N/m"),
    *(
        "-1 GPa",
        "3 deg",
        "1e999",
        "1/0",
        "m",
        "a" * 100,
        "a" * 4000,
        "=1+1",
        "[red]",
        "<b>&",
        "日本",
    ),
    *("../../etc/passwd", "/dev/zero", "\u202e", "\u0000", "\x1b[31m", "%{x}", "{0}", "'\"", "\n"),
)
THINGS = (True, False, [], {}, [[]], [0, 0, 0], {"x": 1}, ["x"], [1e300] * 3, "2020-01-01")


@dataclass(frozen=True)
class Mutant:
    """A model file that somebody may have written, and where it came from."""

    number: int
    seed: str
    text: str
    steps: tuple[str, ...]


def seeds() -> dict[str, str]:
    """The files that are mutated, by name."""
    folders = (
        "examples",
        "examples/bearings",
        "examples/machines",
        "tests/cases/models",
        "tests/cases/robustness",
        "tests/cases/tol",
    )
    files = (path for folder in folders for path in sorted((ROOT / folder).glob("*.toml")))
    found = {path.stem: path.read_text(encoding="utf-8") for path in files}
    found["sample"] = toml(SAMPLE)
    return {name: text for name, text in found.items() if len(text) <= LARGEST_SEED}


def mutant(number: int, texts: dict[str, str]) -> Mutant:
    """The mutant of a number; the same whenever it is asked for."""
    rng = random.Random(f"mutant {number}")  # noqa: S311 - the same mutants every time
    name = rng.choice(sorted(texts))
    if rng.random() < 0.1:
        return Mutant(number, name, _scribbled(texts[name], rng), ("text",))
    content = tomllib.loads(texts[name])
    steps = []
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        step = rng.choice(MUTATIONS)
        step(content, rng)
        steps.append(step.__name__)
    return Mutant(number, name, toml(content), tuple(steps))


def _places(value: Any) -> Iterator[Place]:
    """Every field of the content, as the table or list that holds it and its key."""
    keys = list(value) if isinstance(value, dict) else range(len(value))
    for key in keys:
        yield value, key
        if isinstance(value[key], dict | list):
            yield from _places(value[key])


def _pick(content: Any, rng: random.Random, kinds: type | tuple[type, ...] = object) -> Place:
    found = [p for p in _places(content) if isinstance(p[0][p[1]], kinds)]
    return rng.choice(found) if found else (content, "title")


def number(content: Any, rng: random.Random) -> None:
    """A number of another size."""
    table, key = _pick(content, rng, (int, float))
    old = table.get(key, 0) if isinstance(table, dict) else table[key]
    factor = rng.choice((-1, 0.999999, 1e-12, 1e-6, 1e-3, 1e3, 1e6, 1e12, 1e150))
    try:
        scaled = old * factor if isinstance(old, int | float) else 0
    except OverflowError:
        # an integer of hundreds of digits, from an earlier step
        scaled = old
    table[key] = rng.choice((rng.choice(NUMBERS), scaled))


def quantity(content: Any, rng: random.Random) -> None:
    """A quantity of another size or unit."""
    table, key = _pick(content, rng, str)
    value = rng.choice((*NUMBERS[:-2], 10, 0.3))
    unit = rng.choice(("m", "mm", "um", "N", "N/m", "N/um", "kg", "GPa", "deg", "kg/m^3", "K", ""))
    table[key] = f"{value} {unit}".strip()


def word(content: Any, rng: random.Random) -> None:
    """A text in place of another, or of one that stands elsewhere."""
    table, key = _pick(content, rng, str)
    other, at = _pick(content, rng, str)
    table[key] = rng.choice(
        (rng.choice(WORDS), other.get(at, "x") if isinstance(other, dict) else other[at])
    )


def kind(content: Any, rng: random.Random) -> None:
    """A value of another kind."""
    table, key = _pick(content, rng)
    table[key] = rng.choice((*THINGS, rng.choice(NUMBERS), rng.choice(WORDS)))


def removed(content: Any, rng: random.Random) -> None:
    """A field or a table that is missing."""
    table, key = _pick(content, rng)
    if isinstance(table, dict):
        table.pop(key, None)
    else:
        del table[key]


def repeated(content: Any, rng: random.Random) -> None:
    """A table that stands twice."""
    table, key = _pick(content, rng, list)
    value = table.get(key) if isinstance(table, dict) else table[key]
    if isinstance(value, list) and value:
        value.append(rng.choice(value))


def renamed(content: Any, rng: random.Random) -> None:
    """A key misspelt, or the name of a node changed."""
    table, key = _pick(content, rng)
    if isinstance(table, dict) and key in table:
        table[rng.choice((*WORDS, key + "s", key.upper()))] = table.pop(key)


def moved(content: Any, rng: random.Random) -> None:
    """A node at the place of another, or far away."""
    nodes = content.get("nodes")
    if not isinstance(nodes, dict) or not nodes:
        return
    names = sorted(nodes)
    far = [rng.choice((0, 1e-12, 1e300, 1e12, "1e5 km")) for _ in range(3)]
    nodes[rng.choice(names)] = rng.choice((nodes[rng.choice(names)], far))


def swapped(content: Any, rng: random.Random) -> None:
    """Two values that change places."""
    (one, a), (two, b) = _pick(content, rng), _pick(content, rng)
    try:
        first, second = one[a], two[b]
    except (KeyError, IndexError):
        return
    # a value put inside itself is no file
    if not isinstance(first, dict | list) and not isinstance(second, dict | list):
        one[a], two[b] = second, first


MUTATIONS: tuple[Mutation, ...] = (
    *(number, number, number, quantity, quantity, word, kind, removed, removed),
    *(repeated, renamed, moved, swapped),
)


def _scribbled(text: str, rng: random.Random) -> str:
    """A text with a stretch or a line changed."""
    lines = text.splitlines(keepends=True)
    for _ in range(rng.choice((1, 1, 3))):
        at = rng.randrange(len(lines))
        how = rng.randrange(4)
        if how == 0:
            del lines[at]
        elif how == 1:
            lines.insert(at, rng.choice(lines))
        elif how == 2:
            lines[at] = lines[at].replace(rng.choice('=[]{}",.#0123456789'), rng.choice('[]="e-9'))
        else:
            lines[at] = lines[at][: rng.randrange(len(lines[at]) + 1)]
        lines = lines or ["x\n"]
    return "".join(lines)
