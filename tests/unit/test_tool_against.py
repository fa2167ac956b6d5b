"""The tool relative to a workpiece that gives way."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from strutwork.cutting.tip_dynamics import tip_dynamics
from strutwork.errors import MechanismError, ModelError
from strutwork.fea import ModalRatio, Port, frequency_response
from strutwork.fea.idle import idle_motions
from strutwork.fea.least_stiffness import least_dynamic_stiffness
from strutwork.fea.ports import tool_port, tool_ports
from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model
from strutwork.msa import LoadCase, PlacedStructure, compliance_budget, solve, tool_compliance
from strutwork.msa.assembly import system_of
from strutwork.msa.movable import always_movable, movable_directions
from strutwork.msa.rigid_map import rigid_map
from strutwork.overconstraint.accuracy import accuracy
from strutwork.overconstraint.influence import influence
from strutwork.overconstraint.joint_errors import JointError
from strutwork.reports.chapters.model_tool import tool_chapter
from strutwork.reports.content import Text
from strutwork.reports.model_solution import solve_model
from strutwork.reports.vibration import model_target
from strutwork.studies.dimension import Dimension
from strutwork.studies.error_causes import error_sheet
from strutwork.studies.error_file import parse_errors
from strutwork.studies.gradient_quantities import Vibrating
from strutwork.studies.parametric import Parametric
from tests.gradients import gap
from tests.tool_against import FLOATING, column_and_table, column_text

pytestmark = pytest.mark.filterwarnings("ignore:nodes tip of body arm")

METHODS = ("saddle_point", "null_space", "condensed", "sparse", "compiled")

DAMPING = ModalRatio(0.02)


@cache
def machine(against: str | None, tcp: str = "tip", held: str | None = None) -> Model:
    return column_and_table(against, tcp) if held is None else column_and_table(against, tcp, held)


def close(found: np.ndarray, expected: np.ndarray, rtol: float = 1e-9) -> None:
    """Compliances agree, each entry beside the diagonal ones of its row and column."""
    size = np.sqrt(np.einsum("...ii->...i", np.abs(expected)))
    gap = np.abs(found - expected) / (size[..., :, None] * size[..., None, :])
    assert gap.max() < rtol


@pytest.mark.parametrize("method", METHODS)
def test_compliances_of_tool_and_table_add(method: str) -> None:
    """Springs in series: what the column yields at the tool and the table below it adds."""
    tool = tool_compliance(machine(None).placed)
    table = tool_compliance(machine(None, tcp="at_tip").placed)
    close(tool_compliance(machine("table").placed, method), tool + table)
    # any node of the plate stands for it, for all carry the point at which the tool stands
    close(tool_compliance(machine("at_tip").placed, method), tool + table)
    own = tool_compliance(machine(None, tcp="table").placed)
    arm = rigid_map(np.array([-0.1, 0.03, 0.15]))
    close(table, arm @ own @ arm.T)


@pytest.mark.parametrize("method", METHODS)
def test_a_machine_on_nothing_has_the_relative_compliance_of_one_that_is_held(method: str) -> None:
    """Opposite wrenches are in equilibrium only where the arm between the nodes is right."""
    held = tool_compliance(machine("table").placed)
    floating = machine("table", held=FLOATING)
    close(tool_compliance(floating.placed, method), held)
    with pytest.raises(MechanismError):
        tool_compliance(machine(None, held=FLOATING).placed, method)


def test_a_workpiece_on_the_ground_changes_nothing() -> None:
    absolute = tool_compliance(machine(None).placed)
    for node in ("foot", "base"):
        close(tool_compliance(machine(node).placed), absolute, 1e-12)


def test_the_frame_of_axes_does_not_matter() -> None:
    model = machine("table")
    turn = Rotation.from_rotvec([0.4, -0.7, 1.1]).as_matrix()
    at = model.placement
    turned = replace(at, positions=at.positions @ turn.T, frames=turn @ at.frames)
    six = np.kron(np.eye(2), turn)
    found = tool_compliance(model.structure.at(turned))
    close(found, six @ tool_compliance(model.placed) @ six.T, 1e-8)


def test_many_poses_take_the_compiled_program() -> None:
    model = machine("table")
    moved = model.motion.move(task={"x": np.linspace(-0.15, 0.15, 300)}).placement
    assert moved.reachable.all()
    placed = model.structure.at(moved)
    found = tool_compliance(placed)
    some = [0, 17, 299]
    close(found[some], tool_compliance(placed[some], "saddle_point"))
    # the arm from the table grows with the stroke, and so does what the table adds
    added = found - tool_compliance(PlacedStructure(machine(None).structure, placed.placement))
    assert np.ptp(added[:, 2, 2]) > 0.5 * added[:, 2, 2].max()


def test_relative_motion_in_a_load_case_is_the_compliance() -> None:
    """Equal and opposite forces at tool and table, by the ordinary solver of load cases."""
    model = machine("at_tip")
    force = (30.0, -20.0, 50.0, 0.0, 0.0, 0.0)
    opposite = tuple(-f for f in force)
    case = LoadCase("cut", (("tip", force), ("at_tip", opposite)))
    found = solve(model.placed, [case])
    moved = found.displacement("tip", "cut") - found.displacement("at_tip", "cut")
    np.testing.assert_allclose(moved, tool_compliance(model.placed) @ force, rtol=1e-9)


def test_directions_that_joints_hold_between_tool_and_table() -> None:
    """With the table as the slide's own carrier only the arm and the slide are between."""
    model = machine("head")
    system = system_of(model.placed)
    assert always_movable(system_of(machine("table").placed))
    assert movable_directions(system).rank.tolist() == [6]
    text = column_text("head").replace('rx = "1e5 N*m/rad"\n', "").replace('\nx = "300 N/um"', "")
    rigid = column_from(text)
    found = movable_directions(system_of(rigid.placed))
    assert found.rank.tolist() == [4]
    compliance = tool_compliance(rigid.placed)
    assert np.linalg.matrix_rank(compliance * np.outer(found.scale[0], found.scale[0])) == 4


