"""Frequency response: closed forms, methods against each other, bad input."""

from __future__ import annotations

import contextlib
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.fea import (
    LossFactor,
    ModalRatio,
    PartDamping,
    Port,
    Rayleigh,
    frequency_response,
    modal_model,
    modes,
)
from strutwork.fea.coupled import AnyDamping, part_matrices
from strutwork.fea.frf import Method
from strutwork.fea.modal import STATIC_SHARE
from strutwork.fea.modal_truncation import TRUNCATED
from strutwork.msa import PlacedStructure, system_of, tool_compliance
from strutwork.msa.constraints import scales
from tests.structure_cases import LIBRARY
from tests.structures import Model, cantilever
from tests.vibration import heavy, oscillators, saddle_point_matrices

Array = NDArray[Any]

K, M = 2e5, 3.0
LINES = [0.0, 5.0, 38.0, 41.0, 300.0]
X = Port("m1", "x")

DAMPINGS = {
    "ratio": (ModalRatio(0.03), lambda w: 1j * w * 2 * 0.03 * np.sqrt(K * M)),
    "loss factor": (LossFactor(0.06), lambda w: 0.06j * K + 0 * w),
    "Rayleigh": (Rayleigh(4.0, 2e-4), lambda w: 1j * w * (4.0 * M + 2e-4 * K)),
    "parts": (
        PartDamping(joints={"J1": 0.06}, dashpots=True),
        lambda w: 0.06j * K + 1j * w * 40.0,
    ),
}


def one_mass() -> PlacedStructure:
    return oscillators((K, M), joints={"damping": {"z": 40.0}}).place()


@pytest.mark.parametrize("method", ["modal", "all_modes", "direct"])
@pytest.mark.parametrize("kind", DAMPINGS)
def test_one_mass_on_a_spring(kind: str, method: str) -> None:
    damping, force = DAMPINGS[kind]
    found = frequency_response(one_mass(), [X], [X], LINES, damping, method)  # type: ignore[arg-type]
    w = 2 * np.pi * np.array(LINES)
    expected = 1.0 / (K - M * w**2 + force(w))
    np.testing.assert_allclose(found.receptance[:, 0, 0], expected, rtol=1e-12)
    np.testing.assert_allclose(found.mobility[:, 0, 0], 1j * w * expected, rtol=1e-12)
    np.testing.assert_allclose(found.accelerance[:, 0, 0], -(w**2) * expected, rtol=1e-12)
    np.testing.assert_allclose(found.dynamic_stiffness[:, 0, 0], 1 / np.abs(expected), rtol=1e-12)
    np.testing.assert_allclose(found.static_compliance, [[1 / K]], rtol=1e-12)
    assert found.damping == str(damping)
    assert found.method == ("direct" if kind == "parts" else method)


@pytest.mark.parametrize("name", LIBRARY)
@pytest.mark.parametrize("kind", ["ratio", "loss factor", "Rayleigh"])
def test_direct_equals_all_modes(name: str, kind: str) -> None:
    model = heavy(name)
    placed = model.place()
    damping = {
        "ratio": ModalRatio(0.02),
        "loss factor": LossFactor(0.04),
        "Rayleigh": Rayleigh(5.0, 1e-9),
    }[kind]
    assert model.tool is not None
    ports = moving_ports(placed, model.tool)
    if not ports:
        with pytest.raises(ModelError, match="does not move"):
            frequency_response(placed, [Port(model.tool, "x")], ports, [1.0], damping)
        return
    lines = [3.0, 47.0, 211.0, 1500.0]
    direct, all_modes = (
        frequency_response(placed, ports, ports, lines, damping, method).receptance
        for method in ("direct", "all_modes")
    )
    size = np.abs(direct).max(axis=(-1, -2), keepdims=True)
    assert np.abs(direct - all_modes).max() > 0.0 or len(ports) == 1
    assert (np.abs(direct - all_modes) / size).max() < 1e-8


def moving_ports(placed: PlacedStructure, node: str) -> list[Port]:
    """Translations of a node that move at every pose."""
    found = []
    for direction in "xyz":
        port = Port(node, direction)
        with contextlib.suppress(ModelError):
            modal_model(placed, [port], LossFactor(0.1))
            found.append(port)
    return found


