"""`strutwork compare`: two machines, and universal files under the command's earlier meaning."""

from __future__ import annotations

import csv
import io
import json
import re
from functools import partial
from pathlib import Path

import pytest

from strutwork.reports.cli.compare_command import is_universal
from strutwork.studies.chunks import ChunkStore
from tests.cli.conftest import Program

ROOT = Path(__file__).parents[2]
HEAD, HEXAPOD = (ROOT / "examples" / "machines" / f"{n}.toml" for n in ("3-rps", "6-ups"))
UNIVERSAL = ROOT / "tests" / "cases" / "uff" / "computed.uff"

TWO = """
title = "Bar of {diameter}"
materials.steel = {{ youngs_modulus = "200 GPa", poissons_ratio = 0.3, density = "7850 kg/m^3" }}
sections.rod = {{ shape = "rod", diameter = "{diameter}" }}
nodes = {{ root = [0, 0, 0], TCP = [0.5, 0, 0] }}
{damping}
[[beams]]
name = "bar"
from = "root"
to = "TCP"
section = "rod"
material = "steel"

[[supports]]
node = "root"
fixed = "all"

[tool]
tcp = "TCP"
"""


@pytest.fixture
def bars(tmp_path: Path) -> tuple[Path, Path]:
    """Two bars that differ in their diameter alone: all of their ratios are known."""
    paths = tmp_path / "thin.toml", tmp_path / "thick.toml"
    for path, diameter, damping in zip(
        paths, ("40 mm", "80 mm"), ("", "damping.modal_ratio = 0.01"), strict=True
    ):
        path.write_text(TWO.format(diameter=diameter, damping=damping), encoding="utf-8")
    return paths


def rows_of(result: dict[str, dict[str, dict[str, list[dict[str, object]]]]]) -> dict[str, object]:
    return {row["key"]: row for q in result["questions"].values() for row in q["rows"]}  # type: ignore[misc]


def test_a_bar_twice_as_thick(strutwork: Program, bars: tuple[Path, Path]) -> None:
    found = rows_of(strutwork("compare", *bars, "--json").result)
    # areas go with the square of the diameter, second moments with its fourth power
    for key, ratio in (
        ("home_stiffness_free_x", 4.0),
        ("home_stiffness_free_rx", 16.0),
        ("home_stiffness_blocked_rx", 16.0),
        ("mass", 4.0),
    ):
        row = found[key]
        assert isinstance(row, dict)
        assert row["difference_percent"] == pytest.approx(100.0 * (ratio - 1.0), rel=1e-6)
        assert row["verdict"] == ("A better" if key == "mass" else "B better")
        assert row["marked"]
    assert found["beams"]["verdict"] == "equal"  # type: ignore[index]
    # only the second has damping
    least = found["least_dynamic_stiffness_y"]
    assert isinstance(least, dict)
    assert least["verdict"] == "not compared"
    assert "damping" in least["a"]["reason"]
    assert least["b"]["value"] > 0.0
    assert least["difference_percent"] is None


def test_damping_of_both_and_a_threshold(strutwork: Program, bars: tuple[Path, Path]) -> None:
    options = ("--modal-ratio", "0.02", "--threshold", "400", "--json")
    result = strutwork("compare", *bars, *options).result
    found = rows_of(result)
    assert result["threshold_percent"] == 400.0
    assert found["least_dynamic_stiffness_y"]["verdict"] == "B better"  # type: ignore[index]
    assert found["mass"]["verdict"] == "alike"  # type: ignore[index]


def test_the_table_has_words_and_says_what_is_not_answered(
    strutwork: Program, bars: tuple[Path, Path]
) -> None:
    run = strutwork("compare", *bars)
    assert run.status == 0
    assert re.search(r"along x, others free +│ N/µm +│ +502\.\d +│ +2011 +│ \+300\.0 %", run.out)
    assert "The lighter machine is better." in run.out
    assert "No result for A and B (largest assembly forces at home)" in run.out
    assert re.search(
        r"Marked from a difference of 5 % of A\. A better in 1, B better in 1\d", run.out
    )
    assert "bodies" not in run.out
    assert "bodies" in strutwork("compare", *bars, "--verbose").out


def test_csv_has_every_row(strutwork: Program, bars: tuple[Path, Path]) -> None:
    run = strutwork("compare", *bars, "--csv")
    tables = re.split(r"^# .*\n", run.out, flags=re.MULTILINE)[1:]
    assert len(tables) == 8
    first = list(csv.DictReader(io.StringIO(tables[0])))
    assert {row["verdict"] for row in first} == {"B better"}


def test_machines_of_other_tasks_are_looked_at_over_their_own_poses(strutwork: Program) -> None:
    result = strutwork("compare", HEAD, HEXAPOD, "--json").result
    assert not result["shared_poses"]
    assert "directions z, rx and ry in A and x, y and z in B" in result["poses"]
    assert any("do not have the same degrees of freedom" in note for note in result["notes"])


def test_poses_about_home_that_both_take(strutwork: Program) -> None:
    result = strutwork("compare", HEAD, HEXAPOD, "--around", "z=-20mm..20mm:3", "--json").result
    found = rows_of(result)
    assert result["shared_poses"]
    assert any("over the 3 of 3 poses that both reach" in note for note in result["notes"])
    assert "z 700 mm" in found["worst_stiffness_free_x"]["a"]["at"]  # type: ignore[index]


