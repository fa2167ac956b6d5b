"""Statistics against values worked out by hand."""

from __future__ import annotations

import json
from math import pi

import numpy as np
import pytest
import xarray as xr

from strutwork.errors import ModelError
from strutwork.machines import hemisphere_normals
from strutwork.studies import PoseStatus, area_weights, statistics, summary
from strutwork.studies.variables import stiffness_variables

# every number below is exact in a few binary digits but for one rounding of a sum
EXACT = pytest.approx


def test_population_statistics_of_five_values() -> None:
    # mean 6; deviations -5, -4, -2, 2, 9: squares 25 + 16 + 4 + 4 + 81 = 130
    found = statistics([1.0, 2.0, 4.0, 8.0, 15.0])
    assert (found.count, found.mean, found.sample) == (5, 6.0, False)
    assert found.variance == EXACT(130 / 5, rel=1e-15)
    assert found.standard_deviation == EXACT(26**0.5, rel=1e-15)
    # linear between order statistics at 0, 1/4, 1/2, 3/4, 1
    assert found.quantiles == EXACT((1.2, 2.0, 4.0, 8.0, 13.6), rel=1e-14)


def test_sample_variance_divides_by_one_less() -> None:
    found = statistics([1.0, 2.0, 4.0, 8.0, 15.0], sample=True)
    assert found.variance == EXACT(130 / 4, rel=1e-15)
    assert found.sample


def test_weights_count_as_repetition() -> None:
    # 1, 1, 1, 5: mean 2, variance (3·1 + 9)/4 = 3, and the weights reach 3/4 at the first value
    found = statistics([1.0, 5.0], weights=[3.0, 1.0])
    assert (found.mean, found.variance) == (2.0, 3.0)
    assert found.quantiles == (1.0, 1.0, 1.0, 1.0, 5.0)


@pytest.mark.parametrize(
    ("values", "weights", "sample"),
    [
        ([], None, False),
        ([1.0, np.nan], None, False),
        ([1.0], None, True),
        ([1.0, 2.0], [1.0], False),
        ([1.0, 2.0], [1.0, -1.0], False),
        ([1.0, 2.0], [0.0, 0.0], False),
        ([1.0, 2.0], [1.0, 1.0], True),
    ],
)
def test_what_has_no_statistics_is_refused(
    values: list[float], weights: list[float] | None, sample: bool
) -> None:
    with pytest.raises(ModelError, match="statistics"):
        statistics(values, weights, sample)


def test_area_weights_cover_the_hemisphere() -> None:
    normal = hemisphere_normals(10)
    weights = area_weights(normal)
    # areas of spherical polygons, each good to rounding
    assert weights.sum() == EXACT(2 * pi, rel=1e-9)
    assert weights.min() > 0
    pole = int(normal[:, 2].argmax())
    rim = int(normal[:, 2].argmin())
    # at the pole the lattice's cell is 0.1 by 0.1, seen from above as it is; the sphere bends
    # by a thousandth over it
    assert weights[pole] == EXACT(0.01, rel=5e-3)
    assert weights[rim] > 2 * weights[pole]


def test_area_weights_of_six_directions() -> None:
    # five of an octahedron's corners: the upper one owns a sixth of the sphere, the others
    # half of a sixth above the equator
    normal = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]], dtype=float)
    assert area_weights(normal) == EXACT(np.array([4.0, 2, 2, 2, 2]) * pi / 6, rel=1e-12)


def test_area_weights_need_a_hemisphere() -> None:
    with pytest.raises(ModelError, match="below the equator"):
        area_weights(np.array([[0.0, 0.0, -1.0]]))