def saddle_point_response(
    placed: PlacedStructure, node: str, lines: list[float], viscous: Array, structural: Array
) -> Array:
    """Translational receptances of a node by the complex saddle-point system of one pose."""
    system = system_of(placed)
    k, m, rows = saddle_point_matrices(placed)
    d = scales(system)[0]
    outer = np.outer(d, d)
    vertex = placed.structure.vertex_of_node[placed.structure.mesh_index[node]]
    assert not np.any(system.placed.arms[0, placed.structure.mesh_index[node]])
    load = np.zeros((len(k) + len(rows), 3))
    load[6 * vertex + np.arange(3), np.arange(3)] = 1.0
    size = np.abs(k).max()
    result = []
    for line in lines:
        w = 2 * np.pi * line
        z = k + outer * (1j * structural[0] + 1j * w * viscous[0]) - w**2 * m
        matrix = np.block([[z / size, rows.T], [rows, np.zeros((len(rows),) * 2)]])
        result.append((load.T @ np.linalg.solve(matrix, load.astype(complex))) / size)
    return np.array(result)


def damped(name: str) -> Model:
    """Every second joint with a dashpot along and about each axis, every beam lossy."""
    model = heavy(name)
    model.joints = [
        replace(j, damping={"x": 900.0, "z": 400.0, "rx": 3.0, "rz": 2.0}) if i % 2 else j
        for i, j in enumerate(model.joints)
    ]
    model.beams = [
        replace(b, material=replace(b.material, loss_factor=0.01 * (1 + i % 3)))
        for i, b in enumerate(model.beams)
    ]
    return model


@pytest.mark.parametrize(
    "name",
    ["hexapod", "tripod machine", "serial arm", "two rods, bushing", "four-bar, flexible"],
)
def test_damping_of_parts_against_the_complex_saddle_point_system(name: str) -> None:
    """Nothing but K, M and the rows in common; 1e-8, the project's bound."""
    model = damped(name)
    placed = model.place()
    placed = placed[(0,) * len(placed.batch)]
    elastic = [j.name for j in model.joints if j.stiffness or j.matrix is not None]
    damping = PartDamping(joints={elastic[0]: 0.2})
    assert model.tool is not None
    ports = [Port(model.tool, d) for d in "xyz"]
    lines = [3.0, 47.0, 211.0, 1500.0]
    viscous, structural = part_matrices(system_of(placed), damping)
    assert np.any(viscous)
    assert np.any(structural)
    expected = saddle_point_response(placed, model.tool, lines, viscous, structural)
    found = frequency_response(placed, ports, ports, lines, damping).receptance
    size = np.abs(expected).max(axis=(1, 2), keepdims=True)
    assert (np.abs(found - expected) / size).max() < 1e-8


def test_parts_that_are_alike_damp_like_the_whole() -> None:
    """Every beam with the same loss factor is the loss factor of a structure of beams alone."""
    model = heavy("portal frame")
    model.beams = [replace(b, material=replace(b.material, loss_factor=0.05)) for b in model.beams]
    placed, ports = model.place(), [Port("crown", d) for d in "xyz"]
    lines = [2.0, 20.0, 90.0]
    parts = frequency_response(placed, ports, ports, lines, PartDamping())
    whole = frequency_response(placed, ports, ports, lines, LossFactor(0.05), "all_modes")
    size = np.abs(whole.receptance).max(axis=(1, 2), keepdims=True)
    assert (np.abs(parts.receptance - whole.receptance) / size).max() < 1e-8
    assert parts.method == "direct"


def test_parts_without_damping_leave_the_background() -> None:
    placed = oscillators((K, M)).place()
    found = frequency_response(placed, [X], [X], LINES, PartDamping(ModalRatio(0.03)))
    plain = frequency_response(placed, [X], [X], LINES, ModalRatio(0.03))
    np.testing.assert_array_equal(found.receptance, plain.receptance)
    with pytest.raises(ModelError, match="no part has any"):
        frequency_response(placed, [X], [X], LINES, PartDamping())


@pytest.mark.parametrize("method", ["modal", "all_modes", "direct"])
def test_some_pairs_of_ports_have_the_error_of_all(method: Method) -> None:
    placed = heavy("three-legged frame").place()
    ports = [Port("tool", d) for d in "xyz"]
    every = frequency_response(placed, ports, ports, LINES, LossFactor(0.04), method)
    some = frequency_response(placed, ports[:2], ports[1:], LINES, LossFactor(0.04), method)
    largest = np.abs(every.receptance).max()
    np.testing.assert_allclose(some.receptance, every.receptance[..., 1:, :2], atol=1e-12 * largest)
    assert some.truncation_error.shape == some.receptance.shape
    assert bool(np.any(some.truncation_error)) == (method == "modal")


