from __future__ import annotations

import json
from pathlib import Path

import pytest

from strutwork.machines.schema_file import DIRECTIVE, FILE_NAME, model_schema, schema_text
from tests.cli.conftest import Program


def test_schema_is_printed_or_written(strutwork: Program, tmp_path: Path) -> None:
    assert json.loads(strutwork("schema").out) == model_schema()
    place = tmp_path / "below" / "s.json"
    run = strutwork("schema", "-o", place)
    assert (run.status, run.out) == (0, f"Written: {place}\n")
    assert place.read_text(encoding="utf-8") == schema_text()

    study = json.loads(strutwork("schema", "--of", "study").out)
    assert study == json.loads(strutwork("schema", "--study").out)
    assert study["title"] == "Strutwork study file"
    assert study["properties"]["answers"]["items"]["else"]["enum"][0] == "stiffness"


def test_new_names_the_schema_first_and_puts_it_beside(
    strutwork: Program, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = strutwork("new", "mine", "--like", "3-RPS", "--json").result
    assert result == {"data": ["mine.toml", FILE_NAME]}
    assert Path("mine.toml").read_text(encoding="utf-8").startswith(f"{DIRECTIVE}\n")
    assert Path(FILE_NAME).read_text(encoding="utf-8") == schema_text()
    # a second machine finds it there
    result = strutwork("new", "other", "--like", "6-UPS", "--json").result
    assert result == {"data": ["other.toml"]}
    assert strutwork("check", "other.toml").status == 0
