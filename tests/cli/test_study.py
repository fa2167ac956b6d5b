"""`strutwork study`: from a file to its result, and what it says about a wrong file."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from strutwork.studies.study_store import read_result
from tests.cli.conftest import Program

EXAMPLE = Path(__file__).parents[2] / "examples/studies/hexapod-struts.toml"
RPS = Path(__file__).parents[2] / "examples/machines/3-rps.toml"
SHORT = f"""
machine = "{RPS}"
answers = ["stiffness", "mass"]
workspace = {{}}
[[parameters]]
path = "materials.*.youngs_modulus"
values = ["190 GPa", "210 GPa", "230 GPa"]
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "study.toml"
    path.write_text(SHORT, encoding="utf-8")
    return path


def test_the_result_is_written_and_said(strutwork: Program, file: Path, tmp_path: Path) -> None:
    out = tmp_path / "out" / "result.nc"
    found = strutwork("study", file, "-o", out, "--json").result
    assert (found["machines"], found["solved"]) == (3, 3)
    stiffness = found["answers"]["stiffness_free_home z"]
    assert stiffness["unit"] == "N/m"
    assert stiffness["largest"]["at"] == {"materials.*.youngs_modulus": 2.3e11}
    assert stiffness["follows"]["rank_correlation"] == pytest.approx(1.0)
    assert found["answers"]["mass"]["follows"] is None
    assert found["data"] == [str(out), str(out.with_suffix(".csv"))]
    data = read_result(out)
    assert data.attrs["study_key"] == found["study_key"]
    assert float(data["stiffness_free_home"].max("direction").max()) > 0
    lines = out.with_suffix(".csv").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 4
    assert lines[0].startswith("materials.*.youngs_modulus [Pa],status,reason")
    again = strutwork("study", file, "-o", out, "--resume", "--json").result
    assert again["answers"] == found["answers"]


def test_the_answer_comes_last(strutwork: Program, file: Path) -> None:
    run = strutwork("study", file)
    assert run.status == 0, run.err
    last = run.out.strip().splitlines()[-1]
    assert last.startswith("Largest stiffness free home x")
    assert last.endswith("with materials.*.youngs_modulus 230 GPa")


def test_the_tables_alone_as_csv(strutwork: Program, file: Path) -> None:
    lines = strutwork("study", file, "--csv").out.splitlines()
    assert lines[0] == "# Answers over the machines"
    assert any(line.startswith("stiffness blocked home rz,kN·m/rad,") for line in lines)


def test_numbers_that_can_be_varied(strutwork: Program) -> None:
    found = strutwork("study", RPS, "--paths", "--json").result
    assert found["paths"]["nodes.TCP.x"]["unit"] == "m"
    assert "link_length" in strutwork("study", "proposed-3pprs", "--paths").out


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        (("youngs_modulus", "youngs_modulos"), "Did you mean"),
        (('answers = ["stiffness", "mass"]', 'answers = ["stifness"]'), 'Did you mean "stiffness"'),
        (("[[parameters]]", "[[parameter]]"), 'Did you mean "parameters"'),
        (("values =", "value ="), 'Did you mean "values"'),
        (('values = ["190 GPa", "210 GPa", "230 GPa"]', ""), "neither values nor range"),
        (("190 GPa", "190 mm"), "is a length, not a modulus"),
        (('"190 GPa"', "[1]"), "parameters[0].values"),
        (("workspace = {}", "workspace = { x = { from = 0, to = 0 } }"), "has no extent"),
        (("3-rps.toml", "3-rsp.toml"), 'Did you mean "3-rps.toml"'),
        (("machine =", "machine"), "is not TOML"),
    ],
)
def test_a_wrong_file_is_explained(
    strutwork: Program, file: Path, edit: tuple[str, str], message: str
) -> None:
    text = SHORT.replace(*edit)
    assert text != SHORT
    file.write_text(text, encoding="utf-8")
    run = strutwork("study", file)
    assert run.status == 1
    assert message in run.err
    assert run.out == ""


def test_wrong_usage(strutwork: Program, file: Path, tmp_path: Path) -> None:
    assert strutwork("study", file, "--resume").status == 2
    assert "is a model file, not a study file" in strutwork("study", RPS).err
    assert "names no kind of file" in strutwork("study", file, "-o", tmp_path / "a.txt").err
    missing = strutwork("study", tmp_path / "studdy.toml")
    assert 'Did you mean "study.toml"' in missing.err


def test_the_example_is_what_it_says() -> None:
    content = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))
    assert (EXAMPLE.parent / content["machine"]).is_file()
