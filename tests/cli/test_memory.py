"""No command takes more memory than docs/memory.md states; what would is refused beforehand."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from strutwork.meshes import block, write_mesh
from tests.cli.conftest import Program
from tests.large_models import bushing_chain, supported_frame, toleranced
from tests.model_files import EXAMPLES

ROOT = Path(__file__).parents[2]

pytestmark = pytest.mark.skipif(
    not Path("/proc/self/status").exists(), reason="peaks are asked of Linux"
)

LARGE = {
    "trestles": supported_frame(),
    "bushings": bushing_chain(),
    "toleranced trestles": toleranced(
        supported_frame(), [f"support L{i}" for i in range(0, 450, 50)]
    ),
    # some 5500 coordinates: the most whose responses are computed
    "frame": supported_frame(76),
    "welded pieces": (ROOT / "tests/cases/models/f6_400_joints.toml").read_text(encoding="utf-8"),
}


def stated() -> dict[str, tuple[float, float]]:
    """Ceilings of the page by command, MB: of a machine or a small model, and at the limits."""
    page = (ROOT / "docs" / "memory.md").read_text(encoding="utf-8")
    found = re.findall(r"^\| `(\w+)` \| ([\d ]+) \| ([\d ]+|-) \|", page, re.MULTILINE)
    return {
        name: (float(a.replace(" ", "")), float(b.replace(" ", "")) if b != "-" else float("nan"))
        for name, a, b in found
    }


#: The program, which tells its own peak at its end. What `wait4` tells of a child holds the memory
#: of the parent too, which it had between its birth and the start of the program.
CHILD = """
import atexit, pathlib, sys
told = pathlib.Path(sys.argv.pop(1))
atexit.register(lambda: told.write_text(pathlib.Path("/proc/self/status").read_text()))
from strutwork.reports.cli import main
main()
"""


def peak(*arguments: str | Path) -> float:
    """Largest memory of a run of the program, MB."""
    with tempfile.TemporaryDirectory() as folder:
        told = Path(folder) / "status"
        subprocess.run(
            [sys.executable, "-c", CHILD, str(told), *map(str, arguments)],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            cwd=ROOT,
            env=os.environ | {"OPENBLAS_NUM_THREADS": "1"},
            check=True,
        )
        found = re.search(r"VmHWM:\s*(\d+) kB", told.read_text(encoding="ascii"))
    assert found is not None
    return int(found[1]) / 1024.0


@pytest.mark.parametrize("command", ["check", "solve", "modes"])
def test_a_small_model_keeps_the_ceiling(command: str) -> None:
    assert peak(command, EXAMPLES[1]) < stated()[command][0]


@pytest.mark.slow
@pytest.mark.parametrize(
    "arguments",
    [
        ("tolerance", "mit-ss1"),
        ("frf", "mit-ss1", "--input", "TCP:x", "--modal-ratio", "0.01"),
        (
            *("lobes", "mit-ss1", "--modal-ratio", "0.02", "--tool", "diameter=20mm,teeth=4"),
            *("--material", "aluminium-7075-t6", "--speeds", "2000..12000:11"),
        ),
        ("map", "mit-ss1"),
        ("scale", "mit-ss1"),
        ("report", "mit-ss1", "-o", "{folder}"),
        ("compare", "mit-ss1", "hexel-hexapod"),
        (
            "correlate",
            "tests/cases/uff/frf_computed.uff",
            "tests/cases/uff/frf_computed.uff",
        ),
        ("move", "proposed-3pprs", "--pose", "x=2mm"),
        ("workspace", "proposed-3pprs", "--over", "x=-30mm..30mm:21,y=-30mm..30mm:21"),
        (
            *("singularities", "hexel-hexapod", "--plane", "rx,ry", "--steps", "31"),
            *("--from", "rx=-60deg,ry=-60deg", "--to", "rx=60deg,ry=60deg"),
            *("--ranges", "none", "--length", "100mm"),
        ),
        ("reversals", "hexel-hexapod", "--over", "x=-350mm..350mm:9,y=-350mm..350mm:9"),
        ("accuracy", "hexel-hexapod", "--over", "x=-50mm..50mm:3", "--drive-error", "5um"),
        ("trajectory", "examples/machines/6-ups.toml", "examples/09_circle.csv"),
    ],
    ids=lambda arguments: arguments[0],
)
def test_a_machine_keeps_the_ceiling(arguments: tuple[str, ...], tmp_path: Path) -> None:
    told = [a.format(folder=tmp_path / "report") for a in arguments]
    assert peak(*told) < stated()[arguments[0]][0]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "name"),
    [
        *((c, m) for c in ("check", "solve") for m in ("trestles", "bushings", "welded pieces")),
        ("modes", "trestles"),
        ("modes", "bushings"),
        ("tolerance", "toleranced trestles"),
        ("frf", "frame"),
    ],
)
def test_a_model_at_the_limits_keeps_the_ceiling(command: str, name: str, tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.write_text(LARGE[name], encoding="utf-8")
    more = {
        "tolerance": ["--samples", "10000"],
        "frf": ["--input", "T18:x", "--from", "1", "--to", "200"],
    }
    assert peak(command, path, *more.get(command, [])) < stated()[command][1]


def test_responses_of_a_large_model_are_refused_before_they_begin(
    strutwork: Program, tmp_path: Path
) -> None:
    path = tmp_path / "model.toml"
    path.write_text(supported_frame(200, 10), encoding="utf-8")
    run = strutwork("frf", path, "--input", "TCP:x", "--from", "1", "--to", "10")
    assert run.status == 1
    assert re.search(r"dense matrices of [\d,]+ coordinates will take about [\d.]+ GB", run.err)
    assert "Divide beams into fewer elements" in run.err


def test_a_solid_that_will_not_fit_is_refused_before_it_is_assembled(
    strutwork: Program, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_mesh(block((1, 1, 1), (12, 12, 12)), tmp_path / "cube.vtu")
    path = tmp_path / "model.toml"
    path.write_text(
        "materials.g = { youngs_modulus = 6e10, poissons_ratio = 0.2, density = 2900 }\n"
        "nodes.a = [0.5, 0.5, 0]\n"
        '[[solids]]\nname = "cube"\nmesh = "cube.vtu"\nmaterial = "g"\n'
        '[[solids.interfaces]]\nnode = "a"\nbox = [[0, 0, 0], [1, 1, 0]]\n',
        encoding="utf-8",
    )
    monkeypatch.setattr("strutwork.fea.memory.available_memory", lambda: 2e8)
    run = strutwork("check", path)
    assert run.status == 1
    assert "solid cube: its 1,728 cells of order 2 have 41,472 dofs or more" in run.err
    assert "0.2 GB are available" in run.err
    assert "Choose order = 1, larger cells" in run.err
