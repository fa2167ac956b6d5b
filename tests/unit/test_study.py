"""Studies: which machines are made, what is kept of them, what is flagged, and what is refused."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.stats import spearmanr

from strutwork.errors import ModelError, OutputError, StudyWarning
from strutwork.front import Machine
from strutwork.studies import study as study_module
from strutwork.studies import study_store
from strutwork.studies.answers import Stiffness
from strutwork.studies.chunks import Arrays
from strutwork.studies.parameter import Parameter
from strutwork.studies.parametric import Parametric
from strutwork.studies.run import Chunk
from strutwork.studies.study import Study
from strutwork.studies.study_machines import Machines
from strutwork.studies.study_store import parts_of, read_result, run_to_file
from strutwork.studies.study_table import leading, parameter_columns, rank_correlation
from strutwork.studies.survey import survey

MACHINES = Path(__file__).parents[2] / "examples/machines"
RPS = MACHINES / "3-rps.toml"
TILTS = {"rx": ["-8 deg", "0 deg", "8 deg"], "ry": [0.0, 0.1]}
DIAMETER = next(p for p in Parametric.of(RPS).paths if p.startswith("sections."))


def test_a_machine_of_a_study_is_that_of_its_numbers() -> None:
    """Worst, mean, home and every pose equal a survey of the machine with these numbers."""
    study = Study.of(
        RPS,
        {"materials.*.youngs_modulus": ["100 GPa", 2.1e11], DIAMETER: [0.065, 0.075]},
        workspace=TILTS,
        reductions=["worst", "best", "mean", "home", "poses"],
    )
    found = study.run(workers=2)
    assert dict(found.sizes) == {
        "materials.*.youngs_modulus": 2,
        DIAMETER: 2,
        "direction": 6,
        "pose": 6,
        "reason_text": 1,
    }
    model = Parametric.of(RPS).model({"materials.*.youngs_modulus": 1e11, DIAMETER: 0.075})
    assert study.workspace is not None
    alone = survey(model, study.workspace, [Stiffness()])
    one = found.sel({"materials.*.youngs_modulus": 1e11, DIAMETER: 0.075})
    poses = alone["stiffness_free"].to_numpy().reshape(6, 6)
    assert np.array_equal(one["stiffness_free"].to_numpy(), poses)
    assert np.array_equal(one["stiffness_free_worst"].to_numpy(), poses.min(axis=0))
    assert np.array_equal(one["stiffness_free_best"].to_numpy(), poses.max(axis=0))
    assert np.allclose(one["stiffness_free_mean"].to_numpy(), poses.mean(axis=0), rtol=1e-14)
    worst = one["stiffness_free_worst_pose"].to_numpy()
    assert np.array_equal(worst, poses.argmin(axis=0))
    assert found["pose_rx"].to_numpy()[worst[2]] in (study.workspace.axes["rx"])
    home = Machine.of(model).stiffness().free
    assert np.allclose(one["stiffness_free_home"].to_numpy(), home, rtol=1e-9)


@pytest.mark.parametrize("kind", ["sobol", "latin-hypercube"])
def test_points_over_ranges_repeat_with_their_seed_and_fill_them(kind: str) -> None:
    ranges: dict[str, object] = {"materials.*.youngs_modulus": ("100 GPa", "200 GPa")}
    ranges[DIAMETER] = (0.065, 0.075)
    values = [
        Study.of(RPS, ranges, sample=kind, count=16, seed=seed).drawn.values for seed in (3, 3, 4)
    ]
    assert np.array_equal(values[0], values[1])
    assert not np.array_equal(values[0], values[2])
    shares = (values[0] - [1e11, 0.065]) / [1e11, 0.01]
    # one point in each sixteenth of each range: a Latin hypercube has it, and so has Sobol's net
    assert (np.sort(np.floor(16 * shares), axis=0) == np.arange(16)[:, None]).all()


def test_rows_of_a_list_and_factors() -> None:
    parameters = [
        Parameter("nodes.*.z", values=[1.0, 1.1], relative=True, name="height"),
        Parameter("materials.*.youngs_modulus", values=["200 GPa", "210 GPa"]),
    ]
    study = Study.of(RPS, parameters, sample="list", workspace={})
    assert study.drawn.values.tolist() == [[1.0, 2e11], [1.1, 2.1e11]]
    base, tall = study.model(0).placement.positions, study.model(1).placement.positions
    assert np.allclose(tall[:, 2], 1.1 * base[:, 2])
    found = study.run()
    assert found["height"].attrs["units"] == "1"
    assert found["stiffness_free_home"].dims == ("sample", "direction")


def test_a_logarithmic_range_is_divided_by_ratios() -> None:
    parameter = Parameter("materials.*.youngs_modulus", low=1e9, high=1e11, points=3, log=True)
    assert Study.of(RPS, [parameter]).drawn.values.ravel() == pytest.approx([1e9, 1e10, 1e11])


def test_a_machine_that_cannot_be_is_flagged_and_the_others_go_on() -> None:
    path = "sections.cylinder.outer_diameter"
    found = Study.of(
        MACHINES / "6-ups.toml", {path: ["60 mm", "90 mm"]}, workspace={"z": ["900 mm", "3 m"]}
    ).run(workers=1)
    assert found["status"].to_numpy().tolist() == [1, 0]
    assert found["poses_kept"].to_numpy().tolist() == [0, 1]
    words = found["reason_text"].to_numpy()[found["reason"].to_numpy()]
    assert (
        words[0] == "section cylinder: inner_diameter 0.066 m is not below outer_diameter 0.06 m."
    )
    assert words[1] == ""
    numbers = found["stiffness_free_worst"].to_numpy()
    assert np.isnan(numbers[0]).all()
    assert np.isfinite(numbers[1]).all()
    with pytest.raises(ModelError, match=r"none of its 1 machines can be built: section cylinder"):
        Study.of(MACHINES / "6-ups.toml", {path: ["60 mm"]}, workspace={}).run()


def test_every_answer_by_its_name() -> None:
    names = ("stiffness", "vibration", "assembly", "accuracy", "transmission", "mass")
    study = Study.of(RPS, {"tolerances.*.size": (1e-5, 2e-5)}, *names, count=3, workspace={})
    found = study.run(workers=1)
    assert not (found["status"].to_numpy()).any()
    # tolerances act on assembly forces and accuracy, and on nothing else
    sizes = found["tolerances.*.size"].to_numpy()
    worst = found["accuracy_worst_case_home"].sel(direction="z").to_numpy()
    assert np.ptp(worst / sizes) < np.ptp(worst) / sizes.max()
    assert np.ptp(found["mass"].to_numpy()) == 0.0
    assert np.ptp(found["natural_frequency_home"].to_numpy(), axis=0).max() == 0.0
    assert found["assembly_worst_case_home"].dims == ("sample", "quantity")


def test_what_moves_alike_is_placed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []
    placed = study_module.Stand._placed

    def counted(self: Any, model: Any, of_many: int) -> Any:
        calls.append(model)
        return placed(self, model, of_many)

    monkeypatch.setattr(study_module.Stand, "_placed", counted)
    Study.of(RPS, {DIAMETER: (0.065, 0.075)}, count=8, workspace=TILTS).run(workers=1)
    assert len(calls) == 1
    Study.of(
        RPS, {"joints.drive*.limits.z.high": ("900 mm", "910 mm")}, count=2, workspace=TILTS
    ).run(workers=1)
    assert len(calls) == 3


@pytest.mark.parametrize(
    ("parameters", "options", "message"),
    [
        ({}, {}, "parameters: are none"),
        ({"materials.iron.density": [1]}, {}, "names no number"),
        ({DIAMETER: []}, {}, "neither values nor a range"),
        ({DIAMETER: (0.075, 0.065)}, {"count": 4}, "Give the lower end first"),
        ({DIAMETER: (-0.01, 0.065)}, {"count": 4}, "above 0"),
        ({DIAMETER: (0.065, 0.075)}, {"sample": "sobol"}, r"sample\.count: is missing"),
        (
            {DIAMETER: [0.065]},
            {"sample": "sobol", "count": 4},
            "has values, and the sample is sobol",
        ),
        ({DIAMETER: [0.065]}, {"sample": "gird"}, "unknown kind"),
        ({DIAMETER: [0.065]}, {"sample": "grid", "count": 4}, "stands beside a grid"),
        ({DIAMETER: [0.065]}, {"reductions": ["wurst"]}, 'Did you mean "worst"'),
        ({DIAMETER: [0.065]}, {"workspace": {"q": [1]}}, "unknown direction"),
        ({DIAMETER: [0.065]}, {"workspace": {"x": ["3 kg"]}}, r"workspace\.x"),
        ({DIAMETER: [0.065], "sections.*.outer_diameter": [0.075]}, {}, "as the parameter"),
        ({DIAMETER: (0.065, 0.075)}, {"count": 10**8}, "are the most"),
    ],
)
def test_what_cannot_be_is_refused(
    parameters: dict[str, object], options: dict[str, Any], message: str
) -> None:
    with pytest.raises(ModelError, match=message):
        Study.of(RPS, parameters, **options)


def test_an_unknown_answer_is_refused() -> None:
    with pytest.raises(ModelError, match='Did you mean "stiffness"'):
        Study.of(RPS, {DIAMETER: [0.065]}, "stifness")


def test_the_result_says_what_it_was_made_of() -> None:
    study = Study.of(RPS, {DIAMETER: (0.065, 0.075)}, count=4, seed=7, workspace={})
    found = study.run(workers=1)
    settings = json.loads(found.attrs["settings"])
    assert settings["sample"] == {"kind": "sobol", "count": 4, "seed": 7}
    assert settings["parameters"][DIAMETER]["range"] == [0.065, 0.075]
    assert found[DIAMETER].attrs["units"] == "m"
    assert found.attrs["study_key"] == study.key
    other = Study.of(RPS, {DIAMETER: (0.065, 0.075)}, count=4, seed=8, workspace={})
    assert other.inputs != study.inputs
    assert other.code == study.code


def small() -> Study:
    study = Study.of(RPS, {DIAMETER: [0.065, 0.067, 0.068, 0.069]}, workspace={})
    # a machine a chunk
    object.__setattr__(study, "__class__", OneByOne)
    return study


class OneByOne(Study):
    @property
    def chunk(self) -> int:
        return 1


def test_what_was_finished_is_taken_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = small().run(workers=1)
    asked: list[int] = []
    stopped: list[bool] = []
    call = Machines.__call__

    def interrupted(self: Machines, chunk: Chunk) -> Arrays:
        if chunk.start == 2 and not stopped:
            stopped.append(True)
            raise KeyboardInterrupt
        asked.append(chunk.start)
        return call(self, chunk)

    monkeypatch.setattr(Machines, "__call__", interrupted)
    out = tmp_path / "result.nc"
    with (
        pytest.warns(StudyWarning, match="interrupted: . of 4 chunks are kept"),
        pytest.raises(KeyboardInterrupt),
    ):
        run_to_file(small(), out, workers=1)
    assert not out.exists()
    with pytest.raises(ModelError, match="finished parts of this study"):
        run_to_file(small(), out, workers=1)
    before = list(asked)
    # the pool may have begun the one behind
    assert before[:2] == [0, 1]
    found = run_to_file(small(), out, resume=True, workers=1)
    assert sorted(asked) == [0, 1, 2, 3]
    assert 2 not in before
    assert found.identical(whole)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["result.csv", "result.nc"]
    # complete: read, not computed
    monkeypatch.setattr(Machines, "__call__", None)
    assert run_to_file(small(), out, resume=True).equals(whole)


def test_no_result_is_put_over_another_ones(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "result.nc"
    run_to_file(small(), out)
    with pytest.raises(ModelError, match="holds the result of another study"):
        run_to_file(Study.of(RPS, {DIAMETER: [0.065]}, workspace={}), out)
    monkeypatch.setattr(Study, "code", "0")
    with pytest.raises(ModelError, match="of this study by other code"):
        run_to_file(small(), out, resume=True)
    out.write_bytes(b"no result")
    with pytest.raises(ModelError, match="is there already and cannot be read"):
        run_to_file(small(), out)
    assert out.read_bytes() == b"no result"
    with pytest.raises(ModelError, match="names no kind of file"):
        run_to_file(small(), tmp_path / "result.txt")


def test_a_full_disk_keeps_what_was_finished(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study, out = small(), tmp_path / "result.nc"

    def full(path: Path, _: object) -> Path:
        raise OutputError(str(path), "cannot be written (No space left on device).", "Free some.")

    monkeypatch.setattr(study_store, "write_netcdf", full)
    with pytest.raises(OutputError, match=r"result\.nc: cannot be written"):
        run_to_file(study, out)
    assert not out.exists()
    monkeypatch.undo()
    monkeypatch.setattr(Machines, "_ask", None)
    assert parts_of(study, out).is_dir()
    assert run_to_file(small(), out, resume=True).sizes[DIAMETER] == 4


def test_zarr_holds_the_same(tmp_path: Path) -> None:
    pytest.importorskip("zarr")
    study, out = small(), tmp_path / "result.zarr"
    found = run_to_file(study, out)
    assert read_result(out).equals(found)
    assert read_result(out).attrs["study_key"] == study.key
    # the same study again takes its place
    assert run_to_file(study, out).identical(found)
    (tmp_path / "other.nc").write_bytes(b"")
    with pytest.raises(ModelError, match="does not exist"):
        read_result(tmp_path / "missing.zarr")


def test_machines_go_to_other_processes() -> None:
    study = Study.of(RPS, {DIAMETER: [0.065, 0.075]}, workspace=TILTS)
    sent = pickle.loads(pickle.dumps(study.machines))  # noqa: S301 - its own bytes
    chunk = Chunk(0, 0, 2)
    for name, array in study.machines(chunk).items():
        assert np.array_equal(array, sent(chunk)[name], equal_nan=array.dtype.kind == "f"), name


def test_rank_correlation_is_spearmans() -> None:
    rng = np.random.default_rng(1)
    first = rng.random(50).round(1)
    second = first**3 + 0.1 * rng.random(50)
    assert rank_correlation(first, second) == pytest.approx(spearmanr(first, second).statistic)
    assert np.isnan(rank_correlation(first, np.ones(50)))
    study = Study.of(RPS, {DIAMETER: [0.065, 0.067, 0.075]}, "mass", workspace={})
    found = study.run()
    assert leading(parameter_columns(found), found["mass"].to_numpy()) == (DIAMETER, 1.0)
