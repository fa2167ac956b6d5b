"""What holds for the distribution as a whole."""

from __future__ import annotations

import importlib
import pkgutil
import re
import tomllib
from importlib import metadata
from pathlib import Path

import pytest

import strutwork
from strutwork import errors

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PACKAGE = ROOT / "strutwork"
#: The package and the folders beside it that are its subpackages, by links.
ROOMS = ["strutwork", *sorted(p.name for p in PACKAGE.iterdir() if p.is_symlink())]
LONGEST_FILE = 400
#: Extras whose oldest versions are tested as well.
FLOORED = ("cluster", "design", "openmdao", "servo")


def sources() -> list[Path]:
    return [path for room in ROOMS for path in sorted((ROOT / room).rglob("*.py"))]


def floors() -> dict[str, str]:
    requirement = re.compile(r"^([A-Za-z0-9_-]+)>=([0-9.]+)$")
    extras = PROJECT["project"]["optional-dependencies"]
    asked = [PROJECT["project"]["dependencies"], *(extras[name] for name in FLOORED)]
    found = [requirement.match(line) for lines in asked for line in lines]
    assert all(found), "every dependency is written as name>=version"
    return {match[1]: match[2] for match in found if match}


@pytest.mark.parametrize("room", ROOMS)
def test_each_package_says_that_it_is_typed(room: str) -> None:
    assert (ROOT / room / "__init__.py").is_file()
    assert (ROOT / room / "py.typed").is_file()


def test_every_folder_of_code_is_reached_through_the_package() -> None:
    folders = {p.parent.name for p in ROOT.glob("*/__init__.py")}
    assert folders - {"tests", "benchmarks"} == set(ROOMS)
    for room in ROOMS[1:]:
        assert (PACKAGE / room).readlink() == Path("..") / room
        module = importlib.import_module(f"strutwork.{room}")
        assert Path(str(module.__file__)).resolve() == ROOT / room / "__init__.py"


def test_no_code_takes_a_folder_for_a_package_of_its_own() -> None:
    # a user may have a kinematics.py, and another distribution may install reports
    alone = re.compile(rf"^\s*(?:from|import) ({'|'.join(ROOMS[1:])})\b", re.MULTILINE)
    texts = [*sources(), *ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")]
    texts += [
        p for name in ("tests", "benchmarks", "examples") for p in (ROOT / name).rglob("*.py")
    ]
    assert {str(p) for p in texts if alone.search(p.read_text(encoding="utf-8"))} == set()


def test_version_is_written_once() -> None:
    assert strutwork.__version__ == PROJECT["project"]["version"]
    assert metadata.version("strutwork") == strutwork.__version__
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {strutwork.__version__}\n" in citation


def test_tested_floors_are_the_declared_ones() -> None:
    text = (ROOT / "tests" / "floors.txt").read_text(encoding="utf-8")
    pinned = dict(re.findall(r"^([A-Za-z0-9_-]+)==([0-9.]+)$", text, re.MULTILINE))
    assert {name: pinned.get(name) for name in floors()} == floors()


def advised_extras() -> dict[str, list[str]]:
    """Every `strutwork[...]` in sources, scripts and pages, with the files that say it."""
    places = [ROOT / name for name in (*ROOMS, "docs", "examples", "benchmarks", "scripts", ".ci")]
    files = [p for place in places for p in place.rglob("*") if p.is_file()]
    files += [*ROOT.glob("*.md"), ROOT / "pyproject.toml", *ROOT.glob(".github/**/*.yml")]
    found: dict[str, list[str]] = {}
    for path in files:
        if path.suffix not in {".py", ".md", ".toml", ".sh", ".yml", ".html", ".txt", ""}:
            continue
        text = path.read_text(encoding="utf-8", errors="replace")
        # a source may break its string, and a shell may quote it: strutwork"[cad]"
        for names in re.findall(r"strutwork[\"'\s\\]*\[([A-Za-z0-9_, -]+)\]", text):
            for extra in names.split(","):
                found.setdefault(extra.strip(), []).append(str(path.relative_to(ROOT)))
    return found


def test_every_extra_that_is_advised_exists() -> None:
    extras = set(PROJECT["project"]["optional-dependencies"])
    found = advised_extras()
    assert {"cad", "accel"} <= set(found)
    assert {extra: where for extra, where in found.items() if extra not in extras} == {}


def test_every_error_of_the_packages_is_of_the_family() -> None:
    modules = [
        importlib.import_module(module.name)
        for module in pkgutil.walk_packages(strutwork.__path__, "strutwork.")
        if not module.name.endswith("__main__")
    ]
    values = [value for module in modules for value in vars(module).values()]
    classes = [value for value in values if isinstance(value, type)]
    found = [c for c in classes if issubclass(c, Exception) and not issubclass(c, Warning)]
    ours = [error for error in found if error.__module__.startswith("strutwork.")]
    assert errors.UnitError in ours
    assert [error for error in ours if not issubclass(error, errors.StrutworkError)] == []


def test_an_error_shows_part_problem_and_remedy() -> None:
    error = errors.ModelError("beam link1", "has zero length.", "Move one of its nodes.")
    assert str(error) == "beam link1: has zero length.\nMove one of its nodes."
    assert (error.part, error.problem, error.remedy) == error.args
    assert str(errors.StrutworkError("", "stopped.")) == "stopped."


def test_no_file_is_too_long_to_read() -> None:
    lengths = {
        p.relative_to(ROOT): len(p.read_text(encoding="utf-8").splitlines()) for p in sources()
    }
    assert {p: n for p, n in lengths.items() if n > LONGEST_FILE} == {}
