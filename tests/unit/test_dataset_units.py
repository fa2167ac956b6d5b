"""Datasets over poses: one unit an attribute, coordinates of every pose, a table and a plot."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pint_xarray
import pytest
import xarray as xr

import strutwork as sw
from strutwork.errors import ModelError
from strutwork.studies.dataset_units import split_units, unit_of_label

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
    ("units", "label", "unit"),
    [
        ("N/m for x y z; N m/rad for rx ry rz", "y", "N/m"),
        ("N/m for x y z; N m/rad for rx ry rz", "ry", "N m/rad"),
        ("m or rad", "ball:rx", "rad"),
        ("m or rad", "rx:z", "m"),
        ("N; N m; m; rad", "tool rotation rx", "rad"),
        ("N; N m; m; rad", "block radial_force", "N"),
        ("N, N m, m or rad", "block bending_moment", "N m"),
        ("N/m", "rx", "N/m"),
        ("Hz", "1", "Hz"),
    ],
)
def test_the_unit_under_a_label(units: str, label: str, unit: str) -> None:
    assert unit_of_label(units, label) == unit


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
