from __future__ import annotations

import math
from typing import Any

import pytest

from strutwork.errors import ModelError, UnitError
from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model
from strutwork.machines.model_schema import ToleranceTable
from strutwork.overconstraint import DISTRIBUTIONS, KINDS
from tests.model_files import Content, Edit, add, sample, toml

TILT = {"name": "bore", "kind": "parallelism", "joint": "hinge", "slope": "300 um/m"}


def read(*edits: Edit) -> Model:
    return parse_model(toml(sample(*edits)))


def tolerance(**changes: Any) -> Edit:
    """An edit that adds the tolerance `TILT`, changed; None drops a key."""
    content: Content = {**TILT, **changes}
    return add("tolerances", {k: v for k, v in content.items() if v is not None})


def limit(**keys: Any) -> Edit:
    return add("force_limits", keys)


def test_a_file_without_tolerances_has_none() -> None:
    model = read()
    assert (model.tolerances, dict(model.force_limits)) == ((), {})


def test_every_field_arrives_in_si() -> None:
    plane = {
        "kind": "location",
        "joint": None,
        "joints": ["hinge", "mount"],
        "slope": None,
        "size": "20 um",
        "datum": "TCP",
        "axis": [0, 0, 1],
        "along": [1, 0, 0],
        "length": "400 mm",
        "width": "30 cm",
        "distribution": "normal",
    }
    (found,) = read(tolerance(**plane)).tolerances
    assert (found.name, found.kind, found.joints) == ("bore", "location", ("hinge", "mount"))
    assert (found.size, found.length, found.width) == (20e-6, 0.4, 0.3)
    assert (found.datum, found.axis, found.along) == ("TCP", (0, 0, 1), (1, 0, 0))
    assert (found.distribution, found.slope, found.limits) == ("normal", None, None)


@pytest.mark.parametrize(
    ("given", "value"),
    [("300 um/m", 300e-6), ("0.3 mrad", 300e-6), (3e-4, 300e-6), ("1 deg", math.pi / 180)],
)
def test_a_slope_is_an_angle(given: object, value: float) -> None:
    (found,) = read(tolerance(slope=given)).tolerances
    assert found.slope == pytest.approx(value, rel=1e-15)
    assert found.distribution == "uniform"


def test_limits_of_a_length() -> None:
    content = {"kind": "length", "slope": None, "limits": ["-10 um", "30 um"]}
    (found,) = read(tolerance(**content)).tolerances
    assert found.limits == (-10e-6, 30e-6)
    assert found.middle == pytest.approx(10e-6)


def test_costs_are_one_unless_given() -> None:
    model = read(tolerance(), tolerance(name="seat", cost=2.5))
    assert dict(model.tolerance_costs) == {"bore": 1.0, "seat": 2.5}


def test_kinds_and_distributions_are_those_of_the_calculation() -> None:
    for field, known in (("kind", KINDS), ("distribution", DISTRIBUTIONS)):
        annotation = ToleranceTable.model_fields[field].annotation
        assert annotation is not None
        assert annotation.__args__ == tuple(known)


def test_force_limits_by_joint_and_quantity() -> None:
    model = read(
        limit(joints=["hinge", "mount"], radial_force="2 kN"),
        limit(joint="hinge", axial_force=500, bending_moment="3 N*m"),
    )
    assert dict(model.force_limits) == {
        ("hinge", "radial force"): 2000.0,
        ("mount", "radial force"): 2000.0,
        ("hinge", "axial force"): 500.0,
        ("hinge", "bending moment"): 3.0,
    }


def test_a_static_rating_over_its_safety_factor_limits_the_radial_force() -> None:
    model = read(limit(joint="mount", static_rating="13 kN", safety_factor=4))
    assert dict(model.force_limits) == {("mount", "radial force"): 3250.0}
    plain = read(limit(joint="mount", static_rating="13 kN"))
    assert dict(plain.force_limits) == {("mount", "radial force"): 13000.0}


