"""Minima, responses and sensitivities of machines at home, and the dynamic map's inputs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from strutwork.errors import ModelError
from strutwork.fea import LossFactor, ModalRatio, modes
from strutwork.kinematics import Poses, rotation_y
from strutwork.machines import (
    Platform,
    Proposed3PPRS,
    Prototype3PPPRS,
    VibratingLegs,
    dynamic_machine,
    hemisphere_poses,
)
from strutwork.msa import tool_compliance
from strutwork.msa.mass import mass_properties
from strutwork.papers.azulay_2014.dynamic import azulay_table_5
from strutwork.papers.azulay_2014.sensitivity import (
    dynamic_link_lengths,
    mass_sensitivity,
    offset_sensitivity,
)
from strutwork.papers.azulay_2014.synthetic_measurement import (
    prototype_outputs,
    synthetic_measurement,
)
from strutwork.papers.tables import write_published
from strutwork.studies import (
    dynamic_stiffness,
    frequency_responses,
    read_netcdf,
    write_long_csv,
    write_netcdf,
)
from strutwork.studies.dynamic import at_home, grid_minimum, modal_data, tool_ports


@pytest.fixture(scope="module")
def eclipse() -> VibratingLegs:
    return replace(dynamic_machine("eclipse-3pprs"), elements=2)


@pytest.fixture(scope="module")
def proposed() -> VibratingLegs:
    return replace(dynamic_machine("proposed-3pprs"), elements=2)


def test_the_tool_stands_off_the_joints_along_its_axis(eclipse: VibratingLegs) -> None:
    home = eclipse.home().position
    poses = Poses(home + np.array([1e-3, 2e-3, -3e-3]), rotation_y(0.2))
    placement = eclipse.place(poses)
    index = eclipse.linkage.node_index
    seats = placement.positions[[index[f"platform/P{i}"] for i in (1, 2, 3)]]
    tool = placement.positions[index["tool"]]
    # the joints' centre is one offset below the tool, along the tool's axis
    expected = poses.position - eclipse.tool_offset * poses.rotation[:, 2]
    np.testing.assert_allclose(tool, poses.position, atol=1e-15)
    np.testing.assert_allclose(seats.mean(axis=0), expected, atol=1e-15)


def test_the_platform_turns_with_the_tool() -> None:
    """Its disc is thin: about a diameter it has half the inertia it has about its axis."""
    machine = dynamic_machine("alizade-3prps")
    light = replace(machine.base, material=replace(machine.base.material, density=1e-9))
    disc = Platform(mass=2.0, radius=0.1, centre=0.01)
    machine = replace(machine, base=light, platform=disc)
    turn = rotation_y(0.15)
    poses = Poses(machine.home().position, turn)
    found = mass_properties(machine.structure.at(machine.place(poses)))
    axis = turn[:, 2]
    centre = poses.position - (machine.tool_offset - 0.01) * axis
    # links weigh next to nothing: 1e-12 of the platform
    np.testing.assert_allclose(found.centre, centre, atol=1e-9)
    assert axis @ found.inertia @ axis == pytest.approx(2.0 * 0.1**2 / 2, rel=1e-6)
    across = turn[:, 0]
    assert across @ found.inertia @ across == pytest.approx(2.0 * 0.1**2 / 4, rel=1e-6)


@pytest.mark.parametrize(
    "name", ["proposed-3pprs", "eclipse-3pprs", "alizade-3prps", "glozman-3prrs"]
)
def test_the_division_of_links_has_converged(name: str) -> None:
    machine = dynamic_machine(name)
    coarse = dynamic_stiffness({name: machine})
    fine = dynamic_stiffness({name: replace(machine, elements=16)})
    for quantity in ("natural_frequency", "minimum_frequency"):
        # the frequencies that are listed and those that decide a minimum
        np.testing.assert_allclose(coarse[quantity], fine[quantity], rtol=1e-3)
    np.testing.assert_allclose(
        coarse["minimum_dynamic_stiffness"], fine["minimum_dynamic_stiffness"], rtol=2e-3
    )


def test_the_minimum_is_that_of_the_response(eclipse: VibratingLegs) -> None:
    minima = dynamic_stiffness({"eclipse": eclipse})
    responses = frequency_responses({"eclipse": eclipse})
    least = 1.0 / responses["receptance_magnitude"].max("frequency")
    # the responses' lines hold the frequencies of the minima
    np.testing.assert_allclose(least, minima["minimum_dynamic_stiffness"], rtol=1e-9)
    magnitude = np.hypot(responses["receptance_real"], responses["receptance_imaginary"])
    np.testing.assert_allclose(magnitude, responses["receptance_magnitude"], rtol=1e-12)


def test_static_stiffness_is_that_of_the_statics(eclipse: VibratingLegs) -> None:
    compliance = tool_compliance(at_home(eclipse))
    found = dynamic_stiffness({"eclipse": eclipse})["static_stiffness"].to_numpy()[0]
    # two solvers of one system
    np.testing.assert_allclose(found, 1.0 / np.diag(compliance)[:3], rtol=1e-8)


def test_a_grid_never_shows_less_than_the_minimum(eclipse: VibratingLegs) -> None:
    _, model = modal_data(at_home(eclipse), tool_ports(eclipse), ModalRatio(0.01))
    exact = dynamic_stiffness({"eclipse": eclipse})
    least = exact["minimum_dynamic_stiffness"].to_numpy()
    assert np.all(exact["grid_minimum"].to_numpy() >= least)
    # at 73.4 Hz, between lines of 5 Hz, more than twice the minimum; lines of 0.05 Hz come near
    assert float(exact["grid_minimum"][0, 0]) > 2.0 * least[0, 0]
    fine = grid_minimum(model, (50.0, 100.0), 0.05)[0, 0]
    assert least[0, 0] <= fine <= least[0, 0] * 1.01
    with pytest.raises(ModelError, match="grid step"):
        grid_minimum(model, (50.0, 100.0), 0.0)
    with pytest.raises(ModelError, match="longer than the band"):
        grid_minimum(model, (51.0, 54.0), 10.0)


def test_files_hold_every_number(eclipse: VibratingLegs, tmp_path: Path) -> None:
    minima = dynamic_stiffness({"eclipse": eclipse})
    responses = frequency_responses({"eclipse": eclipse}, [20.0, 30.0])
    for study in (minima, responses):
        assert all("units" in v.attrs for v in study.data_vars.values())
        back = read_netcdf(write_netcdf(tmp_path / "study.nc", study))
        xr.testing.assert_equal(study, back)
    path = write_long_csv(tmp_path / "responses.csv", responses)
    lines = path.read_text(encoding="utf-8").splitlines()
    assert lines[0] == (
        "machine,axis,frequency [Hz],receptance_real [m/N],receptance_imaginary [m/N],"
        "receptance_magnitude [m/N]"
    )
    assert len(lines) == 1 + 3 * 2
    last = lines[-1].split(",")
    assert last[:3] == ["eclipse", "z", "30.0"]
    assert float(last[-1]) == responses["receptance_magnitude"].to_numpy()[0, 2, 1]
    with pytest.raises(ModelError, match="2 sets of dimensions"):
        write_long_csv(tmp_path / "minima.csv", minima)


def test_the_tables_file_names_set_and_status(tmp_path: Path) -> None:
    found = azulay_table_5()
    path = write_published(tmp_path, "azulay-2014-table-5", found.table())
    lines = path.read_text(encoding="utf-8").splitlines()
    assert path.name == "published-azulay-2014-table-5.csv"
    assert len(lines) == 1 + 2 * 12
    assert sum(", calibrated" in line.split(",Kzz")[0] for line in lines[1:]) == 12
    assert found.to_dict()["sets"]["blind"]["mean_factor"] > 1.6


def test_longer_links_vibrate_slower(proposed: VibratingLegs) -> None:
    found = dynamic_link_lengths(proposed, frequencies=[10.0, 20.0])
    assert found["link_length"].to_numpy().tolist() == [0.196, 0.216, 0.236]
    first = found["natural_frequency"].sel(mode=1).to_numpy()
    assert first[0] > first[1] > first[2]
    # the vertical minimum, which the constant first link decides, falls with length as in Fig. 8c
    least = found["minimum_dynamic_stiffness"].sel(axis="z").to_numpy()
    assert least[0] > least[1] > least[2]
    with pytest.raises(ModelError, match="proposed machine"):
        dynamic_link_lengths(dynamic_machine("eclipse-3pprs"))
    with pytest.raises(ModelError, match="are none"):
        dynamic_link_lengths(proposed, [])


def test_the_offset_sweep_peaks_where_the_links_meet_the_axis() -> None:
    machine = replace(dynamic_machine("alizade-3prps"), elements=1)
    found = offset_sensitivity({"alizade": machine}, [0.0, 8e-3, 19e-3, 28e-3])
    stiffness = found["static_stiffness"].sel(axis="x").to_numpy()[0]
    formula = found["closed_form"].to_numpy()[0]
    assert stiffness.argmax() == formula.argmax() == 2
    # the offset does nothing along z, whose load passes the platform's centre
    along_z = found["minimum_dynamic_stiffness"].sel(axis="z").to_numpy()[0]
    np.testing.assert_allclose(along_z, along_z[0], rtol=1e-6)
    assert found["offset"].attrs["units"] == "m"


def test_the_mass_moves_frequencies_more_than_minima(eclipse: VibratingLegs) -> None:
    found = mass_sensitivity({"eclipse": eclipse}, [0.25, 0.5, 1.0])
    first = found["natural_frequency"].sel(mode=1).to_numpy()[0]
    assert first[0] > first[1] > first[2]
    # one mode carries the compliance along x: 2ζ K is the minimum whatever the mass
    least = found["minimum_dynamic_stiffness"].sel(axis="x").to_numpy()[0]
    np.testing.assert_allclose(least, least[0], rtol=0.01)
    assert first[0] / first[2] > 1.5
    with pytest.raises(ModelError, match="no values"):
        mass_sensitivity({"eclipse": eclipse}, [])


def test_another_damping_is_kept_and_told(eclipse: VibratingLegs) -> None:
    found = dynamic_stiffness({"eclipse": eclipse}, LossFactor(0.02))
    viscous = dynamic_stiffness({"eclipse": eclipse})
    assert "loss factor" in found.attrs["damping"]
    # η = 2ζ at a resonance; neighbours make the rest
    np.testing.assert_allclose(
        found["minimum_dynamic_stiffness"], viscous["minimum_dynamic_stiffness"], rtol=0.02
    )


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"band": (100.0, 100.0)}, "frequency band"),
        ({"band": (-1.0, 100.0)}, "frequency band"),
        ({"count": 10_000}, "fewer than 10000"),
        ({"damping": ModalRatio(0.0)}, "damping"),
    ],
)
def test_wrong_questions_are_answered_with_an_error(
    eclipse: VibratingLegs, change: dict[str, object], words: str
) -> None:
    with pytest.raises(ModelError, match=words):
        dynamic_stiffness({"eclipse": eclipse}, **change)  # type: ignore[arg-type]


def test_missing_things_are_named(eclipse: VibratingLegs) -> None:
    with pytest.raises(ModelError, match="machines: are none"):
        dynamic_stiffness({})
    with pytest.raises(ModelError, match="machines: are none"):
        frequency_responses({})
    with pytest.raises(ModelError, match="positive and ascending"):
        frequency_responses({"eclipse": eclipse}, [20.0, 10.0])
    weightless = replace(Proposed3PPRS().material, density=None)
    with pytest.raises(ModelError, match="density"):
        dynamic_stiffness({"bare": Proposed3PPRS(material=weightless)})
    with pytest.raises(ModelError, match=r"platform\.mass"):
        Platform(mass=0.0, radius=0.1)
    with pytest.raises(ModelError, match=r"platform\.thickness"):
        Platform(mass=1.0, radius=0.1, thickness=-1.0)
    with pytest.raises(ModelError, match="tool_offset"):
        replace(eclipse, tool_offset=np.inf)
    with pytest.raises(ModelError, match="elements"):
        replace(eclipse, elements=0)
    with pytest.raises(ModelError, match=r"dynamic model hexapod(.|\n)*proposed-3pprs"):
        dynamic_machine("hexapod")


def test_a_constant_first_link_is_as_long_as_it_says() -> None:
    machine = Proposed3PPRS(first_link_length=0.130)
    placement = machine.place(hemisphere_poses(machine.pole_height, lattice=3, rolls=4))
    index = machine.linkage.node_index
    span = (
        placement.positions[..., index["leg1/overhang"], :]
        - placement.positions[..., index["leg1/carriage"], :]
    )
    np.testing.assert_allclose(np.linalg.norm(span, axis=-1), 0.130, rtol=1e-12)
    with pytest.raises(ModelError, match="first_link_length"):
        Proposed3PPRS(first_link_length=0.0)


def test_a_synthetic_measurement_says_so_and_repeats() -> None:
    lines = np.arange(50.0, 120.0, 0.5)
    first = synthetic_measurement(frequencies=lines, seed=7)
    again = synthetic_measurement(frequencies=lines, seed=7)
    other = synthetic_measurement(frequencies=lines, seed=8)
    assert first.label == "synthetic"
    assert "synthetic" in repr(first).lower()
    assert first.response.method == "synthetic measurement, seed 7"
    np.testing.assert_array_equal(first.response.receptance, again.response.receptance)
    assert np.any(first.response.receptance != other.response.receptance)
    assert first.response.receptance.shape == (len(lines), len(prototype_outputs()), 2)


def test_a_synthetic_measurement_is_near_the_model_but_not_it() -> None:
    clean = synthetic_measurement(frequencies=[50.0], noise=0.0)
    noisy = synthetic_measurement(frequencies=[50.0], noise=0.02)
    model = modes(at_home(Prototype3PPPRS()), 10)
    # E, drives and masses differ by 3 to 10 %: frequencies by up to half of it, and by something
    ratio = clean.mode_frequencies / model.frequencies
    assert np.all(np.abs(ratio - 1.0) < 0.08)
    assert np.abs(ratio - 1.0).max() > 1e-3
    # pairs of equal frequencies are parted, as in any machine that was built
    assert clean.mode_frequencies[1] - clean.mode_frequencies[0] > 1e-3
    change = np.abs(noisy.response.receptance / clean.response.receptance - 1.0)
    assert 1e-3 < np.median(change) < 0.1
    with pytest.raises(ModelError, match="noise"):
        synthetic_measurement(frequencies=[50.0], noise=-1.0)
