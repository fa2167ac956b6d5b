"""Commands where nothing can be kept: the same results, and one note of each kind."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.read_only import installation, strutwork

COLUMN = "examples/08_column_on_mounts.toml"
COMMANDS = {
    "solve": ["solve", COLUMN, "--json"],
    "modes": ["modes", COLUMN, "--json"],
    "frf": [
        "frf",
        "eclipse-3pprs:calibrated",
        "--modal-ratio",
        "0.01",
        "--input",
        "TCP:x",
        "--json",
    ],
    "map": ["map", "eclipse-3pprs:calibrated", "--lattice", "1", "--json"],
    "tolerance": [
        "tolerance",
        "examples/06_table_on_two_rails.toml",
        "--samples",
        "1000",
        "--json",
    ],
}

#: Commands that reduce a solid.
WITH_SOLID = {"solve", "modes", "report"}

#: Commands that come without compiled functions.
WITHOUT_COMPILED = {"tolerance"}


@pytest.fixture(scope="module")
def read_only() -> Iterator[Path]:
    with installation(writable=False) as folder:
        yield folder


@pytest.fixture(scope="module")
def writable() -> Iterator[Path]:
    with installation(writable=True) as folder:
        yield folder


def homes(kind: str, folder: Path) -> dict[str, str]:
    """The environment of a user with such a home."""
    if kind == "none" and os.geteuid() == 0:
        return {}
    if kind == "read-only":
        folder.chmod(0o555)
        return {"HOME": str(folder)}
    # one who is in the system's list has a home even without HOME
    return {"HOME": "/nonexistent"}


def notes(err: str) -> list[str]:
    assert "Traceback" not in err, err
    # what takes long on a busy machine tells so
    lines = [line for line in err.splitlines() if not line.endswith(" s so far")]
    assert all(line.startswith("Warning: ") for line in lines), err
    return sorted(line.split()[1] for line in lines)


def expected(command: str) -> list[str]:
    return ["compiled"] * (command not in WITHOUT_COMPILED) + ["superelements"] * (
        command in WITH_SOLID
    )


SLOW = pytest.mark.slow


@pytest.mark.parametrize(
    ("command", "home"),
    [
        pytest.param("frf", "none", marks=SLOW),
        pytest.param("frf", "missing", marks=SLOW),
        pytest.param("frf", "read-only", marks=SLOW),
        pytest.param("solve", "none", marks=SLOW),
        pytest.param("modes", "missing", marks=SLOW),
        pytest.param("map", "none", marks=SLOW),
        ("tolerance", "none"),
    ],
)
def test_read_only_installation(
    read_only: Path, writable: Path, tmp_path: Path, command: str, home: str
) -> None:
    run = strutwork(read_only, COMMANDS[command], homes(home, tmp_path), stranger=True)
    assert run.returncode == 0, run.stderr
    assert notes(run.stderr) == expected(command)
    usual = strutwork(writable, COMMANDS[command], {"XDG_CACHE_HOME": str(tmp_path / "cache")})
    assert usual.returncode == 0, usual.stderr
    if home != "read-only":
        assert notes(usual.stderr) == []
    # the same code on one thread
    assert run.stdout == usual.stdout
    assert not list(read_only.rglob("__pycache__"))
    assert not (read_only / "~").exists()


@pytest.mark.slow
def test_read_only_report(read_only: Path, tmp_path: Path) -> None:
    out = read_only.parent / f"{read_only.name}-report"
    out.mkdir()
    out.chmod(0o777)
    try:
        run = strutwork(
            read_only, ["report", COLUMN, "--out", str(out)], homes("none", tmp_path), stranger=True
        )
        assert run.returncode == 0, run.stderr
        assert notes(run.stderr) == expected("report")
        assert (out / "report.html").stat().st_size > 0
    finally:
        for path in out.rglob("*"):
            path.unlink()
        out.rmdir()


@pytest.mark.slow
@pytest.mark.parametrize("command", ["solve", "frf"])
def test_a_cache_on_a_full_disk(writable: Path, tmp_path: Path, command: str) -> None:
    cache = tmp_path / "cache"
    env = {"XDG_CACHE_HOME": str(cache), "NUMBA_CACHE_DIR": str(cache / "numba")}
    run = strutwork(writable, COMMANDS[command], env, largest_file=4096)
    assert run.returncode == 0, run.stderr
    assert notes(run.stderr) == expected(command)
    assert "File too large" in run.stderr
    assert not [p for p in cache.rglob("*") if p.is_file()]
    usual = strutwork(writable, COMMANDS[command], env)
    assert notes(usual.stderr) == []
    assert run.stdout == usual.stdout
    assert [p for p in cache.rglob("*") if p.is_file()]
