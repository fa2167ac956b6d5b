"""Exact minimum of the dynamic stiffness with dashpots, and the damping of modes they couple."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eigvals

from strutwork.errors import ModelError
from strutwork.fea import (
    LossFactor,
    ModalRatio,
    PartDamping,
    Port,
    Rayleigh,
    frequency_response,
    modes,
)
from strutwork.fea.least_stiffness import least_dynamic_stiffness
from strutwork.fea.mode_damping import damping_ratios
from strutwork.fea.pole_peak import PoleSum, largest_on_band
from strutwork.machines.model_file import parse_model
from strutwork.msa import PlacedStructure
from tests.model_files import SAMPLE, put, sample, toml

X = Port("M", "x")


def chain(*links: tuple[str, str, float, float], masses: dict[str, float]) -> PlacedStructure:
    """Masses on sliders along x, joined by springs with dashpots: (from, to, k, c)."""
    nodes = dict.fromkeys(["ground", *(n for link in links for n in link[:2])])
    joints = [
        {
            "name": f"link{i}",
            "type": "prismatic",
            "axis": [1, 0, 0],
            "between": [first, second],
            "stiffness": {"z": float(k)} if k else {},
            "damping": {"z": float(c)},
        }
        for i, (first, second, k, c) in enumerate(links)
    ]
    content = {
        "nodes": {node: [0, 0, 0] for node in nodes},
        "masses": [{"node": n, "mass": m} for n, m in masses.items()],
        "joints": joints,
        "supports": [{"node": "ground", "fixed": "all"}],
    }
    return parse_model(toml(content)).placed


@pytest.mark.parametrize("ratio", [0.001, 0.05, 0.4])
def test_one_mass_on_a_dashpot(ratio: float) -> None:
    # 1/|H| is least at ω₀ √(1 − 2ζ²), where it is 2ζ √(1 − ζ²) k; Thomson, Theory of Vibration
    k, m = 4e5, 2.5
    placed = chain(("ground", "M", k, 2 * ratio * np.sqrt(k * m)), masses={"M": m})
    found = least_dynamic_stiffness(placed, X, X, PartDamping(), (0.0, 1000.0))
    natural = np.sqrt(k / m) / (2 * np.pi)
    # closed forms, so rounding alone; a minimum is flat, so its place has half the digits
    assert found.value == pytest.approx(2 * ratio * np.sqrt(1 - ratio**2) * k, rel=1e-9)
    assert found.frequency == pytest.approx(natural * np.sqrt(1 - 2 * ratio**2), rel=1e-6)
    assert found.static == pytest.approx(k, rel=1e-12)
    assert found.certified
    ratios = damping_ratios(modes(placed, 1), PartDamping())
    assert ratios == pytest.approx([ratio], rel=1e-9)


def test_overdamped_mode_has_ratio_one_and_no_peak() -> None:
    k, m = 4e5, 2.5
    placed = chain(("ground", "M", k, 5 * np.sqrt(k * m)), masses={"M": m})
    assert damping_ratios(modes(placed, 1), PartDamping()) == pytest.approx([1.0])
    found = least_dynamic_stiffness(placed, X, X, PartDamping(), (1.0, 100.0))
    w = 2 * np.pi * 1.0
    assert found.frequency == pytest.approx(1.0)
    assert found.value == pytest.approx(abs(k - m * w**2 + 5j * np.sqrt(k * m) * w), rel=1e-9)


def test_a_massless_node_behind_a_dashpot() -> None:
    # standard linear solid: (k1 + iωc) in series with k2, and a mass on it
    k1, c, k2, m = 3e5, 400.0, 5e5, 1.5
    placed = chain(("ground", "A", k1, c), ("A", "M", k2, 0.0), masses={"M": m})

    def stiffness(f: Any) -> Any:
        w = 2 * np.pi * f
        return 1 / (1 / (k1 + 1j * w * c) + 1 / k2) - m * w**2

    found = least_dynamic_stiffness(placed, X, X, PartDamping(), (1.0, 500.0))
    near = np.linspace(found.frequency - 0.1, found.frequency + 0.1, 20001)
    wide = np.linspace(1.0, 500.0, 20001)
    least = min(np.abs(stiffness(near)).min(), np.abs(stiffness(wide)).min())
    # the middle of the fine grid is the place itself
    assert found.value == pytest.approx(abs(stiffness(found.frequency)), rel=1e-9)
    assert found.value == pytest.approx(least, rel=1e-9)
    assert found.certified
    assert found.static == pytest.approx(k1 * k2 / (k1 + k2), rel=1e-9)


def test_a_mass_that_slides_freely_in_a_dashpot() -> None:
    # no spring: |iωc − ω²m| rises, so the least is at the start of the band
    c, m = 30.0, 2.0
    placed = chain(("ground", "M", 0.0, c), masses={"M": m})
    found = least_dynamic_stiffness(placed, X, X, PartDamping(), (2.0, 50.0))
    w = 4 * np.pi
    assert found.value == pytest.approx(abs(1j * w * c - w**2 * m), rel=1e-9)
    assert (found.frequency, found.static) == (pytest.approx(2.0), 0.0)
    with pytest.raises(ModelError, match="starts at zero"):
        least_dynamic_stiffness(placed, X, X, PartDamping(), (0.0, 50.0))


@given(
    st.lists(st.floats(1e5, 1e6), min_size=3, max_size=3),
    st.lists(st.floats(1.0, 2000.0), min_size=3, max_size=3),
    st.lists(st.floats(0.5, 4.0), min_size=3, max_size=3),
    st.sampled_from(["x/x", "x/third"]),
)
@settings(max_examples=20, deadline=None)
def test_three_masses_against_their_matrices(k: Any, c: Any, m: Any, ports: str) -> None:
    placed = chain(
        ("ground", "M", k[0], c[0]),
        ("M", "N", k[1], c[1]),
        ("N", "O", k[2], c[2]),
        masses={"M": m[0], "N": m[1], "O": m[2]},
    )
    joined = np.array([[1.0, 0, 0], [-1, 1, 0], [0, -1, 1]])
    K, C, M = joined.T @ np.diag(k) @ joined, joined.T @ np.diag(c) @ joined, np.diag(m)
    output = 0 if ports == "x/x" else 2
    found = least_dynamic_stiffness(
        placed, X, X if output == 0 else Port("O", "x"), PartDamping(), (1.0, 400.0)
    )

    def size(f: Any) -> Any:
        w = 2 * np.pi * np.atleast_1d(f)[:, None, None]
        return np.abs(np.linalg.inv(K + 1j * w * C - w**2 * M)[:, output, 0])

    # nothing on the grid is lower, and the value is that of the matrices at its place
    assert size(np.linspace(1.0, 400.0, 8000)).max() <= (1 + 1e-6) / found.value
    assert size(found.frequency)[0] == pytest.approx(1 / found.value, rel=1e-7)
    assert found.certified
    below = [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]
    state = np.block([[np.zeros((3, 3)), np.eye(3)], below])
    roots = eigvals(state)
    whole = -roots.real / np.abs(roots)
    for ratio in damping_ratios(modes(placed, 3), PartDamping()):
        assert np.abs(whole - ratio).min() < 1e-7


BAND = (1.0, 2000.0)
KINDS = [
    ModalRatio(0.01),
    LossFactor(0.02),
    Rayleigh(1.0, 1e-5),
    PartDamping(ModalRatio(0.01)),
    PartDamping(LossFactor(0.02)),
    PartDamping(Rayleigh(1.0, 1e-5)),
]


@pytest.mark.parametrize("damping", KINDS, ids=str)
@pytest.mark.parametrize(("given_at", "seen_at"), [("TCP:z", "TCP:z"), ("TCP:x", "B:z")])
def test_no_fine_grid_is_lower(damping: Any, given_at: str, seen_at: str) -> None:
    placed = parse_model(toml(SAMPLE)).placed
    given_port, output = Port.parse(given_at), Port.parse(seen_at)
    found = least_dynamic_stiffness(placed, given_port, output, damping, BAND)
    lines = np.append(np.linspace(*BAND, 4000), found.frequency)
    response = frequency_response(placed, [given_port], [output], lines, damping, "direct")
    size = np.abs(response.receptance[:, 0, 0])
    assert size.max() * found.value <= 1 + 1e-6
    # the direct solution at the place has the value of the sum
    assert size[-1] * found.value == pytest.approx(1.0, rel=1e-8)
    assert found.certified


def test_stiffness_between_ports_is_reciprocal() -> None:
    placed = parse_model(toml(SAMPLE)).placed
    a, b = Port("TCP", "x"), Port("B", "ry")
    for damping in (ModalRatio(0.01), PartDamping(ModalRatio(0.01))):
        there = least_dynamic_stiffness(placed, a, b, damping, BAND)
        back = least_dynamic_stiffness(placed, b, a, damping, BAND)
        assert there.value == pytest.approx(back.value, rel=1e-9)
        assert there.static == pytest.approx(back.static, rel=1e-9)


def test_dashpots_that_miss_a_mode_do_not_damp_it() -> None:
    # two masses on springs of their own, one of them without a dashpot
    placed = chain(("ground", "M", 2e5, 0.0), ("ground", "N", 3e5, 50.0), masses={"M": 1, "N": 1})
    with pytest.raises(ModelError, match=r"is zero in the mode at 71\.18 Hz"):
        least_dynamic_stiffness(placed, X, X, PartDamping(), (1.0, 200.0))
    # the mode of the other mass is damped
    found = least_dynamic_stiffness(placed, Port("N", "x"), Port("N", "x"), PartDamping(), (1, 200))
    ratio = 50.0 / (2 * np.sqrt(3e5))
    assert found.value == pytest.approx(2 * ratio * np.sqrt(1 - ratio**2) * 3e5, rel=1e-9)


def test_ports_that_do_not_feel_one_another() -> None:
    placed = chain(("ground", "M", 2e5, 10.0), ("ground", "N", 3e5, 50.0), masses={"M": 1, "N": 1})
    for damping in (ModalRatio(0.01), PartDamping()):
        found = least_dynamic_stiffness(placed, X, Port("N", "x"), damping, (1.0, 200.0))
        assert found.uncoupled
        assert (found.value, found.static) == (np.inf, None)
        response = frequency_response(placed, [X], [Port("N", "x")], [71.0, 87.0], damping)
        assert not response.receptance.any()
        assert not response.static_compliance.any()


@pytest.mark.parametrize("band", [(5.0, 5.0), (10.0, 5.0), (-1.0, 5.0), (1.0, float("inf"))])
def test_bands_that_are_none(band: tuple[float, float]) -> None:
    placed = parse_model(toml(SAMPLE)).placed
    with pytest.raises(ModelError, match="frequency band"):
        least_dynamic_stiffness(placed, X, X, ModalRatio(0.01), band)


def test_no_damping_at_all() -> None:
    placed = parse_model(toml(sample(put("joints.0.damping", {})))).placed
    tip = Port("TCP", "z")
    with pytest.raises(ModelError, match="falls to zero"):
        least_dynamic_stiffness(placed, tip, Port("TCP", "x"), ModalRatio(0.0), BAND)
    with pytest.raises(ModelError, match="no part has any"):
        least_dynamic_stiffness(placed, tip, tip, PartDamping(), BAND)


@pytest.mark.parametrize("damping", KINDS[:3], ids=str)
def test_ratios_of_damping_that_leaves_the_modes_alone(damping: Any) -> None:
    found = modes(parse_model(toml(SAMPLE)).placed, 5)
    w = 2 * np.pi * found.frequencies
    wanted = {
        ModalRatio: np.full(5, 0.01),
        LossFactor: np.full(5, 0.01),
        Rayleigh: 0.5 / w + 0.5e-5 * w,
    }[type(damping)]
    assert damping_ratios(found, damping) == pytest.approx(wanted, rel=1e-12)


@given(st.integers(0, 1000))
@settings(max_examples=25, deadline=None)
def test_largest_of_any_sum_over_poles(seed: int) -> None:
    rng = np.random.default_rng(seed)
    k = rng.integers(1, 8)
    poles = -rng.uniform(0.01, 5, k) + 1j * rng.uniform(-100, 300, k)
    residues = rng.normal(size=k) + 1j * rng.normal(size=k)
    total = PoleSum(poles, residues, complex(rng.normal() * 0.1), float(rng.normal()))
    place, size, certified = largest_on_band(total, 1.0, 200.0)
    assert certified
    grid = np.abs(total.derivatives(np.linspace(1.0, 200.0, 40001))[0])
    assert grid.max() <= size * (1 + 1e-6)
    assert np.abs(total.derivatives(np.array([place]))[0][0]) == pytest.approx(size, rel=1e-12)
