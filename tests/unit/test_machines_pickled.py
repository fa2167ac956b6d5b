"""Machines and models travel: to other processes, and back the same."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest

from strutwork.machines import CATALOGUE, named_machine
from strutwork.machines.load import load

ROOT = Path(__file__).parents[2]
FILES = sorted([*ROOT.glob("examples/*.toml"), *ROOT.glob("examples/machines/*.toml")])
NAMES = [f"{entry.name}" for entry in CATALOGUE.values()]


@pytest.mark.parametrize("name", [*NAMES, *(str(p.relative_to(ROOT)) for p in FILES)])
def test_a_model_travels(name: str) -> None:
    model = load(name if name in NAMES else str(ROOT / name))
    before = model.structure.segments
    # with what it has computed and kept of itself
    there = pickle.loads(pickle.dumps(model))  # noqa: S301 - our own
    assert repr(there) == repr(model)
    assert len(there.structure.segments) == len(before)
    back = there.structure.at(there.placement)
    assert back.placement.values.tobytes() == model.placement.values.tobytes()


@pytest.mark.parametrize("name", NAMES)
def test_a_named_machine_travels(name: str) -> None:
    found = named_machine(name)
    there = pickle.loads(pickle.dumps(found))  # noqa: S301 - our own
    assert there.name == found.name
    assert type(there.machine) is type(found.machine)
    home, other = (m.place(m.home()) for m in (found.machine, there.machine))
    assert home.values.tobytes() == other.values.tobytes()
