"""Machine code on disk: kept, renewed with any source, never required, safe for many at once.

The tiny installation of the last tests is this package's ground floor under four packages with one
compiled function that calls another in another package.
"""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NoReturn

import pytest

import strutwork
from strutwork import cache_folder, jit_cache
from strutwork.cache_folder import takes_files, user_cache
from strutwork.errors import CacheWarning
from strutwork.jit import jit
from strutwork.source_digest import source_digest
from tests.unit.test_package import ROOT, sources


def twice(x: float) -> float:
    return 2.0 * x


def thrice(x: float) -> float:
    return 3.0 * x


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Code is kept in `tmp_path`, and nothing was noted yet."""
    monkeypatch.setattr(jit_cache, "code_folder", lambda: tmp_path)
    monkeypatch.setattr(cache_folder, "_noted", set())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield tmp_path


def hits(function: Any) -> int:
    return sum(function.stats.cache_hits.values())


def test_kept_and_found(folder: Path) -> None:
    first, second = jit()(twice), jit()(twice)
    assert first(1.5) == 3.0
    assert hits(first) == 0
    (kept,) = folder.iterdir()
    before = kept.stat().st_mtime_ns
    assert second(1.5) == 3.0
    assert hits(second) == 1
    # another signature is another file
    assert second(2) == 4.0
    assert len(list(folder.iterdir())) == 2
    assert kept.stat().st_mtime_ns == before


@pytest.mark.parametrize("damage", ["empty", "cut", "flipped", "foreign"])
def test_damaged_code_is_compiled_anew(folder: Path, damage: str) -> None:
    assert jit()(twice)(1.5) == 3.0
    (kept,) = folder.iterdir()
    whole = kept.read_bytes()
    middle = len(whole) // 2
    kept.write_bytes(
        {
            "empty": b"",
            "cut": whole[:middle],
            "flipped": whole[:middle] + bytes([whole[middle] ^ 1]) + whole[middle + 1 :],
            "foreign": b"something else, longer than a checksum" * 9,
        }[damage]
    )
    again, mended = jit()(twice), jit()(twice)
    with pytest.warns(CacheWarning, match="cannot be used"):
        assert again(1.5) == 3.0
    assert hits(again) == 0
    assert [p.name for p in folder.iterdir()] == [kept.name]
    assert mended(1.5) == 3.0
    assert hits(mended) == 1


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EACCES])
def test_a_disk_that_takes_no_more(
    folder: Path, monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    def full(*_: object) -> NoReturn:
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr("numba.core.caching.os.replace", full)
    with pytest.warns(CacheWarning, match=os.strerror(number)) as notes:
        assert [jit()(f)(1.5) for f in (twice, thrice)] == [3.0, 4.5]
    assert len(notes) == 1
    assert "NUMBA_CACHE_DIR or XDG_CACHE_HOME" in str(notes[0].message)
    assert not list(folder.iterdir())


def test_nowhere_to_keep_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jit_cache, "code_folder", lambda: None)
    functions = jit()(twice), jit()(thrice)
    with pytest.warns(CacheWarning, match="nothing can be written") as notes:
        assert [f(1.5) for f in functions] == [3.0, 4.5]
    assert len(notes) == 1
    assert "NUMBA_CACHE_DIR or XDG_CACHE_HOME" in str(notes[0].message)


def test_where_code_may_lie(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(vars(jit_cache.config), "CACHE_DIR", str(tmp_path / "numba"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    chosen, own, user = jit_cache.code_folders()
    assert chosen.parent == tmp_path / "numba"
    assert own.parent.parent == Path(strutwork.__file__).parent
    assert user.parent == tmp_path / "xdg" / "strutwork" / "compiled"


def test_the_users_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("XDG_CACHE_HOME", "relative")
    assert user_cache() == tmp_path / ".cache" / "strutwork"

    def nobody() -> NoReturn:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setattr(Path, "home", nobody)
    assert user_cache() is None
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    assert user_cache() == tmp_path / "xdg" / "strutwork"


def test_a_folder_that_takes_no_files(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    assert not takes_files(tmp_path / "file" / "below")
    assert takes_files(tmp_path / "new" / "below")


def test_every_compiled_function_is_kept_this_way() -> None:
    users = set()
    for path in sources():
        text = path.read_text(encoding="utf-8")
        top = path.relative_to(ROOT).parts[0]
        room = top if top == "strutwork" else f"strutwork.{top}"
        if path.name not in {"jit.py", "jit_cache.py"}:
            assert "numba import" not in text, f"{path}: use strutwork.jit"
        if "strutwork.jit import" in text:
            users.add(room)
    assert users
    assert users <= set(jit_cache.PACKAGES)


def tiny(folder: Path) -> Path:
    shutil.copytree(ROOT / "strutwork", folder / "strutwork", ignore=_without_code)
    for package in jit_cache.PACKAGES[1:]:
        room = folder.joinpath(*package.split("."))
        room.mkdir()
        (room / "__init__.py").touch()
    head = "from strutwork.jit import jit\n"
    (folder / "strutwork" / "kinematics" / "inner.py").write_text(
        f"{head}\n@jit()\ndef inner(x):\n    return 2.0 * x\n"
    )
    (folder / "strutwork" / "msa" / "outer.py").write_text(
        f"{head}from strutwork.kinematics.inner import inner\n\n"
        "@jit()\ndef outer(x):\n    return inner(x) + 1.0\n"
    )
    return folder


def _without_code(_: str, names: list[str]) -> list[str]:
    rooms = {package.rpartition(".")[2] for package in jit_cache.PACKAGES[1:]}
    others = {"cutting", "flexures", "machines", "overconstraint", "reports", "studies"}
    return [name for name in names if name in rooms | others | {"__pycache__"}]


USE_OUTER = """
from strutwork.msa.outer import outer
print(outer(1.0), sum(outer.stats.cache_hits.values()))
"""


def start(folder: Path) -> subprocess.Popen[str]:
    # no bytecode: two edits within a second would look the same to the import system
    return subprocess.Popen(
        [
            sys.executable,
            "-B",
            "-c",
            USE_OUTER,
        ],
        cwd=folder,
        env={"PATH": os.environ["PATH"], "PYTHONPATH": str(folder)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def run(folder: Path) -> str:
    out, err = start(folder).communicate()
    assert not err
    return out.strip()


def test_code_does_not_outlive_a_changed_callee(tmp_path: Path) -> None:
    home = tiny(tmp_path / "site")
    compiled = home / "strutwork" / "__pycache__" / "compiled"
    assert run(home) == "3.0 0"
    assert run(home) == "3.0 1"
    (old,) = compiled.iterdir()
    inner = home / "strutwork" / "kinematics" / "inner.py"
    inner.write_text(inner.read_text().replace("2.0", "5.0"))
    assert run(home) == "6.0 0"
    # what the older sources left is gone
    (new,) = compiled.iterdir()
    assert new.name != old.name


@pytest.mark.slow
def test_eight_processes_on_a_cold_cache(tmp_path: Path) -> None:
    home = tiny(tmp_path / "site")
    children = [start(home) for _ in range(8)]
    ends = [child.communicate() for child in children]
    assert [out.split()[0] for out, _ in ends] == ["3.0"] * 8
    assert [err for _, err in ends] == [""] * 8
    (folder,) = (home / "strutwork" / "__pycache__" / "compiled").iterdir()
    assert [p.suffix for p in folder.iterdir()] == [".nbc", ".nbc"]
    assert run(home) == "3.0 1"


def test_a_digest_sees_names_and_contents(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(tmp_path)
    package = tmp_path / "digested"
    package.mkdir()
    (package / "__init__.py").touch()
    seen = set()
    for name, text in [("a.py", "1"), ("a.py", "2"), ("b.py", "2"), ("b.py", "")]:
        for old in package.glob("?.py"):
            old.unlink()
        (package / name).write_text(text)
        source_digest.cache_clear()
        seen.add(source_digest("digested"))
        assert source_digest("digested") in seen
    assert len(seen) == 4
    with pytest.raises(ModuleNotFoundError, match="no package nowhere"):
        source_digest("nowhere")
