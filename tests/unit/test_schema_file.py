"""The schema that editors read: it takes what the reader takes, and names what is misspelt."""

from __future__ import annotations

import copy
import json
import tomllib
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft7Validator
from pydantic import BaseModel

from strutwork.machines import (
    model_bearing_schema,
    model_flexure_schema,
    model_motion_schema,
    model_process_schema,
    model_schema,
    model_servo_schema,
    model_solid_schema,
)
from strutwork.machines.model_descriptions import DESCRIPTIONS
from strutwork.machines.schema_file import (
    DIRECTIVE,
    FILE_NAME,
    put_beside,
    schema_text,
)
from strutwork.machines.schema_file import (
    model_schema as made,
)

ROOT = Path(__file__).parents[2]
COMMITTED = ROOT / "docs" / "schema" / FILE_NAME
# files of studies, calibrations, errors and servos are no model files
OTHERS = ("studies", "errors", "calibration", "servos")
EXAMPLES = [f for f in sorted((ROOT / "examples").glob("**/*.toml")) if f.parent.name not in OTHERS]
CASES = [*sorted((ROOT / "tests" / "cases" / "models").glob("*.toml"))]


@pytest.fixture(scope="module")
def validator() -> Draft7Validator:
    schema = made()
    Draft7Validator.check_schema(schema)
    return Draft7Validator(schema)


def loaded(name: str) -> dict[str, Any]:
    return tomllib.loads((ROOT / "examples" / name).read_text(encoding="utf-8"))


def messages(validator: Draft7Validator, data: dict[str, Any]) -> str:
    return "\n".join(error.message for error in validator.iter_errors(data))


def test_the_published_schema_is_the_generated_one() -> None:
    # python -m strutwork.machines.schema_file writes it
    assert json.loads(COMMITTED.read_text(encoding="utf-8")) == made()


@pytest.mark.parametrize("file", [*EXAMPLES, *CASES], ids=lambda path: path.name)
def test_every_model_file_is_valid(file: Path, validator: Draft7Validator) -> None:
    data = tomllib.loads(file.read_text(encoding="utf-8"))
    assert messages(validator, data) == ""


def test_there_are_examples_and_cases() -> None:
    assert len(EXAMPLES) > 10
    assert len(CASES) > 10


def test_a_misspelt_key_is_named(validator: Draft7Validator) -> None:
    data = loaded("01_cantilever.toml")
    beam = copy.deepcopy(data)
    beam["beams"][0]["materiel"] = beam["beams"][0].pop("material")
    assert "'materiel' was unexpected" in messages(validator, beam)
    assert "'material' is a required property" in messages(validator, beam)
    top = data | {"beam": []}
    assert "'beam' was unexpected" in messages(validator, top)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("youngs_modulus", "steel"),
        ("youngs_modulus", 0.0),
        ("youngs_modulus", True),
        ("poissons_ratio", 0.6),
        ("poissons_ratio", []),
    ],
)
def test_what_is_no_quantity_or_out_of_range_is_refused(
    key: str, value: object, validator: Draft7Validator
) -> None:
    data = loaded("01_cantilever.toml")
    next(iter(data["materials"].values()))[key] = value
    assert messages(validator, data)


@pytest.mark.parametrize(
    ("table", "entry"),
    [
        ("supports", {"node": "A", "fixed": "all"}),
        ("supports", {"node": "A", "fixed": ["x", "rz"]}),
        ("masses", {"node": "A", "mass": 1, "inertia": [1, 2, "3 kg*m^2"]}),
        ("masses", {"node": "A", "mass": 1, "inertia": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}),
        ("joints", {"name": "J", "type": "bushing", "between": ["A", "B"], "matrix": []}),
    ],
)
def test_what_the_reader_understands_besides_is_valid(
    table: str, entry: dict[str, Any], validator: Draft7Validator
) -> None:
    data = {"nodes": {"A": [0, 0, 0], "B": [0, 0, 0]}, table: [entry]}
    assert messages(validator, data) == ""
    # the reader takes the same
    model_schema.ModelTable.model_validate(data)


@pytest.mark.parametrize("fixed", ["some", ["w"], [1]])
def test_what_no_direction_is_is_refused(fixed: object, validator: Draft7Validator) -> None:
    data = {"nodes": {"A": [0, 0, 0]}, "supports": [{"node": "A", "fixed": fixed}]}
    assert messages(validator, data)


def test_every_key_has_a_description_and_every_description_a_key() -> None:
    tables = {
        value.__name__: {field.alias or name for name, field in value.model_fields.items()}
        for module in (
            model_schema,
            *(model_schema, model_bearing_schema, model_flexure_schema),
            model_motion_schema,
            model_process_schema,
            model_servo_schema,
            model_solid_schema,
        )
        for value in vars(module).values()
        if isinstance(value, type) and issubclass(value, BaseModel) and value.model_fields
    }
    assert {name: set(words) for name, words in DESCRIPTIONS.items()} == tables


def test_a_description_says_the_dimension_and_its_unit() -> None:
    table = made()["definitions"]["MaterialTable"]["properties"]
    assert table["youngs_modulus"]["description"] == (
        'Young\'s modulus: a modulus in Pa, or with its unit as in "205 GPa"'
    )
    assert table["poissons_ratio"]["description"] == "Poisson's ratio; or the shear modulus"


def test_a_model_file_may_begin_with_the_line_that_names_the_schema() -> None:
    text = (ROOT / "examples" / "01_cantilever.toml").read_text(encoding="utf-8")
    assert tomllib.loads(f"{DIRECTIVE}\n{text}") == tomllib.loads(text)


def test_the_schema_is_put_beside_and_renewed_but_a_foreign_file_is_kept(tmp_path: Path) -> None:
    model, place = tmp_path / "m.toml", tmp_path / FILE_NAME
    assert put_beside(model) == place
    assert place.read_text(encoding="utf-8") == schema_text()
    assert put_beside(model) is None
    place.write_text(schema_text().replace("name of the beam", "older"), encoding="utf-8")
    assert put_beside(model) == place
    assert place.read_text(encoding="utf-8") == schema_text()
    for foreign in ('{"title": "mine"}', "[]", "no JSON"):
        place.write_text(foreign, encoding="utf-8")
        assert put_beside(model) is None
        assert place.read_text(encoding="utf-8") == foreign
