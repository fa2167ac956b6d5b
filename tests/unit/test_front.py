"""The front door: `import strutwork`, a machine, its questions."""

from __future__ import annotations

import json
import pickle
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import strutwork as sw
from strutwork.errors import ModelError, UnitError, UnreachableError
from strutwork.fea import modes
from strutwork.front import QUESTIONS, Machine
from strutwork.machines.load import load as plain_model
from strutwork.msa import tool_compliance
from strutwork.studies.answers import Stiffness
from strutwork.studies.design import Design
from strutwork.studies.design_pick import changes_of
from strutwork.studies.design_store import read_design_result
from strutwork.studies.pose_table import pose_table
from strutwork.studies.survey import survey

ROOT = Path(__file__).parents[2]
HEXAPOD = ROOT / "examples" / "machines" / "6-ups.toml"
RAILS = ROOT / "examples" / "06_table_on_two_rails.toml"


@pytest.fixture(scope="module")
def machine() -> Machine:
    return sw.load(HEXAPOD)


ROOMS_PROGRAM = """
import sys, strutwork as sw
before = "strutwork.machines" in sys.modules
print(before, "mit-ss1" in sw.machines(), sw.studies.__name__)
"""


def public(names: list[str]) -> list[str]:
    return [n for n in names if not n.startswith("_")]


def test_completion_shows_few_names(machine: Machine) -> None:
    assert len(public(dir(sw))) <= 14
    assert {"load", "machines"} <= set(dir(sw))
    assert public(dir(machine)) == sorted(QUESTIONS)
    assert all(callable(getattr(machine, q)) and getattr(Machine, q).__doc__ for q in QUESTIONS)


