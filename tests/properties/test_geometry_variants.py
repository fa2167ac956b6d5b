"""Variants of geometry share a program and what no place changes, and have the numbers of each."""

from __future__ import annotations

import pickle
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.variant_speed import built_alone
from strutwork.errors import StrutworkError
from strutwork.machines.model_poses import moved
from strutwork.msa import axis_stiffness_blocked, axis_stiffness_free, compliance_and_outcome
from strutwork.msa.variant_of import origin_of
from strutwork.studies.chunks import Arrays
from strutwork.studies.parameter import Parameter
from strutwork.studies.run import Chunk, chunks_of
from strutwork.studies.study_machines import FAILED, SOLVED, Machines
from strutwork.studies.variants import Variants, why

X = np.array([-0.01, 0.0, 0.01])
#: With home, as many machines at these poses as are worth the compiled kernel.
COUNT = 8


def _factor(*paths: str) -> Parameter:
    """Numbers that are scaled together; joined nodes have to move together."""
    return Parameter(paths, low=0.5, high=2.0, relative=True)


MACHINES = {
    "examples/machines/6-ups.toml": (
        _factor("nodes.base1.x", "nodes.foot1.x"),
        _factor("nodes.tip3.y", "nodes.seat3.y"),
        _factor("nodes.TCP.z"),
        _factor("sections.ram.diameter"),
    ),
    "examples/machines/linear-delta.toml": (
        _factor(*(f"nodes.{n}1{s}.x" for n in ("lower", "seat") for s in "ab")),
        _factor("nodes.rail2.z", "nodes.carriage2.z"),
        _factor("joints.upper1a.axis.x"),
    ),
    "linear-delta": (_factor("rod_length"), _factor("platform_radius")),
    "proposed-3pprs": (_factor("base_radius"), _factor("link_length")),
    # locked joints: coordinates that follow from others in loops, chosen with the program
    "hexel-hexapod": (_factor("long_side"), _factor("joint_height")),
}


@cache
def _variants(name: str) -> Variants:
    return _fresh(name)


def _fresh(name: str) -> Variants:
    return Variants.of(
        name, MACHINES[name], "stiffness", workspace={"x": X, "y": X}, reductions=["poses"]
    )


def _expect(variants: Variants, found: Arrays, row: int, factors: list[float]) -> None:
    if found["status"][row] == FAILED:
        with pytest.raises(StrutworkError) as raised:
            moved(built_alone(variants, factors), {"x": X})
        error = raised.value
        assert why(found, row) == " ".join(f"{error.part}: {error.problem}".split())
        return
    model = built_alone(variants, factors)
    grid = [a.ravel() for a in np.meshgrid(X, X, indexing="ij")]
    _, placement = moved(model, dict(zip("xy", grid, strict=True)))
    assert origin_of(model.structure) is None
    good = placement.reachable
    every = np.full((len(good), 6, 6), np.nan)
    if good.any():
        placed = model.structure.at(placement[good])
        every[good], _ = compliance_and_outcome(placed, "saddle_point")
    with np.errstate(invalid="ignore"):
        for column, of in (
            ("stiffness_free", axis_stiffness_free),
            ("stiffness_blocked", axis_stiffness_blocked),
        ):
            np.testing.assert_array_equal(
                np.isnan(found[column][row, :, 0]), np.isnan(every[:, 0, 0])
            )
            known = ~np.isnan(every[:, 0, 0])
            np.testing.assert_allclose(found[column][row, known], of(every[known]), rtol=1e-9)


@pytest.mark.parametrize("name", MACHINES)
@settings(max_examples=2, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.02, 0.1, 0.4]))
def test_shared_program_gives_what_each_geometry_has_alone(
    name: str, seed: int, scatter: float
) -> None:
    variants = _variants(name)
    shape = (COUNT, len(MACHINES[name]))
    samples = 1.0 + np.random.default_rng(seed).uniform(-scatter, scatter, shape)
    found = variants.values(samples, workers=1)
    for row in (0, COUNT - 1):
        _expect(variants, found, row, samples[row].tolist())


@pytest.mark.filterwarnings("ignore::strutwork.errors.ModelWarning")  # nodes that then meet
@pytest.mark.parametrize("name", MACHINES)
def test_mirrored_and_degenerate_machines_are_what_they_are_alone(name: str) -> None:
    variants = _variants(name)
    width = len(MACHINES[name])
    odd = np.concatenate([np.eye(width) * -2.0, np.eye(width) * -1.0]) + 1.0
    samples = np.concatenate([odd, np.ones((COUNT, width))])
    found = variants.values(samples, workers=1)
    for row in range(len(odd)):
        _expect(variants, found, row, samples[row].tolist())
    # as it is stated
    assert found["status"][-1] == SOLVED


def test_a_joint_that_no_longer_closes_is_named() -> None:
    name = "examples/machines/6-ups.toml"
    paths = ["nodes.base1.x", "nodes.tip1.z"]
    variants = Variants.of(name, paths, "stiffness", workspace={"x": X})
    stated = [n.value for p in paths for n in variants.study.machine.matching(p)]
    found = variants.values(np.add(stated, [[0.0, 0.0], [1e-3, 0.0], [0.0, -1e-3]]))
    assert found["status"].tolist() == [SOLVED, FAILED, FAILED]
    assert "cardan1" in why(found, 1)
    assert "ball1" in why(found, 2)


def _asked(machines: Machines, size: int) -> Arrays:
    """All machines, in chunks of a size."""
    parts = [machines(chunk) for chunk in chunks_of(len(machines.values), size)]
    return {name: np.concatenate([p[name] for p in parts]) for name in _arrays(parts[0])}


def _arrays(part: Arrays) -> list[str]:
    return [name for name in part if name not in ("reasons", "reason")]


def _machines(name: str, samples: np.ndarray) -> Machines:
    """A study of its own, in which nothing was computed before."""
    fresh = _fresh(name)
    study = fresh.study
    return Machines(
        study.machine, study.varied, samples, study.questions, fresh.stand, study.reductions
    )


@pytest.mark.parametrize("name", MACHINES)
def test_order_and_chunks_change_no_bit(name: str) -> None:
    random = np.random.default_rng(23)
    samples = 1.0 + random.uniform(-0.3, 0.3, (2 * COUNT, len(MACHINES[name])))
    whole = _asked(_machines(name, samples), len(samples))
    assert np.isfinite(whole["stiffness_free"]).any()
    order = random.permutation(len(samples))
    shuffled = _asked(_machines(name, samples[order]), 5)
    sent: Machines = pickle.loads(pickle.dumps(_machines(name, samples)))  # noqa: S301 - made here
    # what goes on where another process stopped
    resumed = sent(Chunk(1, COUNT, 2 * COUNT))
    for array in _arrays(resumed):
        np.testing.assert_array_equal(shuffled[array], whole[array][order], err_msg=array)
        np.testing.assert_array_equal(resumed[array], whole[array][COUNT:], err_msg=array)
