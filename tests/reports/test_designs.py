"""Two machines side by side: rows, the poses that count, and the page."""

from __future__ import annotations

import resource
from dataclasses import replace
from math import inf, nan
from pathlib import Path

import numpy as np
import pytest

import strutwork as sw
from strutwork.errors import ModelError, OutputError
from strutwork.front import Machine
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.reports.designs.comparison import compare_designs
from strutwork.reports.designs.page import comparison_page
from strutwork.reports.designs.quantities import QUANTITIES, QUESTIONS
from strutwork.reports.designs.result import DesignComparison
from strutwork.reports.designs.row import Quantity, Row, Value, Verdict
from strutwork.reports.designs.space import space_of

ROOT = Path(__file__).parents[2]
HEAD, HEXAPOD = (ROOT / "examples" / "machines" / f"{n}.toml" for n in ("3-rps", "6-ups"))
BAR, FRAME = (ROOT / "examples" / f"{n}.toml" for n in ("01_cantilever", "04_four_bar"))

MORE = Quantity("k", "home", "stiffness", "N/m", "more")
LESS = replace(MORE, better="less")
NEITHER = replace(MORE, better="", unit="1")


@pytest.mark.parametrize(
    ("quantity", "a", "b", "difference", "verdict"),
    [
        (MORE, Value(2e6), Value(3e6), 50.0, "B better"),
        (LESS, Value(2e6), Value(3e6), 50.0, "A better"),
        (NEITHER, Value(2.0), Value(3.0), 50.0, "differs"),
        (MORE, Value(2e6), Value(2.09e6), 4.5, "alike"),
        (MORE, Value(-2.0), Value(-1.0), 50.0, "B better"),
        (MORE, Value(2e6), Value(2e6 * (1 + 1e-12)), pytest.approx(0.0, abs=1e-9), "equal"),
        (LESS, Value(0.0), Value(0.0), 0.0, "equal"),
        (LESS, Value(0.0), Value(1.0), None, "A better"),
        (MORE, Value(inf), Value(inf), None, "equal"),
        (MORE, Value(inf), Value(5.0), None, "A better"),
        (MORE, Value(5.0), Value(inf), None, "B better"),
        (MORE, Value(why="no tool"), Value(5.0), None, "not compared"),
        (NEITHER, Value(words="x and y"), Value(words="x"), None, "differs"),
        (NEITHER, Value(words="x"), Value(words="x"), None, "equal"),
    ],
)
def test_a_row(
    quantity: Quantity, a: Value, b: Value, difference: float | None, verdict: Verdict
) -> None:
    row = Row(quantity, a, b, 5.0)
    assert row.difference == difference
    assert row.verdict == verdict
    assert row.marked == (verdict in {"A better", "B better", "differs"})
    # exchanged, the other one is better
    exchanged = {"A better": "B better", "B better": "A better"}
    assert Row(quantity, b, a, 5.0).verdict == exchanged.get(verdict, verdict)


def test_numbers_as_they_are_shown() -> None:
    assert Value(41.758e6).shown("N/m") == "41.76"
    assert Value(inf).shown("N/m") == "infinite"
    assert Value(120.0).shown("1") == "120"
    assert Row(LESS, Value(0.0), Value(1.0), 5.0).shown_difference == "no ratio"
    plain = Row(MORE, Value(inf), Value(5.0), 5.0).to_dict()
    assert (plain["a"]["value"], plain["a"]["words"]) == (None, "infinite")


@pytest.fixture(scope="module")
def machines() -> tuple[Machine, Machine]:
    return sw.load(HEAD), sw.load(HEXAPOD)


@pytest.fixture(scope="module")
def compared(machines: tuple[Machine, Machine]) -> DesignComparison:
    first, second = machines
    return first.compare(second)


def test_rows_are_the_machines_own_answers(
    machines: tuple[Machine, Machine], compared: DesignComparison
) -> None:
    for machine, mark in zip(machines, "ab", strict=True):
        own = machine.stiffness()
        for k, direction in enumerate("xyz"):
            free = getattr(compared[f"home_stiffness_free_{direction}"], mark)
            blocked = getattr(compared[f"home_stiffness_blocked_{direction}"], mark)
            assert free.number == pytest.approx(own.free[k], rel=1e-12)
            assert blocked.number == pytest.approx(own.blocked[k], rel=1e-12)
        frequencies = machine.modes(3).frequencies
        found = [getattr(compared[f"frequency_{k}"], mark).number for k in (1, 2, 3)]
        np.testing.assert_allclose(found, frequencies, rtol=1e-9)
        check, forces = machine.check(), machine.assembly_forces()
        assert check.mass is not None
        assert getattr(compared["mass"], mark).number == pytest.approx(check.mass.total)
        assert forces.deviation is not None
        deviation = getattr(compared["tool_deviation"], mark).number
        assert deviation == pytest.approx(float(forces.deviation.largest.max()))


