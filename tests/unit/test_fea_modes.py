"""Natural frequencies, shapes, effective masses and energy shares."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea import modes
from strutwork.fea.lowest import natural_frequencies
from strutwork.fea.modes import CHUNK
from strutwork.msa import PointMass, system_of
from strutwork.msa.mass import mass_contributions, mass_properties
from tests.structure_cases import LIBRARY
from tests.structures import BAR, Model, cantilever
from tests.unit.test_fea_reduction import swinging_door
from tests.vibration import BODY, heavy, oscillators

METHODS = pytest.mark.parametrize("method", ["dense", "sparse"])


@pytest.mark.parametrize("name", LIBRARY)
def test_shapes_at_the_nodes_are_mass_normalised(name: str) -> None:
    placed = heavy(name).place()
    found = modes(placed, 9)
    system = system_of(placed)
    count = found.frequencies.shape[-1]
    shapes = np.moveaxis(found.shapes.reshape(system.poses, count, -1, 6), 1, -1)
    gram = np.zeros((system.poses, count, count))
    for _, nodes, part in mass_contributions(system):
        at = shapes[:, nodes].reshape(system.poses, -1, count)
        gram += np.swapaxes(at, -1, -2) @ part @ at
    np.testing.assert_allclose(gram, np.broadcast_to(np.eye(count), gram.shape), atol=1e-8)


@pytest.mark.parametrize("name", LIBRARY)
def test_energy_shares_add_to_one_and_rigid_body_modes_have_none(name: str) -> None:
    found = modes(heavy(name).place(), 12)
    total = found.energy_shares.sum(axis=-1)
    np.testing.assert_allclose(total[found.frequencies > 0], 1.0, rtol=1e-12)
    assert np.all(found.energy_shares[found.frequencies == 0] == 0.0)
    assert np.all(found.energy_shares > -1e-9)
    assert found.energy_shares.shape[-1] == len(found.energy_parts)
    np.testing.assert_array_equal((found.frequencies == 0).sum(axis=-1), found.rigid_body_modes)


def test_energy_shares_name_what_bends() -> None:
    """Two springs in a row, one a hundred times softer: it holds nearly all the energy."""
    found = modes(oscillators((1e4, 1e-9), (1e6, 5.0)).place(), 1)
    assert found.energy_parts == ("joint J1", "joint J2")
    # in series the energies are as the compliances
    np.testing.assert_allclose(found.energy_shares[0], [100 / 101, 1 / 101], rtol=1e-6)


def test_energy_shares_of_a_beam_in_many_elements_are_one_share() -> None:
    model = Model("c")
    model.nodes(a=(0, 0, 0), b=(0.5, 0, 0), c=(1.0, 0, 0))
    model.beam("first", "a", "b", BAR, elements=3)
    model.beam("second", "b", "c", BAR, elements=1)
    model.support("a")
    found = modes(model.place(), 1)
    assert found.energy_parts == ("beam first", "beam second")
    # ∫ M² over a half, M of the first mode of a cantilever: most of it next to the clamp
    assert found.energy_shares[0, 0] > 0.9


@METHODS
@pytest.mark.parametrize("name", ["floating frame"])
def test_effective_masses_of_a_free_structure_sum_to_its_mass(name: str, method: str) -> None:
    placed = heavy(name).place()
    # its six rigid-body modes hold all of it
    found = modes(placed, 6, method=method)  # type: ignore[arg-type]
    properties = mass_properties(placed)
    np.testing.assert_allclose(found.total_mass[:3], properties.total)
    np.testing.assert_allclose(found.total_mass[3:], np.diag(properties.inertia))
    np.testing.assert_allclose(found.effective_mass.sum(axis=0), found.total_mass, rtol=1e-9)


def test_effective_mass_of_a_cantilever() -> None:
    """61.31 % of the mass in its first bending, 18.83 % in the second (Blevins 1979)."""
    model = cantilever(length=2.0, elements=30, shear=False)
    found = modes(model.place(), 40)
    share = found.effective_mass[:, 1] / found.total_mass[1]
    largest = np.sort(share)[::-1]
    # rotary inertia of a slender bar changes the fourth digit
    np.testing.assert_allclose(largest[:2], [0.6131, 0.1883], rtol=1e-3)


def test_all_there_are_and_a_note_where_more_are_asked() -> None:
    found = modes(oscillators((1e4, 3.0), (2e4, 3.0)).place(), 5)
    assert found.frequencies.shape == (2,)
    assert found.shapes.shape[0] == found.effective_mass.shape[0] == 2
    assert found.note == "5 modes were requested, but only 2 exist."
    assert modes(oscillators((1e4, 3.0)).place(), 1).note == ""


def test_poses_with_fewer_modes_end_in_infinity() -> None:
    found = modes(swinging_door().place(), 2)
    np.testing.assert_array_equal(found.rigid_body_modes, [1, 0])
    np.testing.assert_allclose(found.frequencies[0], [0.0, 200 / (2 * np.pi)], rtol=1e-10)
    np.testing.assert_allclose(found.frequencies[1, 0], 200 / (2 * np.pi), rtol=1e-10)
    assert np.isinf(found.frequencies[1, 1])
    assert not np.any(found.shapes[1, 1])


def test_a_batch_gives_what_its_poses_give_alone() -> None:
    placed = heavy("hexapod, spinning struts").place()
    together = modes(placed, 12)
    for pose in range(placed.batch[0]):
        alone = modes(placed[pose], 12)
        np.testing.assert_allclose(alone.frequencies, together.frequencies[pose], rtol=1e-9)
        assert alone.rigid_body_modes == together.rigid_body_modes[pose] == 6


def test_more_poses_than_a_chunk_keep_their_order() -> None:
    lengths = np.linspace(0.3, 0.6, CHUNK + 3)
    model = cantilever()
    model.positions["tip"] = np.stack([lengths, 0 * lengths, 0 * lengths], axis=-1)
    found = modes(model.place(), 1).frequencies[:, 0]
    assert np.all(np.diff(found) < 0)
    alone = modes(model.place()[CHUNK + 1], 1).frequencies[0]
    assert found[CHUNK + 1] == pytest.approx(alone, rel=1e-12)


def test_a_batch_of_two_axes_keeps_its_shape() -> None:
    model = cantilever()
    model.positions["tip"] = np.array([[[0.4, 0, 0], [0.5, 0, 0]], [[0.6, 0, 0], [0.7, 0, 0]]])
    found = modes(model.place(), 3)
    assert found.frequencies.shape == (2, 2, 3)
    assert found.shapes.shape == (2, 2, 3, 3, 6)
    assert found.rigid_body_modes.shape == (2, 2)


def test_a_machine_of_rigid_links_alone_has_only_rigid_body_modes() -> None:
    model = Model("bob")
    model.ground(pin=(0, 0, 0))
    model.nodes(bob=(0.5, 0, 0))
    model.joint("hinge", "revolute", ("pin", "heel"))
    model.rigid("arm", "heel", "bob")
    model.masses.append(PointMass("bob", 2.0, BODY))
    found = modes(model.place(), 3)
    np.testing.assert_array_equal(found.frequencies, [0.0])
    assert found.rigid_body_modes == 1
    assert found.energy_parts == ()
    assert "1 exist" in found.note


def test_results_as_plain_lists() -> None:
    found = modes(cantilever().place(), 2)
    plain = found.to_dict()
    assert plain["frequencies"] == found.frequencies.tolist()
    assert plain["rigid_body_modes"] == 0
    assert plain["shapes"][0]["tip"] == found.shapes[0, 1].tolist()
    assert np.shape(plain["effective_mass"]) == (2, 6)
    assert "2 modes" in repr(found)
    assert "Hz" in repr(found)
    batch = modes(heavy("hexapod").place(), 2)
    with pytest.raises(ModelError, match="several poses"):
        batch.to_dict()


def test_bad_input() -> None:
    placed = cantilever().place()
    with pytest.raises(ModelError, match="0 modes asked for"):
        modes(placed, 0)
    with pytest.raises(ModelError, match='unknown method "magic"'):
        modes(placed, 2, method="magic")  # type: ignore[arg-type]
    with pytest.raises(ModelError, match="has no mass"):
        modes(oscillators((1e4, 0.0)).place(), 1)
    model = cantilever()
    model.support("tip")
    with pytest.raises(ModelError, match="every direction is locked"):
        modes(model.place(), 1)
    with pytest.raises(ModelError, match="0 asked for"):
        natural_frequencies(placed, 0)


@pytest.mark.parametrize("name", LIBRARY)
def test_the_few_lowest_frequencies_agree_with_all(name: str) -> None:
    """Subspace iteration beside the whole solution."""
    placed = heavy(name).place()
    quick, vectors = natural_frequencies(placed, 3)
    whole = modes(placed, 3)
    exist = whole.frequencies.shape[-1]
    np.testing.assert_allclose(quick[..., :exist], whole.frequencies, rtol=1e-8, atol=1e-9)
    assert np.all(np.isinf(quick[..., exist:]))
    assert vectors.shape[:-2] == placed.batch


def test_the_few_lowest_do_not_make_up_frequencies_of_motions_without_mass() -> None:
    """Sixty springs in a row with three masses: three modes in sixty coordinates."""
    pairs = [(1e4, 2.0 if i % 20 == 19 else 0.0) for i in range(60)]
    placed = oscillators(*pairs).place()
    whole = modes(placed, 3).frequencies
    for count in (2, 3, 5):
        quick, vectors = natural_frequencies(placed, count)
        np.testing.assert_allclose(quick[:3], whole[:count], rtol=1e-8)
        assert np.all(np.isinf(quick[3:]))
        assert np.all(np.isfinite(vectors))