@pytest.mark.parametrize("damping", [ModalRatio(0.02), LossFactor(0.04)], ids=str)
def test_static_residual_makes_the_response_whole(damping: AnyDamping) -> None:
    placed = heavy("three-legged frame").place()
    ports = [Port("tool", d) for d in "xyz"]
    highest = 60.0
    lines = [0.0, 10.0, 30.0, highest]
    kept = frequency_response(placed, ports, ports, lines, damping)
    whole = frequency_response(placed, ports, ports, lines, damping, "all_modes")
    assert 0 < kept.kept_modes < whole.kept_modes == 84
    assert STATIC_SHARE <= kept.static_share < 1.0
    compliance = tool_compliance(placed)[:, :3, :3]
    # the bound that is stated is one, is not idle, and is small beside the answer of every pair
    wrong = np.abs(kept.receptance - whole.receptance)
    peak = np.abs(whole.receptance).max(axis=1, keepdims=True)
    assert kept.truncation_error.shape == wrong.shape
    assert np.all(wrong <= kept.truncation_error + 1e-10 * peak)
    assert np.all(kept.truncation_error <= 1.01 * TRUNCATED * peak)
    driven = np.arange(3)
    last = wrong[:, -1, driven, driven]
    assert np.all(last > 0.5 * kept.truncation_error[:, -1, driven, driven])
    assert not np.any(whole.truncation_error)
    # modes left out lie above 2 × highest, carry at most 1 % of the static compliance, and are
    # taken for static: off by 1/(1 − 1/4) − 1 = 1/3 and, undamped, by 2 ζ/2 = 0.02 of it
    own = np.sqrt(np.einsum("pii->pi", compliance))
    size = own[:, None, :, None] * own[:, None, None, :]
    error = np.abs(kept.receptance - whole.receptance) / size
    assert error[:, 0].max() < 1e-9
    assert error.max() < 0.01 * (1 / 3 + 0.03)
    np.testing.assert_allclose(kept.static_compliance, compliance, rtol=1e-8, atol=1e-14)
    if isinstance(damping, ModalRatio):
        np.testing.assert_allclose(kept.receptance[:, 0].real, compliance, rtol=1e-8, atol=1e-14)


def test_relative_response_tool_to_workpiece() -> None:
    """Two oscillators that know nothing of each other: compliances add."""
    model = oscillators((K, M), (1e4, 1.0))
    model.joints[1] = replace(model.joints[1], between=("m0", "m2"))
    model.positions["m2"] = np.zeros(3)
    port = Port("m1", "x", against="m2")
    found = frequency_response(model.place(), [port], [port], LINES, LossFactor(0.05))
    w = 2 * np.pi * np.array(LINES)
    expected = sum(1 / (k * (1 + 0.05j) - m * w**2) for k, m in ((K, M), (1e4, 1.0)))
    np.testing.assert_allclose(found.receptance[:, 0, 0], expected, rtol=1e-12)


def test_a_floating_structure() -> None:
    """A free mass: H = −1/(m ω²); a pair on a spring: the closed form of two masses."""
    model = oscillators((0.0, 2.0), (K, 3.0))
    placed, ports = model.place(), [Port("m1", "x"), Port("m2", "x")]
    lines = np.array([2.0, 50.0, 400.0])
    expected = []
    for line in lines:
        w = 2 * np.pi * line
        stiffness = K * (1 + 0.1j) * np.array([[1, -1], [-1, 1]])
        expected.append(np.linalg.inv(stiffness - w**2 * np.diag([2.0, 3.0])))
    for method in ("modal", "all_modes", "direct"):
        found = frequency_response(placed, ports, ports, lines, LossFactor(0.1), method)  # type: ignore[arg-type]
        size = np.abs(expected).max(axis=(1, 2), keepdims=True)
        assert (np.abs(found.receptance - expected) / size).max() < 1e-9
    assert np.all(np.isinf(found.static_compliance))
    for method in ("all_modes", "direct"):
        with pytest.raises(NumericalError, match="frequency response"):
            frequency_response(placed, ports, ports, [0.0], LossFactor(0.1), method)  # type: ignore[arg-type]


def test_struts_that_spin_leave_the_tool_its_static_compliance() -> None:
    placed = heavy("hexapod, spinning struts").place()
    port = Port("tool", "z")
    found = frequency_response(placed, [port], [port], [0.0, 20.0], ModalRatio(0.02))
    held = frequency_response(heavy("hexapod").place(), [port], [port], [0.0], ModalRatio(0.02))
    np.testing.assert_allclose(found.static_compliance, held.static_compliance, rtol=1e-8)
    np.testing.assert_allclose(found.receptance[:, 0].real, found.static_compliance, rtol=1e-9)


def test_inputs_and_outputs_may_differ_and_repeat() -> None:
    placed = cantilever(elements=3).place()
    x, z, turn = Port("tip", "x"), Port("tip", "z"), Port("beam/1", "ry")
    found = frequency_response(placed, [z, x], [turn, z, z], [30.0], LossFactor(0.1))
    assert found.receptance.shape == (1, 3, 2)
    np.testing.assert_array_equal(found.receptance[:, 1], found.receptance[:, 2])
    square = frequency_response(placed, [x, z, turn], [x, z, turn], [30.0], LossFactor(0.1))
    np.testing.assert_allclose(found.receptance[0, 0, 0], square.receptance[0, 2, 1], rtol=1e-9)
    assert "1 lines, 3 x 2 receptances" in repr(found)


