"""What a tolerance may be: every bad value is refused with its name and a remedy."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from strutwork.errors import ModelError
from strutwork.overconstraint import KINDS, Tolerance, misfit_sources
from tests.assemblies import block_on_joints

GOOD = Tolerance("bore", "position", ("J0",), size=1e-5)


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        ({"size": 0.0}, "size is 0"),
        ({"size": -2e-5}, "size is -2e-05"),
        ({"size": float("nan")}, "size is nan"),
        ({"size": float("inf")}, "size is inf"),
        ({"length": 0.0}, "length is 0"),
        ({"length": -0.1}, "length is -0.1"),
        ({"kind": "parallelism", "size": None, "slope": 0.0}, "slope is 0"),
        ({"kind": "parallelism", "size": None, "slope": -3e-4}, "slope is -0.0003"),
        ({"kind": "location", "length": 0.2, "width": -1.0}, "width is -1"),
        ({"kind": "roundness"}, 'unknown kind "roundness"'),
        ({"distribution": "beta"}, 'unknown distribution "beta"'),
        ({"joints": ()}, "names no joint"),
        ({"joints": ("J0", "J1", "J0")}, 'names the joint "J0" twice'),
        ({"size": None}, "needs size, one of them; it has none"),
        ({"slope": 1e-4}, "has size and slope"),
        ({"size": None, "slope": 1e-4}, "it has slope"),
        ({"size": None, "limits": (-1.0, 1.0)}, "it has limits"),
        ({"kind": "parallelism"}, "needs the length over which it holds"),
        ({"kind": "perpendicularity", "size": None}, "needs size or slope"),
        ({"kind": "parallelism", "slope": 1e-4, "length": 0.1}, "has size and slope"),
        ({"kind": "location", "length": 0.2}, "has one of length and width"),
        ({"kind": "location", "width": 0.2}, "has one of length and width"),
        ({"kind": "length", "limits": (0.0, 1e-5)}, "has size and limits"),
        ({"kind": "length", "size": None}, "needs size or limits"),
        ({"kind": "length", "size": None, "limits": (1e-5, -1e-5)}, "limits are 1e-05 and -1e-05"),
        ({"kind": "length", "size": None, "limits": (1e-5, 1e-5)}, "limits are 1e-05 and 1e-05"),
        ({"kind": "length", "size": None, "limits": (0.0, float("nan"))}, "limits are 0 and nan"),
        ({"axis": (0.0, 0.0, 0.0)}, "axis is (0.0, 0.0, 0.0)"),
        ({"axis": (0.0, float("nan"), 1.0)}, "axis is (0.0, nan, 1.0)"),
        ({"along": (0.0, 0.0, 0.0)}, "along is (0.0, 0.0, 0.0)"),
    ],
)
def test_bad_values(change: dict[str, Any], problem: str) -> None:
    with pytest.raises(ModelError) as caught:
        replace(GOOD, **change)
    assert caught.value.part == "tolerance bore"
    assert problem in caught.value.problem
    assert caught.value.remedy


def test_an_unknown_kind_is_answered_with_those_that_are_known() -> None:
    with pytest.raises(ModelError) as caught:
        replace(GOOD, kind="paralelism")
    assert all(kind in caught.value.remedy for kind in KINDS)


@pytest.mark.parametrize(
    ("tolerance", "problem", "remedy"),
    [
        (replace(GOOD, joints=("J0", "K1")), 'unknown joint "K1"', "J0, J1, J2, J3"),
        (replace(GOOD, datum="shelf"), 'unknown datum "shelf"', "A datum is a node: tool, g0, p0"),
        (
            replace(GOOD, datum="stool"),
            'datum "stool" is on stool, but the joint J0 joins ground and block',
            "a node of one of the joint's bodies",
        ),
        (
            replace(GOOD, axis=(0.0, 1.0, 0.0), along=(0.0, 2.0, 0.0)),
            "second axis",
            "not parallel",
        ),
    ],
)
def test_what_is_not_in_the_model(tolerance: Tolerance, problem: str, remedy: str) -> None:
    model = block_on_joints(1)
    model.nodes(stool=(3, 3, 3))
    with pytest.raises(ModelError) as caught:
        misfit_sources(model.place(), [tolerance])
    assert caught.value.part == "tolerance bore"
    assert problem in caught.value.problem
    assert remedy in caught.value.remedy


def test_two_of_a_name() -> None:
    other = replace(GOOD, joints=("J1",))
    with pytest.raises(ModelError, match="tolerance bore: is defined twice") as caught:
        misfit_sources(block_on_joints(1).place(), [GOOD, other])
    assert caught.value.remedy == "Give it another name."


@pytest.mark.parametrize(
    ("tolerance", "extent", "middle"),
    [
        (GOOD, 0.5e-5, 0.0),
        (Tolerance("t", "parallelism", ("J0",), slope=3e-4), 3e-4, 0.0),
        (Tolerance("t", "parallelism", ("J0",), size=3e-5, length=0.1), 3e-4, 0.0),
        (Tolerance("t", "flatness", ("J0",), size=3e-5), 1.5e-5, 0.0),
        (Tolerance("t", "length", ("J0",), size=3e-5), 3e-5, 0.0),
        (Tolerance("t", "length", ("J0",), limits=(-1e-5, 3e-5)), 2e-5, 1e-5),
    ],
)
def test_extent_and_middle_of_zones(tolerance: Tolerance, extent: float, middle: float) -> None:
    assert tolerance.extent == pytest.approx(extent, rel=1e-12)
    assert tolerance.middle == pytest.approx(middle, abs=1e-20)
