"""A machine whose numbers change by their path: what changes, what is shared, what is refused."""

from __future__ import annotations

import copy
import pickle
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from strutwork import load
from strutwork.errors import ModelError, UnitError
from strutwork.machines import model_rebuild
from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model
from strutwork.machines.model_numbers import Steps
from strutwork.machines.proposed_3pprs import Proposed3PPRS
from strutwork.msa import tool_compliance
from strutwork.msa.variant_of import origin_of
from strutwork.studies.description import plain
from strutwork.studies.parametric import Parametric
from tests.model_files import SAMPLE, toml

MACHINES = Path(__file__).parents[2] / "examples/machines"
HEXAPOD = MACHINES / "6-ups.toml"
TEXT = HEXAPOD.read_text(encoding="utf-8")


def content(model: Model) -> Any:
    """Everything that a model states, as plain values."""
    p = model.placement
    return [
        *(plain(v) for v in (model.structure, model.cases, model.limits, model.drives)),
        *(plain(v) for v in (model.tolerances, model.tolerance_costs, model.damping, model.title)),
        *(plain(v) for v in (p.positions, p.frames, p.values, p.names, model.supports)),
        plain(None if model.workspace is None else dict(model.workspace.axes)),
        {str(k): v for k, v in model.force_limits.items()},
    ]


def edited(data: dict[str, Any], places: tuple[Steps, ...], value: float) -> dict[str, Any]:
    """The content of a file with another number."""
    data = copy.deepcopy(data)
    for steps in places:
        at: Any = data
        for step in steps[:-1]:
            at = at[step]
        last = steps[-1]
        at[last.rstrip("_") if isinstance(last, str) else last] = value
    return data


@pytest.fixture(scope="module")
def hexapod() -> Parametric:
    return Parametric.of(HEXAPOD)


def test_the_numbers_of_a_file_with_units_and_meanings(hexapod: Parametric) -> None:
    assert len(hexapod.paths) == 299
    diameter = hexapod.paths["sections.ram.diameter"]
    assert (diameter.value, diameter.unit, diameter.meaning) == (0.05, "m", "diameter")
    stiffness = hexapod.paths["joints.cardan1.stiffness.ry"]
    assert (stiffness.value, stiffness.unit) == (1e6, "N*m/rad")
    assert hexapod.paths["nodes.TCP.z"].value == 0.9
    assert hexapod.paths["home.drive1.z"].meaning.startswith("joint coordinates")
    assert all(number.meaning for number in hexapod.paths.values())


@given(st.data())
@settings(max_examples=40, deadline=None)
def test_a_changed_value_comes_back_as_if_the_file_stated_it(
    hexapod: Parametric, data: st.DataObject
) -> None:
    fixed = ("nodes.", "axis", "home.", "points")
    light = [p for p in hexapod.paths if not any(word in p for word in fixed)]
    paths = data.draw(st.lists(st.sampled_from(light), min_size=1, max_size=4, unique=True))
    # within the ranges of Poisson's ratio, of tubes and of joint ranges
    values = {p: hexapod.paths[p].value * data.draw(st.floats(0.9, 1.1)) for p in paths}
    model = hexapod.model(values)
    changed: dict[str, Any] = tomllib.loads(TEXT)
    for path, value in values.items():
        changed = edited(changed, hexapod.paths[path].places, value)
    again = Parametric.of(changed)
    assert again.values(paths) == pytest.approx(values, rel=1e-15)
    assert content(model) == content(again.origin.model)


def test_paths_of_every_kind_reach_what_they_name() -> None:
    sample = Parametric.of(SAMPLE)
    data = tomllib.loads(toml(SAMPLE))
    for path, number in sample.paths.items():
        value = number.value * 1.01 if isinstance(number.value, float) else number.value + 1
        try:
            model = sample.model({path: value})
        except ModelError:
            # a node or an axis that leaves its joint
            assert path.startswith(("nodes.", "joints.")), path
            continue
        assert content(model) == content(parse_model(toml(edited(data, number.places, value))))


def test_what_moves_nothing_is_not_closed_again(
    hexapod: Parametric, monkeypatch: pytest.MonkeyPatch
) -> None:
    base = hexapod.model()

    def refuse(*_: object) -> None:
        raise AssertionError("built anew")

    monkeypatch.setattr(model_rebuild, "build_model", refuse)
    model = hexapod.model({"sections.ram.diameter": "80 mm", "joints.ball*.stiffness.z": "1 N/um"})
    assert model.placement is base.placement
    assert model.motion.joints is base.motion.joints
    assert model.motion.linkage is model.structure.linkage
    assert {j.stiffness["z"] for j in model.structure.linkage.joints if "ball" in j.name} == {1e6}
    # what moves is placed anew, and is not built anew either
    for path, value in (("nodes.TCP.z", 0.91), ("joints.cardan1.axis.x", 0.4)):
        other = hexapod.model({path: value})
        assert other.motion.joints is not base.motion.joints
        assert origin_of(other.structure) is base.structure
    assert hexapod.model({"nodes.TCP.z": 0.91}).placement.positions[0, 2] == 0.91
    with pytest.raises(AssertionError, match="built anew"):
        hexapod.model({"home.drive1.z": 0.01})


def test_the_geometry_moves_and_closes() -> None:
    machine = Parametric.of(HEXAPOD)
    model = machine.model({"nodes.TCP.z": "950 mm"})
    assert model.placement.positions[0, 2] == 0.95
    with pytest.raises(ModelError, match=r"cardan1.*0\.005 m apart"):
        machine.model({"nodes.foot1.z": "5 mm"})
    both = machine.model({"nodes.foot1.z": "5 mm", "nodes.base1.z": "5 mm"})
    assert np.abs(both.motion.home.positions - machine.model().placement.positions).max() == 0.005


