"""Solids swing as surfaces, with the edges that bound them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import strutwork as sw
from strutwork.reports.figures import vibration
from strutwork.reports.figures.vibration import mode_view
from strutwork.reports.vibration_study import VibrationStudy, study_model_vibration

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def column() -> VibrationStudy:
    """A granite column on four mounts, and an arm."""
    model = sw.load(ROOT / "examples" / "08_column_on_mounts.toml")
    return study_model_vibration(model, "vibration")


def labels(study: VibrationStudy) -> list[str]:
    return [str(k + 1) for k in range(len(study.modes.shapes))]


def test_surfaces_move_as_their_edges_do(column: VibrationStudy) -> None:
    view = mode_view(column, labels(column))
    motion = view["motion"]
    lines, solids = motion, motion["also"]
    mesh = view["data"][solids["trace"]]
    assert mesh["type"] == "mesh3d"
    assert max(map(max, (mesh["i"], mesh["j"], mesh["k"]))) == len(mesh["x"]) - 1
    assert mesh["intensity"] == solids["modes"][0]["size"]
    at = np.array([lines["rest"][side] for side in "xyz"], dtype=float).T
    corners = np.array([solids["rest"][side] for side in "xyz"], dtype=float).T
    apart = np.linalg.norm(at[:, None] - corners, axis=-1)
    edge, corner = np.nonzero(apart < 1e-6)
    assert len(edge) > 20
    for k, mode in enumerate(solids["modes"]):
        surface = np.array([mode[side] for side in "xyz"], dtype=float).T[corner]
        line = np.array([lines["modes"][k][side] for side in "xyz"], dtype=float).T[edge]
        # a beam's end may stand at a corner of a solid that it does not touch
        same = np.linalg.norm(surface - line, axis=-1) < 1e-3 * np.abs(surface).max()
        assert same.mean() > 0.9
        assert np.abs(surface).max() > 0


def test_a_large_surface_is_left_to_its_edges(
    column: VibrationStudy, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(vibration, "MOST_POINTS", 10)
    view = mode_view(column, labels(column))
    assert "also" not in view["motion"]
    assert all(trace["type"] != "mesh3d" for trace in view["data"])


def test_a_mode_in_a_notebook_moves_the_solids() -> None:
    machine = sw.load(ROOT / "examples" / "08_column_on_mounts.toml")
    first, second = (machine.plot(mode=mode).data[2] for mode in (1, 2))
    assert first.type == "mesh3d"
    assert np.abs(np.subtract(first.x, second.x)).max() > 1.0
    assert list(first.intensity) != list(second.intensity)
