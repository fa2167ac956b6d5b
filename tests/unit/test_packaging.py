"""What is handed to others: source distribution, wheel, conda recipe."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
BIN = Path(sys.executable).parent

#: What git tracks of these ships; the rest of a checkout does not go into a build.
SOURCES = [path.name for path in ROOT.iterdir() if (path / "__init__.py").is_file()]
SHIPPED = sorted({*SOURCES} - {"tests", "benchmarks"})


def _run(*words: str | Path, at: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(word) for word in words], cwd=at, capture_output=True, text=True, check=False
    )


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Both distributions, the wheel made of the source distribution."""
    folder = tmp_path_factory.mktemp("built")
    copy = folder / "checkout"
    copy.mkdir()
    # templates of new machines are links to examples
    for name in (*SHIPPED, "examples"):
        shutil.copytree(
            ROOT / name, copy / name, symlinks=True, ignore=shutil.ignore_patterns("__pycache__")
        )
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, copy / name)
    run = _run(sys.executable, "-m", "build", "--no-isolation", "-o", folder / "dist", at=copy)
    assert run.returncode == 0, run.stdout + run.stderr
    (wheel,), (source,) = (
        list((folder / "dist").glob(pattern)) for pattern in ("*.whl", "*.tar.gz")
    )
    return {"wheel": wheel, "source": source}


def test_what_an_index_demands(built: dict[str, Path]) -> None:
    for words in (
        (BIN / "twine", "check", "--strict", *built.values()),
        (BIN / "check-wheel-contents", built["wheel"]),
    ):
        run = _run(*words, at=ROOT)
        assert run.returncode == 0, run.stdout + run.stderr


def test_every_file_of_the_packages_ships(built: dict[str, Path]) -> None:
    wanted = {
        Path(folder).relative_to(ROOT).joinpath(name).as_posix()
        # links stand for the packages beside, and for the templates
        for folder, _, names in os.walk(ROOT / "strutwork", followlinks=True)
        for name in names
        if "__pycache__" not in folder
    }
    assert "strutwork/machines/templates/3-rps.toml" in wanted
    with zipfile.ZipFile(built["wheel"]) as archive:
        found = {name for name in archive.namelist() if ".dist-info/" not in name}
    assert found == wanted
    with tarfile.open(built["source"]) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert wanted <= names


def test_the_conda_recipe_asks_for_the_same() -> None:
    recipe = (ROOT / "packaging" / "conda" / "recipe.yaml").read_text(encoding="utf-8")
    run = recipe.split("  run:\n")[1].split("\n\n")[0]
    listed = re.findall(r"^    - (\S+) (\S+)$", run, re.MULTILINE)
    python, *rest = listed
    assert python == ("python", PROJECT["requires-python"])
    wanted = [re.match(r"([\w.-]+)(>=.*)", one) for one in PROJECT["dependencies"]]
    assert rest == [(one[1].lower(), one[2]) for one in wanted if one]
    assert f'version: "{PROJECT["version"]}"' in recipe
    (entry,) = PROJECT["scripts"].items()
    assert f"- {entry[0]} = {entry[1]}\n" in recipe


@pytest.mark.slow
def test_the_wheel_alone_runs_the_main_job(built: dict[str, Path], tmp_path: Path) -> None:
    """In a fresh environment, from an empty folder: minutes, most of them SfePy's compilation."""
    steps: list[tuple[str | Path, ...]] = [
        (sys.executable, "-m", "venv", tmp_path / "env"),
        (tmp_path / "env/bin/python", "-m", "pip", "install", "-q", built["wheel"]),
        (tmp_path / "env/bin/strutwork", "new", "mine", "--like", "3-RPS"),
        (tmp_path / "env/bin/strutwork", "report", "mine.toml", "-o", "report"),
    ]
    for words in steps:
        run = _run(*words, at=tmp_path)
        assert run.returncode == 0, run.stdout + run.stderr
    page = (tmp_path / "report" / "report.html").read_text(encoding="utf-8")
    assert "<title>mine" in page
