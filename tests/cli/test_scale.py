"""`strutwork scale`: stiffness, frequencies and removal rate against size."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np
import pytest

from strutwork.papers.son_2002.size import mit_ss1_scale
from strutwork.studies.dataset_files import read_netcdf
from tests.cli.conftest import Program

FEW = ("--from", "0.5", "--to", "1.5", "--lengths", "2")


def test_exponents_in_json_and_files(strutwork: Program, tmp_path: Path) -> None:
    found = strutwork("scale", "mit-ss1", *FEW, "-o", tmp_path, "--json").result
    size = found["size"]
    assert size["granite"] is False
    similar, rollers, same = size["laws"]
    assert similar["stiffness_exponents"] == pytest.approx([1, 1, 1, 3, 3, 3], abs=1e-9)
    assert similar["frequency_exponents"] == pytest.approx([-1] * 4, abs=1e-9)
    ours = mit_ss1_scale()
    for law, index in ((rollers, 1), (same, 2)):
        expected = ours.stiffness_law(index).exponent
        assert law["stiffness_exponents"] == pytest.approx(expected, rel=1e-9)
        for axis, exponent in zip("xyz", expected, strict=False):
            # drives of n = 3.5: f ~ L^0.25, F ~ L^−0.25, and the stiffness as found
            last = law["removal_rate"][axis][2]
            assert last["deflection"] == pytest.approx(-0.25 - exponent, rel=1e-9)
    assert [Path(name).name for name in found["data"][2:]] == [
        "mit-ss1-size.nc",
        "mit-ss1-size-stiffness.csv",
        "mit-ss1-size-frequency.csv",
    ]
    data = read_netcdf(tmp_path / "mit-ss1-size.nc")
    assert np.allclose(data["stiffness"].values[1], rollers["stiffness"], rtol=1e-12)
    with (tmp_path / "mit-ss1-size-frequency.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 3 * len(size["factors"]) * 4
    assert float(rows[0]["frequency [Hz]"]) == pytest.approx(similar["frequencies"][0][0])


def test_exponents_in_tables(strutwork: Program) -> None:
    printed = strutwork("scale", "mit-ss1", *FEW).out
    assert "calibrated machine" in printed
    line = next(x for x in printed.splitlines() if x.startswith("│ similar joints  │ 3.5"))
    numbers = re.findall(r"-?\d+\.\d+", line)
    assert numbers == ["3.5", "0.250", "-0.250", "-1.250", "-1.250", "-1.250"]


@pytest.mark.slow
def test_on_the_granite(strutwork: Program) -> None:
    found = strutwork("scale", "mit-ss1", *FEW, "--granite", "--json").result
    size = found["size"]
    assert size["granite"] is True
    assert size["laws"][0]["frequency_exponents"] == pytest.approx([-1] * 10, abs=1e-9)
    # the mounts are softer than all else: the same mounts leave a large machine as soft
    assert size["laws"][2]["stiffness_exponents"][0] < 0.2
