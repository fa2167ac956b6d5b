"""Hard names, names of files and encodings through every command, as a user's shell runs them."""

from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
import xarray as xr

from strutwork.csv_rows import csv_name
from strutwork.fea.uff_names import fitted_names
from strutwork.fea.uff_read import read_universal
from strutwork.names import is_hidden, visible
from strutwork.reports.cli.streams import ASCII
from tests.cli.conftest import Program
from tests.hard_names import CASE, JOINT, LONG, NODES, hard_model

ROOT = Path(__file__).parents[2]
ROBUSTNESS = ROOT / "tests" / "cases" / "robustness"
PORT = f"{LONG}1:z"
BAND = ("--from", "1", "--to", "50", "--lines", "50")
RAILS = ROOT / "examples" / "06_table_on_two_rails.toml"

#: How a shell may set the encoding of what a program prints.
ENCODINGS = {
    "latin-1": {"PYTHONIOENCODING": "latin-1"},
    "ascii": {"PYTHONIOENCODING": "ascii"},
    "locale C": {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
}


def shell(*arguments: str | bytes | Path, **environment: str) -> subprocess.CompletedProcess[bytes]:
    """Run the program in a process of its own."""
    kept = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHONIO", "PYTHONUTF8"))}
    return subprocess.run(
        [sys.executable, "-c", "from strutwork.reports.cli import main; main()", *arguments],
        env=kept | {"PYTHONPATH": str(ROOT), "COLUMNS": "200"} | environment,
        capture_output=True,
        check=False,
        timeout=300,
    )


@pytest.fixture
def model(tmp_path: Path) -> Path:
    path = tmp_path / "model.toml"
    path.write_text(hard_model(), encoding="utf-8")
    return path


def cells(path: Path) -> set[str]:
    with path.open(encoding="utf-8", newline="") as file:
        return {cell for row in csv.reader(file) for cell in row}


def test_every_command_takes_the_longest_names(
    strutwork: Program, model: Path, tmp_path: Path
) -> None:
    strutwork("check", model, "--json").result  # noqa: B018 - the status is looked at
    solved = strutwork("solve", model, "--json").result["cases"][CASE]
    assert set(NODES) < set(solved["displacements"])
    assert list(solved["joint_forces"]) == [JOINT]
    strutwork("modes", model, "-n", "2", "-o", tmp_path, "--json").result  # noqa: B018
    strutwork("frf", model, "--input", PORT, *BAND, "-o", tmp_path, "--json").result  # noqa: B018
    ours, drawn = strutwork("report", model, "-o", tmp_path / "r", "--json").result, tmp_path / "r"
    assert {Path(p).name for p in ours["data"]} < {p.name for p in drawn.iterdir()}
    assert set(NODES) < set(json.loads((drawn / "drawing.json").read_text("utf-8"))["nodes"])

    written = fitted_names(NODES)
    (first, *_) = read_universal(tmp_path / "model-modes.uff").modes
    assert set(written.values()) <= set(first.nodes)
    (function,) = read_universal(tmp_path / "model-frf.uff").functions
    assert function.output[0] == fitted_names([f"{LONG}1"])[f"{LONG}1"]

    compared = strutwork(
        "correlate", tmp_path / "model-modes.uff", tmp_path / "model-modes.uff", "--json"
    )
    assert len(compared.result["modes"]) == 2


def test_tolerances_take_the_longest_names(strutwork: Program, tmp_path: Path) -> None:
    text = RAILS.read_text(encoding="utf-8")
    (name, *others) = [
        line.split('"')[1]
        for line in text.partition("[[joints]]")[2].splitlines()
        if line.startswith("name = ")
    ]
    long = "=" + LONG
    path = tmp_path / "rails.toml"
    path.write_text(text.replace(f'"{name}"', f'"{long}"'), encoding="utf-8")

    found = strutwork("tolerance", path, "--samples", "0", "-o", tmp_path / "out", "--json").result

    assert any(q["joint"] == long for q in found["quantities"])
    assert others
    (table,) = (tmp_path / "out").glob("*.csv")
    assert any(csv_name(c).startswith(long) for c in cells(table))
    assert not any(c.startswith("=") for c in cells(table))
    (dataset,) = (tmp_path / "out").glob("*.nc")
    with xr.open_dataset(dataset, engine="h5netcdf") as file:
        assert any(str(q).startswith(long) for q in file["quantity"].to_numpy())


def test_names_of_101_characters_are_refused(strutwork: Program, tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.write_text(hard_model().replace(LONG, LONG + "n"), encoding="utf-8")
    run = strutwork("check", path)
    assert run.status == 1
    assert "100" in run.err


def test_no_cell_is_a_formula_and_each_name_matches(
    strutwork: Program, model: Path, tmp_path: Path
) -> None:
    strutwork("report", model, "-o", tmp_path / "r", "--json").result  # noqa: B018
    tables = list((tmp_path / "r").glob("*.csv"))
    found = set().union(*map(cells, tables))
    for cell in found:
        if cell.startswith(("=", "+", "-", "@", "\t", "\r")):
            float(cell)
    assert JOINT in {csv_name(c) for c in found}
    assert JOINT not in found


@pytest.mark.slow
@pytest.mark.parametrize("encoding", ENCODINGS)
def test_every_encoding_shows_every_character(model: Path, tmp_path: Path, encoding: str) -> None:
    plain = "ascii" if encoding == "locale C" else encoding
    for command in (
        ("machines",),
        ("--help",),
        ("check", model),
        ("solve", model),
        ("modes", model, "-n", "2", "-o", tmp_path / "ö"),
        ("frf", model, "--input", PORT, *BAND),
        ("frf", model, "--input", NODES[-2] + ":z", *BAND),
        ("tolerance", RAILS, "--samples", "100"),
        ("report", model, "-o", tmp_path / "東"),
        ("check", tmp_path / "東\u2028.toml"),
    ):
        run = shell(*(str(part) for part in command), **ENCODINGS[encoding])
        assert b"Traceback" not in run.stderr, run.stderr
        assert run.returncode == (1 if "\u2028" in str(command[-1]) else 0), run.stderr
        assert (run.stdout + run.stderr).strip()
        (run.stdout + run.stderr).decode(plain)


def test_signs_of_units_have_their_ascii_forms(model: Path) -> None:
    run = shell("solve", model, PYTHONIOENCODING="ascii")
    assert b"N/um" in run.stdout
    assert b"N*m" in run.stdout
    assert rb"[red]\u6771\u4eac %{x}</script>" in run.stdout
    assert all(form.isascii() for form in ASCII.values())


@pytest.mark.slow
@pytest.mark.parametrize("encoding", ENCODINGS)
def test_json_is_the_same_in_every_encoding(model: Path, encoding: str) -> None:
    wide = json.loads(shell("solve", model, "--json", PYTHONIOENCODING="utf-8").stdout)
    run = shell("solve", model, "--json", **ENCODINGS[encoding])
    assert run.stdout.isascii() or encoding == "latin-1"
    assert json.loads(run.stdout.decode("latin-1")) == wide


@pytest.mark.parametrize("name", ["esc.toml", "esc2.toml"])
@pytest.mark.parametrize("command", ["check", "solve", "modes", "report", "tolerance"])
def test_escape_sequences_in_names_are_refused_and_shown(
    strutwork: Program, command: str, name: str
) -> None:
    run = strutwork(command, ROBUSTNESS / name)
    assert run.status == 1
    assert run.out == ""
    assert r"\x1b[2J\x1b]0;PWN\x07tip" in run.err
    assert not any(is_hidden(c) for c in run.err.replace("\n", ""))


@pytest.mark.parametrize("character", ["\x00", "\n", "\x7f", "\x9b", "\u202e", "\u2069", "\u2028"])
@pytest.mark.parametrize("place", ["node", "key", "title"])
def test_hidden_characters_never_reach_the_terminal(
    strutwork: Program, tmp_path: Path, place: str, character: str
) -> None:
    hostile = json.dumps(f"a{character}b").replace("\x7f", "\\u007f")
    text = hard_model("TITLE").replace('"end"', hostile).replace("\nend =", f"\n{hostile} =")
    if place == "key":
        text = hard_model("TITLE") + f"{hostile} = 1\n"
    if place == "title":
        text = hard_model("TITLE").replace('"TITLE"', hostile)
    path = tmp_path / "model.toml"
    path.write_text(text, encoding="utf-8")
    for options in ((), ("--json",)):
        run = strutwork("solve", path, *options)
        assert run.status == (0 if place == "title" else 1)
        shown = (run.out + run.err).replace("\n", "")
        assert not any(is_hidden(c) for c in shown)


def test_markup_and_signs_for_words_are_shown_as_they_are(strutwork: Program, model: Path) -> None:
    run = strutwork("solve", model)
    assert "[red]東京 %{x}</script>" in run.out
    assert "=joint[/bold]" in run.out
    assert ":smile:" in run.out


def test_wrong_usage_shows_what_was_typed_written_out(strutwork: Program) -> None:
    for typed in (("check", "a", "b\x1b[2J"), ("c\x1b[2J",), ("check", "--d\x1b[2J")):
        run = strutwork(*typed)
        assert run.status == 2
        assert r"\x1b[2J" in run.err
        assert "\x1b" not in run.err


@pytest.mark.slow
def test_names_of_files_that_are_no_utf8(tmp_path: Path) -> None:
    folder = os.fsencode(tmp_path)
    for name in (b"\xff m.toml", b"a\nb.toml", b"'\"<i>.toml", b"-x.toml"):
        path = folder + b"/" + name
        with open(path, "w", encoding="utf-8") as file:  # noqa: PTH123 - a name in bytes
            file.write(hard_model(""))
        for command in (
            (b"check",),
            (b"solve",),
            (b"modes", b"-n", b"2", b"-o", folder + b"/\xfe"),
            (b"frf", b"--input", PORT.encode(), *map(str.encode, BAND), b"-o", folder + b"/\xfe"),
            (b"report", b"-o", folder + b"/\xfd" + name),
            (b"report", b"--json", b"-o", folder + b"/\xfd" + name),
        ):
            run = shell(*command, b"--", path)
            assert run.returncode == 0, run.stderr
            shown = (run.stdout + run.stderr).decode("utf-8").replace("\n", "")
            assert not any(is_hidden(c) for c in shown)
        page = Path(os.fsdecode(folder + b"/\xfd" + name)) / "report.html"
        assert page.read_text(encoding="utf-8")
        settings = json.loads((page.parent / "report.json").read_text("utf-8"))["settings"]
        assert settings["model"] == visible(os.fsdecode(name))
        data = json.loads(run.stdout)
        assert Path(data["report"]) == page
    universal = folder + b"/\xfe/\xff m-modes.uff"
    assert shell("correlate", universal, universal).returncode == 0
    missing = shell("check", folder + b"/\xfc\x1b.toml")
    assert missing.returncode == 1
    assert rb"\xfc\x1b.toml: does not exist" in missing.stderr
