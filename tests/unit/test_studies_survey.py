"""One survey for every question: what counts, what does not and why, and resumption."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import strutwork
from strutwork.errors import StudyError, StudyWarning
from strutwork.kinematics import Joint
from strutwork.kinematics.limits import Limit, check_limits
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model import Model
from strutwork.msa.tool import COMPILED_FROM
from strutwork.studies import survey as module
from strutwork.studies.answers import Assembly, Stiffness
from strutwork.studies.executor import Executor
from strutwork.studies.filters import PoseStatus
from strutwork.studies.survey import survey

MACHINES = Path(__file__).parents[2] / "examples/machines"


def small(name: str) -> tuple[Model, TaskGrid]:
    model = strutwork.load(MACHINES / f"{name}.toml")
    assert model.workspace is not None
    return model, TaskGrid({d: v[[0, -1]] for d, v in model.workspace.axes.items()})


# beams of hollow sections and a solid among them: all of a structure must be written down
@pytest.mark.parametrize("name", ["linear-delta", "gantry"])
def test_finished_chunks_are_taken_again(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    model, grid = small(name)
    answers = [Stiffness(), Assembly.of(model)]
    first = survey(model, grid, answers, folder=tmp_path)

    def refuse(*_: object) -> None:
        raise AssertionError("a finished chunk was computed again")

    monkeypatch.setattr(module, "_asked", refuse)
    assert survey(model, grid, answers, folder=tmp_path).identical(first)
    # another question: all of it is asked anew, and fails
    with pytest.warns(StudyWarning), pytest.raises(StudyError, match="computed again"):
        survey(model, grid, [Stiffness()], folder=tmp_path)


def test_out_of_range_is_told_from_out_of_reach() -> None:
    model, _ = small("linear-delta")
    grid = TaskGrid({"x": np.array([0.0, 0.1, 2.0]), "z": np.array([0.0, 0.3])})
    status = survey(model, grid, [Stiffness()])["status"].to_numpy()
    assert status[:, 0].tolist() == [PoseStatus.GOOD, PoseStatus.GOOD, PoseStatus.UNREACHABLE]
    assert status[0, 1] == PoseStatus.JOINT_RANGE


def test_more_ranges_than_a_byte_counts() -> None:
    model, _ = small("linear-delta")
    joint = Joint("slide1", "prismatic", ("a", "b"))
    limits = [Limit(joint.name, "z", -1.0, 1.0, joint.type)] * 300
    last = Limit(joint.name, "z", 0.5, 1.0, joint.type)
    home = replace(model.motion.place(model.motion.home_pose))
    checked = check_limits([*limits, last], home)
    assert checked.reason(()) == f"{last} is exceeded"


class Backwards:
    """The last chunk first."""

    def map(
        self,
        function: Callable[[Any], Any],
        chunks: Iterable[Any],
        keep: object = None,  # noqa: ARG002 - nothing is kept
        lost: object = None,  # noqa: ARG002 - nothing is lost
    ) -> Iterator[Any]:
        return reversed([function(chunk) for chunk in reversed([*chunks])])


# its parallelograms close loops, whose dependent coordinates are chosen on poses
@pytest.mark.parametrize("name", ["linear-delta", "6-ups"])
def test_the_order_of_chunks_changes_no_digit(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "CHUNK", 50)

    def run(executor: Executor | None) -> xr.Dataset:
        model, grid = small(name)
        counts = zip(grid.axes.items(), (7, 7, 6), strict=True)
        grid = TaskGrid({d: np.linspace(v[0], v[-1], n) for (d, v), n in counts})
        assert len(grid) >= COMPILED_FROM
        return survey(model, grid, [Stiffness()], workers=1, executor=executor)

    forwards, backwards = run(None), run(Backwards())
    assert backwards.drop_attrs().identical(forwards.drop_attrs())
    assert int((forwards["status"] == PoseStatus.GOOD).sum()) > 2 * 50
