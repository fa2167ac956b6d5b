"""`strutwork study`: from a file to its result, and what it says about a wrong file."""

from __future__ import annotations

import errno
import resource
import tomllib
from functools import partial
from pathlib import Path

import pytest

from strutwork.files import write_error
from strutwork.studies import study_store
from strutwork.studies.study import Study
from strutwork.studies.study_machines import Machines
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

SCATTER = 'distribution = "normal"\nscatter = "5 %"'


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
        (("values =", 'name = "mass"\nvalues ='), "has the name of something else in the result"),
        (("values =", 'name = "direction"\nvalues ='), "has the name of something else"),
        (("materials.*.youngs_modulus", "mass"), "study MACHINE --paths` lists all"),
        (('values = ["190 GPa", "210 GPa", "230 GPa"]', ""), "neither values nor range"),
        (("190 GPa", "190 mm"), "is a length, not a modulus"),
        (('"190 GPa"', "[1]"), "parameters[0].values"),
        (("workspace = {}", "workspace = { x = { from = 0, to = 0 } }"), "has no extent"),
        (("3-rps.toml", "3-rsp.toml"), 'Did you mean "3-rps.toml"'),
        (("machine =", "machine"), "is not TOML"),
        (('values = ["190 GPa", "210 GPa", "230 GPa"]', "values = []"), "neither values nor range"),
        (('"190 GPa"', '"-1 GPa"'), "Give a modulus above 0"),
        (('values = ["190 GPa", "210 GPa", "230 GPa"]', 'distribution = "gauss"'), "distribution"),
        (('values = ["190 GPa", "210 GPa", "230 GPa"]', SCATTER), "sample.count: is missing"),
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


def test_poses_that_machines_miss_are_said(strutwork: Program, file: Path) -> None:
    some = "workspace = { z = { from = 0.65, to = 1.0, points = 4 } }"
    file.write_text(SHORT.replace("workspace = {}", some), encoding="utf-8")
    said = strutwork("study", file).out
    assert "The machines can be asked at 2 of the 4 poses (others are out of reach" in said
    far = "workspace = { z = { from = 1.5, to = 2.0, points = 2 } }"
    file.write_text(SHORT.replace("workspace = {}", far), encoding="utf-8")
    said = strutwork("study", file).out
    assert "No machine can be asked at any of the 2 poses" in said
    assert "Stiffness free worst has no finite value in any machine." in said


def test_wrong_usage(strutwork: Program, file: Path, tmp_path: Path) -> None:
    assert strutwork("study", file, "--resume").status == 2
    assert "is a model file, not a study file" in strutwork("study", RPS).err
    assert "names no kind of file" in strutwork("study", file, "-o", tmp_path / "a.txt").err
    missing = strutwork("study", tmp_path / "studdy.toml")
    assert 'Did you mean "study.toml"' in missing.err


def test_the_example_is_what_it_says() -> None:
    content = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))
    assert (EXAMPLE.parent / content["machine"]).is_file()


def test_scatter_is_said_last_and_in_json(strutwork: Program, file: Path) -> None:
    values = 'values = ["190 GPa", "210 GPa", "230 GPa"]'
    file.write_text(SHORT.replace(values, SCATTER) + "[sample]\ncount = 8\n", encoding="utf-8")
    run = strutwork("study", file)
    assert run.status == 0, run.err
    assert "Scatter of the answers, with 95 % intervals" in run.out
    last = run.out.strip().splitlines()[-1]
    assert last.startswith("Stiffness free home x: mean ")
    assert "5 % of the machines are below" in last
    found = strutwork("study", file, "--json").result["scatter"]
    assert found["quantiles"] == [0.05, 0.5, 0.95]
    # eight machines say nothing of where the lowest twentieth may end
    assert found["answers"]["stiffness_free_home x"]["quantile_interval"][0][0] is None


