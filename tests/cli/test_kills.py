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

from reports.manifest import verify_report
from strutwork.staging import PREFIX
from studies.chunks import ChunkStore
from studies.dataset_files import read_netcdf

ROOT = Path(__file__).parents[2]
PROGRAM = (sys.executable, "-c", "from reports.cli import main; main()")
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT)}

#: Moments of each kind.
MOMENTS = 50

#: Writes one chunk after another; read back, each is whole or not there.
CHUNKS = """
import sys
from pathlib import Path
import numpy as np
from studies.chunks import ChunkStore
store = ChunkStore(Path(sys.argv[1]), "key")
for number in range(40):
    store.write(number, {"a": np.full(50_000, float(number))})
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


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "whole"),
    [
        ((*PROGRAM, "report", "examples/04_four_bar.toml", "-o"), _report_whole),
        ((*PROGRAM, "map", "proposed-3pprs", "--lattice", "1", "-o"), _tables_whole),
        ((*PROGRAM, "scale", "mit-ss1", "--lengths", "2", "-o"), _tables_whole),
        ((*PROGRAM, "tolerance", "mit-ss1", "--samples", "100", "-o"), _tables_whole),
        ((sys.executable, "-c", CHUNKS), _chunks_whole),
    ],
    ids=["report", "map", "scale", "tolerance", "chunks"],
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
        child = start(folder)
        # most of a run reads libraries: aim at its second half
        time.sleep(lasts * draw.uniform(0.5, 1.02))
        child.send_signal(signal.SIGKILL)
        killed += child.wait() == -signal.SIGKILL
        if folder.exists():
            whole(folder)
    assert killed > MOMENTS // 4
    assert start(folder).wait() == 0
    assert _content(folder) == good
    assert not list(tmp_path.rglob(f"{PREFIX}*"))
