"""Warnings of the functions themselves: superelements beyond their range, shared preloads."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from strutwork.errors import ModelWarning, ValidityWarning
from strutwork.fea import (
    ModalRatio,
    PartDamping,
    Port,
    complex_modes,
    frequency_response,
    minimum_dynamic_stiffness,
    modes,
    preloaded,
)
from strutwork.fea.least_stiffness import least_dynamic_stiffness
from strutwork.machines.model_file import parse_model, read_model
from strutwork.msa import LoadCase
from strutwork.reports.vibration import Target, target_modes, target_response
from strutwork.studies.model_damping import model_damping
from tests.model_files import SAMPLE, put, sample, toml
from tests.unit.test_fea_idle import with_block

CASES = Path(__file__).parents[1] / "cases" / "models"
DAMPING = ModalRatio(0.01)


def port() -> Port:
    return Port(parse_model(toml(SAMPLE)).placed.structure.linkage.tool or "", "z")


BEYOND: dict[str, Callable[[Any, float], object]] = {
    "modes": lambda placed, _: modes(placed, 40),
    "complex_modes": lambda placed, _: complex_modes(placed, PartDamping(DAMPING), 60),
    "frequency_response": lambda placed, top: frequency_response(
        placed, [port()], [port()], [1.0, top], DAMPING
    ),
    "least_dynamic_stiffness": lambda placed, top: least_dynamic_stiffness(
        placed, port(), port(), DAMPING, (1.0, top)
    ),
    "minimum_dynamic_stiffness": lambda placed, top: minimum_dynamic_stiffness(
        placed, [port()], DAMPING, (1.0, top)
    ),
}


@pytest.mark.parametrize("name", BEYOND)
def test_a_function_called_from_python_warns_of_a_superelement(name: str) -> None:
    with pytest.warns(ValidityWarning, match="granite 450 Hz") as caught:
        BEYOND[name](with_block(900.0), 451.0)
    # once, and where the user called it
    assert [Path(w.filename).name for w in caught] == ["test_fea_warnings.py"]


@pytest.mark.parametrize("name", ["frequency_response", "least_dynamic_stiffness"])
def test_within_its_range_nothing_is_said(name: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        BEYOND[name](with_block(900.0), 450.0)


def test_a_target_says_it_once() -> None:
    placed = with_block(900.0)
    target = Target("block", "b", placed, placed.structure.linkage.nodes, DAMPING)
    with pytest.warns(ValidityWarning) as caught:
        target_response(target, port(), port(), (1.0, 451.0), 10)
    assert len({str(w.message) for w in caught}) == 1
    with pytest.warns(ValidityWarning) as caught:
        target_modes(target, 40)
    assert len(caught) == 1


def test_modes_that_are_only_looked_at_say_nothing() -> None:
    """The modes behind the note on preloads are shown to nobody."""
    placed = with_block(1.0)
    force = LoadCase("push", ((placed.structure.linkage.tool or "", (1.0, 0, 0, 0, 0, 0)),))
    target = Target("block", "b", placed, placed.structure.linkage.nodes, DAMPING, (force,))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        target_response(target, port(), port(), (0.1, 0.5), 10)


@pytest.mark.parametrize(
    ("name", "case", "joints"),
    [
        ("door", "w", ("h1 in x", "h2 in x")),
        ("f2_four_rigid_blocks", "load", tuple(f"block{i} in" for i in range(4))),
    ],
)
def test_a_preload_that_rigid_joints_share_is_named(
    name: str, case: str, joints: tuple[str, ...]
) -> None:
    model = read_model(CASES / f"{name}.toml")
    with pytest.warns(ModelWarning, match=f"preload {case}: .* not determined") as caught:
        preloaded(model.placed, model.case(case))
    assert all(joint in str(caught[0].message) for joint in joints)
    assert len(caught) == 1


def test_a_preload_that_statics_gives_is_no_matter() -> None:
    model = read_model(CASES / "hanging_20beams.toml")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        preloaded(model.placed, model.cases[0])
        # nor one that loads what is shared with nothing
        door = read_model(CASES / "door.toml")
        preloaded(door.placed, replace(door.case("w"), wrenches=(), gravity=None, line_loads=()))


def test_loss_factors_of_materials_beside_a_damping_of_the_whole() -> None:
    lossy = put("materials.steel.loss_factor", 0.002)
    both = parse_model(toml(sample(lossy, put("damping", {"modal_ratio": 0.01}))))
    with pytest.warns(ModelWarning, match="material steel: the loss factor is not used") as caught:
        model_damping(both)
    assert len(caught) == 1
    alone = sample(lossy)
    alone.pop("damping", None)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert isinstance(model_damping(parse_model(toml(alone))), PartDamping)
