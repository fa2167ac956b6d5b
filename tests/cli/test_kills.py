"""Commands killed at random moments: nothing half, and the next run is right."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from strutwork.fea.superelement_file import read_superelement
from strutwork.reports.manifest import verify_report
from strutwork.staging import PREFIX
from strutwork.studies.chunks import ChunkStore
from strutwork.studies.dataset_files import read_netcdf

ROOT = Path(__file__).parents[2]
PROGRAM = (sys.executable, "-c", "from strutwork.reports.cli import main; main()")
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT)}

#: Moments of each kind.
MOMENTS = 50

#: Writes one chunk after another; read back, each is whole or not there.
CHUNKS = """
import sys
from pathlib import Path
import numpy as np
from strutwork.studies.chunks import ChunkStore
store = ChunkStore(Path(sys.argv[1]), "key")
for number in range(40):
    store.write(number, {"a": np.full(50_000, float(number))})
"""

#: Reduces twenty small solids, each stored in the cache; read back, each is whole or not there.
SUPERELEMENTS = """
import sys
from pathlib import Path
from strutwork.fea.interface import Interface
from strutwork.fea.reduce_solid import reduce_solid
from strutwork.fea.solid import Solid
from strutwork.meshes import block
from strutwork.msa.materials import Material
steel = Material.isotropic(200e9, 0.3, density=7800.0, name="steel")
ends = [Interface("a", "-z"), Interface("b", "+z")]
for number in range(1, 21):
    bar = Solid(block((0.2, 0.2, 0.1 * number), (2, 2, 5)), {"solid": steel}, order=1, name="bar")
    reduce_solid(bar, ends, modes=6, folder=Path(sys.argv[1]))
"""


def _content(folder: Path) -> dict[str, bytes]:
    return {p.name: p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def _tables_whole(folder: Path) -> None:
    for path in folder.glob("*.nc"):
        read_netcdf(path)


def _report_whole(folder: Path) -> None:
    if (folder / "report.html").exists():
        verify_report(folder)


def _chunks_whole(folder: Path) -> None:
    for number in range(40):
        path = ChunkStore(folder, "key").path(number)
        assert path.exists() == (ChunkStore(folder, "key").read(number) is not None)


def _superelements_whole(folder: Path) -> None:
    for path in folder.glob("*.superelement"):
        read_superelement(path)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "whole"),
    [
        ((*PROGRAM, "report", "examples/04_four_bar.toml", "-o"), _report_whole),
        ((*PROGRAM, "map", "proposed-3pprs", "--lattice", "1", "-o"), _tables_whole),
        ((*PROGRAM, "scale", "mit-ss1", "--lengths", "2", "-o"), _tables_whole),
        ((*PROGRAM, "tolerance", "mit-ss1", "--samples", "100", "-o"), _tables_whole),
        ((sys.executable, "-c", CHUNKS), _chunks_whole),
        ((sys.executable, "-c", SUPERELEMENTS), _superelements_whole),
    ],
    ids=["report", "map", "scale", "tolerance", "chunks", "superelements"],
)
def test_killed_at_random_moments(
    tmp_path: Path, command: tuple[str, ...], whole: Callable[[Path], None]
) -> None:
    def start(folder: Path) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            [*command, str(folder)],
            cwd=ROOT,
            env=ENVIRONMENT,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    folder = tmp_path / "out"
    assert start(tmp_path / "good").wait() == 0
    began = time.perf_counter()
    assert start(tmp_path / "good").wait() == 0
    lasts = time.perf_counter() - began
    good = _content(tmp_path / "good")
    draw = np.random.default_rng(15)
    killed = 0
    for _ in range(MOMENTS):
        began = time.perf_counter()
        child = start(folder)
        # most of a run reads libraries: aim at its second half
        time.sleep(lasts * draw.uniform(0.5, 1.02))
        if child.poll() is None:
            child.send_signal(signal.SIGKILL)
        else:
            # other work on the machine has ended since it was measured
            lasts = min(lasts, 0.9 * (time.perf_counter() - began))
        killed += child.wait() == -signal.SIGKILL
        if folder.exists():
            whole(folder)
    assert killed > MOMENTS // 4
    assert start(folder).wait() == 0
    assert _content(folder) == good
    assert not list(tmp_path.rglob(f"{PREFIX}*"))
