"""The component of OpenMDAO: its names, its partial derivatives, an optimum, a missing OpenMDAO."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import openmdao.api as om
import pytest
from openmdao.utils.assert_utils import assert_check_partials

from strutwork.errors import ModelError
from strutwork.studies.function import MachineFunction
from strutwork.studies.openmdao_component import MachineComponent, openmdao_name
from tests.gradients import CANTILEVER, CHAIN

DIAMETER = "sections.bar.diameter"


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """OpenMDAO leaves a folder where it runs."""
    monkeypatch.chdir(tmp_path)


def problem(function: MachineFunction, **options: object) -> om.Problem:
    made = om.Problem(reports=False)
    made.model.add_subsystem("machine", MachineComponent(function=function, **options), ["*"])
    return made


@pytest.mark.parametrize("reduction", ["worst", "poses"])
def test_partial_derivatives_are_those_of_differences(reduction: str) -> None:
    function = MachineFunction.of(
        CHAIN,
        ["sections.bar.outer_diameter", "joints.elbow.stiffness.rz", "masses[0].mass"],
        ["stiffness_x", "mass", "frequency_1", "displacement:tip:z@cut"],
        reduction=reduction,
    )
    made = problem(function)
    made.setup(force_alloc_complex=False)
    made.run_model()
    checked = made.check_partials(
        form="central", step=1e-4, step_calc="rel_element", out_stream=None
    )
    assert len(checked["machine"]) == 12
    assert_check_partials(checked, atol=0.0, rtol=1e-6)


def test_the_lightest_cantilever_that_is_stiff_enough() -> None:
    """Only the diameter is left to choose: 3EI/L³ is the stiffness asked for."""
    function = MachineFunction.of(
        CANTILEVER, {DIAMETER: ("20 mm", "60 mm")}, ["mass", "stiffness_z"]
    )
    made = problem(function)
    made.driver = om.ScipyOptimizeDriver(optimizer="SLSQP", tol=1e-12, disp=False)
    made.model.add_design_var("sections:bar:diameter", lower=20, upper=60, units="mm")
    made.model.add_constraint("stiffness_z", lower=0.4, units="N/um", ref=0.4)
    made.model.add_objective("mass")
    made.setup()
    made.set_val("sections:bar:diameter", 50, units="mm")
    # a mass without density is not the lightest
    heavy = MachineFunction.of(
        CANTILEVER.replace("1e-6 kg/m^3", "7850 kg/m^3"), function.parameters, function.answers
    )
    made.model.machine.options["function"] = heavy
    assert made.run_driver().success
    diameter = (0.4e6 * 0.6**3 / 3 / 210e9 * 64 / np.pi) ** 0.25
    assert made.get_val("sections:bar:diameter")[0] == pytest.approx(diameter, rel=1e-6)


def test_names_and_units() -> None:
    function = MachineFunction.of(
        CHAIN.replace("1e5 N*m/rad", "8e4 N*m/rad"),
        ["joints.*.stiffness.rz", "masses[0].mass"],
        ["displacement:tip:z@cut"],
    )
    made = problem(function, names={"masses[0].mass": "tip_mass"})
    made.setup()
    made.final_setup()
    inputs = made.model.list_inputs(units=True, out_stream=None, prom_name=True)
    assert {meta["prom_name"]: meta["units"] for _, meta in inputs} == {
        "joints:all:stiffness:rz": "N*m/rad",
        "tip_mass": "kg",
    }
    assert openmdao_name("nodes.base*.z+nodes.foot*.z") == "nodes:baseall:z:and:nodes:footall:z"
    assert openmdao_name('bodies."left arm!".mass') == 'bodies:"left_arm_":mass'


def test_what_names_cannot_be() -> None:
    function = MachineFunction.of(CHAIN, ["masses[0].mass"], ["mass"])
    with pytest.raises(ModelError, match=r"call both masses\[0\]\.mass and mass mass"):
        problem(function, names={"masses[0].mass": "mass"}).setup()
    with pytest.raises(ModelError, match=r"neither a parameter nor an answer\.\nThere are masses"):
        problem(function, names={"masses.mass": "m"}).setup()


def test_a_machine_that_cannot_be_lets_the_driver_go_on() -> None:
    paths = ["sections.bar.outer_diameter", "sections.bar.inner_diameter"]
    made = problem(MachineFunction.of(CHAIN, paths, ["mass"]))
    made.setup()
    made.set_val("sections:bar:inner_diameter", 1.0)
    with pytest.raises(om.AnalysisError, match=r"sections?\b"):
        made.run_model()


def test_a_missing_openmdao_is_said_with_its_remedy() -> None:
    code = (
        "import sys; sys.modules['openmdao'] = sys.modules['openmdao.api'] = None\n"
        "from strutwork.errors import ModelError\n"
        "try: import strutwork.studies.openmdao_component\n"
        "except ModelError as error: print(error)\n"
    )
    said = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        cwd=Path(__file__).parents[2],
    )
    assert 'pip install "strutwork[openmdao]"' in said.stdout