def dataset(stiffness: list[float], status: list[int]) -> xr.Dataset:
    """A map whose blocked and free stiffness along x are given, 2 and 3 N/m along y and z."""
    compliance = np.zeros((len(stiffness), 6, 6))
    for i, k in enumerate(stiffness):
        compliance[i] = np.diag(1 / np.array([k, 2.0, 3.0, 4.0, 5.0, 6.0]))
    codes = np.array(status, dtype=np.int8)
    variables = stiffness_variables("point", compliance, codes)
    variables["position"] = xr.Variable(
        ("point", "axis"), np.arange(3.0 * len(stiffness)).reshape(-1, 3)
    )
    variables["roll"] = xr.Variable("point", 0.1 * np.arange(len(stiffness)))
    return xr.Dataset(variables, attrs={"machine": "some machine"})


def test_summary_takes_the_points_that_count() -> None:
    mechanism = int(PoseStatus.MECHANISM)
    found = summary(dataset([1.0, 99.0, 7.0, 4.0], [0, mechanism, 0, 0]))
    axis = found.axis("x")
    assert (found.points, found.points_kept, axis.unit) == (4, 3, "N/m")
    # 1, 7, 4: mean 4, variance (9 + 9 + 0)/3
    assert axis.statistics.mean == EXACT(4.0, rel=1e-14)
    assert axis.statistics.variance == EXACT(6.0, rel=1e-14)
    assert (axis.best.index, axis.worst.index) == (2, 0)
    assert axis.best.position == (6.0, 7.0, 8.0)
    assert axis.best.roll == EXACT(0.2)
    assert found.axis("z").statistics.mean == EXACT(3.0, rel=1e-14)


def test_summary_names_units_of_rotations() -> None:
    found = summary(dataset([1.0], [0]), "free", ("rx",))
    assert found.axis("rx").unit == "N m/rad"
    assert found.axis("rx").statistics.mean == EXACT(4.0, rel=1e-14)
    assert found.to_dict()["axes"][0]["direction"] == "rx"


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"meaning": "stiff"}, "stiff"),
        ({"weights": "mass"}, "mass"),
        ({"weights": "area"}, "no hemisphere"),
        ({"directions": ("u",)}, 'unknown direction "u"'),
    ],
)
def test_summary_says_what_it_does_not_know(settings: dict[str, str], message: str) -> None:
    with pytest.raises(ModelError, match=message):
        summary(dataset([1.0], [0]), **settings)  # type: ignore[arg-type]


def test_summary_of_nothing_is_an_error() -> None:
    with pytest.raises(ModelError, match="no valid pose"):
        summary(dataset([1.0], [int(PoseStatus.UNREACHABLE)]))


def test_locked_points_make_the_mean_infinite_and_leave_quantiles_of_the_sample() -> None:
    found = statistics([1.0, np.inf, 3.0, 2.0])
    assert (found.count, found.mean, found.variance) == (4, np.inf, np.inf)
    assert found.quantiles == (1.0, 1.0, 2.0, 3.0, np.inf)
    weighted = statistics([1.0, np.inf, 3.0], [1.0, 0.0, 1.0])
    assert (weighted.mean, weighted.variance) == (2.0, 1.0)
    for bad in (np.nan, -np.inf):
        with pytest.raises(ModelError, match="not numbers"):
            statistics([1.0, bad])


def test_a_summary_has_no_infinite_number_in_its_dictionary() -> None:
    # a tool on a slide along x, at two points
    compliance = np.zeros((2, 6, 6))
    compliance[:, 0, 0] = 1e-8, 5e-9
    status = np.zeros(2, dtype=np.int8)
    variables = stiffness_variables("pose", compliance, status)
    variables["position"] = xr.Variable(("pose", "axis"), np.zeros((2, 3)))
    dataset = xr.Dataset(variables)
    found = summary(dataset)
    assert found.axis("x").statistics.mean == EXACT(1.5e8)
    assert found.axis("y").worst.value == np.inf
    axes = found.to_dict()["axes"]
    assert axes[0]["best"]["value"] == EXACT(2e8)
    assert axes[1]["worst"]["value"] is None
    assert axes[1]["statistics"]["mean"] is None
    assert set(axes[1]["statistics"]["quantiles"]) == {None}
    json.dumps(found.to_dict(), allow_nan=False)