def column_from(text: str) -> Model:
    return parse_model(text, "column.toml")


def test_the_budget_has_the_parts_of_both_sides() -> None:
    budget = compliance_budget(machine("table").placed, [0, 0, 1, 0, 0, 0])
    shares = budget.to_dict()
    assert sum(shares.values()) == pytest.approx(1.0, abs=1e-9)
    assert shares["beam pillar"] > 0.02
    assert shares["beam column"] > 0.02
    assert float(budget.deflection) == pytest.approx(tool_compliance(machine("table").placed)[2, 2])


def test_responses_begin_at_the_static_compliance() -> None:
    model = machine("table")
    ports = tool_ports(model.structure.linkage)
    response = frequency_response(model.placed, ports, ports, [0.01], DAMPING, "all_modes")
    static = tool_compliance(model.placed)[:3, :3]
    np.testing.assert_allclose(response.receptance[0].real, static, atol=1e-6 * static.max())
    # uncoupled sides: what the tool and the table do at a frequency adds
    band = (1.0, 2000.0)
    port = tool_port(model.structure.linkage, "x")
    least = least_dynamic_stiffness(model.placed, port, port, DAMPING, band)
    both = [
        frequency_response(model.placed, [p], [p], [least.frequency], DAMPING, "all_modes")
        for p in (Port("tip", "x"), Port("at_tip", "x"))
    ]
    total = sum(one.receptance[0, 0, 0] for one in both)
    assert least.value == pytest.approx(1 / abs(total), rel=1e-6)
    (tip,) = tip_dynamics(model.placed, "tip", DAMPING, "table")
    both_ways = frequency_response(model.placed, ports, ports, [80.0], DAMPING, "all_modes")
    np.testing.assert_allclose(tip.response(np.array([80.0]))[0], both_ways.receptance[0])


