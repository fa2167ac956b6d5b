"""The short answer last; --verbose for the rest; --csv for tables alone."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import numpy as np
import pytest

from strutwork.kinematics import FreeMotion
from strutwork.machines.load import load
from strutwork.reports.chapters.model import check_chapter
from strutwork.reports.content import Text
from strutwork.reports.freedom_words import freedom_sentences, freedom_words, tool_freedoms
from strutwork.reports.model_check import check_model
from tests.cli.conftest import Program
from tests.model_files import EXAMPLES

EXAMPLE = {path.stem: path for path in EXAMPLES}
HEXAPOD = Path(__file__).parents[2] / "examples" / "machines" / "6-ups.toml"

#: The short answers of checks: the tool's freedoms are those of the mechanisms' names.
ANSWERS = {
    HEXAPOD: "has 6 freedoms: x, y, z, rx, ry and rz. The drives hold the tool. No constraint",
    "mit-ss1": "has 3 freedoms: x, z and ry. The drives hold the tool. 12 constraints are",
    "biglide": "has 2 freedoms: x and y.",
    EXAMPLE[
        "04_four_bar"
    ]: "With the drives free it has 1 freedom, and no tool is named. The drives hold it. 3 ",
    EXAMPLE["05_two_link_leg"]: "has 1 freedom: x (with ry).",
    EXAMPLE["01_cantilever"]: "Its joints hold it. No constraint is redundant",
}


@pytest.mark.parametrize("target", ANSWERS, ids=str)
def test_a_check_ends_with_its_answer(target: str | Path, strutwork: Program) -> None:
    lines = strutwork("check", target).out.rstrip().splitlines()
    answer = lines[-2] if lines[-1].startswith("--verbose") else lines[-1]
    assert ANSWERS[target] in answer
    # a hexapod's motions name 36 joints each: they are for who asks
    assert "moves at" not in "".join(lines)


def test_verbose_names_the_joints(strutwork: Program) -> None:
    out = strutwork("check", EXAMPLE["04_four_bar"], "--verbose").out
    assert "moves at R1 in rz" in out
    assert "States of self-stress" in out
    # the next command is brief again
    assert "moves at" not in strutwork("check", EXAMPLE["04_four_bar"]).out


def _tables(text: str) -> dict[str, list[list[str]]]:
    found = {}
    for block in text.split("\n\n"):
        title, rest = block.split("\n", 1)
        assert title.startswith("# ")
        found[title[2:]] = list(csv.reader(io.StringIO(rest)))
    return found


def test_csv_holds_the_tables_with_every_digit(strutwork: Program) -> None:
    tripod = EXAMPLE["03_tripod"]
    run = strutwork("solve", tripod, "--csv")
    tables = _tables(run.out)
    answers = strutwork("solve", tripod, "--json").result["cases"]["cutting"]
    head, *rows = tables["Displacements"]
    assert head[:2] == ["node", "x, mm"]
    # all 19 nodes, though the short answer shows ten
    assert len(rows) == 19
    tool = dict(zip(head, next(row for row in rows if row[0] == "TCP"), strict=True))
    assert float(tool["x, mm"]) == 1e3 * answers["displacements"]["TCP"][0]
    assert len(tables["Stiffness at the tool TCP"]) == 7


def test_a_long_table_shows_the_largest(strutwork: Program) -> None:
    tripod = EXAMPLE["03_tripod"]
    short = strutwork("solve", tripod).out
    table = short.split("Displacements")[1].split("Reactions")[0]
    assert "TCP" in table
    assert "--verbose lists 9 more." in table
    assert "base1" not in table
    assert "base1" in strutwork("solve", tripod, "-v").out.split("Reactions")[0]


def test_a_solution_ends_with_its_answer(strutwork: Program) -> None:
    last = strutwork("solve", EXAMPLE["03_tripod"]).out.rstrip().splitlines()[-1]
    assert "least with 0.3663 N/µm in x and largest with 151.8 N/µm in z" in last


@pytest.mark.parametrize(
    "command",
    [
        ("machines",),
        ("modes", EXAMPLE["03_tripod"]),
        ("frf", EXAMPLE["03_tripod"], "--input", "TCP:z"),
        ("tolerance", EXAMPLE["06_table_on_two_rails"], "--samples", "1000"),
        ("move", HEXAPOD, "--pose", "z=210mm"),
    ],
    ids=lambda c: str(c[0]),
)
def test_every_table_has_a_csv(command: tuple[str | Path, ...], strutwork: Program) -> None:
    run = strutwork(*command, "--csv")
    assert run.status == 0, run.err
    for title, (head, *rows) in _tables(run.out).items():
        assert rows, title
        assert {len(row) for row in rows} == {len(head)}


def test_csv_and_json_exclude_each_other(strutwork: Program) -> None:
    run = strutwork("check", EXAMPLE["01_cantilever"], "--csv", "--json")
    assert (run.status, run.out) == (1, "")
    assert "--json: cannot be combined with --csv. Choose one" in run.err.replace("\n", " ")


def test_freedoms_of_a_tool() -> None:
    # a screw: it moves 2 m along z per rad, and nothing else
    assert tool_freedoms(np.array([[0, 0, 2.0, 0, 0, 1.0]]), 1.0) == ["z (with rz)"]
    # two motions whose sum and difference are the axes
    both = np.array([[1.0, 1, 0, 0, 0, 0], [1, -1, 0, 0, 0, 0]])
    assert tool_freedoms(both, 1.0) == ["x", "y"]
    # the second leaves the tool where it is
    assert tool_freedoms(np.array([[1.0, 0, 0, 0, 0, 0], [0] * 6]), 1.0) == ["x"]
    assert tool_freedoms(np.zeros((2, 6)), 1.0) == []


def test_motions_that_leave_the_tool_where_it_is() -> None:
    model = load(EXAMPLE["03_tripod"])
    assert model.tool is not None
    still = np.zeros((len(model.structure.linkage.nodes), 6))
    along = still.copy()
    along[model.structure.linkage.node_index[model.tool], 2] = 1.0
    spins = [FreeMotion(np.zeros((1, 6)), still, (), "") for _ in range(2)]
    lift = FreeMotion(np.zeros((1, 6)), along, (), "")
    assert freedom_words(model, [lift]) == "the tool has 1 freedom: z"
    assert freedom_words(model, [lift, spins[0]]) == (
        "the tool has 1 freedom: z; 1 further motion leaves it where it is"
    )
    assert freedom_words(model, spins) == (
        "the tool has no freedom; 2 motions leave it where it is"
    )


@pytest.mark.parametrize("name", ["03_tripod", "04_four_bar", "05_two_link_leg"])
def test_a_report_says_what_a_check_says(name: str) -> None:
    found = check_model(load(EXAMPLE[name]))
    texts = {b.text for b in check_chapter(found).blocks if isinstance(b, Text)}
    said = freedom_sentences(found)[0]
    assert said.startswith("With the drives free ")
    assert said in texts
