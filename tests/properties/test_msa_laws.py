"""Laws that hold for every structure: reciprocity, linearity, energy, one answer by all roads."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from strutwork.msa import Beam, LoadCase, rigid_map, solve, system_of, tool_compliance
from strutwork.msa.beam import local_stiffness, to_global
from tests.random_frames import MATERIALS, random_frame, random_load, random_section
from tests.structure_cases import by_length

seeds = st.integers(0, 2**32 - 1)
# solutions of condition 1e5 to 1e8 with one step of refinement
SOLVED = 1e-9


@given(seeds, st.booleans())
def test_work_of_one_load_on_the_others_displacements_is_mutual(seed: int, joints: bool) -> None:
    """Betti: F₁·u₂ = F₂·u₁."""
    model = random_frame(seed, joints=joints)
    one, two = random_load(seed, model, "one"), random_load(seed + 7, model, "two")
    found = solve(model.place(), [one, two])

    def work(load: LoadCase, on: str) -> float:
        return sum(float(np.dot(six, found.displacement(n, on))) for n, six in load.wrenches)

    own = work(one, "one") * work(two, "two")
    assert own > 0
    assert abs(work(one, "two") - work(two, "one")) <= SOLVED * np.sqrt(own)


@given(seeds, st.floats(-1e3, 1e3), st.booleans())
def test_solutions_are_linear_in_loads_and_misfits(seed: int, factor: float, joints: bool) -> None:
    model = random_frame(seed, joints=joints)
    one = random_load(seed, model, "one")
    two = LoadCase("two", gaps={("support n0", d): 1e-4 for d in ("x", "z", "ry")})
    joined = LoadCase(
        "sum",
        tuple((n, tuple(factor * v for v in six)) for n, six in one.wrenches),  # type: ignore[misc]
        gaps=two.gaps,
    )
    found = solve(model.place(), [one, two, joined])
    for field, scale in (("displacements", 1.0), ("joint_forces", 1.0), ("beam_forces", 1.0)):
        array = by_length(getattr(found, field), scale)
        expected = factor * array[..., 0] + array[..., 1]
        # the misfit of the one support costs no force: round-off is judged by the load's
        parts = max(abs(factor), 1.0) * np.abs(array[..., 0]).max() + np.abs(array[..., 1]).max()
        assert np.abs(array[..., 2] - expected).max() <= 1e-8 * parts


@given(seeds, st.booleans())
def test_stiffness_is_symmetric_and_never_gives_energy(seed: int, joints: bool) -> None:
    system = system_of(random_frame(seed, joints=joints).place())
    k = system.stiffness[0]
    weight = 1 / np.sqrt(np.diag(k))
    unit = k * weight * weight[:, None]
    assert np.abs(unit - unit.T).max() <= 1e-14
    assert np.linalg.eigvalsh(unit).min() >= -1e-12
    by_triplets = system.sparse_stiffness.toarray() * weight * weight[:, None]
    np.testing.assert_allclose(by_triplets, unit, atol=1e-14)


@given(seeds, st.lists(st.floats(-1, 1), min_size=6, max_size=6))
def test_a_rigid_motion_costs_no_energy_and_breaks_no_joint(seed: int, motion: list[float]) -> None:
    """Of all clusters together; only the support feels it."""
    model = random_frame(seed, joints=True)
    system = system_of(model.place())
    structure = system.placed.structure
    twist = np.asarray(motion)
    points = system.placed.positions[0, structure.reference_nodes]
    u = (rigid_map(points) @ twist).ravel()
    force = system.stiffness[0] @ u
    largest = np.abs(system.stiffness[0]).max() * max(np.abs(u).max(), 1e-30)
    assert np.abs(force).max() <= 1e-12 * largest
    rates = system.rows[0] @ u
    inner = [not label.startswith("support") for label in system.row_labels]
    assert np.abs(rates[inner]).max(initial=0.0) <= 1e-12 * max(np.abs(u).max(), 1e-30)


@given(seeds)
def test_a_single_beam_feels_no_rigid_motion(seed: int) -> None:
    rng = np.random.default_rng(seed)
    beam = Beam("b", ("a", "c"), MATERIALS[0], random_section(rng))
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    axes[2] *= np.sign(np.linalg.det(axes))
    length = rng.uniform(0.1, 3.0)
    k = to_global(axes, local_stiffness(np.asarray(length), beam.properties))
    motion = np.concatenate([np.eye(6), rigid_map(length * axes[0])])
    assert np.abs(k @ motion).max() <= 1e-13 * np.abs(k).max() * max(length, 1.0)


@given(seeds, st.booleans())
@settings(max_examples=20)
def test_all_roads_lead_to_one_answer(seed: int, joints: bool) -> None:
    model = random_frame(seed, joints=joints)
    placed = model.place()
    cases = [
        random_load(seed, model),
        LoadCase("weight", gravity=(0.0, 3.0, -9.0)),
        LoadCase("sink", gaps={("support n0", "z"): 1e-3}),
    ]
    expected = solve(placed, cases, "saddle_point")
    for method in ("null_space", "condensed", "sparse"):
        found = solve(placed, cases, method)  # type: ignore[arg-type]
        for field in ("displacements", "joint_forces", "beam_forces"):
            array, reference = getattr(found, field), getattr(expected, field)
            assert np.abs(array - reference).max() <= SOLVED * np.abs(reference).max()
    compliance = tool_compliance(placed, "saddle_point")
    for method in ("null_space", "condensed", "sparse", "compiled"):
        found_c = tool_compliance(placed, method)  # type: ignore[arg-type]
        assert np.abs(found_c - compliance).max() <= SOLVED * np.abs(compliance).max()


@given(seeds, st.integers(2, 5))
@settings(max_examples=20)
def test_a_batch_is_its_poses(seed: int, poses: int) -> None:
    rng = np.random.default_rng(seed)
    model = random_frame(seed, joints=True)
    loads = [random_load(seed, model)]
    # joint nodes share their place: move all copies of a node by the same amount
    moved = {
        name: rng.uniform(-0.1, 0.1, (poses, 3)) for name in model.positions if "." not in name
    }
    model.positions = {
        name: place + moved[name.split(".")[0]] for name, place in model.positions.items()
    }
    placed = model.place()
    together = solve(placed, loads)
    for method in ("saddle_point", "compiled"):
        c = tool_compliance(placed, method)  # type: ignore[arg-type]
        for pose in range(poses):
            alone = tool_compliance(placed[pose], "saddle_point")
            assert np.abs(c[pose] - alone).max() <= SOLVED * np.abs(alone).max()
    for pose in range(poses):
        alone_u = solve(placed[pose], loads).displacements
        gap = np.abs(together.displacements[pose] - alone_u).max()
        assert gap <= SOLVED * np.abs(alone_u).max()


@given(seeds)
@settings(max_examples=50)
def test_compliance_is_symmetric_positive_and_softens_with_every_cut(seed: int) -> None:
    """Rayleigh: taking stiffness away never makes the tool stiffer."""
    model = random_frame(seed)
    c = tool_compliance(model.place())
    weight = 1 / np.sqrt(np.diag(c))
    assert np.abs(c - c.T).max() == 0.0
    assert np.linalg.eigvalsh(c * weight * weight[:, None]).min() > 0
    model.joints[-1] = type(model.joints[-1])(
        model.joints[-1].name,
        "fixed",
        model.joints[-1].between,
        stiffness=dict.fromkeys(("x", "y", "z", "rx", "ry", "rz"), 1e6),
    )
    softer = tool_compliance(model.place())
    assert np.linalg.eigvalsh((softer - c) * weight * weight[:, None]).min() >= -1e-10