def test_ports_of_the_command_line_are_relative_at_the_tool_alone() -> None:
    target = model_target(machine("table"), "column")
    assert target.port("tip:y") == target.port("TCP:y") == Port("tip", "y", "table", carried=True)
    assert target.port("at_tip:y") == Port("at_tip", "y")
    assert target.port("table-tip:y") == Port("tip", "y", "table")
    # without carrying the point the rotation of the table does not count
    near, far = (
        frequency_response(target.placed, [p], [p], [0.01], DAMPING, "all_modes").receptance
        for p in (target.port("tip:z"), target.port("table-tip:z"))
    )
    assert abs(near[0, 0, 0]) > 1.02 * abs(far[0, 0, 0])


def test_misfits_displace_the_tool_relative_to_the_table() -> None:
    here, absolute = machine("table"), machine(None)
    columns = [("slide", "z"), ("slide", "ry")]
    found = influence(here.placed, columns).tool
    # the misfit of the slide forces nothing: only the tool moves
    np.testing.assert_allclose(found, influence(absolute.placed, columns).tool, atol=1e-12)
    floating = machine("table", held=FLOATING)
    errors = [JointError("drive error", "slide", "z", 1e-6)]
    by_rows = accuracy(here.placed, (), errors)
    by_stiffness = accuracy(here.placed, (), errors, "stiffness")
    np.testing.assert_allclose(by_rows.transmission, by_stiffness.transmission, atol=1e-9)
    np.testing.assert_allclose(by_rows.transmission[..., 0], [1, 0, 0, 0, 0, 0], atol=1e-9)
    assert idle_motions(floating.placed) == ()


def test_gradients_follow_the_arm_to_the_table() -> None:
    names = ("nodes.table.x", "nodes.at_tip.z+nodes.tip.z", "sections.bar.diameter")
    made = Parametric.of(column_text("table"))
    parameters = [Dimension.of(made, name) for name in names]
    quantities = ["stiffness_x", "blocked_stiffness_ry", "least_dynamic_stiffness_x"]
    vibrating = Vibrating(DAMPING, (1.0, 2000.0))
    assert gap(made.model, parameters, quantities, None, vibrating).max() < 2e-6


def test_what_cannot_be_is_named() -> None:
    with pytest.raises(ModelError, match=r"tool\.against.*one rigid body"):
        column_and_table("quill")
    with pytest.raises(ModelError, match=r"tool\.against.*unknown node \"tabel\""):
        column_and_table("tabel")


def test_the_error_sheet_takes_the_workpiece_of_the_model() -> None:
    text = 'gravity = [0, 0, -9.81]\n[[cutting]]\nname = "mean"\nforce = ["50 N", "0 N", "-20 N"]\n'
    here, absolute = machine("table"), machine(None)
    sheet = error_sheet(here, parse_errors(text, "errors.toml", here))
    force = np.array([50.0, 0.0, -20.0, 0.0, 0.0, 0.0])
    (cut,) = sheet.of("cutting").rows
    np.testing.assert_allclose(cut.mean, tool_compliance(here.placed) @ force, rtol=1e-8)
    # the errors file names it as well, for a model that does not
    named = parse_errors(f'{text}[tool]\nagainst = "table"\n', "errors.toml", absolute)
    other = error_sheet(absolute, named)
    np.testing.assert_allclose(other.mean, sheet.mean, rtol=1e-8)
    ground = error_sheet(absolute, parse_errors(text, "errors.toml", absolute))
    assert abs(ground.mean[2] - sheet.mean[2]) > 1e-8


def test_pages_and_answers_name_the_workpiece() -> None:
    model = machine("table")
    chapter = tool_chapter(solve_model(model))
    (text,) = [b for b in chapter.blocks if isinstance(b, Text)][:1]
    assert "tool centre point tip relative to table" in str(text)
    assert "opposite sign on the workpiece" in str(text)
    assert solve_model(model).to_dict()["tcp"]["against"] == "table"
    assert "against" not in solve_model(machine(None)).to_dict()["tcp"]
