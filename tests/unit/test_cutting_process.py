"""Processes, cutters, materials and forces of cutting."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from strutwork.cutting import (
    Cutter,
    ForceCoefficients,
    Milling,
    ProcessDamping,
    Turning,
    cutting_force,
    material,
    material_library,
    removal_rates,
)
from strutwork.cutting.materials import LIBRARY
from strutwork.errors import ModelError, UnitError

ALUMINIUM = ForceCoefficients(6e8, 2e8, 1e8, 2e4, 1e4, 5e3)


def milling(immersion: float = 0.5, *, helix: float = 0.0, lead: float = 0.5 * np.pi) -> Milling:
    return Milling(Cutter(0.02, 4, helix=helix, lead=lead), ALUMINIUM, immersion, "up")


def test_the_directional_matrix_of_a_tooth_is_that_of_the_book() -> None:
    """Altintas 2012, equation 4.60: ½ K_t times −sin 2φ − K_r (1 − cos 2φ), and so on."""
    process = Milling(Cutter(0.02, 1), ALUMINIUM, 1.0, "up")
    phi = np.linspace(0.1, 3.0, 7)
    kr = 1.0 / 3.0
    s, c = np.sin(2.0 * phi), np.cos(2.0 * phi)
    rows = [[-s - kr * (1 - c), -(1 + c) - kr * s], [(1 - c) - kr * s, s - kr * (1 + c)]]
    expected = 0.5 * 6e8 * np.array(rows)
    found = process.directional.at(phi, 1e-3)[:, :2, :2]
    np.testing.assert_allclose(found, np.moveaxis(expected, -1, 0), atol=1e-6 * 6e8)


@pytest.mark.parametrize("helix", [0.0, 0.5])
@pytest.mark.parametrize("lead", [0.5 * np.pi, 0.8])
def test_the_average_is_the_mean_over_a_pitch(helix: float, lead: float) -> None:
    chip = milling(0.7, helix=helix, lead=lead).directional
    angles = (np.arange(200_000) + 0.5) / 200_000 * chip.pitch
    mean = chip.at(angles, 5e-3).mean(axis=0)
    np.testing.assert_allclose(mean, chip.average, atol=2e-5 * np.abs(chip.average).max())


def test_a_helix_that_lags_by_one_pitch_cuts_steadily() -> None:
    chip = milling(0.3, helix=0.5).directional
    at = chip.at(np.linspace(0.0, chip.pitch, 17), chip.pitch / chip.lag)
    np.testing.assert_allclose(at, np.broadcast_to(chip.average, at.shape), atol=1e-6)


def test_breaks_and_cuts_of_a_pitch() -> None:
    chip = milling(0.5).directional
    assert chip.breaks(1e-3) == pytest.approx([0.0, 0.5 * np.pi])
    chip = Milling(Cutter(0.02, 2), ALUMINIUM, 0.5, "down").directional
    assert chip.breaks(1e-3) == pytest.approx([0.0, 0.5 * np.pi, np.pi])
    assert chip.cuts(1.0, 1e-3)
    assert not chip.cuts(2.0, 1e-3)


def test_the_force_of_a_straight_tooth() -> None:
    """A quarter turn after the entry of up-milling the chip has the full feed."""
    process = Milling(Cutter(0.02, 1), ALUMINIUM, 1.0, "up")
    force = cutting_force(process, 2e-3, 1e-4, 0.5 * np.pi)
    tangential = (6e8 * 1e-4 + 2e4) * 2e-3
    radial = (2e8 * 1e-4 + 1e4) * 2e-3
    axial = (1e8 * 1e-4 + 5e3) * 2e-3
    assert force == pytest.approx([-radial, tangential, -axial])


def test_the_mean_force_is_that_of_the_average_matrix() -> None:
    process = Milling(Cutter(0.02, 4, helix=0.5), ForceCoefficients(6e8, 2e8, 1e8), 0.4, "up")
    turn = (np.arange(3000) + 0.5) / 3000 * 2.0 * np.pi
    mean = cutting_force(process, 1e-3, 1e-4, turn).mean(axis=0)
    # the chip of the feed along x
    expected = process.directional.average[:, 0] * 1e-3 * 1e-4
    np.testing.assert_allclose(mean, expected, atol=1e-3 * np.abs(expected).max())


def test_runout_moves_load_from_tooth_to_tooth_and_keeps_the_mean() -> None:
    straight, off = (Cutter(0.02, 2, runout=r) for r in (0.0, 1e-5))
    turn = (np.arange(2000) + 0.5) / 2000 * 2.0 * np.pi
    k = ForceCoefficients(6e8)
    plain, uneven = (cutting_force(Milling(c, k, 1.0), 1e-3, 1e-4, turn) for c in (straight, off))
    np.testing.assert_allclose(uneven.mean(axis=0), plain.mean(axis=0), atol=0.5)
    halves = np.abs(uneven[:1000] - uneven[1000:]).max()
    assert halves == pytest.approx(6e8 * 1e-3 * 4e-5, rel=1e-3)


def test_removal_rates() -> None:
    process = milling(0.5)
    assert removal_rates(process, 6000.0, 2e-3, 1e-4) == pytest.approx(2e-3 * 0.01 * 1e-4 * 400)
    turned = Turning(1e9, diameter=0.1)
    assert removal_rates(turned, 600.0, 2e-3, 1e-4) == pytest.approx(2e-3 * 1e-4 * np.pi * 0.1 * 10)
    with pytest.raises(ModelError, match="no diameter"):
        removal_rates(Turning(1e9), 600.0, 2e-3, 1e-4)


def test_every_material_has_a_source_and_numbers_in_range() -> None:
    library = material_library()
    assert len(library) >= 5
    for one in library.values():
        assert one.source
        assert 1e8 < one.tangential < 1e10
        assert one.edge_tangential < 1e6
    assert material("aluminium-insperger-2004").radial == 2e8
    second = material("aluminium-7075-t6-second-test")
    assert (second.tangential, second.radial, second.edge_tangential, second.edge_radial) == (
        pytest.approx(600.46e6),
        pytest.approx(180.96e6),
        pytest.approx(17.9e3),
        pytest.approx(20.42e3),
    )
    with pytest.raises(ModelError, match="is not in the library"):
        material("unobtainium")


def test_the_library_as_data_is_well_formed() -> None:
    """Every entry says which test it is from: the tool, and a document with its year."""
    entries = tomllib.loads(LIBRARY.read_text(encoding="utf-8"))
    assert set(entries) == set(material_library())
    for name, entry in entries.items():
        assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)+", name), name
        assert re.search(r"\b(19|20)\d\d\b", entry["source"]), name
        assert entry["tool"].strip(), name
        for key, value in entry.items():
            if key not in {"tool", "source"}:
                unit = "N/mm" if key.startswith("edge_") else "MPa"
                assert re.fullmatch(rf"\d+(\.\d+)? {unit}", value), (name, key)
    numbers = [
        tuple((k, v) for k, v in e.items() if k not in {"tool", "source"}) for e in entries.values()
    ]
    # no test is entered twice
    assert len(set(numbers)) == len(numbers)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('[a]\ntangential = "600 MPa"', "has no source"),
        ('[a]\nsource = "a test"', "no tangential"),
        ('[a]\nsource = "a test"\ntangential = "600 MPa"\ncolour = 3', 'unknown key "colour"'),
        ("a = 3", "is no table"),
        ("[a", "cannot be read"),
        ('[a]\nsource = "a test"\ntangential = "-600 MPa"', "above zero"),
    ],
)
def test_a_faulty_file_of_materials(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "materials.toml"
    file.write_text(text)
    with pytest.raises(ModelError, match=message):
        material_library(file)


def test_a_coefficient_of_another_dimension(tmp_path: Path) -> None:
    file = tmp_path / "materials.toml"
    file.write_text('[a]\nsource = "a test"\ntangential = "600 mm"')
    with pytest.raises(UnitError):
        material_library(file)


@pytest.mark.parametrize(
    "make",
    [
        lambda: Cutter(0.0, 2),
        lambda: Cutter(0.02, 0),
        lambda: Cutter(0.02, 2, helix=2.0),
        lambda: Cutter(0.02, 2, lead=0.0),
        lambda: Cutter(0.02, 2, runout=0.02),
        lambda: ForceCoefficients(float("nan")),
        lambda: ForceCoefficients(6e8, -1.0),
        lambda: milling(0.0),
        lambda: milling(1.1),
        lambda: Milling(Cutter(0.02, 2), ALUMINIUM, 0.5, "sideways"),  # type: ignore[arg-type]
        lambda: Turning(0.0),
        lambda: Turning(1e9, normal=(0.0, 0.0, 0.0)),
        lambda: Turning(1e9, teeth=0),
        lambda: Turning(1e9, damping=ProcessDamping(1e5)),
        lambda: ProcessDamping(-1.0),
    ],
)
def test_numbers_out_of_range_are_refused(make: object) -> None:
    with pytest.raises(ModelError):
        make()  # type: ignore[operator]
