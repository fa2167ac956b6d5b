"""Curved parts in model files: what straight cells lose is said, with the size that reaches 1 %."""

from __future__ import annotations

import re
import shutil
import warnings
from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelWarning
from strutwork.fea import modes
from strutwork.fea.solid_modes import solid_modes
from strutwork.machines.model_solid_mesh import solid_mesh
from strutwork.machines.model_solid_schema import SolidTable
from strutwork.meshes import cell_volumes, tube, write_mesh
from strutwork.msa import rod
from tests.solid_cases import STEEL, matrices_of
from tests.structures import Model

CASES = Path(__file__).parents[1] / "cases" / "step"

#: Of the shaft: m and m³.
RADIUS, LENGTH, VOLUME = 0.015, 0.1, 7.0686e-5


def shaft(folder: Path, cell: float) -> SolidTable:
    shutil.copy(CASES / "shaft.step", folder)
    return SolidTable(name="shaft", step="shaft.step", cell=cell, material="steel", interfaces=[])


def beam_frequency() -> float:
    """First bending frequency of the shaft as a free Timoshenko beam, Hz."""
    model = Model()
    model.nodes(a=(0, 0, 0), b=(LENGTH, 0, 0))
    model.beam("shaft", "a", "b", rod(2 * RADIUS), material=STEEL, elements=30)
    return float(modes(model.place(), 7).frequencies[6])


def test_the_size_that_is_named_reaches_one_percent_in_volume_and_frequency(tmp_path: Path) -> None:
    pytest.importorskip("gmsh")
    with pytest.warns(ModelWarning, match=r"solids\.shaft: .* -7\.\d % off") as caught:
        coarse = solid_mesh(shaft(tmp_path, 0.012), tmp_path)
    assert cell_volumes(coarse).sum() < 0.94 * VOLUME
    named = re.search(r"Cells of (\S+) m should reach 1 %\.", str(caught[0].message))
    assert named is not None
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fine = solid_mesh(shaft(tmp_path, float(named[1])), tmp_path)
    assert cell_volumes(fine).sum() == pytest.approx(VOLUME, rel=0.01)
    found = solid_modes(matrices_of(fine), 9).frequencies[6:]
    assert found[0] == pytest.approx(beam_frequency(), rel=0.01)
    assert STEEL.density is not None
    torsion = np.sqrt(STEEL.shear_modulus / STEEL.density) / (2 * LENGTH)
    assert found[2] == pytest.approx(torsion, rel=0.01)


def test_a_mesh_file_of_curved_cells_is_said_to_become_straight(tmp_path: Path) -> None:
    write_mesh(tube(0.03, 0.08, 0.2, (1, 8, 2), order=2), tmp_path / "ring.vtu")
    table = SolidTable(name="ring", mesh="ring.vtu", material="steel", interfaces=[])
    with pytest.warns(ModelWarning, match=r"solids\.ring: .* % off.*\n?.*times finer to reach"):
        solid_mesh(table, tmp_path)
