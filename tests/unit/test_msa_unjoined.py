"""Ends that meet under two names of a node."""

from __future__ import annotations

from pathlib import Path

import pytest

from strutwork.errors import MechanismError
from strutwork.machines.model import ModelWarning
from strutwork.machines.model_file import parse_model, read_model
from strutwork.msa import Spring, rod, solve
from strutwork.msa.unjoined import in_words, unjoined_nodes
from tests.structures import Model, wrench

CASES = Path(__file__).parents[1] / "cases" / "models"


def meeting(gap: float = 0.0) -> Model:
    """Two beams whose ends are at one place, on a metre."""
    model = Model()
    model.nodes(a=(0, 0, 0), b=(1, 0, 0), b2=(1 + gap, 0, 0), c=(2, 0, 0))
    model.beam("left", "a", "b", rod(0.02))
    model.beam("right", "b2", "c", rod(0.02))
    model.support("a")
    model.support("c")
    return model


@pytest.mark.parametrize(("gap", "found"), [(0.0, True), (1e-7, True), (1e-3, False)])
def test_ends_at_one_place(gap: float, found: bool) -> None:
    placed = meeting(gap).place()
    assert unjoined_nodes(placed) == ((("b", "b2"),) if found else ())


def test_what_joins_them_is_counted() -> None:
    for kind in ("fixed", "spherical", "prismatic"):
        model = meeting()
        model.joint("link", kind, ("b2", "b"))
        assert unjoined_nodes(model.place()) == ()
    sprung = meeting()
    sprung.springs.append(Spring("pad", ("b", "b2"), {"y": 1e5}))
    assert unjoined_nodes(sprung.place()) == ()
    # two parts on the ground are joined by it
    held = meeting()
    held.support("b")
    held.springs.append(Spring("foot", ("b2",), {"z": 1e5}))
    assert unjoined_nodes(held.place()) == ()


def test_a_chain_of_joints_at_one_place_joins_all_its_ends() -> None:
    model = meeting()
    model.nodes(pin=(1, 0, 0))
    model.joint("first", "revolute", ("b", "pin"))
    assert unjoined_nodes(model.place()) == (("b", "b2"),)
    model.joint("second", "revolute", ("pin", "b2"), (0, 1, 0))
    assert unjoined_nodes(model.place()) == ()


def test_a_rigid_body_with_two_nodes_at_one_place() -> None:
    model = meeting()
    model.nodes(p=(1, 0, 0), q=(1, 0.5, 0))
    model.rigid("block", "p", "q")
    model.joint("one", "spherical", ("p", "b"))
    placed = model.place()
    assert unjoined_nodes(placed) == (("b", "b2"),)
    assert in_words(placed, ("q", "b2")).startswith("nodes q of body block and b2 of beam right")


def test_a_file_whose_beams_end_under_two_names_warns_and_the_error_says_why() -> None:
    with pytest.warns(ModelWarning, match="nodes B of beam b1 and B2 of beam b2 are at one place"):
        model = read_model(CASES / "f8_unjoined.toml")
    with pytest.raises(MechanismError, match="Probably nodes B of beam b1 and B2 of beam b2"):
        solve(model.placed, model.cases)


def test_a_mechanism_whose_nodes_are_joined_is_not_blamed_on_them() -> None:
    model = meeting()
    model.joint("link", "spherical", ("b", "b2"))
    model.joints = [j for j in model.joints if j.name != "support c"]
    model.positions.pop("c.ground")
    model.grounded.remove("c.ground")
    with pytest.raises(MechanismError) as caught:
        solve(model.place(), [wrench("push", "c", 0.0, 0.0, -1.0)])
    assert "Probably" not in str(caught.value)


def test_the_tool_may_stand_where_the_workpiece_is(recwarn: pytest.WarningsRecorder) -> None:
    text = (CASES / "f8_unjoined.toml").read_text()
    text = text.replace('tcp = "C"', 'tcp = "B"') + '[[supports]]\nnode = "C"\nfixed = "all"\n'
    assert unjoined_nodes(parse_model(text).placed) == (("B", "B2"),)
    assert not recwarn.list
