"""Dimensions out of proportion are named; millimetres taken for metres, mostly."""

from __future__ import annotations

import warnings
from dataclasses import fields, replace
from math import sqrt
from typing import Any

import pytest

from strutwork.errors import ModelError, ProportionWarning
from strutwork.kinematics import Poses
from strutwork.machines.catalogue import CATALOGUE
from strutwork.machines.model_file import parse_model
from strutwork.msa import tube

#: A fresh machine a test: a structure warns once.
NAMES = list(CATALOGUE)

#: Numbers that are not a size of the machine: stiffnesses, masses, angles and the model's own.
NO_SIZE = ("shortest_first_link", "shortest_column", "apparent_pole_height", "guide_range")


def sizes(machine: Any) -> list[str]:
    """Fields that hold one length of the machine."""
    return [
        f.name
        for f in fields(machine)
        if isinstance(getattr(machine, f.name), float)
        and not any(word in f.name for word in ("stiffness", "mass", "inertia", "factor"))
        and not any(word in f.name for word in ("ball", "preload", "_pair", "_turn"))
        and f.name not in NO_SIZE
    ]


@pytest.mark.parametrize("name", NAMES)
def test_machines_of_the_catalogue_are_in_proportion(name: str) -> None:
    machine = CATALOGUE[name].factory()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        machine.structure.at(machine.place(machine.home()))


@pytest.mark.parametrize("name", NAMES)
def test_a_length_in_millimetres_is_named(name: str) -> None:
    machine = CATALOGUE[name].factory()
    named = sizes(machine)
    assert len(named) >= 3
    for field in named:
        length = getattr(machine, field)
        with pytest.raises(ModelError, match=rf"{field}.*m, out of proportion[\s\S]*metres"):
            replace(machine, **{field: 1000.0 * length})


def test_a_machine_of_another_size_is_in_proportion() -> None:
    small = CATALOGUE["proposed-3pprs"].factory()
    for scale in (0.1, 10.0):
        replace(small, **{field: scale * getattr(small, field) for field in sizes(small)})


def test_sections_and_beams_that_do_not_fit() -> None:
    wrong = CATALOGUE["proposed-3pprs"].factory(section=tube(19, 14))
    placement = wrong.place(wrong.home())
    with pytest.warns(ProportionWarning, match=r'leg1/link is 0.216 m.*"tube" 19 m deep.*metres'):
        wrong.structure.at(placement)
    with warnings.catch_warnings():
        # once, not for every chunk of a sweep
        warnings.simplefilter("error")
        wrong.structure.at(placement)


def test_a_stub_in_a_machine_is_in_proportion() -> None:
    machine = CATALOGUE["proposed-3pprs"].factory(shortest_first_link=3e-5)
    # the height at which the sliders stand on the guide
    height = sqrt(machine.link_length**2 - 0.144**2)
    placement = machine.place(Poses.of([0.0, 0.0, height]))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        machine.structure.at(placement)


def cantilever(length: str, section: str, far: str = "") -> str:
    return f"""
[materials.steel]
youngs_modulus = "205 GPa"
poissons_ratio = 0.29
[sections.s]
{section}
[nodes]
A = [0, 0, 0]
B = [{length}, 0, 0]
{far}
[[beams]]
name = "arm"
from = "A"
to = "B"
material = "steel"
section = "s"
[[supports]]
node = "A"
fixed = "all"
"""


TUBE = 'shape = "tube"\nouter_diameter = 0.019\ninner_diameter = 0.014'
GIVEN = 'shape = "properties"\narea = 1.0\nIy = {0}\nIz = {0}\nJ = {0}'


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (cantilever("216", TUBE), "arm is 216 m long"),
        (cantilever("0.0001", TUBE), "0.019 m deep"),
        (cantilever("0.2", GIVEN.format(100.0)), "deep"),
        (cantilever("2000", 'shape = "rod"\ndiameter = 50'), "2000 m apart"),
    ],
)
def test_a_file_with_lengths_out_of_proportion_is_warned_of(text: str, words: str) -> None:
    with pytest.warns(ProportionWarning, match=words):
        parse_model(text).placed  # noqa: B018 - placing is what looks at the lengths


@pytest.mark.parametrize(
    "text",
    [
        cantilever("0.216", TUBE),
        # a stub in a machine, a wire, a bridge
        cantilever("0.005", TUBE),
        cantilever("1", 'shape = "rod"\ndiameter = 0.0005'),
        cantilever("400", 'shape = "rod"\ndiameter = 8'),
    ],
)
def test_stubs_wires_and_bridges_are_in_proportion(text: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parse_model(text).placed  # noqa: B018 - as above
