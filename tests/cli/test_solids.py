"""Solids from the model file through every command, against the solid that was not reduced.

The reference is the sparse model of the whole column, assembled by SfePy, with the mount, the arm
and the mass put on its ports: K + iωC − ω²M, factorised at every frequency. The reduction is exact
in statics, and below half of the cutoff it promises 1e-4 in frequency.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.linalg as sla
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from strutwork.fea.interface import Interface
from strutwork.fea.reduce_solid import tied
from strutwork.fea.solid import Solid
from strutwork.meshes import block, grid, lines_through, patch, write_mesh
from strutwork.msa import Beam, Material, rectangle
from strutwork.msa.beam import local_stiffness, to_global
from strutwork.msa.mass import local_mass
from tests.cli.conftest import Program
from tests.model_files import Content, drop, put, toml
from tests.solid_models import column

Array = NDArray[Any]

EXAMPLE = Path(__file__).parents[2] / "examples" / "08_column_on_mounts.toml"
ALPHA, BETA = 8.0, 2e-6
DAMPERS = [3e3, 2e3, 5e3, 0.0, 0.0, 0.0]
MOUNT = [30e6, 30e6, 80e6, 1e6, 1e6, 1e6]


@pytest.fixture(autouse=True)
def kept(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """Superelements of these tests stay with them; equal solids are reduced once."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.getbasetemp() / "superelements"))


@cache
def whole() -> tuple[sp.csc_array, sp.csc_array, sp.csc_array, Array]:
    """Stiffness, damping and mass of everything, and where the tip's six unknowns are."""
    x, y = lines_through((0, 0.2, 0.05, 0.15), 0.2), lines_through((0, 0.15, 0.05, 0.1), 0.2)
    mesh = grid(x, y, lines_through((0, 0.6), 0.2))
    mesh = patch(mesh, "head", (0.05, 0.05, 0.6), (0.15, 0.1, 0.6))
    granite = Material.isotropic(60e9, 0.25, density=2900.0, name="granite")
    solid = tied(
        Solid(mesh, {"solid": granite}, name="column"),
        [
            Interface("foot", "-z", (0.1, 0.075, 0.0)),
            Interface("head", "head", (0.1, 0.075, 0.6), "rigid"),
        ],
    )
    count = solid.stiffness.shape[0]
    tip = count + np.arange(6)
    ports = sp.csc_array(sp.vstack([solid.ports, sp.csc_array((6, 12))]))
    # x of the arm along global y, z up
    axes = np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    steel = Material.isotropic(210e9, 0.3, density=7850.0, name="steel")
    beam = Beam("arm", ("head", "tip"), steel, rectangle(0.06, 0.04))
    properties = np.array(beam.properties)
    area, iy, iz = 0.06 * 0.04, 0.06 * 0.04**3 / 12, 0.04 * 0.06**3 / 12
    inertia = 7850.0 * np.array([area, iy + iz, iy, iz])
    ends = sp.csc_array(
        sp.vstack([ports[:, 6:].T, sp.csc_array((np.ones(6), (range(6), tip)), (6, count + 6))])
    )
    length = np.array(0.2)
    bent = to_global(axes, local_stiffness(length, properties))
    moved = to_global(axes, local_mass(length, properties, inertia))
    stiffness = sp.block_diag([solid.stiffness, sp.csc_array((6, 6))])
    stiffness = stiffness + ends.T @ sp.csc_array(bent) @ ends
    foot = ports[:, :6]
    stiffness = stiffness + foot @ sp.diags_array(MOUNT) @ foot.T
    mass = sp.block_diag([solid.mass, sp.diags_array([5.0] * 3 + [0.0] * 3)])
    mass = mass + ends.T @ sp.csc_array(moved) @ ends
    damping = ALPHA * mass + BETA * stiffness + foot @ sp.diags_array(DAMPERS) @ foot.T
    return sp.csc_array(stiffness), sp.csc_array(damping), sp.csc_array(mass), tip


@pytest.fixture
def file(write: Callable[[Content], Path]) -> Path:
    return write(column())


