"""Studies that take no executor of their own go where `computed_on` sends them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from strutwork.kinematics import following
from strutwork.machines.load import load
from strutwork.studies import study as study_module
from strutwork.studies.calibrate import calibrate
from strutwork.studies.calibration_problem import Parameter, Target
from strutwork.studies.cluster_work import compute, identity, pickled
from strutwork.studies.design import Design
from strutwork.studies.design_store import parts_of, run_design
from strutwork.studies.executor import computed_on, default_executor
from strutwork.studies.parameter import Parameter as Varying
from strutwork.studies.scale import scale_study
from strutwork.studies.study import Study
from strutwork.studies.trajectory import Samples, study_trajectory
from strutwork.studies.workspace import workspace
from strutwork.studies.workspace_margin import MachineMargin

pytest.importorskip("cloudpickle")


class Elsewhere:
    """What a cluster does to functions and chunks, in this process, and last chunk first."""

    def __init__(self) -> None:
        self.sent = 0

    def map(
        self,
        function: Callable[[Any], Any],
        chunks: Iterable[Any],
        keep: Callable[[Any, Any], object] | None = None,
        lost: Callable[[Exception], Any] | None = None,
    ) -> Iterator[Any]:
        del lost
        every, payload = list(chunks), pickled(function)
        self.sent += len(every)
        found: dict[int, Any] = {}
        for place, chunk in reversed(list(enumerate(every))):
            found[place] = compute(str(hash(payload)), payload, chunk, identity().code)
            if keep is not None:
                keep(chunk, found[place])
        yield from (found[place] for place in range(len(every)))


def test_inside_it_studies_go_there_and_after_it_they_do_not() -> None:
    there = Elsewhere()
    with computed_on(there):
        assert default_executor() is there
    assert default_executor() is not there


def test_sizes_are_computed_elsewhere_and_kept(tmp_path: Path) -> None:
    placed = load("examples/machines/3-rps.toml").placed
    expected = scale_study(placed, (0.5, 1.0, 2.0), count=2)
    there, again = Elsewhere(), Elsewhere()
    for executor in (there, again):
        with computed_on(executor, tmp_path):
            found = scale_study(placed, (0.5, 1.0, 2.0), count=2)
        assert found.stiffness.tobytes() == expected.stiffness.tobytes()
        assert found.frequencies.tobytes() == expected.frequencies.tobytes()
    assert (there.sent, again.sent) == (9, 0)


def curve(values: dict[str, float]) -> dict[str, float]:
    return {"a": values["p"] ** 2 + values["q"], "b": values["p"] - values["q"] ** 2}


def test_starts_of_a_calibration_are_computed_elsewhere() -> None:
    parameters = [Parameter(n, 1.0, 0.1, 3.0, "1") for n in ("p", "q")]
    targets = [Target("a", 5.0, 0.1, "1"), Target("b", 1.0, 0.1, "1")]
    expected = calibrate(curve, parameters, targets, starts=3)
    there = Elsewhere()
    with computed_on(there):
        found = calibrate(curve, parameters, targets, starts=3)
    assert found.values.tobytes() == expected.values.tobytes()
    assert found.costs.tobytes() == expected.costs.tobytes()
    assert found.evaluations == expected.evaluations
    assert there.sent == 3


def test_the_poses_of_a_workspace_are_computed_elsewhere(tmp_path: Path) -> None:
    model = load("proposed-3pprs")
    axes = {"x": np.linspace(-0.2, 0.2, 41), "y": np.linspace(-0.2, 0.2, 41)}
    margin = MachineMargin(model, ("x", "y"), np.full(2, 0.01))
    assert not margin.follows
    expected = workspace(margin, axes, halvings=2)
    there, again = Elsewhere(), Elsewhere()
    for executor in (there, again):
        with computed_on(executor, tmp_path):
            found = workspace(margin, axes, halvings=2)
        assert found.to_dataset().identical(expected.to_dataset())
        assert found.grid.border.tobytes() == expected.grid.border.tobytes()
    assert there.sent >= 2
    assert again.sent == 0


def test_pieces_of_a_trajectory_are_computed_elsewhere(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(following, "PIECE", 16)
    model = load("examples/machines/6-ups.toml")
    times = np.linspace(0.0, 1.0, 12)
    samples = Samples(times, {("", "x"): 0.02 * np.sin(3 * times), ("", "y"): 0.01 * times**2})
    expected = study_trajectory(model, samples, reactions=True).followed
    there, again = Elsewhere(), Elsewhere()
    for executor in (there, again):
        with computed_on(executor, tmp_path):
            found = study_trajectory(model, samples, reactions=True).followed
        assert found.forces.tobytes() == expected.forces.tobytes()
        assert found.drives.tobytes() == expected.drives.tobytes()
        assert found.reactions is not None
        assert expected.reactions is not None
        assert found.reactions.tobytes() == expected.reactions.tobytes()
        assert found.reaction_labels == expected.reaction_labels
    # 12 times and four between each two
    assert (there.sent, again.sent) == (4, 0)


def test_machines_of_a_study_are_made_elsewhere(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(study_module, "CHUNK_MOST", 4)
    parameter = Varying(
        "joints.ball*.stiffness.*", distribution="normal", scatter="10 %", independent=True
    )
    study = Study.of("examples/machines/6-ups.toml", [parameter], count=8, workspace={})
    expected = study.run(workers=1)
    there, again = Elsewhere(), Elsewhere()
    for executor in (there, again):
        with computed_on(executor, tmp_path):
            assert study.run().identical(expected)
    assert (there.sent, again.sent) == (2, 0)


def test_designs_are_computed_elsewhere_and_their_generations_kept(tmp_path: Path) -> None:
    pytest.importorskip("pymoo")
    design = Design.of(
        "examples/machines/3-rps.toml",
        {"sections.cylinder.outer_diameter": ("60 mm", "90 mm")},
        *("stiffness_z", "first_frequency", "mass"),
        workspace={},
        population=36,
        generations=2,
    )
    expected = run_design(design)
    there, again = Elsewhere(), Elsewhere()
    for executor in (there, again):
        with computed_on(executor, tmp_path / "kept"):
            found = run_design(design, tmp_path / "front.nc", resume=executor is again)
        assert not parts_of(design, tmp_path / "front.nc").exists()
        for name in expected.data_vars:
            assert found[name].to_numpy().tobytes() == expected[name].to_numpy().tobytes(), name
    (tmp_path / "front.nc").unlink()
    with computed_on(again, tmp_path / "kept"):
        run_design(design, tmp_path / "front.nc")
    # two chunks of each generation, and none of those that are kept
    assert (there.sent, again.sent) == (4, 0)
    assert len(list((tmp_path / "kept" / design.key[:16]).iterdir())) == 2
