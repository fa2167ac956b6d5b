"""Numbers that people read: what is rounding beside what it was made from is 0."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from strutwork.machines.model_file import parse_model, read_model
from strutwork.msa import tool_compliance
from strutwork.reports.build import write_report
from strutwork.reports.model_solution import solve_model
from strutwork.reports.numbers import matrix_without_rounding
from strutwork.reports.solution_tables import FORCE_TABLES, shown_energy, shown_tables

ROOT = Path(__file__).parents[2]
CASES = ROOT / "tests" / "cases"


def test_a_settlement_that_strains_nothing_has_no_force_and_no_energy() -> None:
    """A leg that is statically determinate follows its base; its forces were 1e-15 N."""
    found = solve_model(read_model(str(ROOT / "examples" / "05_two_link_leg.toml")))
    number = found.statics.cases.index("settle")
    tables = shown_tables(found, number)
    for _, _, key in FORCE_TABLES:
        assert not any(np.any(six) for six in tables[key].values())
    assert any(np.any(six) for six in tables["displacements"].values())
    assert shown_energy(found, number) == 0.0
    # a load that does strain keeps its own
    other = next(i for i, c in enumerate(found.model.cases) if c.wrenches)
    assert shown_energy(found, other) == found.statics.strain_energy[other] > 0.0
    assert any(np.any(six) for six in shown_tables(found, other)["beam_forces"].values())


def test_a_settlement_that_strains_keeps_its_small_force() -> None:
    """12 EI δ/l³ of a thin wire, seven orders below what EA/l of its elements would take."""
    text = (CASES / "models" / "f7_preload_ignored.toml").read_text(encoding="utf-8")
    text = text[: text.index("[[loads]]")]
    text += '[[settlements]]\ncase = "sink"\nnode = "A"\ndisplacement = { z = 1e-3 }\n'
    found = solve_model(parse_model(text))
    inertia = np.pi * 0.001**4 / 64
    force = 12 * 210e9 * inertia * 1e-3
    shown = shown_tables(found, 0)["reactions"]["A"][2]
    assert abs(shown) == pytest.approx(force, rel=1e-4)
    assert shown_energy(found, 0) == pytest.approx(force * 1e-3 / 2, rel=1e-4)


@pytest.mark.parametrize(
    ("name", "still"),
    [
        ("models/skew_guide", [2, 3, 4, 5]),
        ("models/f1b_rotary_table", [2, 3, 4]),
        ("models/f2_four_rigid_blocks", [1, 2, 3, 4, 5]),
        ("robustness/straight_guide", [1, 2, 3, 4, 5]),
        ("robustness/skew_guide2", [3, 4, 5]),
    ],
)
def test_directions_that_do_not_take_part_are_exactly_zero(name: str, still: list[int]) -> None:
    compliance = tool_compliance(read_model(CASES / f"{name}.toml").placed)
    shown = matrix_without_rounding(compliance)
    assert not np.any(shown[still])
    assert not np.any(shown[:, still])
    moving = np.setdiff1d(range(6), still)
    block = np.ix_(moving, moving)
    np.testing.assert_array_equal(shown[block], compliance[block])


def test_a_stiff_direction_is_not_taken_for_one_that_stands_still() -> None:
    matrix = np.diag([1.0, 1e-12, 1.0, 1e-6, 1e-18, 1e-6])
    np.testing.assert_array_equal(matrix_without_rounding(matrix), matrix)


@pytest.mark.filterwarnings("ignore::strutwork.errors.ModelWarning")
def test_a_page_has_no_rounding(tmp_path: Path) -> None:
    for name in ("skew_guide", "f1b_rotary_table"):
        write_report(str(CASES / "models" / f"{name}.toml"), tmp_path / name)
        page = (tmp_path / name / "report.html").read_text(encoding="utf-8")
        text = re.sub(r"<(script|svg|style).*?</\1>|<[^>]+>", " ", page, flags=re.DOTALL)
        assert "7.500e-9" in text or "9.000e-7" in text
        assert not re.search(r"e[-\N{MINUS SIGN}](1[5-9]|[2-9]\d)\b", text)