def test_statics_are_those_of_the_whole_solid(file: Path, strutwork: Program) -> None:
    stiffness, _, mass, tip = whole()
    found = strutwork("solve", file, "--json").result
    factor = splu(stiffness)
    load = np.zeros(stiffness.shape[0])
    load[tip] = [100, 50, -200, 3, 0, 1]
    cutting = factor.solve(load)
    case = found["cases"]["cutting"]
    # exact but for the rounding of two factorisations, with condition numbers near 1e8
    assert case["displacements"]["tip"] == pytest.approx(cutting[tip], rel=1e-6, abs=1e-12)
    assert case["strain_energy"] == pytest.approx(load @ cutting / 2, rel=1e-7)
    assert case["reactions"]["ground"][:3] == pytest.approx([-100, -50, 200], abs=1e-5)
    unit = np.zeros((stiffness.shape[0], 6))
    unit[tip, range(6)] = 1.0
    compliance = factor.solve(unit)[tip]
    assert np.array(found["tcp"]["compliance"]) == pytest.approx(
        compliance, abs=1e-7 * np.abs(compliance).max()
    )
    # weight: masses of the whole model under a field that is uniform
    weighed = found["cases"]["gravity"]["reactions"]["ground"][2]
    solid = 0.2 * 0.15 * 0.6 * 2900 + 0.06 * 0.04 * 0.2 * 7850 + 5.0
    assert weighed == pytest.approx(9.81 * solid, rel=1e-7)
    assert mass.shape == stiffness.shape


def test_nodes_inside_a_solid_are_in_no_table(file: Path, strutwork: Program) -> None:
    nodes = ["ground", "foot", "head", "tip"]
    solved = strutwork("solve", file, "--json").result
    assert list(solved["cases"]["cutting"]["displacements"]) == nodes
    shapes = strutwork("modes", file, "-n", 3, "--json").result["shapes"]
    assert list(shapes[0]) == nodes
    for command in ("check", "solve", "modes"):
        assert "column/1" not in strutwork(command, file).out


def test_modes_are_those_of_the_whole_solid(file: Path, strutwork: Program) -> None:
    stiffness, _, mass, _ = whole()
    accurate = strutwork("check", file, "--json").result["solids"]["column"]["accurate_to"]
    values = sla.eigh(
        stiffness.toarray(), mass.toarray(), eigvals_only=True, subset_by_index=[0, 19]
    )
    expected = np.sqrt(values) / (2 * np.pi)
    below = expected[expected < accurate]
    assert len(below) >= 8
    run = strutwork("modes", file, "-n", len(below), "--json")
    assert run.result["frequencies"] == pytest.approx(below, rel=1e-4)
    assert run.err == ""


def test_the_response_is_that_of_the_whole_solid(file: Path, strutwork: Program) -> None:
    stiffness, damping, mass, tip = whole()
    for given, output in (("tip:x", "tip:x"), ("TCP:z", "tip:rx")):
        found = strutwork(
            *("frf", file, "--input", given, "--output", output),
            *("--from", 20, "--to", 1500, "--lines", 25, "--json"),
        ).result
        receptance = np.array(found["receptance"]["real"]) + 1j * np.array(
            found["receptance"]["imag"]
        )
        names = ["x", "y", "z", "rx", "ry", "rz"]
        push, read = (tip[names.index(p.split(":")[1])] for p in (given, output))
        load = np.zeros(stiffness.shape[0], dtype=complex)
        load[push] = 1.0
        expected = []
        for frequency in found["frequencies"]:
            w = 2 * np.pi * frequency
            expected.append(splu(stiffness + 1j * w * damping - w**2 * mass).solve(load)[read])
        # a frequency off by 1e-5 moves a flank of the response by as much over the damping ratio
        largest = np.abs(expected).max()
        np.testing.assert_allclose(receptance, expected, rtol=1e-3, atol=1e-5 * largest)


def test_check_counts_and_weighs(file: Path, strutwork: Program) -> None:
    found = strutwork("check", file, "--json").result
    assert (found["mobility"], found["redundant_constraints"]) == (0, 0)
    solid = found["solids"]["column"]
    assert solid["mass"] == pytest.approx(0.2 * 0.15 * 0.6 * 2900, rel=1e-9)
    # 3 x 3 x 3 quadratic cells
    assert solid["degrees_of_freedom"] == 3 * 7**3
    assert solid["kept"] == found["degrees_of_freedom"] - 6
    printed = strutwork("check", file).out
    assert "accurate below, Hz" in printed


@pytest.mark.filterwarnings("default::strutwork.machines.model.ModelWarning")
@pytest.mark.parametrize(
    "command", [["modes", "-n", "40"], ["frf", "--input", "tip:x", "--from", "10", "--to", "9e4"]]
)
def test_frequencies_beyond_the_promise_are_warned_of(
    command: list[str], file: Path, strutwork: Program
) -> None:
    run = strutwork(command[0], file, *command[1:])
    assert run.status == 0
    assert re.match(
        r"Warning: Frequencies up to .* half of a solid's cutoff .* column \d+ Hz\. Raise", run.err
    )