def test_stiffness_follows_the_section(hexapod: Parametric) -> None:
    thick = hexapod.model({"sections.ram.diameter": 0.06})
    assert thick.motion.legs is hexapod.model().motion.legs
    before, after = (tool_compliance(m.placed)[2, 2] for m in (hexapod.model(), thick))
    assert after < before


def test_a_symmetric_matrix_changes_on_both_sides() -> None:
    machine = Parametric.of(HEXAPOD)
    assert "bodies.platform.inertia.y.x" not in machine.paths
    inertia = np.array(
        machine.model({"bodies.platform.inertia.x.y": 0.1}).structure.masses[0].inertia
    )
    assert inertia[0, 1] == inertia[1, 0] == 0.1


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"sections.rams.diameter": 1}, 'Did you mean "sections.ram.diameter"'),
        ({"sections.ram.width": 1}, r"There are sections\.ram\.diameter\."),
        ({"zzz": 1}, "Paths begin with gravity, materials"),
        ({"sections.x*": 1}, "names no number"),
        ({"joints.*.stiffness.*": 1}, "different units"),
        ({"sections.ram.diameter": 0.05, "sections.*.diameter": 0.06}, "is named by"),
        ({"sections.ram.diameter": "-1 mm"}, "above 0"),
        ({"sections.ram.diameter": float("nan")}, "not a finite number"),
        ({"sections.cylinder.inner_diameter": "90 mm"}, "not below outer_diameter"),
        ({"workspace.x.points": 2.5}, "whole number of at least 2"),
        ({"workspace.x.points": float("inf")}, "whole number of at least 2"),
    ],
)
def test_what_cannot_be_is_refused_by_name(
    hexapod: Parametric, values: dict[str, float | str], message: str
) -> None:
    with pytest.raises(ModelError, match=message):
        hexapod.model(values)


def test_another_dimension_is_refused(hexapod: Parametric) -> None:
    with pytest.raises(UnitError, match=r"sections\.ram\.diameter: .* is a mass, not a length"):
        hexapod.model({"sections.ram.diameter": "3 kg"})


def test_names_with_dots_and_stars_are_quoted() -> None:
    content = copy.deepcopy(SAMPLE)
    content["sections"] = {"a.b": SAMPLE["sections"]["tube"], "c*": SAMPLE["sections"]["bar"]}
    content["beams"][0]["section"], content["beams"][1]["section"] = "a.b", "c*"
    machine = Parametric.of(toml(content))
    model = machine.model({'sections."a.b".outer_diameter': 0.05, 'sections."c*".width_y': 0.021})
    assert [b.section.outline[0] for b in model.structure.beams] == [0.05, 0.021]


def test_it_may_be_sent_to_another_process(hexapod: Parametric) -> None:
    for machine in (hexapod, Parametric.of("hexel-hexapod"), Parametric.of("proposed-3pprs:blind")):
        path, number = next(iter(machine.paths.items()))
        sent = pickle.loads(pickle.dumps(machine))  # noqa: S301 - its own bytes
        values = {path: number.value + 0.01}
        assert plain(sent.model(values).structure) == plain(machine.model(values).structure)


def test_a_machine_of_the_catalogue() -> None:
    machine = Parametric.of("proposed-3pprs")
    assert machine.paths["link_length"].unit == "m"
    model = machine.model({"link_length": "236 mm", "section.outer_diameter": "20 mm"})
    direct = Proposed3PPRS(link_length=0.236)
    assert np.allclose(model.placement.positions, direct.place(direct.home()).positions)
    assert {b.section.name for b in model.structure.beams} == {"tube 19/14"}
    assert {b.section.outline[0] for b in model.structure.beams} == {0.02}
    nested = Parametric.of("proposed-3pprs:blind").model({"base.link_length": 0.22})
    assert nested.structure.masses
    listed = Parametric.of("mit-ss1").model({"strut_lengths[*": 0.45, "elements": 2})
    assert {b.elements for b in listed.structure.beams} == {2}
    with pytest.raises(ModelError, match=r"cannot stand at home|out of all proportion"):
        machine.model({"link_length": "10 mm"})
    with pytest.raises(ModelError, match="states none here"):
        Parametric.of("prototype-3ppprs").model({"stage_angles[0]": "3 deg"})


def test_where_it_comes_from() -> None:
    loaded = load(HEXAPOD)
    assert Parametric.of(loaded).paths.keys() == Parametric.of(TEXT).paths.keys()
    assert Parametric.of(Proposed3PPRS()).paths["link_length"].value == 0.216
    assert Parametric.of(Parametric.of("hexel-hexapod")).source == "hexel-hexapod"
    with pytest.raises(ModelError, match="was changed or moved"):
        Parametric.of(loaded.at(z="880 mm"))
    with pytest.raises(ModelError, match="Did you mean"):
        Parametric.of("hexel-hexapood")
    with pytest.raises(ModelError, match="does not exist"):
        Parametric.of("missing.toml")
    with pytest.raises(ModelError, match="states no numbers"):
        Parametric.of(3)


def test_a_solid_is_reduced_again_only_where_its_material_changes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    machine = Parametric.of(MACHINES / "gantry.toml")
    base = machine.model()

    def refuse(*_: object) -> None:
        raise AssertionError("built anew")

    monkeypatch.setattr(model_rebuild, "build_model", refuse)
    for path in ("materials.steel.youngs_modulus", "joints.y1.stiffness.x"):
        changed = machine.model({path: 1.01 * machine.paths[path].value})
        assert changed.structure.elements is base.structure.elements
    with pytest.raises(AssertionError, match="built anew"):
        machine.model({"materials.granite.density": "2800 kg/m^3"})
