"""Machines by the same questions: every number is that of the part that finds it alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea import modes
from strutwork.kinematics import mobility
from strutwork.machines.load import load
from strutwork.machines.model_poses import moved
from strutwork.msa import axis_stiffness_free, tool_compliance
from strutwork.studies.comparison import HALF, POINTS, common_task, machine_answers

EXAMPLES = Path(__file__).parents[2] / "examples" / "machines"


@pytest.mark.parametrize(
    ("name", "axes"),
    [("6-ups", "xyz"), ("3-rps", "z"), ("planar-3-rrr", "xy"), ("gantry", "xyz")],
)
def test_the_task_is_along_the_translations_that_a_machine_has(name: str, axes: str) -> None:
    grid = common_task(load(EXAMPLES / f"{name}.toml"))
    assert tuple(grid.axes) == tuple(axes)
    for values in grid.axes.values():
        assert len(values) == POINTS
        assert np.ptp(values) == pytest.approx(2 * HALF, rel=1e-12)


def test_every_answer_is_that_of_its_own_function() -> None:
    model = load(EXAMPLES / "6-ups.toml")
    found = machine_answers(model)
    assert not found.missing
    assert found.mobility == mobility(model.structure.linkage, model.placement).mobility == 6
    assert (found.drives, found.redundant) == (6, 0)
    assert (found.reached, found.poses) == (POINTS**3, POINTS**3)
    at_home = axis_stiffness_free(tool_compliance(model.placed))[:3]
    np.testing.assert_allclose(found.home, at_home, rtol=1e-9)
    assert found.frequency == pytest.approx(float(modes(model.vibrating, 1).frequencies[0]))
    # home is a pose of the task, so that its least is no more; and where it is, it is met again
    assert np.all(found.worst <= found.home * (1 + 1e-12))
    for k in range(3):
        _, placement = moved(model, {d: [v] for d, v in found.worst_at[k].items()})
        there = model.structure.at(placement[0])
        again = axis_stiffness_free(tool_compliance(there))[k]
        assert found.worst[k] == pytest.approx(float(again), rel=1e-9)
    assert 1.0 <= found.condition[0] <= found.condition[1] < np.inf


def test_an_answer_that_a_machine_has_not_is_missing_with_its_reason() -> None:
    found = machine_answers(load("hexel-hexapod"))
    assert np.isnan(found.frequency)
    assert "has no mass" in found.missing["frequency"]
    assert found.to_dict()["first_frequency"] is None
    assert np.isfinite(found.worst).all()


def test_a_machine_without_drives_has_no_task(tmp_path: Path) -> None:
    text = (EXAMPLES / "3-rps.toml").read_text(encoding="utf-8")
    still = tmp_path / "still.toml"
    still.write_text(text.replace('driven = ["z"]', ""), encoding="utf-8")
    with pytest.raises(ModelError, match=r"driven|drive"):
        common_task(load(still))
