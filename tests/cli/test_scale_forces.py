"""`strutwork scale`: assembly forces against the length of the struts."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from tests.cli.conftest import Program


def test_scale_in_json_tables_and_files(strutwork: Program, tmp_path: Path) -> None:
    few = ("--from", "0.5", "--to", "1.5", "--lengths", "3")
    found = strutwork("scale", "mit-ss1", *few, "-o", tmp_path, "--json").result
    assert found["lengths"] == [0.5, 1.0, 1.5]
    # Table 2, largest radial force of joint 1: 9.7, 19.6 and 29.4 kN, met within 4 %
    ours = [row[0] for row in found["radial_force"]]
    assert ours == pytest.approx([9.7e3, 19.6e3, 29.4e3], rel=0.04)
    with (tmp_path / "mit-ss1-scale.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 3 * 2 * 6
    assert float(rows[0]["force [N]"]) == pytest.approx(ours[0], rel=1e-12)
    printed = strutwork("scale", "mit-ss1", *few)
    assert "Largest axial force, kN" in printed.out
    assert "calibrated" in printed.out


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (("eclipse-3pprs",), "Name a model that can"),
        (("mit-ss1", "--from", "2", "--to", "1"), "from 2 to 1 m"),
        (("mit-ss1", "--from", "0"), "--from of at least"),
        (("mit-ss1", "--tilt", "3 mm"), "an angle"),
        (("mit-ss1", "--tilt", "-3e-4"), "positive"),
        (("mit-ss1", "--width-ratio", "0"), "width"),
    ],
)
def test_scale_refuses(arguments: tuple[str, ...], expected: str, strutwork: Program) -> None:
    run = strutwork("scale", *arguments, "--json")
    assert (run.status, run.out) == (1, "")
    assert expected in run.err