def test_indices_are_said_last_and_in_json(strutwork: Program, file: Path) -> None:
    pytest.importorskip("SALib")
    text = (
        SHORT.replace(
            'values = ["190 GPa", "210 GPa", "230 GPa"]', 'range = ["190 GPa", "230 GPa"]'
        )
        + '[[parameters]]\npath = "materials.*.density"\nrange = [7000, 8000]\n'
        + '[sample]\nkind = "saltelli"\ncount = 8\nsecond_order = true\n'
    )
    file.write_text(text, encoding="utf-8")
    run = strutwork("study", file)
    assert run.status == 0, run.err
    assert "Sobol indices of second order" in run.out
    last = run.out.strip().splitlines()[-1]
    assert "depends most on materials.*.youngs_modulus: total Sobol index" in last
    found = strutwork("study", file, "--json").result["sobol"]
    mass = found["indices"]["mass"]
    assert mass["materials.*.youngs_modulus"]["total"] == pytest.approx(0.0, abs=1e-12)
    assert mass["materials.*.density"]["total"] > 0.5
    assert found["second"]["mass"][0]["parameters"] == list(mass)


def test_kept_parts_serve_the_same_study_again(
    strutwork: Program, file: Path, tmp_path: Path
) -> None:
    kept, out = tmp_path / "kept", tmp_path / "result.nc"
    first = strutwork("study", file, "--keep", kept, "-o", out, "--json").result
    parts = list(kept.rglob("*"))
    assert any(p.is_file() for p in parts)
    again = strutwork("study", file, "--keep", kept, "--json")
    assert again.result["answers"] == first["answers"]
    assert not out.with_name("result.nc.parts").exists()


def test_a_cluster_that_does_not_answer_is_named(
    strutwork: Program, file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("distributed")
    cluster = pytest.importorskip("strutwork.studies.cluster")
    monkeypatch.setattr(cluster, "Dask", partial(cluster.Dask, patience=1.0))
    run = strutwork("study", file, "--cluster", "tcp://127.0.0.1:9")
    assert run.status == 1
    assert "127.0.0.1:9" in run.err
    assert run.out == ""


def test_a_full_disk_loses_nothing(
    strutwork: Program, file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(path: Path, _: object) -> Path:
        raise write_error(path, OSError(errno.ENOSPC, "No space left on device"))

    out = tmp_path / "result.nc"
    monkeypatch.setattr(study_store, "write_netcdf", full)
    run = strutwork("study", file, "-o", out)
    assert run.status == 3
    assert "result.nc" in run.err
    assert "o space left on device" in run.err
    assert "is kept beside" in run.err
    assert not out.exists()
    monkeypatch.undo()
    assert "Give --resume" in strutwork("study", file, "-o", out).err
    monkeypatch.setattr(Machines, "__call__", None)
    assert strutwork("study", file, "-o", out, "--resume").status == 0
    assert out.is_file()


def test_a_disk_that_was_full_from_the_start_leaves_nothing_to_resume(
    strutwork: Program, file: Path, tmp_path: Path
) -> None:
    out = tmp_path / "result.nc"
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, limits[1]))
    try:
        run = strutwork("study", file, "-o", out)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert run.status == 3
    assert "cannot be written (File too large)" in run.err
    assert "kept beside" not in run.err
    assert strutwork("study", file, "-o", out).status == 0
    (tmp_path / "folder.nc").mkdir()
    assert "is a folder" in strutwork("study", file, "-o", tmp_path / "folder.nc").err


def test_the_result_of_another_study_or_version_is_not_overwritten(
    strutwork: Program, file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "result.nc"
    assert strutwork("study", file, "-o", out).status == 0
    before = out.read_bytes()
    monkeypatch.setattr(Study, "code", "0")
    assert "of this study by other code" in strutwork("study", file, "-o", out).err
    file.write_text(SHORT.replace("230 GPa", "240 GPa"), encoding="utf-8")
    run = strutwork("study", file, "-o", out)
    assert run.status == 1
    assert "holds the result of another study" in run.err
    assert "Name another file, or remove this one." in run.err
    assert out.read_bytes() == before
