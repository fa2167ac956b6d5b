"""Studies of tolerances over one pose and several."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.machines import MitSS1
from strutwork.machines.model_file import read_model
from strutwork.overconstraint import (
    allocate,
    limit_vector,
    tolerance_responses,
    tool_deviation,
    worst_case,
)
from strutwork.papers.son_2002.assembly_map import nominal_grid
from strutwork.papers.son_2002.tolerances import machine_bearings, mit_ss1_tolerances
from strutwork.studies.tolerance_result import ToleranceStudy, write_table
from strutwork.studies.tolerance_study import StudyOptions, at_pose, in_a_row, tolerance_study
from strutwork.studies.toleranced_machine import toleranced_machine

RAILS = Path(__file__).parents[2] / "examples" / "06_table_on_two_rails.toml"
MACHINE = MitSS1()
TOLERANCES = mit_ss1_tolerances()
X = np.array([[0.0, 0.02, -0.05], [0.04, -0.03, 0.01]])
LIMITS = {(name, "radial force"): 4e3 for name in machine_bearings(MACHINE)}
NO_SAMPLES = StudyOptions(samples=0)


def study(options: StudyOptions = NO_SAMPLES) -> ToleranceStudy:
    """The machine at six poses, given as a batch of two by three."""
    placed = MACHINE.structure.at(MACHINE.place(MACHINE.poses(X, 0.0, 5 * X)))
    return tolerance_study(placed, TOLERANCES, LIMITS, options, title="six poses")


def test_every_pose_is_that_pose_alone() -> None:
    found = study()
    assert found.worst.value.shape[0] == len(found.poses) == X.size
    for i, x in enumerate(X.ravel()):
        placed = MACHINE.structure.at(MACHINE.place(MACHINE.poses(x, 0.0, 5 * x)))
        alone = worst_case(tolerance_responses(placed, TOLERANCES))
        # bounds are certified to 1e-9; the poses of a batch share one BLAS call
        np.testing.assert_allclose(found.worst.value[i], alone.value, rtol=1e-7, atol=1e-9)


def test_largest_over_the_poses_with_its_shares_and_misfits() -> None:
    found = study()
    assert found.largest == pytest.approx(found.worst.value.max(axis=0))
    q = found.responses.index("strut1/block near", "radial force")
    pose = found.worst_pose[q]
    assert found.shares[q] == pytest.approx(found.worst.shares[pose, q])
    # every zone is symmetric, so that the shares are all there is
    assert found.shares[q].sum() == pytest.approx(1.0, abs=1e-9)
    misfits = found.misfits(q)
    gap = [misfits[joint][direction] for joint, direction in found.responses.sources.columns]
    rows = found.responses.influence
    j = rows.linkage.joint_index["strut1/block near"]
    force = rows.forces[pose, j, :2] @ np.array(gap)
    assert np.linalg.norm(force) == pytest.approx(found.largest[q], rel=1e-8)


def test_the_governing_pose_uses_the_largest_share_of_a_limit() -> None:
    found = study()
    used = (found.worst.value / limit_vector(found.responses, LIMITS)).max(axis=1)
    assert found.governing == used.argmax()
    assert found.utilisation.max() == pytest.approx(used.max())
    assert found.within_limits == (used.max() <= 1)
    unlimited = tolerance_study(
        MACHINE.structure.at(MACHINE.place(MACHINE.poses(X))), TOLERANCES, None, NO_SAMPLES
    )
    forces = [q.unit == "N" for q in unlimited.quantities]
    assert unlimited.governing == unlimited.worst.value[:, forces].max(axis=1).argmax()
    assert not np.isfinite(unlimited.limit).any()
    assert not unlimited.utilisation.any()


def test_allocation_keeps_the_limits_at_all_poses() -> None:
    found = study(StudyOptions(samples=0, objective="uniform"))
    assert found.allocation is not None
    # proportional: the factor is the reciprocal of the largest utilisation over all poses
    scale = 1 / found.utilisation.max()
    assert found.allocation.scale == pytest.approx(np.full(len(TOLERANCES), scale), rel=1e-6)
    used = found.to_dict()["allocation"]["utilisation"]
    assert max(used.values()) == pytest.approx(1.0, abs=1e-6)


def test_costs_reach_the_allocation() -> None:
    model = read_model(RAILS)
    options = StudyOptions(samples=0, objective="cost", costs=model.tolerance_costs)
    found = tolerance_study(model.placed, model.tolerances, model.force_limits, options)
    assert found.allocation is not None
    alone = allocate(
        tolerance_responses(model.placed, model.tolerances),
        model.force_limits,
        "cost",
        model.tolerance_costs,
    )
    assert found.allocation.sizes == pytest.approx(alone.sizes, rel=1e-6)
    flat = tolerance_study(
        model.placed,
        model.tolerances,
        model.force_limits,
        StudyOptions(samples=0, objective="cost"),
    )
    assert flat.allocation is not None
    # what costs twice as much is given more room
    assert found.allocation.sizes[1] > 1.05 * flat.allocation.sizes[1]


def test_distribution_is_that_of_the_governing_pose() -> None:
    found = study(StudyOptions(samples=2000, seed=5, method="quasi_monte_carlo"))
    assert found.distribution is not None
    at = found.worst.value[found.governing]
    assert found.distribution.values.worst == pytest.approx(at, rel=1e-6)
    assert found.distribution.method == "quasi_monte_carlo"
    told = found.to_dict()
    assert told["distribution"]["pose"] == found.poses[found.governing] == told["governing_pose"]
    assert told["distribution"]["samples"] >= 2000


def test_the_tool_in_any_direction_moves_at_least_as_far_as_along_an_axis() -> None:
    found = study()
    assert found.deviation is not None
    axes = [i for i, q in enumerate(found.quantities) if q.kind == "displacement"]
    along = found.worst.value[:, axes]
    assert found.deviation.largest == pytest.approx(tool_deviation(found.worst).largest)
    # the certificate's gap is 1e-4
    assert np.all(along.max(axis=1) <= found.deviation.bound * (1 + 1e-9))
    assert np.all(found.deviation.largest <= np.linalg.norm(along, axis=1) * (1 + 1e-3))
    told = found.to_dict()["tool_deviation"]
    assert told["pose"] == found.poses[found.farthest]
    assert told["largest"] == found.deviation.largest.max()


def test_one_pose_without_batch_axes() -> None:
    model = read_model(RAILS)
    responses = tolerance_responses(model.placed, model.tolerances)
    row = in_a_row(responses)
    assert row.gain.shape == (1, *responses.gain.shape)
    back = at_pose(row, 0)
    np.testing.assert_array_equal(back.gain, responses.gain)
    np.testing.assert_array_equal(back.sources.map, responses.sources.map)
    np.testing.assert_array_equal(back.influence.forces, responses.influence.forces)
    assert "1 pose," in repr(
        tolerance_study(model.placed, model.tolerances, None, NO_SAMPLES, title="rails")
    )


def test_dataset_and_table(tmp_path: Path) -> None:
    found = study()
    dataset = found.to_dataset()
    assert dataset["worst"].dims == ("pose", "quantity")
    assert dataset["share"].sizes["tolerance"] == len(TOLERANCES)
    with write_table(tmp_path / "table.csv", found).open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == found.worst.value.size
    # every digit is written, so that what is read is the same number
    assert [float(row["worst"]) for row in rows] == found.worst.value.ravel().tolist()
    limits = {(row["quantity"], row["limit"]) for row in rows}
    assert ("strut1/block near radial force", "4000.0") in limits
    assert ("strut1/block near axial force", "") in limits


def test_progress_is_told() -> None:
    model, told = read_model(RAILS), []

    def started(label: str):  # type: ignore[no-untyped-def]
        return lambda done, total: told.append((label, done, total))

    tolerance_study(
        model.placed, model.tolerances, None, StudyOptions(samples=1000), progress=started
    )
    assert told[-1] == ("distribution", 1000, 1000)


def test_nothing_to_study() -> None:
    model = read_model(RAILS)
    with pytest.raises(ModelError, match="tolerances: are none"):
        tolerance_study(model.placed, ())
    with pytest.raises(ModelError, match="force limits: are not given"):
        tolerance_study(
            model.placed, model.tolerances, None, StudyOptions(samples=0, objective="uniform")
        )


def test_the_machine_of_the_catalogue_stands_at_home_first() -> None:
    machine = toleranced_machine("mit-ss1")
    assert machine.poses[0] == "home"
    assert len(machine.poses) == machine.placed.batch[0] == 1 + len(nominal_grid()[0])
    assert {t.name for t in machine.tolerances} == {t.name for t in TOLERANCES}
    with pytest.raises(ModelError, match=r"tolerances of eclipse-3pprs(.|\n)*mit-ss1"):
        toleranced_machine("eclipse-3pprs")
