from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from strutwork.reports.cli import main
from tests.model_files import Content, toml


@dataclass(frozen=True)
class Run:
    """What a command left: its exit status and what it printed."""

    status: int
    out: str
    err: str

    @property
    def result(self) -> dict[str, Any]:
        """The JSON object; fails when there is more or less than one line of it."""
        assert self.status == 0, self.err
        assert self.out.count("\n") == 1
        found = json.loads(self.out, parse_constant=lambda word: pytest.fail(f"JSON has {word}"))
        assert isinstance(found, dict)
        return found


Program = Callable[..., Run]


@pytest.fixture
def strutwork(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Program:
    """Runs the program in this process."""

    # wide enough that no table folds its words, whatever terminal the tests run in
    monkeypatch.setenv("COLUMNS", "240")
    # what a command says must not depend on how busy the machine is
    monkeypatch.setattr("strutwork.reports.cli.watch.PATIENCE", 1e6)

    def run(*arguments: str | Path) -> Run:
        monkeypatch.setattr(sys, "argv", ["strutwork", *map(str, arguments)])
        capsys.readouterr()
        status: object = 0
        try:
            main()
        except SystemExit as end:
            status = end.code or 0
        assert isinstance(status, int)
        printed = capsys.readouterr()
        return Run(status, printed.out, printed.err)

    return run


@pytest.fixture
def write(tmp_path: Path) -> Callable[[Content], Path]:
    """Writes a model file."""

    def to_file(content: Content) -> Path:
        path = tmp_path / "model.toml"
        path.write_text(toml(content), encoding="utf-8")
        return path

    return to_file
