"""The schemas of files beside a model: they take what the readers take, and name what is wrong."""

from __future__ import annotations

import json
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft7Validator
from pydantic import BaseModel

from strutwork.reports.cli.schema_command import FileKind
from strutwork.studies.schema_kinds import KINDS, file_name, schema_of

ROOT = Path(__file__).parents[2]
EXAMPLES = [
    *(
        ("design" if file.name.endswith("-design.toml") else "study", file)
        for file in sorted((ROOT / "examples/studies").glob("*.toml"))
    ),
    *(("calibration", file) for file in sorted((ROOT / "examples/calibration").glob("*.toml"))),
    *(("errors", file) for file in sorted((ROOT / "examples/errors").glob("*.toml"))),
    *(("servo", file) for file in sorted((ROOT / "examples/servos").glob("*.toml"))),
    *(("process", file) for file in sorted((ROOT / "machines/data").glob("*process*.toml"))),
]
BASE: dict[str, Any] = {"machine": "m.toml", "parameters": [{"path": "a", "values": ["2 mm", 3]}]}


def validator(kind: str) -> Draft7Validator:
    schema = schema_of(kind)
    Draft7Validator.check_schema(schema)
    return Draft7Validator(schema)


def messages(kind: str, data: dict[str, Any]) -> str:
    return "\n".join(error.message for error in validator(kind).iter_errors(data))


def test_the_command_knows_every_kind() -> None:
    assert [kind.value for kind in FileKind] == ["model", *KINDS]


@pytest.mark.parametrize("kind", KINDS)
def test_the_published_schema_is_the_generated_one(kind: str) -> None:
    # python -m strutwork.studies.schema_kinds writes them
    place = ROOT / "docs/schema" / file_name(kind)
    assert json.loads(place.read_text(encoding="utf-8")) == schema_of(kind)


@pytest.mark.parametrize(("kind", "file"), EXAMPLES, ids=lambda one: getattr(one, "name", one))
def test_every_example_is_valid(kind: str, file: Path) -> None:
    assert {kind for kind, _ in EXAMPLES} == set(KINDS)
    assert messages(kind, tomllib.loads(file.read_text(encoding="utf-8"))) == ""


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
def test_what_is_misspelt_or_wrong_is_named(change: dict[str, Any], message: str) -> None:
    found = messages("study", BASE | change)
    assert message in found
    assert bool(message) == bool(found)


@pytest.mark.parametrize(
    ("kind", "data", "message"),
    [
        (
            "design",
            BASE | {"objectives": [{"quantity": "weight"}]},
            "'weight' is not one of",
        ),
        ("design", BASE, "'objectives' is a required property"),
        (
            "calibration",
            BASE | {"parameters": [{"path": "a", "prior": "10 %"}], "frf": [{"file": "a.uff"}]},
            "'band' is a required property",
        ),
        ("errors", {"ground": [{"direction": "w"}]}, "'w' is not one of"),
        ("process", {"teeth": 2.5}, "2.5 is not of type 'integer'"),
    ],
)
def test_other_files_name_what_is_wrong(kind: str, data: dict[str, Any], message: str) -> None:
    assert message in messages(kind, data)


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "process"])
def test_every_key_has_a_description_and_every_description_a_key(kind: str) -> None:
    top = KINDS[kind].top
    known = {
        name: {field.alias or key for key, field in value.model_fields.items()}
        for name, value in vars(sys.modules[top.__module__]).items()
        if isinstance(value, type)
        and issubclass(value, BaseModel)
        and value.__module__ == top.__module__
    }
    words = {name: set(keys) for name, keys in KINDS[kind].descriptions.items()}
    assert {name: words.get(name) for name in known} == known