def test_at_another_pose(strutwork: Program) -> None:
    words = ("--pose", "rx=5deg", "--around", "z=-20mm..20mm:3", "--json")
    moved, home = (strutwork("compare", HEAD, HEXAPOD, *words[k:]).result for k in (0, 2))
    assert (moved["where"], home["where"]) == ("at rx = 5 deg", "at home")
    key = "home_stiffness_free_z"
    assert rows_of(moved)[key] != rows_of(home)[key]
    # what they are looked at over stays where it is
    assert rows_of(moved)["worst_stiffness_free_z"] == rows_of(home)["worst_stiffness_free_z"]


@pytest.mark.slow
def test_kept_parts_serve_the_same_comparison_again(
    strutwork: Program, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept, other = tmp_path / "kept", tmp_path / "other.toml"
    text = HEAD.read_text(encoding="utf-8")
    assert "210 GPa" in text
    other.write_text(text.replace("210 GPa", "200 GPa"), encoding="utf-8")
    words = ("compare", HEAD, other, "--around", "rx=-5deg..5deg:3", "--keep", kept, "--json")
    first = strutwork(*words).result
    parts = {p: p.stat().st_mtime_ns for p in kept.rglob("chunk-*.npz")}
    assert parts

    def written(*_: object) -> None:
        raise AssertionError("a chunk is computed again")

    monkeypatch.setattr(ChunkStore, "write", written)
    assert strutwork(*words).result == first
    assert {p: p.stat().st_mtime_ns for p in kept.rglob("chunk-*.npz")} == parts


def test_a_page(strutwork: Program, bars: tuple[Path, Path], tmp_path: Path) -> None:
    page = tmp_path / "made" / "bars.html"
    run = strutwork("compare", *bars, "--html", page, "--json")
    assert run.result["report"] == str(page)
    assert [p.name for p in page.parent.iterdir()] == ["bars.html"]
    text = page.read_text(encoding="utf-8")
    assert "Bar of 40 mm beside Bar of 80 mm" in text
    named = re.search(r'data-names="([^"]*)"', text)
    assert named is not None
    assert {"comparison.csv", "differences.csv", "pictures.json", "report.json"} <= set(
        json.loads(named[1].replace("&#34;", '"').replace("&quot;", '"'))
    )


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("mit-ss1", "mit-ss1"), '"mit-ss1" and "mit-ss1" are the same'),
        (("proposed-3pprs", "proposed-3pprs:static"), "are the same"),
        ((HEAD, HEAD.parent / ".." / "machines" / HEAD.name), "are the same"),
        (("mit-ss1", "mit-ss2"), 'Did you mean "mit-ss1"?'),
        (("mit-ss1", UNIVERSAL), "strutwork correlate"),
        ((UNIVERSAL, "mit-ss1"), "strutwork correlate"),
        (("mit-ss1", HEAD, "--pose", "x=5m"), "mit-ss1, pose: cannot be taken"),
        (("mit-ss1", HEAD, "--around", "q=1..2"), "--around"),
        (("mit-ss1", HEAD, "--threshold", "nan"), "threshold"),
        (("mit-ss1", HEAD, "--modal-ratio", "0.01", "--loss-factor", "0.02"), "Give one of them"),
    ],
    ids=str,
)
def test_bad_input(words: tuple[str | Path, ...], said: str, strutwork: Program) -> None:
    run = strutwork("compare", *words)
    assert run.out == ""
    # the program refuses numbers outside an option's range as wrong usage
    assert run.status == (2 if "--threshold" in words else 1)
    assert said in run.err


def test_a_copy_of_a_file_is_the_same_machine(
    strutwork: Program, bars: tuple[Path, Path], tmp_path: Path
) -> None:
    (tmp_path / "copy.toml").write_bytes(bars[0].read_bytes())
    run = strutwork("compare", bars[0], tmp_path / "copy.toml")
    assert run.status == 1
    assert "are the same" in run.err


def test_universal_files_are_still_compared(strutwork: Program) -> None:
    old = strutwork("compare", UNIVERSAL, UNIVERSAL, "--window", "0.2", "--json")
    assert "strutwork correlate" in old.err
    new = strutwork("correlate", UNIVERSAL, UNIVERSAL, "--window", "0.2", "--json")
    assert new.err == ""
    assert old.result == new.result


def test_what_is_a_universal_file(tmp_path: Path) -> None:
    other = tmp_path / "measured.txt"
    other.write_bytes(UNIVERSAL.read_bytes())
    assert is_universal(str(other))
    assert is_universal("absent.UNV")
    assert not is_universal("mit-ss1")
    assert not is_universal(str(HEAD))
    assert not is_universal(str(tmp_path))


def test_a_cluster_that_does_not_answer_is_no_reason_of_a_machine(
    strutwork: Program, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("distributed")
    cluster = pytest.importorskip("strutwork.studies.cluster")
    monkeypatch.setattr(cluster, "Dask", partial(cluster.Dask, patience=0.5))
    run = strutwork("compare", "proposed-3pprs", "eclipse-3pprs", "--cluster", "tcp://127.0.0.1:9")
    assert run.status == 1
    assert "cluster tcp://127.0.0.1:9: cannot be reached" in run.err
    assert run.out == ""
