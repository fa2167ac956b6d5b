"""Idle motions, the check of superelements, and weighing."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from strutwork.errors import ModelWarning, ValidityWarning
from strutwork.fea import ModalRatio, Port, modal_model, modes
from strutwork.fea.idle import free_motions, idle_line, idle_motions
from strutwork.fea.validity import beyond, limits, warn_beyond
from strutwork.machines.model_file import parse_model
from strutwork.msa.mass import mass_properties
from strutwork.reports.covering_band import covering_band
from strutwork.reports.model_check import check_mass
from strutwork.reports.vibration import Target, target_modes
from tests.model_files import SAMPLE, toml
from tests.vibration import heavy


def test_spinning_struts_push_no_mode_out() -> None:
    spinning, held = (heavy(name).place()[0] for name in ("hexapod, spinning struts", "hexapod"))
    nodes = spinning.structure.linkage.nodes
    found = target_modes(Target("spinning", "s", spinning, nodes, ModalRatio(0.01)), 6)
    assert int(found.modes.rigid_body_modes) == free_motions(spinning) == 6
    assert len(found.elastic.modes.frequencies) == 6
    # the struts spin with the same inertia as ever: the machine does not feel it
    wanted = modes(held, 6).frequencies
    np.testing.assert_allclose(found.elastic.modes.frequencies, wanted, rtol=1e-6)
    assert [motion.parts for motion in sorted(found.idle, key=str)] == [
        (f"cylinder{i}", f"piston{i}") for i in range(6)
    ]
    assert all(motion.spins for motion in found.idle)
    assert found.rigid_line.startswith("6 rigid-body modes at 0 Hz. 6 idle motions")
    assert len(found.to_dict()["idle_motions"]) == 6
    assert idle_motions(held) == ()
    assert idle_line(()) == ""


def test_what_floats_as_a_whole_is_not_idle() -> None:
    content: dict[str, Any] = {
        **{key: SAMPLE[key] for key in ("materials", "sections")},
        "nodes": {"A": [0, 0, 0], "B": ["300 mm", 0, 0]},
        "beams": SAMPLE["beams"][:1],
    }
    placed = parse_model(toml(content)).placed
    assert free_motions(placed) == 6
    assert idle_motions(placed) == ()


@dataclass(frozen=True)
class Block:
    """A heavy superelement between two nodes, of any kind that has a cutoff."""

    name: str
    nodes: tuple[str, ...]
    cutoff: float

    def stiffness(self, at: Any) -> Any:
        one = 1e8 * np.eye(6)
        return np.broadcast_to(np.block([[one, -one], [-one, one]]), (*at.batch, 12, 12))

    def mass(self, at: Any) -> Any:
        return np.broadcast_to(
            np.diag([5.0] * 3 + [0.1] * 3 + [5.0] * 3 + [0.1] * 3), (*at.batch, 12, 12)
        )


def with_block(cutoff: float) -> Any:
    placed = parse_model(toml(SAMPLE)).placed
    nodes = placed.structure.beams[0].nodes
    structure = replace(placed.structure, elements=(Block("granite", nodes, cutoff),))
    return replace(placed, structure=structure)


def test_any_superelement_is_asked_how_far_it_holds() -> None:
    placed = with_block(900.0)
    assert limits(placed) == {"granite": 450.0}
    assert beyond(placed, 450.0) == ""
    assert "granite 450 Hz" in beyond(placed, 450.1)
    assert issubclass(ValidityWarning, ModelWarning)
    with pytest.warns(ValidityWarning, match="Frequencies up to 500 Hz .* granite 450 Hz"):
        warn_beyond(placed, 500.0)
    # nothing is known of an element without a cutoff or a limit
    assert limits(with_block(0.0)) == {"granite": 0.0}
    unknown = beyond(with_block(0.0), 1.0)
    assert "No limit is stored with a reduced solid" in unknown
    assert "cutoff" not in unknown
    target = Target("block", "b", placed, placed.structure.linkage.nodes, ModalRatio(0.01))
    with pytest.warns(ValidityWarning, match="granite 450 Hz"):
        target_modes(target, 40)


def test_one_mass_for_all() -> None:
    """Weighed by the check, by `strutwork.msa.mass` and by the effective masses of modes alike."""
    bare, placed = parse_model(toml(SAMPLE)).placed, with_block(900.0)
    first, second = check_mass(bare), check_mass(placed)
    assert first is not None
    assert second is not None
    assert second.total == pytest.approx(first.total + 10.0)
    for at, found in ((bare, first), (placed, second)):
        whole = mass_properties(at)
        assert found.total == float(whole.total)
        assert found.center == tuple(whole.centre)
        assert modes(at, 1).total_mass[0] == found.total


def test_tripods_band_covers_what_gives_way() -> None:
    placed = parse_model(Path("examples/03_tripod.toml").read_text(encoding="utf-8")).placed
    ports = [Port("TCP", axis) for axis in "xyz"]
    band, stop = covering_band(placed, ports)
    assert band is not None
    assert stop == ""
    model = modal_model(placed, ports, ModalRatio(0.01))
    natural = np.where(model.square[0] > 0, model.square[0], np.inf) ** -0.5 / (2 * np.pi)
    part = model.residues[0] ** 2
    inside = part[:, (natural > band[0]) & (natural < band[1])].sum(axis=1)
    massive = part[:, model.square[0] > 0].sum(axis=1)
    assert np.all(inside >= 0.99 * massive)
    # twice the sixth frequency, where the band once ended, lies below the resonance along z
    z = natural[part[2].argmax()]
    assert 2 * np.sort(natural)[5] < z < band[1]


def test_a_band_says_where_it_stops(monkeypatch: pytest.MonkeyPatch) -> None:
    placed = parse_model(Path("examples/03_tripod.toml").read_text(encoding="utf-8")).placed
    monkeypatch.setattr("strutwork.studies.covering_band.FARTHEST", 1.5)
    band, stop = covering_band(placed, [Port("TCP", "z")])
    assert band is not None
    assert "The band ends at" in stop
    assert "TCP:z" in stop
