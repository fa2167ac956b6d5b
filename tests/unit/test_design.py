"""Designs by several objectives: feasibility, the front, resuming, wrong questions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.msa.mass import total_mass as mass_of
from strutwork.studies import design_search
from strutwork.studies.chunks import Arrays
from strutwork.studies.design import Design
from strutwork.studies.design_judged import CANNOT_BE, FEASIBLE, MISSES, NOT_FINITE, OUTSIDE
from strutwork.studies.design_pick import changes_of, write_machine
from strutwork.studies.design_search import front_of
from strutwork.studies.design_store import parts_of, read_design_result, run_design
from strutwork.studies.design_table import reasons_of
from strutwork.studies.design_terms import Constraint, Cost, CostOf, Objective
from strutwork.studies.parameter import Parameter
from strutwork.studies.parametric import Parametric
from strutwork.studies.variants import Variants

pytest.importorskip("pymoo")

MACHINES = Path(__file__).parents[2] / "examples/machines"
RPS = MACHINES / "3-rps.toml"
OUTER = "sections.cylinder.outer_diameter"
MODULUS = "materials.*.youngs_modulus"


def total_mass(model: Model) -> float:
    return float(np.ravel(mass_of(model.placed))[0])


def small(**changes: Any) -> Design:
    options: dict[str, Any] = {"workspace": {}, "population": 6, "generations": 3, "seed": 2}
    return Design.of(
        RPS,
        {OUTER: ("45 mm", "90 mm"), MODULUS: ["190 GPa", "210 GPa"]},
        "stiffness_z",
        "mass",
        **(options | changes),
    )


def test_the_front_is_what_no_machine_beats() -> None:
    found = run_design(small())
    good = found["status"].to_numpy() == FEASIBLE
    assert found.sizes["machine"] > 12
    front = found["front"].to_numpy()
    assert good[front].all()
    stiffness, mass = found["stiffness_z"].to_numpy(), found["mass"].to_numpy()
    beaten = [
        any(
            good[j]
            and stiffness[j] >= stiffness[i]
            and mass[j] <= mass[i]
            and (stiffness[j] > stiffness[i] or mass[j] < mass[i])
            for j in range(len(mass))
        )
        for i in front
    ]
    assert not any(beaten)
    # the stiffest first
    assert (np.diff(stiffness[front]) < 0).all()
    # a machine of the front is what its numbers say
    row = int(front[0])
    machine = load(RPS)
    assert float(found["mass"].attrs["stated"]) == pytest.approx(total_mass(machine))
    model = Parametric.of(RPS).model(
        {OUTER: float(found[OUTER][row]), MODULUS: float(found[MODULUS][row])}
    )
    assert mass[row] == pytest.approx(total_mass(model), rel=1e-12)


def test_the_lightest_machine_that_keeps_its_stiffness() -> None:
    """Of lists every machine can be made: the best one is known without a search."""
    stated = small().stated.values[0, 0]
    design = Design.of(
        RPS,
        {
            OUTER: [f"{d} mm" for d in (54, 58, 62, 66, 70, 75, 80, 85)],
            "sections.cylinder.inner_diameter": [
                f"{d} mm" for d in (30, 34, 38, 42, 46, 50, 54, 60)
            ],
            MODULUS: ["200 GPa", "205 GPa", "210 GPa"],
        },
        "mass",
        constraints=[Constraint.of("stiffness_z", at_least=float(stated))],
        workspace={},
        population=12,
        generations=7,
        seed=1,
    )
    axes = [(np.arange(n) + 0.5) / n for n in (8, 8, 3)]
    shares = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 3)
    judged = design.judge(design.samples(shares))
    mass = judged.values[:, 0]
    good = judged.status == FEASIBLE
    assert 0 < np.count_nonzero(good) < len(shares)
    found = run_design(design)
    assert found.sizes["machine"] < len(shares) / 2
    (row,) = found["front"].to_numpy()
    assert float(found["mass"][row]) == mass[good].min()
    assert float(found["stiffness_z"][row]) >= stated


def test_the_same_seed_gives_the_same_machines() -> None:
    first, second, other = (run_design(small(seed=s))["share"].to_numpy() for s in (2, 2, 3))
    np.testing.assert_array_equal(first, second)
    assert first.shape != other.shape or not np.array_equal(first, other)


def test_machines_that_cannot_be_and_limits_have_reasons() -> None:
    limit = Constraint.of("mass", at_most="14 kg")
    design = small(constraints=[limit])
    wide = design.samples(np.array([[0.0, 0.1], [0.4, 0.1], [1.0, 0.9]]))
    judged = design.judge(wide)
    mass = judged.values[:, 1]
    assert judged.status[0] == CANNOT_BE
    assert "inner_diameter" in judged.reasons[0]
    assert np.isnan(judged.values[0]).all()
    assert judged.status[1:].tolist() == [OUTSIDE if m > 14.0 else FEASIBLE for m in mass[1:]]
    assert (design.violations(judged)[:, 0] > 0).tolist() == [True, False, False]
    heavy = mass[1:] > 14.0
    assert (design.violations(judged)[1:, 2] > 0).tolist() == heavy.tolist()
    if heavy.any():
        assert "mass is above its limit" in judged.reasons


def test_every_pose_must_be_reached_unless_reach_is_spoken_of() -> None:
    # beyond the reach of the machine
    far = {"z": [0.68, 1.5]}
    design = small(workspace=far)
    middle = np.array([[0.5, 0.5]])
    judged = design.judge(design.samples(middle))
    assert judged.status.tolist() == [MISSES]
    assert judged.reached.tolist() == [0.5]
    with pytest.raises(ModelError, match=r"none of its .* machines is feasible: "):
        run_design(small(workspace=far, generations=1))
    spoken = Design.of(RPS, {OUTER: ("60 mm", "90 mm")}, "stiffness_z", "reach", workspace=far)
    judged = spoken.judge(spoken.samples(np.array([[0.5]])))
    assert judged.status.tolist() == [FEASIBLE]
    assert judged.values[0, 1] == 0.5


def test_machines_that_cannot_be_built_are_counted_together() -> None:
    """Their reasons have numbers that differ."""
    thin = Design.of(
        RPS, {OUTER: ("10 mm", "40 mm")}, "mass", workspace={}, population=4, generations=1
    )
    with pytest.raises(ModelError, match=r"4 of them cannot be built, the first because of sect"):
        run_design(thin)


def test_a_quantity_that_is_not_finite_loses_its_machine_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    values = Variants.values

    def some(self: Variants, samples: Any, workers: int | None = None) -> Arrays:
        found = values(self, samples, workers)
        stiffness = found["stiffness_free_home"]
        if len(stiffness) > 1:
            built = np.flatnonzero(found["status"] == 0)
            stiffness[built[0]], stiffness[built[1]] = np.inf, np.nan
        return found

    monkeypatch.setattr(Variants, "values", some)
    found = run_design(small(generations=2))
    status = found["status"].to_numpy()
    lost = np.flatnonzero(status == NOT_FINITE)
    assert len(lost) == 4
    assert not set(lost) & set(found["front"].to_numpy())
    assert np.isfinite(found["stiffness_z"].to_numpy()[found["front"].to_numpy()]).all()
    assert reasons_of(found)["stiffness z is not finite"] == len(lost)
    assert (status == FEASIBLE).sum() >= 4


def test_names_of_parameters_are_checked_before_the_search(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Design, "judge", None)
    for name in ("share", "front", "poses_reached"):
        named = [Parameter(OUTER, low="60 mm", high="90 mm", name=name)]
        with pytest.raises(ModelError, match="has the name of something else in the result"):
            run_design(Design.of(RPS, named, "mass", workspace={}))


def test_cost_is_linear() -> None:
    cost = Cost(100.0, 2.0, (CostOf(OUTER, 3.0, "1 mm"),), "EUR")
    design = small(cost=cost, constraints=[Constraint.of("cost", at_least=0.0)])
    judged = design.judge(np.array([[0.07, 210e9]]))
    _, mass, money = judged.values[0]
    assert money == pytest.approx(100.0 + 2.0 * mass + 3.0 * 70.0)
    with pytest.raises(ModelError, match="names no parameter"):
        small(cost=Cost(parts=(CostOf("wall", 3.0),)), constraints=design.constraints)
    with pytest.raises(ModelError, match="asked for and not stated"):
        Design.of(RPS, {OUTER: ("60 mm", "90 mm")}, "cost", workspace={})


def test_an_interrupted_search_goes_on(tmp_path: Path) -> None:
    design, path = small(), tmp_path / "front.nc"
    whole = run_design(design)

    def stop(number: int, _: int, __: int) -> None:
        if number == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_design(design, path, told=stop)
    assert len(list(parts_of(design, path).iterdir())) == 2
    with pytest.raises(ModelError, match="--resume"):
        run_design(design, path)
    asked: list[int] = []
    judge = Design.judge

    def counting(self: Design, samples: Any, workers: int | None = None) -> Any:
        asked.append(len(samples))
        return judge(self, samples, workers)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Design, "judge", counting)
        found = run_design(design, path, resume=True)
        assert len(asked) == 1
        np.testing.assert_array_equal(found["share"], whole["share"])
        np.testing.assert_array_equal(found["mass"], whole["mass"])
        assert not parts_of(design, path).exists()
        # more generations go on from the result
        more = run_design(small(generations=4), path, resume=True)
        assert len(asked) == 2
        # what is complete is read
        again = run_design(small(generations=4), path, resume=True)
        assert len(asked) == 2
    np.testing.assert_array_equal(again["mass"], more["mass"])
    assert int(read_design_result(path).attrs["generations"]) == 4
    with pytest.raises(ModelError, match="another design"):
        run_design(small(seed=7), path)


def test_a_machine_of_the_front_is_written(tmp_path: Path) -> None:
    found = run_design(small(generations=1))
    path = write_machine(found, 1, tmp_path / "machine.toml")
    changes = changes_of(found, 1)
    text = path.read_text(encoding="utf-8")
    assert f"outer_diameter = {changes[OUTER]!r} # machine 1 of a design" in text
    design = Design.of(path, {OUTER: ("60 mm", "90 mm")}, "stiffness_z", "mass", workspace={})
    row = int(found["front"][0])
    assert design.stated.values[0].tolist() == pytest.approx(
        [float(found["stiffness_z"][row]), float(found["mass"][row])], rel=1e-9
    )
    with pytest.raises(ModelError, match="is not on the front"):
        write_machine(found, 99, tmp_path / "other.toml")


def test_a_design_of_lists_ends_when_no_machine_is_left() -> None:
    design = Design.of(
        RPS, {MODULUS: ["190 GPa", "210 GPa"]}, "stiffness_z", workspace={}, population=4
    )
    found = run_design(design)
    assert sorted(found[MODULUS].to_numpy()) == [190e9, 210e9]
    assert found[MODULUS].to_numpy()[found["front"].to_numpy()].tolist() == [210e9]
    assert reasons_of(found) == {}


def test_a_front_of_equal_machines_has_one_of_them() -> None:
    targets = np.array([[1.0, 2.0], [1.0, 2.0], [2.0, 1.0], [2.0, 2.0], [0.5, 3.0]])
    assert front_of(targets).tolist() == [4, 0, 2]
    assert front_of(np.zeros((0, 2))).tolist() == []


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Objective.of("stifness_z"), 'Did you mean "stiffness_z"'),
        (lambda: Constraint.of("mass"), "has no limit"),
        (lambda: Constraint.of("mass", "3 kg", "2 kg"), "above at_most"),
        (lambda: Constraint.of("mass", at_most="3 mm"), "is a length, not a mass"),
        (lambda: small(population=2), "population of four"),
        (lambda: Design.of(RPS, {OUTER: (0.06, 0.09)}, workspace={}), "objectives: are none"),
        (
            lambda: Design.of(RPS, {OUTER: (0.06, 0.09)}, "mass", "mass", workspace={}),
            "is named twice",
        ),
    ],
)
def test_a_wrong_question_is_explained(make: Any, message: str) -> None:
    with pytest.raises(ModelError) as caught:
        make()
    assert message in str(caught.value)


def test_without_pymoo_the_message_names_the_command(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> Any:
        raise ImportError(name)

    monkeypatch.setattr(design_search.importlib, "import_module", missing)
    with pytest.raises(ModelError, match=r'pip install "strutwork\[design\]"'):
        run_design(small())