def test_every_question_has_rows_and_a_criterion(compared: DesignComparison) -> None:
    assert [row.quantity for row in compared.rows] == list(QUANTITIES)
    assert all(compared.of(question.key) and question.criterion for question in QUESTIONS)
    table = compared.to_dataframe()
    assert list(table.index) == [q.key for q in QUANTITIES]
    assert table.loc["mass", "verdict"] == "A better"
    assert "B better" in compared._repr_html_()
    with pytest.raises(KeyError):
        compared["home_stiffness"]


def test_workspaces_that_overlap(machines: tuple[Machine, Machine]) -> None:
    _, hexapod = machines
    home = hexapod.motion.task_of(hexapod.motion.home_pose)
    axes = {"x": np.linspace(-0.1, 0.1, 5), "y": np.zeros(1), "z": home[2] + np.linspace(0, 0.2, 3)}
    other = replace(hexapod, workspace=TaskGrid(axes))
    # one of them does not move along y: neither is looked at where the other cannot be compared
    assert not space_of(hexapod, other).shared
    axes["y"] = np.linspace(-0.3, 0.3, 3)
    space = space_of(hexapod, replace(hexapod, workspace=TaskGrid(axes)))
    assert space.shared
    assert space.a is not None
    spans = {
        d: (v[0] - home["xyz".index(d)], v[-1] - home["xyz".index(d)])
        for d, v in space.a.axes.items()
    }
    assert spans["x"] == pytest.approx((-0.1, 0.1))
    assert spans["y"] == pytest.approx((-0.15, 0.15))
    assert spans["z"] == pytest.approx((0.0, 0.05))


def test_a_workspace_that_one_states_and_one_that_nobody_states(
    machines: tuple[Machine, Machine],
) -> None:
    head, hexapod = machines
    none = replace(hexapod, workspace=None)
    space = space_of(head, none)
    assert space.shared
    assert space.b is not None
    assert set(space.b.axes) == {"z", "rx", "ry"}
    assert "Neither states a workspace" in space_of(replace(head, workspace=None), none).words


def test_what_has_no_tool_and_no_freedom_is_answered_in_words(tmp_path: Path) -> None:
    first, second = sw.load(BAR), sw.load(FRAME)
    found = first.compare(second)
    assert "it has no tool" in found["worst_stiffness_free_x"].b.why or second.tool is not None
    for row in found.rows:
        for value in (row.a, row.b):
            assert value.known == (value.number is not None or bool(value.words))
    assert found.report(tmp_path / "page.html").stat().st_size > 1e6


def test_a_full_disk_is_said_of_the_page(compared: DesignComparison, tmp_path: Path) -> None:
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, limits[1]))
    try:
        with pytest.raises(OutputError, match=r"page\.html: cannot be written \(File too large\)"):
            compared.report(tmp_path / "page.html")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert not list(tmp_path.iterdir())


def test_names_in_the_page_are_text(machines: tuple[Machine, Machine], tmp_path: Path) -> None:
    head, hexapod = machines
    hostile = "</script><b>1</b>"
    found = compare_designs(
        (hostile, replace(head, title=hostile)), ("B", hexapod), around=TaskGrid({"z": np.zeros(1)})
    )
    page = comparison_page(found)
    assert not found.named
    assert [chapter.key for chapter in page.chapters][1:-1] == [q.key for q in QUESTIONS]
    text = found.report(tmp_path / "page.html").read_text(encoding="utf-8")
    assert hostile not in text
    assert "&lt;b&gt;1&lt;/b&gt;" in text


def test_bad_input(machines: tuple[Machine, Machine]) -> None:
    head, hexapod = machines
    with pytest.raises(ModelError, match="are the same"):
        head.compare(sw.load(HEAD))
    for threshold in (-1.0, nan, inf):
        with pytest.raises(ModelError, match="threshold"):
            head.compare(hexapod, threshold=threshold)
    with pytest.raises(ModelError, match=r"3-rps\.toml"):
        head.compare(hexapod, {"q": 1.0})
