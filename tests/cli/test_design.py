"""`strutwork design`: from a file to its front, a machine of it, and wrong files."""

from __future__ import annotations

from pathlib import Path

import pytest

from strutwork.studies.design_store import read_design_result
from tests.cli.conftest import Program

pytest.importorskip("pymoo")

RPS = Path(__file__).parents[2] / "examples/machines/3-rps.toml"
SHORT = f"""
machine = "{RPS}"
workspace = {{}}
[[parameters]]
path = "sections.cylinder.outer_diameter"
range = ["55 mm", "90 mm"]
name = "cylinder"
[[objectives]]
quantity = "stiffness_z"
[[objectives]]
quantity = "mass"
goal = "minimise"
[[constraints]]
quantity = "cost"
at_most = 1000
[cost]
per_kg = 8
currency = "EUR"
[[cost.parameters]]
name = "cylinder"
amount = 2
per = "1 mm"
[search]
population = 6
generations = 2
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "design.toml"
    path.write_text(SHORT, encoding="utf-8")
    return path


def test_the_front_is_written_and_one_machine_of_it(
    strutwork: Program, file: Path, tmp_path: Path
) -> None:
    out = tmp_path / "front.nc"
    found = strutwork("design", file, "-o", out, "--json").result
    assert (found["machines"], found["feasible"]) == (12, 12)
    assert found["units"]["stiffness_z"] == "N/m"
    assert found["data"] == [str(out), str(out.with_suffix(".csv"))]
    first = found["front"][0]
    assert first["cost"] == pytest.approx(8 * first["mass"] + 2000 * first["cylinder"])
    data = read_design_result(out)
    assert data.attrs["design_key"] == found["design_key"]
    lines = out.with_suffix(".csv").read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("front,cylinder [m],stiffness_z [N/m],mass [kg],cost")
    assert len(lines) == 13
    again = strutwork("design", file, "-o", out, "--resume", "--json").result
    assert again["front"] == found["front"]
    machine = tmp_path / "machine.toml"
    assert strutwork("design", out, "--pick", "1", "-o", machine).status == 0
    mass = strutwork("design", file.with_name("again.toml"), "--json")
    assert mass.status == 1
    file.write_text(SHORT.replace(str(RPS), str(machine)), encoding="utf-8")
    stated = strutwork("design", file, "--json").result["stated"]
    assert stated["mass"] == pytest.approx(first["mass"], rel=1e-9)
    assert "is not on the front" in strutwork("design", out, "--pick", "99", "-o", machine).err


def test_the_answer_comes_last(strutwork: Program, file: Path) -> None:
    run = strutwork("design", file)
    assert run.status == 0, run.err
    *_, largest, least, last = run.out.strip().splitlines()
    assert largest.startswith("Largest stiffness z: ")
    assert least.startswith("Least mass: ")
    assert last.startswith("The machine as described (stiffness z ")
    assert "EUR" in run.out


def test_a_search_along_gradients_says_where_it_ended(
    strutwork: Program, file: Path, tmp_path: Path
) -> None:
    text = f"""
machine = "{RPS}"
workspace = {{}}
[[parameters]]
path = "sections.cylinder.outer_diameter"
range = ["55 mm", "90 mm"]
name = "cylinder"
[[objectives]]
quantity = "mass"
[[constraints]]
quantity = "stiffness_z"
at_least = "stated"
[search]
method = "gradient"
starts = 2
"""
    file.write_text(text, encoding="utf-8")
    page = tmp_path / "page"
    run = strutwork("design", file, "--report", page)
    assert run.status == 0, run.err
    assert " machines along the gradients from 2 starts (SLSQP); " in run.out
    assert "2 starts ended at the same mass." in run.out
    assert "2 starts ended at the same mass." in (page / "report.html").read_text(encoding="utf-8")
    # what is kept of the machine as described: its own cylinder
    assert "Least mass: 46.97 kg, machine 1 of the front (cylinder 70 mm)." in run.out
    file.write_text(text.replace('"stiffness_z"', '"locked_in_force"'), encoding="utf-8")
    refused = strutwork("design", file)
    assert refused.status == 1
    assert "has no gradient: it is a sum of sizes" in refused.err


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        (("stiffness_z", "stiffnes_z"), 'Did you mean "stiffness_z"'),
        (('goal = "minimise"', 'goal = "least"'), "objectives"),
        (("at_most = 1000", ""), "has no limit"),
        (("[search]", "[serch]"), 'Did you mean "search"'),
        (('per = "1 mm"', 'per = "1 kg"'), "is a mass, not a length"),
        (("at_most = 1000", "at_most = 1"), "none of its 12 machines is feasible"),
        (("population = 6", "population = 1"), "population"),
        (("55 mm", "95 mm"), "Give the lower end first"),
        (("machine =", "machine"), "is not TOML"),
    ],
)
def test_a_wrong_file_is_explained(
    strutwork: Program, file: Path, edit: tuple[str, str], message: str
) -> None:
    text = SHORT.replace(*edit)
    assert text != SHORT
    file.write_text(text, encoding="utf-8")
    run = strutwork("design", file)
    assert run.status == 1
    assert message in run.err
    assert run.out == ""


def test_wrong_usage(strutwork: Program, file: Path, tmp_path: Path) -> None:
    assert strutwork("design", file, "--resume").status == 2
    assert strutwork("design", file, "--pick", "1").status == 2
    assert "is a model file, not a design file" in strutwork("design", RPS).err
    assert "names no kind of file" in strutwork("design", file, "-o", tmp_path / "a.txt").err
    assert "cannot be read" in strutwork("design", file, "--pick", "1", "-o", "a.toml").err
