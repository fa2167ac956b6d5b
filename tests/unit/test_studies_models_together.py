"""Machines that are computed as one stack have the numbers that each has alone."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence

import numpy as np
import pytest

from strutwork.errors import ModelWarning
from strutwork.fea import lowest
from strutwork.fea.eigen import Eigen, solve_eigen
from strutwork.fea.lowest import natural_frequencies
from strutwork.fea.modes import lowest as lowest_of
from strutwork.fea.preload import preloaded
from strutwork.fea.reduction import Reduced, reduce_system
from strutwork.machines.model import Model
from strutwork.msa import compliance_and_outcome, solve, tool
from strutwork.msa.assembly import system_of
from strutwork.msa.mass import total_mass
from strutwork.msa.stacked import can_stack, stacked
from strutwork.studies.models_together import first_frequencies, masses
from strutwork.studies.parametric import Parametric
from strutwork.studies.standing import Stand, Standing
from strutwork.studies.variants import Variants, why

HEXAPOD = "examples/machines/6-ups.toml"

#: By file, numbers that are varied: elastic and locked loops, springs, point masses, line loads.
MACHINES = {
    HEXAPOD: ("sections.ram.diameter", "joints.ball*.stiffness.*", "bodies.platform.mass"),
    "examples/machines/3-rps.toml": ("materials.*.youngs_modulus", "materials.*.density"),
    "examples/machines/tricept.toml": ("materials.*.youngs_modulus", "bodies.*.mass"),
    "examples/machines/planar-3-rrr.toml": ("materials.*.youngs_modulus", "materials.*.density"),
    "examples/02_space_frame.toml": ("materials.*.density", "springs.*.stiffness.*"),
    "examples/05_two_link_leg.toml": ("materials.*.youngs_modulus", "springs.*.stiffness.*"),
    "examples/machines/linear-delta.toml": ("materials.*.density", "bodies.*.mass"),
}


def _variants(machine: Parametric, paths: Sequence[str], count: int) -> list[Model]:
    factors = np.random.default_rng(3).uniform(0.8, 1.25, (count, len(paths)))
    stated = [{n.path: n.value for n in machine.matching(path)} for path in paths]
    found = []
    for row in factors.tolist():
        changes = [{p: v * f for p, v in one.items()} for one, f in zip(stated, row, strict=True)]
        found.append(machine.model({p: v for one in changes for p, v in one.items()}))
    return found


def _there(machine: Parametric, paths: Sequence[str]) -> list[str]:
    # not every example states every kind of number
    return [p for p in paths if any(q.startswith(p.split("*")[0]) for q in machine.paths)]


@pytest.mark.parametrize("path", MACHINES)
def test_stack_has_frequencies_and_masses_of_each_machine_alone(path: str) -> None:
    machine = Parametric.of(path)
    models = _variants(machine, _there(machine, MACHINES[path]), 4)
    # some have no tool, and stand at home alone
    home = Standing(models[0].placement[None], np.array([0]), np.zeros(1, np.int8), ("",))
    standing = [(m, home) for m in models]
    with warnings.catch_warnings():
        # rigid joints of some examples share the preload
        warnings.simplefilter("ignore", ModelWarning)
        found = first_frequencies(standing)
        alone = [natural_frequencies(m.vibrating, 1)[0].item() for m in models]
    np.testing.assert_allclose(found, alone, rtol=1e-9)
    assert np.ptp(found) > 1e-3 * found[0]
    weighed = [total_mass(m.structure.at(m.placement)).item() for m in models]
    np.testing.assert_allclose(masses(standing), weighed, rtol=1e-12)


@pytest.mark.parametrize("path", MACHINES)
def test_stack_has_statics_and_preload_of_each_machine_alone(path: str) -> None:
    machine = Parametric.of(path)
    models = _variants(machine, _there(machine, MACHINES[path]), 3)
    assert all(can_stack(m.structure) for m in models)
    cases = models[0].cases
    stack = stacked([m.structure for m in models], models[0].placement)
    # two of the three: numbers are taken with their poses
    found = solve(stack[1:], cases)
    for i, model in enumerate(models[1:]):
        alone = solve(model.placed, cases)
        for name in ("displacements", "joint_forces", "beam_forces", "strain_energy"):
            one, other = getattr(found, name)[i], getattr(alone, name)
            np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9 * np.abs(other).max())
    if not cases:
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        together = preloaded(stack, cases[0])
        alone_too = preloaded(models[2].placed, cases[0])
    assert together.stiffening is not None
    assert alone_too.stiffening is not None
    parts, others = together.stiffening.parts, alone_too.stiffening.parts
    largest = max(np.abs(other).max() for _, _, other in others)
    for (name, _, one), (same, _, other) in zip(parts, others, strict=True):
        assert name == same
        np.testing.assert_allclose(one[2], other, rtol=1e-9, atol=1e-9 * largest)


def test_machines_that_move_or_carry_otherwise_are_asked_alone() -> None:
    machine = Parametric.of(HEXAPOD)
    changes: list[Mapping[str, float]] = [
        {"sections.ram.diameter": 0.05},
        {"sections.ram.diameter": 0.06},
        {"nodes.TCP.z": 0.91},
        {"loads[0].force.z": -3000.0},
    ]
    models = [machine.model(c) for c in changes]
    stand = Stand(None)
    found = first_frequencies([*((m, stand(m)) for m in models), None])
    assert np.isfinite(found).tolist() == [True, True, False, False, False]


def test_a_machine_that_buckles_says_so_and_the_others_have_their_frequencies() -> None:
    variants = Variants.of(HEXAPOD, ["sections.ram.diameter"], "frequency", workspace={})
    found = variants.values([[0.05], [0.003], [0.055], [0.06]], workers=1)
    assert found["status"].tolist() == [0, 1, 0, 0]
    assert "buckles under its preload" in why(found, 1)
    machine = Parametric.of(HEXAPOD)
    for row, diameter in ((0, 0.05), (2, 0.055), (3, 0.06)):
        model = machine.model({"sections.ram.diameter": diameter})
        alone = natural_frequencies(model.vibrating, 1)[0].item()
        assert found["first_frequency"][row] == pytest.approx(alone, rel=1e-9)


def test_tool_compliance_of_a_stack_is_not_that_of_the_first_machine(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # the compiled kernel, which knows the numbers of one machine only, would take so many poses
    monkeypatch.setattr(tool, "COMPILED_FROM", 1)
    machine = Parametric.of(HEXAPOD)
    models = _variants(machine, MACHINES[HEXAPOD], 3)
    stack = stacked([m.structure for m in models], models[0].placement)
    found, _ = compliance_and_outcome(stack)
    for i, model in enumerate(models):
        alone, _ = compliance_and_outcome(model.placed, "saddle_point")
        np.testing.assert_allclose(found[i], alone, rtol=1e-8, atol=1e-9 * np.abs(alone).max())


def test_poses_that_do_not_converge_are_solved_whole_and_the_others_kept(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    machine = Parametric.of(HEXAPOD)
    models = [machine.model({"sections.ram.diameter": d}) for d in (0.02, 0.03, 0.05, 0.09)]
    stack = stacked([m.structure for m in models], models[0].placement)
    whole = lowest_of(solve_eigen(reduce_system(system_of(stack))), 1)[0]
    asked: list[int] = []

    def counting(reduced: Reduced) -> Eigen:
        asked.append(len(reduced.basis))
        return solve_eigen(reduced)

    monkeypatch.setattr(lowest, "solve_eigen", counting)
    for rounds in range(1, 6):
        monkeypatch.setattr(lowest, "ROUNDS", rounds)
        found = natural_frequencies(stack, 1)[0]
        np.testing.assert_allclose(found, whole, rtol=1e-10)
    # with some number of rounds, some have converged and others not
    assert any(0 < poses < len(models) for poses in asked)
