"""`strutwork workspace`: what it prints, its files, and questions that it refuses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import Program

OVER = ("--over", "x=-30mm..30mm:9,y=-30mm..30mm:9")


def test_words_and_numbers_agree(strutwork: Program, tmp_path: Path) -> None:
    found = strutwork("workspace", "proposed-3pprs", *OVER, "--largest", "box", "--json").result
    assert found["unit"] == "m²"
    assert 0.0 < found["error"] < 0.2 * found["measure"]
    assert sum(found["border"].values()) == pytest.approx(1.0)
    assert found["home"]["component"] == 1
    assert found["components"][0]["home"]
    assert found["poses"] == 81
    big = found["largest"]
    assert big["sides"]["x"] == big["sides"]["y"]
    assert 0.0 < big["measure"] < found["measure"]
    run = strutwork("workspace", "proposed-3pprs", *OVER, "--out", tmp_path)
    assert f"Area {1e4 * found['measure']:.4g} ± {1e4 * found['error']:.2g} cm²" in run.out
    for path in tmp_path.iterdir():
        assert str(path.name) in run.out
    assert {p.suffix for p in tmp_path.iterdir()} == {".nc", ".csv"}
    near = found["nearest"]
    assert near["reason"] in run.out
    assert near["distance"] == pytest.approx(np.hypot(*near["at"].values()))


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
        ((), "says no workspace"),
        ((*OVER, "--tilt", "30mm"), "--tilt"),
        ((*OVER, "--spare", "roll"), "--spare"),
        ((*OVER, "--spare", "x=0mm..1mm"), "direction of the grid"),
        ((*OVER, "--largest", "cylinder"), "cylinder"),
        ((*OVER, "--largest", "box", "--proportions", "1:0"), "--proportions"),
        ((*OVER, "--largest", "box", "--around", "z=0mm"), "--around"),
        ((*OVER, "--radius", "200mm"), "interfere at home"),
        ((*OVER, "--conditioning", "2"), "conditioning"),
    ],
)
def test_what_cannot_be_asked(strutwork: Program, options: tuple[str, ...], words: str) -> None:
    run = strutwork("workspace", "proposed-3pprs", *options, status=1)
    assert words in run.err


def test_options_that_exclude_each_other(strutwork: Program) -> None:
    run = strutwork(
        "workspace", "proposed-3pprs", *OVER, "--tilt", "1deg", "--dexterous", "2deg", status=2
    )
    assert "not both" in run.err