def test_tolerances_of_joints_on_a_solid(
    write: Callable[[Content], Path], strutwork: Program
) -> None:
    def held_twice(content: Content) -> None:
        content["nodes"]["wall"] = content["nodes"]["head"]
        content["joints"].append({"name": "pin", "type": "spherical", "between": ["wall", "head"]})
        content["supports"].append({"node": "wall", "fixed": "all"})
        content["tolerances"] = [
            {"name": "pin place", "kind": "point_position", "joint": "pin", "size": "20 um"}
        ]

    path = write(column(held_twice))
    found = strutwork("tolerance", path, "--samples", 0, "--json").result
    worst = max(
        q["worst"]
        for q in found["quantities"]
        if (q["joint"], q["kind"]) == ("pin", "radial force")
    )
    solved = strutwork(
        "solve",
        write(
            column(
                held_twice,
                put("misfits", [{"case": "x", "joint": "pin", "gap": {"x": 1e-5}},
                                {"case": "y", "joint": "pin", "gap": {"y": 1e-5}}]),
            )
        ),
        "--json",
    ).result  # fmt: skip
    forces = np.array([solved["cases"][c]["joint_forces"]["pin"][:2] for c in "xy"])
    # the largest over all directions of a misfit of 10 µm
    assert worst == pytest.approx(np.linalg.norm(forces, 2), rel=1e-2)


def test_the_example_in_all_commands(tmp_path: Path, strutwork: Program) -> None:
    checked = strutwork("check", EXAMPLE, "--json").result
    frame = (0.6 * 0.5 * 0.18 + 0.6 * 0.16 * 0.72) * 2900
    assert checked["solids"]["column"]["mass"] == pytest.approx(frame, rel=1e-9)
    found = strutwork("modes", EXAMPLE, "-n", 8, "--json")
    assert found.err == ""
    assert found.result["rigid_body_modes"] == 0
    # six modes on the mounts, then the arm
    assert found.result["frequencies"][5] < 110
    assert found.result["frequencies"][6] > 240
    run = strutwork("report", EXAMPLE, "-o", tmp_path)
    assert run.status == 0, run.err
    drawing = json.loads((tmp_path / "drawing.json").read_text(encoding="utf-8"))
    solid = drawing["solids"]["column"]
    assert solid["materials"] == ["granite"]
    assert len(solid["nodes"]) == 5
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "edge of a solid" in page
    assert "accuracy is not guaranteed" not in page
    # the drawn edges move with the modes
    shapes = (tmp_path / "vibration-mode-shapes.csv").read_text(encoding="utf-8")
    assert len(shapes.splitlines()) > 1000


@pytest.mark.filterwarnings("default::strutwork.machines.model.ModelWarning")
def test_the_report_says_where_the_promise_ends(
    write: Callable[[Content], Path], tmp_path: Path, strutwork: Program
) -> None:
    # a soft column alone: its own second bending is among the six modes of the page
    bare = [
        drop("beams"),
        drop("masses"),
        drop("loads"),
        drop("nodes.tip"),
        put("tool.tcp", "head"),
    ]
    soft = put("materials.granite.youngs_modulus", 6e6)
    path = write(column(*bare, soft, put("solids.0.modes", 6)))
    run = strutwork("report", path, "-o", tmp_path / "page")
    assert run.status == 0, run.err
    assert "accuracy is not guaranteed" in run.err
    page = (tmp_path / "page" / "report.html").read_text(encoding="utf-8")
    assert "accuracy is not guaranteed" in page


def test_a_mesh_beside_the_model_file(tmp_path: Path, strutwork: Program) -> None:
    folder = tmp_path / "sub"
    mesh = patch(block((0.2, 0.15, 0.6), (3, 2, 6)), "top", (0, 0, 0.6), (0.2, 0.15, 0.6))
    (folder / "parts").mkdir(parents=True)
    write_mesh(mesh, folder / "parts" / "column.msh")
    content = column(put("solids.0", {
        "name": "column", "mesh": "parts/column.msh", "material": "granite",
        "interfaces": [{"node": "foot", "patch": "-z"}, {"node": "head", "patch": "top"}],
    }))  # fmt: skip
    (folder / "model.toml").write_text(toml(content), encoding="utf-8")
    assert strutwork("check", folder / "model.toml").status == 0
    write_mesh(mesh, folder / "parts" / "column.msh")
    (folder / "parts" / "column.msh").write_bytes(b"$MeshFormat\n4.1")
    broken = strutwork("check", folder / "model.toml")
    assert (broken.status, broken.out) == (1, "")
    assert "solids.column.mesh" in broken.err
