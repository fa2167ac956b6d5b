"""Compliance ellipsoids: the surface is C times the unit sphere, the axes are those of a beam."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from strutwork.machines.load import load
from strutwork.machines.model_file import parse_model
from strutwork.reports.chapters import ellipsoids
from strutwork.reports.content import Chapter, Row, Table
from strutwork.reports.figures.ellipsoid import AIR, compliance_ellipsoid
from strutwork.reports.subject import Subject

MACHINES = Path(__file__).parents[2] / "examples" / "machines"

CANTILEVER = """
[materials.steel]
youngs_modulus = "200 GPa"
poissons_ratio = 0.25
density = "7850 kg/m^3"

[sections.bar]
shape = "rectangle"
width_y = "20 mm"
height_z = "40 mm"

[nodes]
root = [0, 0, 0]
tip = ["500 mm", 0, 0]

[[beams]]
name = "bar"
from = "root"
to = "tip"
material = "steel"
section = "bar"
shear = false

[[supports]]
node = "root"
fixed = "all"

[tool]
tcp = "tip"
"""


@pytest.fixture(scope="module")
def bar() -> Subject:
    return Subject(parse_model(CANTILEVER), "bar.toml", "bar")


def table(chapter: Chapter) -> Table:
    return next(b for b in chapter.blocks if isinstance(b, Table))


def test_the_surface_is_the_sphere_under_the_compliance() -> None:
    compliance = np.array([[4.0, 1.0, 0.0], [1.0, 2.0, 0.5], [0.0, 0.5, 0.4]]) * 1e-6
    spec = compliance_ellipsoid(compliance)
    surface = spec["data"][0]
    points = np.array([surface[a] for a in "xyz"])
    # six digits are drawn: 1e-5
    size = np.linalg.norm(np.linalg.solve(1e6 * compliance, points), axis=0)
    np.testing.assert_allclose(size, 1.0, rtol=0, atol=3e-4)
    values = np.linalg.eigvalsh(1e6 * compliance)
    for trace, value in zip(spec["data"][1:], values[::-1], strict=True):
        ends = np.array([trace[a] for a in "xyz"])
        assert np.linalg.norm(ends[:, 0]) == pytest.approx(value, rel=1e-5)
    reach = [-AIR * values[-1], AIR * values[-1]]
    for a in "xyz":
        assert spec["layout"]["scene"][f"{a}axis"]["range"] == pytest.approx(reach)
    assert len(set(spec["layout"]["scene"]["aspectratio"].values())) == 1


def test_axes_of_a_cantilever(bar: Subject, tmp_path: Path) -> None:
    """L³/3EI, L/EA and L/EI are exact for this beam: 1e-9 is rounding."""
    chapter = ellipsoids.write(bar)
    path = tmp_path / "ellipsoids.csv"
    chapter.files[0].write(path)
    with path.open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    young, length, wide, high = 200e9, 0.5, 0.020, 0.040
    weak, strong = young * high * wide**3 / 12, young * wide * high**3 / 12
    bent = {"z": length**3 / 3 / strong, "y": length**3 / 3 / weak}
    expected = [bent["y"], bent["z"], length / (young * wide * high)]
    moved = [float(r["length"]) for r in rows if r["motion"] == "displacement"]
    assert moved == pytest.approx(expected, rel=1e-9)
    turned = sorted(float(r["length"]) for r in rows if r["motion"] == "rotation")
    assert turned[0] == pytest.approx(length / strong, rel=1e-9)
    assert any(v == pytest.approx(length / weak, rel=1e-9) for v in turned)
    assert [str(row[4]) for row in table(chapter).rows[:3]] == [
        "0.000, 1.000, 0.000",
        "0.000, 0.000, 1.000",
        "1.000, 0.000, 0.000",
    ]


def test_the_softest_pose_of_the_workspace_stands_beside_home() -> None:
    subject = Subject(load(MACHINES / "linear-delta.toml"), "delta", "delta")
    assert ellipsoids.missing(subject) == ""
    chapter = ellipsoids.write(subject)
    places = list(dict.fromkeys(str(row[0]) for row in table(chapter).rows))
    assert len(places) == 2
    assert places[0] == "at home"
    sizes = [float(str(row[3])) for row in table(chapter).rows if row[1] == "displacement, largest"]
    free = subject.stiffness_survey["stiffness_free"].sel(direction=["x", "y", "z"]).to_numpy()
    # the largest semi-axis is at least the compliance along any axis
    assert sizes[1] >= 1e6 / np.nanmin(free) * (1 - 1e-3)
    assert sizes[1] > sizes[0]
    (row,) = [b for b in chapter.blocks if isinstance(b, Row)]
    assert {figure.data for figure in row.figures} == {ellipsoids.FILE}


def test_equal_axes_have_no_direction_of_their_own() -> None:
    round_bar = CANTILEVER.replace('height_z = "40 mm"', 'height_z = "20 mm"')
    chapter = ellipsoids.write(Subject(parse_model(round_bar), "bar.toml", "bar"))
    first, second, third = (str(row[4]) for row in table(chapter).rows[:3])
    assert first == second == "any normal to the other"
    assert third == "1.000, 0.000, 0.000"


def test_a_structure_without_a_tool_has_none() -> None:
    without = CANTILEVER.split("[tool]", maxsplit=1)[0]
    assert "no tool" in ellipsoids.missing(Subject(parse_model(without), "bar.toml", "bar"))
