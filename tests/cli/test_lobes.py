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


@pytest.mark.parametrize(
    ("words", "said"),
    [
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
