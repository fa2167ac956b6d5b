"""The D-optimal choice against every choice there is, and in closed form."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.studies.calibration_schema import CandidatesTable
from strutwork.studies.experiment import Experiment
from strutwork.studies.parametric import Parametric
from strutwork.studies.pose_choice import choose_poses, greedy_exchange
from tests.calibrations import unknowns


@pytest.mark.parametrize("seed", range(8))
def test_the_choice_is_that_of_an_exhaustive_search(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows = rng.standard_normal((10, 2, 3)) * rng.uniform(0.1, 3.0, (10, 1, 1))
    each = np.swapaxes(rows, -1, -2) @ rows
    prior = 0.1 * np.eye(3)
    best = max(
        combinations(range(10), 4),
        key=lambda some: np.linalg.slogdet(prior + each[list(some)].sum(axis=0))[1],
    )
    chosen = greedy_exchange(prior, each, 4)
    sizes = [np.linalg.slogdet(prior + each[list(c)].sum(axis=0))[1] for c in (chosen, best)]
    # an exchange one for one may end a little below the best of all
    assert sizes[0] == pytest.approx(sizes[1], abs=0.02)


def test_a_line_is_measured_at_its_ends() -> None:
    """y = a + b x: the determinant is largest with half of the places at either end."""
    x = np.linspace(-1.0, 1.0, 9)
    rows = np.stack([np.ones(9), x], axis=1)
    chosen = greedy_exchange(1e-6 * np.eye(2), rows[:, :, None] * rows[:, None, :], 4)
    assert chosen == (0, 1, 7, 8)


def test_poses_of_a_machine() -> None:
    machine = Parametric.of("examples/machines/3-rps.toml")
    paths = ("joints.drive1.stiffness.z", "joints.drive2.stiffness.z", "joints.drive3.stiffness.z")
    experiment = Experiment(machine, unknowns(machine, *paths))
    table = CandidatesTable.model_validate(
        {
            "rx": {"from": "-10 deg", "to": "10 deg", "points": 3},
            "ry": {"from": "-10 deg", "to": "10 deg", "points": 3},
            "deflections": {
                "load": {"node": "TCP", "z": "-500 N"},
                "at": ["TCP:y", "TCP:z"],
                "scatter": "0.1 um",
            },
        }
    )
    found = choose_poses(experiment, table, 2)
    assert found.candidates == 9
    assert found.kinds == ("deflections",)
    information = [information_alone(experiment, k) for k in range(9)]
    prior = np.diag([1.0 / u.vague**2 for u in experiment.unknowns])
    best = max(
        combinations(range(9), 2),
        key=lambda some: np.linalg.slogdet(prior + sum(information[k] for k in some))[1],
    )
    sizes = [
        np.linalg.slogdet(prior + sum(information[k] for k in some))[1]
        for some in (found.chosen, best)
    ]
    assert sizes[0] == pytest.approx(sizes[1], abs=1e-9)
    after = np.linalg.inv(prior + sum(information[k] for k in found.chosen))
    assert found.after == pytest.approx(1.959964 * np.sqrt(np.diag(after)), rel=1e-5)
    assert np.all(found.after < found.before)
    assert found.gain >= found.gain_random
    assert found.better == 1.0
    assert (found.spread_words(0, 0.031), found.spread_words(0, 1.0)) == ("± 3.1 %", "×÷ 2.72")
    with pytest.raises(ModelError, match="too few to choose 10"):
        choose_poses(experiment, table, 10)
    with pytest.raises(ModelError, match="do not say what is measured"):
        choose_poses(experiment, table.model_copy(update={"deflections": None}), 2)


def information_alone(experiment: Experiment, k: int) -> np.ndarray:
    """JᵀJ of one of the nine poses, by differences of the displacements themselves."""
    from strutwork.machines.model_poses import at_pose  # noqa: PLC0415
    from strutwork.msa import LoadCase, solve  # noqa: PLC0415

    angles = np.radians([-10.0, 0.0, 10.0])
    at = {"rx": angles[k // 3], "ry": angles[k % 3]}

    def moved(values: np.ndarray) -> np.ndarray:
        model = at_pose(experiment.machine.model(experiment.numbers(values)), at, {})
        case = LoadCase("pull", (("TCP", (0.0, 0.0, -500.0, 0.0, 0.0, 0.0)),))
        node = model.structure.mesh_index["TCP"]
        return np.asarray(solve(model.placed, [case]).displacements)[node, 1:3, 0] / 1e-7

    values = experiment.values(experiment.guess)
    columns = []
    for i in range(len(values)):
        step = np.ones(len(values))
        step[i] = np.exp(1e-4)
        columns.append((moved(values * step) - moved(values / step)) / 2e-4)
    jacobian = np.stack(columns, axis=1)
    return np.asarray(jacobian.T @ jacobian)