def test_a_batch_gives_what_its_poses_give_alone() -> None:
    placed = heavy("tripod machine").place()
    ports = [Port("tool", d) for d in ("x", "rz")]
    lines = [10.0, 80.0]
    together = frequency_response(placed, ports, ports, lines, ModalRatio(0.01), "all_modes")
    assert together.receptance.shape == (6, 2, 2, 2)
    for pose in range(6):
        alone = frequency_response(placed[pose], ports, ports, lines, ModalRatio(0.01), "all_modes")
        size = np.abs(alone.receptance).max(axis=0)
        assert (np.abs(alone.receptance - together.receptance[pose]) / size).max() < 1e-8


def test_bad_input() -> None:
    placed = one_mass()
    damping = ModalRatio(0.02)
    for lines in ([], [-1.0], [np.nan], [[1.0]]):
        with pytest.raises(ModelError, match="frequencies"):
            frequency_response(placed, [X], [X], lines, damping)
    for inputs, outputs in (([], [X]), ([X], [])):
        with pytest.raises(ModelError, match="at least one input and one output"):
            frequency_response(placed, inputs, outputs, [1.0], damping)
    with pytest.raises(ModelError, match='"magic" is unknown'):
        frequency_response(placed, [X], [X], [1.0], damping, "magic")  # type: ignore[arg-type]
    with pytest.raises(ModelError, match="port m1:y: does not move"):
        frequency_response(placed, [X], [Port("m1", "y")], [1.0], damping)
    with pytest.raises(ModelError, match="has no mass"):
        frequency_response(oscillators((K, 0.0)).place(), [X], [X], [1.0], damping)


@pytest.mark.parametrize("method", ["modal", "all_modes", "direct"])
def test_a_line_on_a_resonance_without_damping(method: str) -> None:
    # ω² = 64 is exact in floating point; so is 1 − ω²/64 at a line whose ω rounds to 8
    placed = oscillators((64.0, 1.0)).place()
    near = 8.0 / (2 * np.pi)
    line = next(f for f in near * (1 + 1e-16 * np.arange(-9, 10)) if 2 * np.pi * f == 8.0)
    assert modes(placed, 1).frequencies[0] == pytest.approx(line, rel=1e-15)
    with pytest.raises(NumericalError, match="frequency response"):
        frequency_response(placed, [X], [X], [line], LossFactor(0.0), method)  # type: ignore[arg-type]


@pytest.mark.parametrize("method", ["modal", "all_modes", "direct"])
def test_damping_beyond_critical_is_a_creep(method: str) -> None:
    """Stiffness-proportional damping is beyond critical for every mode above 2/β."""
    k, m, beta = 1e4, 1.0, 0.1
    found = frequency_response(
        oscillators((k, m)).place(),
        *([X], [X], [1.0, 15.0, 400.0], Rayleigh(0.0, beta), method),  # type: ignore[arg-type]
    )
    w = 2 * np.pi * found.frequencies
    # 1/(k − m ω² + iωβk) with ζ = βω₀/2 = 5
    np.testing.assert_allclose(
        found.receptance[:, 0, 0], 1 / (k - m * w**2 + 1j * w * beta * k), rtol=1e-12
    )


def test_direct_solutions_over_fifteen_decades() -> None:
    placed = oscillators((K, M), (5e5, 2.0)).place()
    lines = np.geomspace(1e-6, 1e9, 31)
    port = [Port("m1", "x")]
    direct = frequency_response(placed, port, port, lines, LossFactor(0.05), "direct")
    modal = frequency_response(placed, port, port, lines, LossFactor(0.05), "all_modes")
    # each line by itself: beside a resonance the response at 1 GHz is 1e-20 of it
    np.testing.assert_allclose(direct.receptance, modal.receptance, rtol=1e-9)


def test_a_direct_solution_that_is_off_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    placed = oscillators((K, M), (5e5, 2.0)).place()
    port = [Port("m1", "x")]
    exact = np.linalg.solve

    def rough(matrix: Array, right: Array) -> Array:
        return np.asarray(exact(matrix, right) * (1.0 + 1e-5))

    monkeypatch.setattr(np.linalg, "solve", rough)
    with pytest.raises(NumericalError, match=r"at 30 Hz is accurate to 1e-05 of its largest"):
        frequency_response(placed, port, port, [30.0], LossFactor(0.05), "direct")
