"""`strutwork lobes`: limiting depths of a machine, and what is refused."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from tests.cli.conftest import Program

HEAD = "examples/machines/3-rps.toml"
CUT = (
    *("--tool", "diameter=20mm,teeth=4", "--material", "aluminium-7075-t6"),
    *("--immersion", "0.5", "--speeds", "500..2500:5"),
)


def test_limits_of_a_machine_are_printed_and_written(strutwork: Program, tmp_path: Path) -> None:
    found = strutwork("lobes", HEAD, *CUT, "--json", "-o", tmp_path).result
    assert found["speeds_rpm"] == [500.0, 1000.0, 1500.0, 2000.0, 2500.0]
    exact, zero = found["exact_depth"], found["zero_order_depth"]
    # at half immersion exactly one of four teeth cuts at a time
    assert exact == pytest.approx(zero, rel=0.08)
    assert set(found["kinds"]) == {"Hopf"}
    assert 0.0 <= found["exact_residual_share"] <= 0.01
    assert found["absolute_depth"] <= min(zero)
    assert found["pockets"][0]["speed_rpm"] == 2500.0
    (path,) = found["data"]
    with Path(path).open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert [float(r["exact depth [m]"]) for r in rows] == pytest.approx(exact)


def test_the_feed_and_the_material_change_the_limit(strutwork: Program, tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(
        '[half]\ntangential = "383.505 MPa"\nradial = "84.4 MPa"\naxial = "111 MPa"\n'
        'source = "half of aluminium-7075-t6"\n'
    )
    plain = strutwork("lobes", HEAD, *CUT, "--json").result["absolute_depth"]
    words = [f"{file}:half" if w == "aluminium-7075-t6" else w for w in CUT]
    half = strutwork("lobes", HEAD, *words, "--json").result["absolute_depth"]
    assert half == pytest.approx(2.0 * plain, rel=1e-9)


def test_a_loss_factor_gives_zero_order_limits_alone(strutwork: Program) -> None:
    run = strutwork("lobes", HEAD, *CUT, "--loss-factor", "0.03", "--json")
    assert run.result["exact_depth"] is None
    assert "Only zero-order limits" in run.err


def test_exact_limits_that_are_withheld_leave_the_others(strutwork: Program) -> None:
    """At 5 rpm the teeth are so far apart that the map would be too large."""
    run = strutwork("lobes", HEAD, *CUT, "--speeds", "5..10:3", "--json")
    assert run.result["exact_depth"] is None
    assert all(run.result["zero_order_depth"])
    assert "Only zero-order limits" in run.err
    assert "Ask for higher speeds" in run.err


def test_the_process_of_a_model_and_of_a_file_stand_for_the_options(
    strutwork: Program, tmp_path: Path
) -> None:
    file = tmp_path / "cut.toml"
    file.write_text(
        'diameter = "20 mm"\nteeth = 4\nmaterial = "aluminium-7075-t6"\nimmersion = 0.5\n'
        'speeds = { from = "500 rpm", to = "2500 rpm", points = 5 }\n'
    )
    plain = strutwork("lobes", HEAD, *CUT, "--json").result
    given = strutwork("lobes", HEAD, "--process", file, "--json").result
    # the model's own has more speeds
    own = strutwork("lobes", HEAD, *CUT[-2:], "--json").result
    for found in (given, own):
        assert found["speeds_rpm"] == pytest.approx(plain["speeds_rpm"])
        assert found["exact_depth"] == pytest.approx(plain["exact_depth"])


def test_poses_and_the_rose_are_printed_and_written(strutwork: Program, tmp_path: Path) -> None:
    asked = ("lobes", HEAD, *CUT, "--rose", "--over", "rx=-2deg..2deg:3,z=630mm")
    run = strutwork(*asked, "-o", tmp_path)
    assert run.status == 0
    assert "raises the depth by" in run.out
    assert "by direction of" in run.out
    assert "3 of 3 are valid" in run.out
    found = strutwork(*asked, "--json").result
    assert len(found["rose"]["absolute_depth"]) == 36
    assert sum(found["effects"].values()) == pytest.approx(1.0, abs=1e-4)
    depth = found["over"]["extremes"]["limiting_depth"]
    assert depth["least"]["value"] < depth["largest"]["value"]
    assert {p.name for p in tmp_path.iterdir()} == {
        "3-rps-lobes.csv",
        "3-rps-rose.csv",
        "3-rps-stability-survey.csv",
        "3-rps-stability-survey.nc",
    }


def test_a_machine_without_a_process_needs_the_options(strutwork: Program) -> None:
    run = strutwork("lobes", "examples/machines/tricept.toml")
    assert (run.status, run.out) == (1, "")
    assert "neither --process nor the model states a process" in run.err


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "material = "),
        ("tangential = 6e8\n", "coefficients without a source"),
        ('material = "butter"\n', "is not in the library"),
        ('material = "aluminium-7075-t6"\ntangential = 6e8\n', "a material and a tangential"),
        ('material = "aluminium-7075-t6"\nradial = 6e8\n', "coefficients beside a material"),
    ],
)
def test_a_wrong_process_file_is_refused(
    text: str, said: str, strutwork: Program, tmp_path: Path
) -> None:
    file = tmp_path / "cut.toml"
    speeds = 'speeds = { from = "500 rpm", to = "2500 rpm" }\n'
    file.write_text(f'diameter = "20 mm"\nteeth = 4\n{text}{speeds}')
    run = strutwork("lobes", HEAD, "--process", file)
    assert (run.status, run.out) == (1, "")
    assert said in run.err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--over", "z=nowhere"), "nowhere"),
        (("--process", "missing.toml"), "does not exist"),
        (("--tool", "diameter=20mm"), "has no teeth"),
        (("--tool", "teeth=4"), "has no diameter"),
        (("--tool", "diameter=20mm,teeth=many"), 'has "many" teeth'),
        (("--tool", "diameter=20mm,teeth=4,colour=red"), "cannot be read"),
        (("--material", "butter"), "is not in the library"),
        (("--speeds", "2000..500:5"), "cannot be read"),
        (("--speeds", "500..2000:1"), "cannot be read"),
        (("--immersion", "1.5"), "radial immersion"),
        (("--axis", "up"), "is no direction"),
        (("--feed", "z"), "a feed along the tool"),
        (("--deepest", "3 kg"), "--deepest"),
        (("--deepest", "-3 mm"), "depth of cut"),
        (("--node", "nowhere"), "nowhere"),
    ],
)
def test_wrong_words_are_refused(words: tuple[str, ...], said: str, strutwork: Program) -> None:
    run = strutwork("lobes", HEAD, *CUT, *words)
    assert (run.status, run.out) == (1, "")
    assert said in run.err
