"""The schema of study files: it takes what the reader takes, and names what is misspelt."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft7Validator
from pydantic import BaseModel

from strutwork.studies import study_schema as tables
from strutwork.studies.study_descriptions import DESCRIPTIONS
from strutwork.studies.study_schema_file import FILE_NAME, study_schema

ROOT = Path(__file__).parents[2]
# a file of a design has tables of its own
EXAMPLES = [
    file
    for file in sorted((ROOT / "examples/studies").glob("*.toml"))
    if not file.name.endswith("-design.toml")
]
BASE: dict[str, Any] = {"machine": "m.toml", "parameters": [{"path": "a", "values": ["2 mm", 3]}]}


@pytest.fixture(scope="module")
def validator() -> Draft7Validator:
    schema = study_schema()
    Draft7Validator.check_schema(schema)
    return Draft7Validator(schema)


def messages(validator: Draft7Validator, data: dict[str, Any]) -> str:
    return "\n".join(error.message for error in validator.iter_errors(data))


def test_the_published_schema_is_the_generated_one() -> None:
    # python -m strutwork.studies.study_schema_file writes it
    place = ROOT / "docs/schema" / FILE_NAME
    assert json.loads(place.read_text(encoding="utf-8")) == study_schema()


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda path: path.name)
def test_every_example_is_valid(file: Path, validator: Draft7Validator) -> None:
    assert len(EXAMPLES) >= 3
    assert messages(validator, tomllib.loads(file.read_text(encoding="utf-8"))) == ""


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({}, ""),
        ({"workspace": {}}, ""),
        ({"parameters": [{"path": ["a", "b"], "range": [1, "2 mm"], "relative": True}]}, ""),
        ({"parameter": []}, "'parameter' was unexpected"),
        ({"parameters": [{"pat": "a"}]}, "'pat' was unexpected"),
        ({"parameters": [{"path": "a", "distribution": "gauss"}]}, "'gauss' is not one of"),
        ({"sample": {"kind": "saltelli", "count": 0}}, "less than the minimum of 1"),
        ({"answers": ["stifness"]}, "'stifness' is not one of"),
        ({"reductions": ["wurst"]}, "'wurst' is not one of"),
        ({"vibration": {"band": ["10 Hz"]}}, "is too short"),
    ],
)
def test_what_is_misspelt_or_wrong_is_named(
    change: dict[str, Any], message: str, validator: Draft7Validator
) -> None:
    found = messages(validator, BASE | change)
    assert message in found
    assert bool(message) == bool(found)


def test_every_key_has_a_description_and_every_description_a_key() -> None:
    known = {
        name: {field.alias or key for key, field in value.model_fields.items()}
        for name, value in vars(tables).items()
        if isinstance(value, type)
        and issubclass(value, BaseModel)
        and value.__module__ == tables.__name__
    }
    assert {name: set(words) for name, words in DESCRIPTIONS.items()} == known
