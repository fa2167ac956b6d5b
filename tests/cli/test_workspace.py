"""`strutwork workspace`: what it prints, its files, and questions that it refuses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import Program
from tests.shaped_arm import written

OVER = ("--over", "x=-30mm..30mm:9,y=-30mm..30mm:9")


def test_words_and_numbers_agree(strutwork: Program, tmp_path: Path) -> None:
    found = strutwork("workspace", "proposed-3pprs", *OVER, "--json").result
    assert found["unit"] == "m²"
    assert 0.0 < found["error"] < 0.2 * found["measure"]
    assert sum(found["border"].values()) == pytest.approx(1.0)
    assert found["home"]["component"] == 1
    assert found["components"][0]["home"]
    assert found["poses"] == 81
    run = strutwork("workspace", "proposed-3pprs", *OVER, "--out", tmp_path)
    assert f"Area {1e4 * found['measure']:.4g} ± {1e4 * found['error']:.2g} cm²" in run.out
    for path in tmp_path.iterdir():
        assert str(path.name) in run.out
    assert {p.suffix for p in tmp_path.iterdir()} == {".nc", ".csv"}
    near = found["nearest"]
    assert near["reason"] in run.out
    assert near["distance"] == pytest.approx(np.hypot(*near["at"].values()))


def test_the_largest_box_about_home(strutwork: Program) -> None:
    ask = ("workspace", "proposed-3pprs", *OVER, "--largest", "box", "--around", "x=0mm,y=0mm")
    found = strutwork(*ask, "--proportions", "2:1", "--json").result
    big = found["largest"]
    assert big["sides"]["x"] == pytest.approx(2 * big["sides"]["y"])
    assert big["centre"] == {"x": 0.0, "y": 0.0}
    assert 0.0 < big["measure"] == pytest.approx(np.prod([*big["sides"].values()]))
    assert big["measure"] < found["measure"]
    assert big["confirmed"] == 81**2
    # its critical point is on its border, and ends the workspace by what is told
    shares = [2 * abs(big["critical"][d]) / big["sides"][d] for d in "xy"]
    assert max(shares) == pytest.approx(1.0, rel=1e-6)
    assert big["reason"] in found["border"]


def test_a_bound_on_stiffness_shrinks_it(strutwork: Program) -> None:
    ask = ("workspace", "proposed-3pprs", *OVER, "--json")
    free = strutwork(*ask).result
    held = strutwork(*ask, "--stiffness", "0.26 N/um").result
    assert 0.0 < held["measure"] < free["measure"]
    assert any(words.startswith("stiffness in the softest") for words in held["border"])


def test_tilts_shrink_it(strutwork: Program) -> None:
    measures = [
        strutwork("workspace", "proposed-3pprs", *OVER, *options, "--json").result["measure"]
        for options in ((), ("--tilt", "10deg"), ("--dexterous", "10deg", "--azimuths", "6"))
    ]
    assert 0.0 < measures[2] < measures[1]
    assert measures[2] < measures[0]


def test_a_direction_with_one_value_is_where_the_tool_is_put(strutwork: Program) -> None:
    low, high = (
        strutwork("workspace", "proposed-3pprs", "--over", f"x=-30mm..30mm:41,z={z}mm", "--json")
        for z in (120, 140)
    )
    assert low.result["measure"] != pytest.approx(high.result["measure"], rel=1e-3)
    assert low.result["grid"] == {"x": [-0.03, 0.03, 41]}


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--over", "x=-30mm..30mm:10"), "odd number"),
        (("--over", "x=-1mm..1mm:5,y=-1mm..1mm:5,z=0mm..1mm:5,rx=0deg..1deg:5"), "one, two or"),
        ((*OVER, "--tilt", "30mm"), "--tilt"),
        ((*OVER, "--spare", "roll"), "--spare"),
        ((*OVER, "--spare", "x=0mm..1mm"), "direction of the grid"),
        ((*OVER, "--largest", "cylinder"), "cylinder"),
        ((*OVER, "--largest", "box", "--proportions", "1:0"), "--proportions"),
        ((*OVER, "--largest", "box", "--around", "z=0mm"), "--around"),
        ((*OVER, "--radius", "200mm"), "interfere at home"),
        ((*OVER, "--conditioning", "2"), "conditioning"),
        ((*OVER, "--amplification", "3..x"), "--amplification"),
        ((*OVER, "--stiffness", "20 N/um"), "home does not meet"),
    ],
)
def test_what_cannot_be_asked(strutwork: Program, options: tuple[str, ...], words: str) -> None:
    run = strutwork("workspace", "proposed-3pprs", *options)
    assert run.status == 1
    assert words in run.err


def test_a_file_without_a_workspace(strutwork: Program) -> None:
    run = strutwork("workspace", "examples/05_two_link_leg.toml")
    assert run.status == 1
    assert "gives no workspace" in run.err


def test_options_that_exclude_each_other(strutwork: Program) -> None:
    run = strutwork("workspace", "proposed-3pprs", *OVER, "--tilt", "1deg", "--dexterous", "2deg")
    assert run.status == 2
    assert "not both" in run.err


def test_shapes_of_a_file_are_looked_at(strutwork: Program, tmp_path: Path) -> None:
    path = written(tmp_path)
    ask = ("workspace", path, "--over", "x=-100mm..200mm:11,y=-100mm..100mm:11", "--interference")
    found = strutwork(*ask, "--json").result
    assert found["interference"] == {"capsules": 1, "shapes": 1, "pairs": 1}
    assert "interference of arm and post" in found["border"]
    assert "Interference: 1 capsule and 1 mesh, 1 pair that may collide" in strutwork(*ask).out


def test_the_largest_box_that_keeps_an_amplification(strutwork: Program) -> None:
    ask = ("workspace", "proposed-3pprs", *OVER, "--largest", "box", "--around", "x=0mm,y=0mm")
    free, fast = (
        strutwork(*ask, *bound, "--json").result["largest"]
        for bound in ((), ("--amplification", "0.9"))
    )
    assert 0.0 < fast["measure"] < free["measure"]
    assert fast["reason"] == "largest velocity amplification, 0.9"
