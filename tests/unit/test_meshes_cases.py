"""Small mesh files from public reports: the right value, or the true error."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.meshes import cell_volumes, patch_area, read_mesh

CASES = Path(__file__).parents[1] / "cases"
MESHES = [
    case
    for case in json.loads((CASES / "expected.json").read_text(encoding="utf-8"))
    if case["what"] == "mesh"
]


def test_the_cases_are_there() -> None:
    assert len(MESHES) >= 31
    known = {"V", "regions", "region_x", "sets", "patches", "area"}
    for case in MESHES:
        assert case.get("error_says") or (case["right"] and set(case["right"]) <= known)


@pytest.mark.parametrize("case", MESHES, ids=lambda case: f"{case['id']} {case['file']}")
def test_a_mesh_file_gives_its_right_value_or_its_true_error(case: dict[str, Any]) -> None:
    path, unit = CASES / case["file"], case.get("unit", "m")
    if "error_says" in case:
        with pytest.raises(ModelError) as caught:
            read_mesh(path, unit)
        text = str(caught.value)
        assert any(word in text for word in case["error_says"])
        assert case.get("error_does_not_say", "\0") not in text
        return
    mesh, right = read_mesh(path, unit), case["right"]
    volumes = cell_volumes(mesh)
    if "V" in right:
        assert volumes.sum() == pytest.approx(right["V"], rel=1e-7)
    for name, volume in right.get("regions", {}).items():
        assert volumes[mesh.region_cells(name)].sum() == pytest.approx(volume, rel=1e-9)
    for name, place in right.get("region_x", {}).items():
        centres = np.concatenate([mesh.points[b.nodes].mean(axis=1) for b in mesh.blocks])
        assert centres[mesh.region_cells(name), 0].mean() == pytest.approx(place, rel=1e-9)
    for name, count in right.get("sets", {}).items():
        assert len(mesh.node_set(name)) == count
    for name, count in right.get("patches", {}).items():
        assert len(mesh.patch(name)) == count
    for name, area in right.get("area", {}).items():
        assert patch_area(mesh, mesh.patch(name)) == pytest.approx(area, rel=1e-9)
