"""What becomes of the poses of a batch when some of them have no answer."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork import MechanismError, ModelError, NumericalError, Outcome, PoseWarning
from strutwork.errors import StrutworkError
from strutwork.fea import modes
from strutwork.machines import Proposed3PPRS, Prototype3PPPRS
from strutwork.msa import PlacedStructure, compliance_and_outcome, tool_compliance
from strutwork.msa.tool import COMPILED_FROM
from strutwork.outcome import solve_poses
from strutwork.overconstraint import influence
from strutwork.studies import CheckPoints, hemisphere
from tests.structures import cantilever

Poses = NDArray[np.intp]


def failing(bad: dict[int, StrutworkError], done: list[int]) -> Callable[[Poses], None]:
    """A solver that raises for a whole stack when one of its poses is bad."""

    def run(part: Poses) -> None:
        for pose in part:
            if int(pose) in bad:
                raise bad[int(pose)]
        done.extend(int(p) for p in part)

    return run


def test_the_poses_at_fault_are_found_and_the_others_solved_once() -> None:
    bad = {
        3: NumericalError("solution", "the residual is large at pose 0", ""),
        64: NumericalError("solution", "the residual is large at pose 5.", ""),
        999: MechanismError("joints a in rz", "moves.", ""),
    }
    done: list[int] = []
    found = solve_poses(failing(bad, done), 1000)
    assert sorted(done) == [p for p in range(1000) if p not in bad]
    assert np.flatnonzero(~found.solved).tolist() == [3, 64, 999]
    # the number of the pose does not make a reason of its own
    assert found.counts() == {
        "solution: the residual is large": 2,
        "the structure moves freely under its load": 1,
    }
    assert found.reason(0) == ""
    assert found.reason(999) == "the structure moves freely under its load"
    assert np.flatnonzero(found.of_kind(MechanismError)).tolist() == [999]
    assert "997 of 1000" in repr(found)
    assert found[2:5].reshaped((3, 1)).solved.tolist() == [[True], [False], [True]]
    with pytest.raises(NumericalError, match="residual"):
        found.require_all()
    assert found.require_some() is found
    with pytest.warns(PoseWarning, match="no result at 3 of 1000 poses.*2: solution"):
        found.warn("compliance")


def test_poses_known_to_be_hopeless_are_not_tried_one_by_one() -> None:
    calls: list[int] = []
    error = MechanismError("joint", "moves.", "")

    def run(part: Poses) -> None:
        calls.append(len(part))
        if np.any(part % 2):
            raise error

    found = solve_poses(run, 5000, lambda: (np.arange(5000) % 2 == 1, error))
    assert calls == [5000, 2500]
    np.testing.assert_array_equal(found.solved, np.arange(5000) % 2 == 0)


def test_a_model_wrong_at_every_pose_is_said_to_be_wrong() -> None:
    error = ModelError("beam b", "has no section.", "")
    with pytest.raises(ModelError, match="no section"):
        solve_poses(failing(dict.fromkeys(range(5000), error), []), 5000)
    with pytest.raises(ModelError, match="no section"):
        solve_poses(failing({0: error, 1: error}, []), 2)


def test_nothing_solved_raises_the_first_error_and_no_pose_is_solved() -> None:
    error = NumericalError("x", "fails.", "")
    found = solve_poses(failing(dict.fromkeys(range(4), error), []), 4)
    with pytest.raises(NumericalError, match="fails"):
        found.require_some()
    empty = solve_poses(failing({}, []), 0)
    assert empty.require_some().require_all().status.shape == (0,)
    assert Outcome.good((2, 3)).solved.all()


def spoiled(count: int) -> PlacedStructure:
    """A machine at some poses near home, of which the second is a mechanism."""
    machine = Proposed3PPRS()
    points = machine.home().position + np.linspace(-1e-3, 1e-3, count)[:, None] * [1.0, 0.5, 0.2]
    poses = CheckPoints(points, np.tile([0.0, 0.0, 1.0], (count, 1)))
    placement = machine.place(poses.poses(slice(None), np.array([0.2])))
    frames = placement.frames.copy()
    # links on vertical hinges turn with the platform, which nothing holds about its vertical
    for leg in (1, 2, 3):
        frames[1, machine.linkage.joint_index[f"leg{leg}/hinge"]] = np.eye(3)
    return machine.structure.at(replace(placement, frames=frames))


@pytest.mark.parametrize("count", [5, COMPILED_FROM + 4])
def test_a_mechanism_in_a_batch_is_marked_and_the_rest_solved(count: int) -> None:
    placed = spoiled(count)
    good = np.arange(count) != 1
    with pytest.warns(PoseWarning, match=f"no result at 1 of {count} poses, .*moves freely"):
        found = tool_compliance(placed)
    again, outcome = compliance_and_outcome(placed)
    np.testing.assert_array_equal(again, found)
    np.testing.assert_array_equal(outcome.solved, good)
    assert np.isnan(found[1]).all()
    expected = tool_compliance(placed[good], "saddle_point")
    np.testing.assert_allclose(found[good], expected, rtol=1e-7, atol=1e-9 * expected.max())
    for single in (placed[1], placed[1:2]):
        with pytest.raises(MechanismError, match="hinge"):
            tool_compliance(single)
    with pytest.raises(MechanismError, match=r"hinge(.|\n)*at pose 1"):
        outcome.require_all()


def test_batch_axes_stay() -> None:
    placed = spoiled(6)
    square = PlacedStructure(
        placed.structure,
        replace(
            placed.placement,
            **{
                name: getattr(placed.placement, name).reshape(
                    2, 3, *getattr(placed.placement, name).shape[1:]
                )
                for name in ("positions", "frames", "values", "status")
            },
        ),
    )
    found, outcome = compliance_and_outcome(square)
    assert outcome.solved.tolist() == [[True, False, True], [True, True, True]]
    np.testing.assert_array_equal(found.reshape(6, 6, 6), compliance_and_outcome(placed)[0])
    assert "freely" in outcome.reason((0, 1))


def test_assembly_influence_marks_poses() -> None:
    placed = spoiled(3)
    found, alone = influence(placed), influence(placed[[0, 2]])
    assert found.outcome.solved.tolist() == [True, False, True]
    np.testing.assert_array_equal(found.forces[[0, 2]], alone.forces)
    assert np.isnan(found.forces[1]).all()
    assert found[2].outcome.solved
    with pytest.raises(MechanismError):
        influence(placed[1])


def test_modes_mark_poses() -> None:
    model = cantilever()
    model.nodes(tip=[[0.5, 0, 0], [0.0, 0, 0], [0.6, 0, 0]])
    placed = model.place()
    found, alone = modes(placed, 2), modes(placed[[0, 2]], 2)
    assert found.outcome.solved.tolist() == [True, False, True]
    assert found.outcome.counts() == {"beam beam: has zero length": 1}
    np.testing.assert_array_equal(found.frequencies[[0, 2]], alone.frequencies)
    assert np.isnan(found.frequencies[1]).all()
    with pytest.raises(ModelError, match="zero length"):
        modes(placed[1], 2)


def test_all_poses_of_the_prototype_but_its_singular_ones_have_a_compliance() -> None:
    machine = Prototype3PPPRS()
    poses = hemisphere(machine).poses(slice(None), np.zeros(1))
    placed = machine.structure.at(machine.place(poses))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PoseWarning)
        compliance = tool_compliance(placed)
    found = np.isfinite(compliance).all(axis=(1, 2))
    assert found.sum() >= 300
    assert np.all(np.linalg.eigvalsh(compliance[found])[:, 0] > 0)
