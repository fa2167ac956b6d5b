"""Datasets over poses: one unit an attribute, coordinates of every pose, a table and a plot."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pint_xarray
import pytest
import xarray as xr

import strutwork as sw
from strutwork.errors import ModelError
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.overconstraint import Quantity
from strutwork.studies.answers import Assembly
from strutwork.studies.dataset_files import read_netcdf, to_json, write_netcdf
from strutwork.studies.dataset_units import (
    LabelledUnits,
    label_units,
    split_units,
    unit_at,
    unit_attributes,
    unit_coordinate,
)
from strutwork.studies.survey import survey
from strutwork.studies.survey_files import write_survey
from strutwork.studies.variables import named

HEXAPOD = Path(__file__).parents[2] / "examples" / "machines" / "6-ups.toml"


@pytest.fixture(scope="module")
def found() -> xr.Dataset:
    return sw.load(HEXAPOD).survey({"x": [-0.1, 0.0, 0.1], "ry": [0.0, 0.1]})


def test_pint_reads_every_unit(found: xr.Dataset) -> None:
    # pint-xarray refuses a dataset with one unit that it cannot read
    quantified = found.pint.quantify()
    assert str(quantified["x"].pint.units) == "meter"
    assert "component_units" in found["stiffness_free"].attrs
    apart = found.strutwork.split_units().pint.quantify()
    units = {
        "stiffness_free_translation": "newton / meter",
        "stiffness_free_rotation": "newton * meter / radian",
        "joint_coordinate_translation": "meter",
        "joint_coordinate_rotation": "radian",
    }
    assert {name: f"{apart[name].pint.units:D}" for name in units} == {
        name: f"{pint_xarray.unit_registry.Unit(unit):D}" for name, unit in units.items()
    }
    assert not any("component_units" in v.attrs for v in apart.data_vars.values())


def test_units_apart_hold_the_same_numbers(found: xr.Dataset) -> None:
    apart = split_units(found)
    np.testing.assert_array_equal(
        apart["stiffness_free_rotation"].sel(direction_rotation="rz"),
        found["stiffness_free"].sel(direction="rz"),
    )
    np.testing.assert_array_equal(
        apart["joint_coordinate_translation"].sel(joint_translation="drive1:z"),
        found["joint_coordinate"].sel(joint="drive1:z"),
    )


@pytest.mark.parametrize(
    ("text", "labels", "units"),
    [
        ("N/m for x y z; N m/rad for rx ry rz", ["y", "ry"], ["N/m", "N m/rad"]),
        ("m for x y z; rad for rx ry rz", ["rz", "x"], ["rad", "m"]),
        ("Hz", ["rx", "x"], ["Hz", "Hz"]),
        # no label says its own unit
        ("m or rad", ["ball:rx", "rx:z"], []),
        ("N, N m, m or rad", ["tool rotation in rx", "block radial force"], []),
        ("N/m for x y z; N m/rad for rx ry rz", ["x", "elsewhere"], []),
    ],
)
def test_units_are_those_that_the_text_states(
    text: str, labels: list[str], units: list[str]
) -> None:
    size = xr.Variable("label", np.ones(len(labels)), unit_attributes(text))
    data = xr.Dataset({"size": size}, coords={"label": labels})
    assert list(label_units(data, "size").values()) == units
    assert unit_at(data, "size", labels[0]) == (units[0] if units else text)


def test_a_joint_whose_name_sounds_like_a_turn_of_the_tool() -> None:
    # by its words "tool rotation torque" was an angle of the tool
    quantities = (
        Quantity("tool rotation", "torque", ("rz",), "N*m"),
        Quantity(None, "displacement", ("x",), "m"),
        Quantity("block", "radial force", ("x", "y"), "N"),
    )
    (column,) = Assembly((), quantities).columns
    assert isinstance(column.unit, LabelledUnits)
    names = [q.name for q in quantities]
    data = xr.Dataset(
        {"worst_case": named("quantity", np.arange(3.0), column.unit, "")},
        coords={"quantity": names} | unit_coordinate("worst_case", "quantity", column.unit),
    )
    assert label_units(data, "worst_case") == dict(zip(names, ["N m", "m", "N"], strict=True))
    apart = split_units(data)
    assert apart["worst_case_moment"].attrs["units"] == "N m"
    assert apart["worst_case_translation"].item() == 1.0
    assert not [name for name in apart.coords if str(name).endswith("_unit")]


def test_a_survey_of_tolerances_has_the_units_of_its_quantities(tmp_path: Path) -> None:
    model = sw.load(HEXAPOD.with_name("gantry.toml"))
    assembly = Assembly.of(model)
    grid = TaskGrid({"x": np.array([0.0, 0.01])})
    data = survey(model, grid, (assembly,))
    expected = {q.name: q.unit.replace("*", " ") for q in assembly.quantities}
    assert label_units(data, "worst_case") == expected
    parts = {"force", "moment", "translation", "rotation"}
    assert {f"worst_case_{part}" for part in parts} <= set(split_units(data))
    with write_survey(tmp_path / "s.csv", data).open(encoding="utf-8") as file:
        head = next(csv.reader(file))
    assert {f"worst_case {name}, {unit}" for name, unit in expected.items()} <= set(head)


def test_files_and_attributes_state_units_in_words_alone(found: xr.Dataset, tmp_path: Path) -> None:
    assert found["joint_coordinate"].attrs == {
        "component_units": "m or rad",
        "long_name": "joint coordinates",
    }
    back = read_netcdf(write_netcdf(tmp_path / "s.nc", found))
    assert set(back.coords) == set(found.coords) - {"joint_coordinate_unit"}
    assert {n: v.attrs for n, v in back.data_vars.items()}.keys() == found.data_vars.keys()
    assert all(
        back[n].attrs.get(key) == found[n].attrs.get(key)
        for n in found.data_vars
        for key in ("units", "component_units")
    )
    assert "joint_coordinate_unit" not in to_json(found)["coordinates"]
    # what the text itself states is known of the file as well
    assert "stiffness_free_rotation" in split_units(back)
    assert "joint_coordinate" in split_units(back)


def test_every_pose_has_all_its_coordinates(found: xr.Dataset) -> None:
    # what the grid does not name stays at home: the tool stands 900 mm high
    assert set(found.coords) >= {"x", "y", "z", "rx", "ry", "rz"}
    np.testing.assert_allclose(found["z"], 0.9, atol=1e-9)
    np.testing.assert_allclose(found["y"], 0.0, atol=1e-9)
    frame = found.strutwork.to_dataframe()
    assert len(frame) == 6
    assert list(frame.index.names) == ["x", "ry"]
    assert {"y", "z", "rx", "rz", "stiffness_free_rz"} <= set(frame)


def test_what_follows_is_among_them() -> None:
    # a 3-RPS turns about x and y and moves along z: as it turns, its tool moves aside
    tripod = sw.load(Path(__file__).parents[2] / "examples" / "03_tripod.toml")
    found = tripod.survey({"ry": [0.0, 0.1]})
    assert np.hypot(found["x"], found["y"]).diff("ry").item() > 1e-5
    np.testing.assert_allclose(found["rx"], 0.0, atol=1e-9)


def test_a_plot_marks_the_worst_pose(found: xr.Dataset) -> None:
    figure = found.strutwork.plot("stiffness_free", "z")
    contour, mark = figure.data
    values = 1e-6 * found["stiffness_free"].sel(direction="z").to_numpy()
    np.testing.assert_allclose(contour.z, values.T)
    assert figure.layout.xaxis.title.text == "x, mm"
    assert figure.layout.yaxis.title.text == "ry, deg"
    at = np.unravel_index(values.argmin(), values.shape)
    assert mark.x[0] == pytest.approx(1e3 * found["x"][at[0]].item())
    assert "worst" in mark.name
    curve = found.isel(ry=0).strutwork.plot().data[0]
    np.testing.assert_allclose(curve.y, 1e-6 * found["stiffness_free"][:, 0, 0])


def test_plots_that_are_refused(found: xr.Dataset) -> None:
    with pytest.raises(ModelError, match='Did you mean "stiffness_free"'):
        found.strutwork.plot("stifness_free")
    with pytest.raises(ModelError, match="Labels: x, y, z"):
        found.strutwork.plot("stiffness_free", "w")
    with pytest.raises(ModelError, match=r"along 0\.\nSelect"):
        found.isel(x=[0], ry=[0]).strutwork.plot()