def test_rooms_are_entered_when_asked_for() -> None:
    said = subprocess.run(
        [
            sys.executable,
            "-c",
            ROOMS_PROGRAM,
        ],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    assert said.split() == ["False", "True", "strutwork.studies"]
    with pytest.raises(AttributeError, match="no attribute 'machine'"):
        _ = sw.machine  # type: ignore[attr-defined]


def test_machines_are_listed() -> None:
    listed = sw.machines()  # type: ignore[operator]
    assert len(listed) == 14
    assert "mit-ss1            MIT-SS-1" in repr(listed)
    assert listed._repr_html_().count("<tr>") == 15


def test_every_answer_is_that_of_its_own_function(machine: Machine) -> None:
    model = plain_model(HEXAPOD)
    compliance = tool_compliance(model.placed)
    found = machine.stiffness()
    np.testing.assert_array_equal(found.compliance, compliance)
    np.testing.assert_allclose(found.free, 1.0 / np.diag(compliance))
    np.testing.assert_allclose(found.blocked, np.diag(np.linalg.inv(compliance)))
    np.testing.assert_array_equal(
        machine.modes(4).frequencies, modes(model.vibrating, 4).frequencies
    )
    assert machine.check().mobility.mobility == 6
    assert machine.solve().statics.cases == tuple(c.name for c in model.cases)
    grid = replace(model.workspace, axes={"x": np.array([0.0, 0.01])})  # type: ignore[type-var]
    asked = machine.survey({"x": [0.0, 0.01]})
    expected = survey(model, grid, [Stiffness()])
    np.testing.assert_array_equal(asked["stiffness_free"], expected["stiffness_free"])
    response = machine.frequency_response([0.0, 20.0], axes=("z",))
    # at rest the structure as it vibrates, under its preload, is as stiff as its statics say
    still = tool_compliance(model.vibrating)[2, 2]
    assert np.asarray(response.receptance)[0, 0, 0].real == pytest.approx(still, rel=1e-2)


def test_assembly_forces() -> None:
    found = sw.load(RAILS).assembly_forces()
    assert np.max(found.utilisation) > 0.0


def test_elsewhere(machine: Machine) -> None:
    there = machine.at(x="20 mm", rz="5 deg")
    assert isinstance(there, Machine)
    assert there.source == ""
    tool = there.structure.linkage.nodes.index(there.require_tool())
    shift = there.placement.positions[tool] - machine.placement.positions[tool]
    np.testing.assert_allclose(shift, [0.02, 0.0, 0.0], atol=1e-9)
    assert there.stiffness().free[2] < machine.stiffness().free[2]
    leg = machine.at(joints={"drive1:z": "880 mm"})
    assert leg.motion.joints is not None
    with pytest.raises(UnreachableError, match="cannot be taken"):
        machine.at(z=3.0)
    with pytest.raises(UnitError, match="x"):
        machine.at(x="20 kg")


def test_a_changed_machine_has_no_source(machine: Machine) -> None:
    assert machine.source == str(HEXAPOD)
    changed = replace(machine, title="another")
    assert (type(changed), changed.source) == (Machine, "")
    copied = pickle.loads(pickle.dumps(machine))  # noqa: S301 - our own
    assert copied.stiffness().free[2] == machine.stiffness().free[2]


def test_a_machine_with_other_numbers(machine: Machine) -> None:
    thick = machine.changed({"sections.ram.diameter": "60 mm"})
    assert (type(thick), thick.source) == (Machine, "")
    assert thick.stiffness().free[2] > machine.stiffness().free[2]
    with pytest.raises(ModelError, match=r'Did you mean "sections\.ram\.diameter"'):
        machine.changed({"sections.ram.diametre": 0.06})
    with pytest.raises(ModelError, match="was changed or moved since it was read"):
        thick.changed({"sections.ram.diameter": 0.06})


def test_a_design_of_a_machine(tmp_path: Path) -> None:
    """Limits by quantity, the file, and each machine of the front as a machine."""
    machine = sw.load(ROOT / "examples" / "machines" / "3-rps.toml")
    ranges = {"sections.ram.diameter": ("30 mm", "48 mm")}
    options: dict[str, Any] = {"workspace": {}, "method": "gradient", "starts": 1}
    limits: dict[str, Any] = {"at_least": {"stiffness_z": "stated"}, "at_most": {"mass": "1 t"}}
    file = tmp_path / "light.nc"
    found = machine.design(ranges, "mass", **limits, out=file, **options)
    assert read_design_result(file).attrs["design_key"] == found.attrs["design_key"]
    best = machine.changed(changes_of(found, 1))
    assert best.stiffness().free[2] >= machine.stiffness().free[2] * (1.0 - 1e-9)
    settings = json.loads(found.attrs["settings"])
    assert {c["quantity"]: sorted(c) for c in settings["constraints"]} == {
        "stiffness_z": ["at_least", "quantity"],
        "mass": ["at_most", "quantity"],
    }
    dynamic = "least_dynamic_stiffness_z"
    wide, narrow = (
        Design.of(machine, ranges, dynamic, workspace={}, band=band).stated.values.item()
        for band in ((5.0, 300.0), (5.0, 6.0))
    )
    assert narrow > 1.5 * wide
    with pytest.raises(ModelError, match='Did you mean "stiffness_z"'):
        machine.design(ranges, "mass", at_least={"stifness_z": 1.0})
    with pytest.raises(ModelError, match="was changed or moved since it was read"):
        best.design(ranges, "mass")


def test_wrong_arguments_are_explained(machine: Machine) -> None:
    ram = "sections.ram.diameter"
    wrong: list[tuple[Callable[[], object], str]] = [
        (lambda: machine.study({ram: [0.04]}, workspace="all"), "workspace: is a str"),
        (lambda: machine.study({ram: [0.04]}, resume=True), "resume: goes on from nothing"),
        (lambda: machine.study({ram: (0.04, 0.05)}, count=2, seed=-1), "sample.seed: is -1"),
        (lambda: machine.design({ram: (0.04, 0.05)}, "mass", at_least=["mass"]), "at_least: is a"),
        (lambda: machine.design({ram: (0.04, 0.05)}, "mass", resume=True), "goes on from nothing"),
        (lambda: machine.design({ram: (0.04, 0.05)}, "mass", band=(5, 1)), "from 5 to 1 Hz"),
        (lambda: machine.calibrate(ram), "Give a dictionary or a list"),
        (lambda: machine.calibrate({ram: 0.05}), "has no pair as its range"),
        (lambda: machine.calibrate([ram], priors={"ram": 0.1}), "names no parameter of the"),
        (lambda: machine.calibrate([ram]), "has no measurement"),
    ]
    for make, message in wrong:
        with pytest.raises(ModelError, match=message):
            make()


def test_a_machine_is_compared_with_one_by_its_name() -> None:
    bar, frame = (ROOT / "examples" / f"{n}.toml" for n in ("01_cantilever", "04_four_bar"))
    named = sw.load(bar).compare(frame)
    assert (named.a.name, named.b.name) == (str(bar), str(frame))


def test_without_damping_there_is_no_response(machine: Machine) -> None:
    with pytest.raises(ModelError, match=r"damping: is missing"):
        replace(machine, damping=None).frequency_response([10.0])


def test_drawings(machine: Machine) -> None:
    assert machine.plot().layout.title.text == machine.title
    swinging = machine.plot(mode=2)
    assert swinging.layout.title.text.startswith("Mode 2: ")
    first, second = (np.array(machine.plot(mode=m).data[1].z, dtype=float) for m in (1, 2))
    assert np.nanmax(np.abs(first - second)) > 0.0
    assert "times its true size" in machine.plot(case="cutting").layout.title.text
    with pytest.raises(ModelError, match="for both a case and a mode"):
        machine.plot(case="cutting", mode=1)
    with pytest.raises(ModelError, match="99 does not exist"):
        machine.plot(mode=99)


@pytest.fixture
def small(tmp_path: Path) -> Path:
    file = tmp_path / "Small <b>.toml"
    file.write_text((ROOT / "examples" / "04_four_bar.toml").read_text(encoding="utf-8"))
    return file


def test_reports(small: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    machine = sw.load(small)
    assert machine.report().report == Path("report-small-b", "report.html")
    changed = replace(machine, title="Another <i>")
    written = changed.report(tmp_path / "two")
    assert "<title>Another &lt;i&gt;" in written.report.read_text(encoding="utf-8")


def test_shown_in_a_notebook(machine: Machine) -> None:
    shown = replace(machine, title="<script>alert(1)</script>")._repr_html_()
    assert "<script>" not in shown
    assert "drive1:z" in shown
    assert "460.8 N" not in shown
    table = machine.stiffness()._repr_html_()
    assert table.count("<tr>") == 7
    # in the units that the command prints
    assert ">460.8</td>" in table
    assert table.count("N/µm") == table.count("kN·m/rad") == 3
    assert "z 460.8 N/µm" in repr(machine.stiffness())


def test_one_row_a_pose(machine: Machine) -> None:
    data = machine.survey({"x": [0.0, 0.01], "z": [0.9, 0.92, 3.0]})
    frame = pose_table(data)
    assert frame.shape[0] == 6
    assert list(frame.index.names) == ["x", "z"]
    row = frame.loc[(0.01, 0.92)]
    expected = data["stiffness_free"].sel(x=0.01, z=0.92, direction="rx").item()
    assert row["stiffness_free_rx"] == expected
    assert row["joint_coordinate_drive1:z"] == pytest.approx(
        data["joint_coordinate"].sel(x=0.01, z=0.92, joint="drive1:z").item()
    )
    assert frame["reason"].loc[(0.0, 0.9)] == ""
    assert frame["reason"].loc[(0.0, 3.0)] != ""
    with pytest.raises(ModelError, match="status"):
        pose_table(data.drop_vars("status"))
