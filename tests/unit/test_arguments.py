"""Wrong arguments of the public methods: the nearest option, the type, the remedy."""

from __future__ import annotations

import inspect
import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import strutwork as sw
from strutwork.arguments import TAKERS, checked
from strutwork.errors import ModelError
from strutwork.front import QUESTIONS, Machine

HEAD = Path(__file__).parents[2] / "examples/machines/3-rps.toml"
RAM = "sections.ram.diameter"
RANGE = {RAM: (0.04, 0.05)}


@pytest.fixture(scope="module")
def machine() -> Machine:
    return sw.load(HEAD)


Call = Callable[[Machine], object]

MISSPELT: list[tuple[Call, str]] = [
    (lambda m: m.study(RANGE, cuont=4), 'study: has no option "cuont".\nDid you mean "count"'),
    (lambda m: m.design(RANGE, "mass", populatoin=40), 'Did you mean "population"'),
    (lambda m: m.function([RAM], ["mass"], posses={}), 'Did you mean "poses"'),
    (lambda m: m.survey(wokers=2), 'Did you mean "workers"'),
    (lambda m: m.compare(m, treshold=0.1), 'Did you mean "threshold"'),
    (lambda m: m.calibrate([RAM], start=3), 'Did you mean "starts"'),
    (lambda m: m.closed_loop(dampng=0.1), 'Did you mean "damping"'),
    (lambda m: m.state_space([], [], mode=3), 'Did you mean "modes"'),
    (lambda m: m.modes(cuont=3), 'modes: has no option "cuont"'),  # type: ignore[call-arg]
    (lambda m: m.gradient(bye=[RAM]), 'Did you mean "by"'),  # type: ignore[call-arg]
]

TYPES: list[tuple[Call, str]] = [
    (lambda m: m.study(RANGE, count="many"), "count: is a str, 'many', in study.\nGive a whole"),
    (lambda m: m.study(RANGE, count=4.5), "count: is a float, 4.5"),
    (lambda m: m.study(RANGE, count=True), "count: is a bool, True"),
    (lambda m: m.study(RANGE, reductions="worst"), "Give a list"),
    (lambda m: m.study([3]), r"parameters\[0\]: is an int, 3"),  # type: ignore[list-item]
    (lambda m: m.design(RANGE, "mass", population="40"), "population: is a str"),
    (lambda m: m.design(RANGE, "mass", band=5), "Give a pair of numbers or None"),
    (lambda m: m.design(RANGE, "mass", cost=3), "Give a Cost or None"),
    (lambda m: m.design(RANGE, 3), "objectives: is an int"),  # type: ignore[arg-type]
    (lambda m: m.design(RANGE, "mass", at_least={3: 4}), "Give keys that are texts"),
    (lambda m: m.changed({RAM: None}), rf"numbers\['{RAM}'\]: is None in changed"),  # type: ignore[dict-item]
    (lambda m: m.at(x=[3]), "x: is a list"),  # type: ignore[arg-type]
    (lambda m: m.survey({"x": "a"}), r"over\['x'\]: is a str"),
    (lambda m: m.modes("3"), "count: is a str"),  # type: ignore[arg-type]
    (lambda m: m.plot(case=3), "case: is an int"),  # type: ignore[arg-type]
    (lambda m: m.study(RANGE, progress=3), "Give a function or None"),
]


@pytest.mark.parametrize(("call", "message"), [*MISSPELT, *TYPES])
def test_wrong_arguments_name_the_remedy(machine: Machine, call: Call, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        call(machine)


def test_arguments_too_many_and_too_few(machine: Machine) -> None:
    with pytest.raises(ModelError, match=r"Call modes\(count=10\)"):
        machine.modes(3, 4)  # type: ignore[call-arg]
    with pytest.raises(ModelError, match="missing a required argument: 'parameters'"):
        machine.study()  # type: ignore[call-arg]
    with pytest.raises(ModelError, match="name: is an int, 3, in load"):
        sw.load(3)  # type: ignore[arg-type]


def test_what_is_right_passes(machine: Machine) -> None:
    """Numbers of NumPy, pairs as lists, entries that only the taker knows."""

    @checked
    def take(count: int, band: tuple[float, float] | None = None, *, more: object = 3) -> object:
        return count, band, more

    assert take(np.int64(3), [np.float64(1.0), 2]) == (3, [1.0, 2], 3)  # type: ignore[arg-type]
    assert take(3, None, more={}) == (3, None, {})
    assert machine.changed({RAM: np.float64(0.045)}).structure is not machine.structure


def test_methods_keep_their_faces(machine: Machine) -> None:
    assert list(inspect.signature(Machine.modes).parameters) == ["self", "count"]
    assert set(TAKERS) <= set(QUESTIONS)
    for name in QUESTIONS:
        kinds = {p.kind for p in inspect.signature(getattr(Machine, name)).parameters.values()}
        # options that a method hands on are known by name, but for the directions of a pose
        assert (inspect.Parameter.VAR_KEYWORD in kinds) == (name in TAKERS or name == "at")
    assert pickle.loads(pickle.dumps(machine)).title == machine.title  # noqa: S301
