"""A report in its folder: whole as a set, beside files that are not ours."""

from __future__ import annotations

import errno
import json
from pathlib import Path

import pytest

from strutwork.errors import ModelError, OutputError
from strutwork.reports.manifest import MANIFEST, read_manifest, verify_report
from strutwork.reports.report_folder import PAGE, write_set
from tests.kills import killed_before

OLD = {PAGE: "old page", "a.csv": "old a", "stale.csv": "old only"}
NEW = {PAGE: "new page", "a.csv": "new a", "b.csv": "new b"}


def put(folder: Path, content: dict[str, str]) -> None:
    write_set(folder, {n: lambda p, t=t: p.write_text(t) for n, t in content.items()})  # type: ignore[misc]


def lying(folder: Path) -> dict[str, str]:
    return {p.name: p.read_text() for p in folder.iterdir() if p.name != MANIFEST}


def test_a_smaller_report_leaves_nothing_of_the_larger_one(tmp_path: Path) -> None:
    put(tmp_path / "r", OLD)
    (tmp_path / "r" / "notes.txt").write_text("mine")
    put(tmp_path / "r", NEW)
    assert lying(tmp_path / "r") == {**NEW, "notes.txt": "mine"}
    assert set(verify_report(tmp_path / "r").files) == set(NEW)


@pytest.mark.parametrize("before", [None, OLD], ids=["new folder", "over an older report"])
def test_killed_before_any_file_operation(tmp_path: Path, before: dict[str, str] | None) -> None:
    wholes = (before, NEW)
    number, states = 0, set()
    while True:
        home = tmp_path / str(number)
        folder = home / "r"
        home.mkdir()
        if before is not None:
            put(folder, before)
            (folder / "notes.txt").write_text("mine")
        killed = killed_before(number, lambda folder=folder: put(folder, NEW))  # type: ignore[misc]
        if not folder.exists():
            assert before is None
            states.add("none")
        elif (folder / PAGE).exists():
            files = {n: (folder / n).read_text() for n in verify_report(folder).files}
            assert files in wholes
            states.add(files[PAGE])
        else:
            # never a page beside other data: without a page it says itself that it is not whole
            with pytest.raises(ModelError):
                verify_report(folder)
            states.add("no page")
        put(folder, NEW)
        verify_report(folder)
        assert lying(folder) == {**NEW, **({} if before is None else {"notes.txt": "mine"})}
        assert [p.name for p in home.iterdir()] == ["r"]
        if not killed:
            break
        number += 1
    assert number > 20
    assert states == ({"none", "new page"} if before is None else {*states, "old page", "new page"})
    assert before is None or "no page" in states


def test_files_that_no_manifest_names_are_not_replaced(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("mine")
    with pytest.raises(OutputError, match=r"would be replaced: a\.csv"):
        put(tmp_path, NEW)
    assert lying(tmp_path) == {"a.csv": "mine"}


def test_a_report_on_something_else_is_not_replaced(tmp_path: Path) -> None:
    folder = tmp_path / "r"

    def write(about: str, content: str) -> None:
        write_set(folder, {PAGE: lambda path: path.write_text(content)}, about)

    write("6-ups.toml", "first")
    with pytest.raises(OutputError, match=r'"6-ups\.toml", but this is on "mit-ss1"') as caught:
        write("mit-ss1", "second")
    assert "another folder" in caught.value.remedy
    assert lying(folder) == {PAGE: "first"}
    write("6-ups.toml", "again")
    assert lying(folder) == {PAGE: "again"}
    # of a report that an earlier version wrote nobody knows what it is on
    manifest = json.loads((folder / MANIFEST).read_text())
    del manifest["about"]
    (folder / MANIFEST).write_text(json.dumps(manifest))
    write("mit-ss1", "second")
    assert lying(folder) == {PAGE: "second"}


def test_the_current_folder_and_a_link(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real, link = tmp_path / "real", tmp_path / "link"
    real.mkdir()
    link.symlink_to(real)
    put(link, OLD)
    monkeypatch.chdir(real)
    put(Path(), NEW)
    assert link.is_symlink()
    assert lying(real) == NEW
    assert lying(Path()) == NEW


def test_a_writer_that_fails_leaves_the_older_report(tmp_path: Path) -> None:
    put(tmp_path / "r", OLD)

    def full(_: Path) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    for folder in ("r", "new"):
        with pytest.raises(OutputError, match="No space left on device") as caught:
            write_set(tmp_path / folder, {"b.csv": full, PAGE: full})
        assert "Free some space" in caught.value.remedy
    assert lying(tmp_path / "r") == OLD
    verify_report(tmp_path / "r")
    assert [p.name for p in tmp_path.iterdir()] == ["r"]


@pytest.mark.parametrize("how", ["changed", "longer", "missing"])
def test_a_changed_report_is_told(tmp_path: Path, how: str) -> None:
    put(tmp_path / "r", OLD)
    path = tmp_path / "r" / "a.csv"
    if how == "missing":
        path.unlink()
    else:
        path.write_text("OLD a" if how == "changed" else "old a and more")
    with pytest.raises(ModelError, match=r"a\.csv"):
        verify_report(tmp_path / "r")


@pytest.mark.parametrize("name", ["../mine", "/etc/mine", "", "..", MANIFEST])
def test_a_manifest_from_elsewhere_reaches_nothing_outside(tmp_path: Path, name: str) -> None:
    (tmp_path / "mine").write_text("mine")
    folder = tmp_path / "r"
    folder.mkdir()
    entry = {"size": 1, "sha256": ""}
    content = {"made_by": "", "complete": True, "files": {name: entry}}
    (folder / MANIFEST).write_text(json.dumps(content))
    with pytest.raises(ModelError, match="not the manifest"):
        put(folder, NEW)
    assert (tmp_path / "mine").read_text() == "mine"


@pytest.mark.parametrize("text", ["", "[]", "{", '{"files": 3}', "[" * 100_000])
def test_a_damaged_manifest(tmp_path: Path, text: str) -> None:
    (tmp_path / MANIFEST).write_text(text)
    with pytest.raises(ModelError, match="manifest"):
        read_manifest(tmp_path)


def test_a_file_in_place_of_the_folder(tmp_path: Path) -> None:
    (tmp_path / "r").write_text("mine")
    for folder in (tmp_path / "r", Path("/dev/full")):
        with pytest.raises(OutputError, match="not a folder"):
            put(folder, NEW)