WRONG: dict[str, tuple[Edit, type[ModelError], list[str]]] = {
    "size of zero": (
        tolerance(kind="position", slope=None, size=0),
        ModelError,
        ["tolerances.bore.size", "0", "above 0"],
    ),
    "negative slope": (tolerance(slope=-1e-4), ModelError, ["tolerances.bore.slope", "-0.0001"]),
    "size in a unit of force": (
        tolerance(slope=None, size="3 N", length=1),
        UnitError,
        ["tolerances.bore.size", "a force"],
    ),
    "unknown kind": (tolerance(kind="roundness"), ModelError, ["tolerances.bore.kind", "flatness"]),
    "unknown distribution": (
        tolerance(distribution="gauss"),
        ModelError,
        ["tolerances.bore.distribution", "normal"],
    ),
    "unknown key": (tolerance(sice=1), ModelError, ["tolerances.bore.sice", '"size"']),
    "unknown datum": (tolerance(datum="Q"), ModelError, ["tolerance bore", '"Q"', "A, B, C"]),
    "unknown joint": (tolerance(joint="Q"), ModelError, ["tolerance bore", '"Q"', "hinge, mount"]),
    "joint and joints": (tolerance(joints=["mount"]), ModelError, ["tolerance bore", "both"]),
    "no joint": (tolerance(joint=None), ModelError, ["tolerance bore", "neither"]),
    "empty list of joints": (
        tolerance(joint=None, joints=[]),
        ModelError,
        ["tolerance bore", "no joint"],
    ),
    "size and slope": (tolerance(size=1e-5), ModelError, ["tolerance bore", "size and slope"]),
    "no size": (tolerance(slope=None), ModelError, ["tolerance bore", "none"]),
    "upside down": (
        tolerance(kind="length", slope=None, limits=["2 um", "1 um"]),
        ModelError,
        ["tolerance bore", "lower one first"],
    ),
    "cost of zero": (tolerance(cost=0), ModelError, ["tolerances.bore.cost"]),
    "limit of an unknown joint": (
        limit(joint="Q", radial_force=1),
        ModelError,
        ["force_limits[0]", '"Q"', "hinge, mount"],
    ),
    "limit without a joint": (limit(radial_force=1), ModelError, ["force_limits[0]", "neither"]),
    "limit of nobody": (
        limit(joints=[], radial_force=1),
        ModelError,
        ["force_limits[0]", "names no joint"],
    ),
    "limit of nothing": (limit(joint="mount"), ModelError, ["force_limits[0]", "static_rating"]),
    "limit of a free direction": (
        limit(joint="mount", torque="3 N*m"),
        ModelError,
        ["force_limits[0]", "torque of mount", "radial force, axial force"],
    ),
    "limit in a wrong unit": (
        limit(joint="mount", radial_force="3 N*m"),
        UnitError,
        ["force_limits[0].radial_force"],
    ),
    "limit of zero": (
        limit(joint="mount", radial_force=0),
        ModelError,
        ["force_limits[0].radial_force", "above 0"],
    ),
    "limit and rating": (
        limit(joint="mount", radial_force=1, static_rating=2),
        ModelError,
        ["force_limits[0]", "both"],
    ),
    "safety of nothing": (
        limit(joint="mount", axial_force=1, safety_factor=2),
        ModelError,
        ["force_limits[0]", "safety_factor"],
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_messages_name_the_part(name: str) -> None:
    edit, kind, expected = WRONG[name]
    with pytest.raises(kind) as caught:
        read(edit)
    assert [part for part in expected if part not in str(caught.value)] == []


def test_a_tolerance_or_a_limit_given_twice() -> None:
    with pytest.raises(ModelError, match="tolerance bore: is defined twice"):
        read(tolerance(), tolerance())
    with pytest.raises(ModelError, match="a second time"):
        read(limit(joint="mount", radial_force=1), limit(joint="mount", static_rating=2))
