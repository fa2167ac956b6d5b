"""The JSON schema of the model file, by which an editor completes and checks it.

``python -m strutwork.machines.schema_file`` writes docs/schema/strutwork-model.schema.json.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel
from pydantic.json_schema import GenerateJsonSchema

from strutwork.files import write_text
from strutwork.machines.model_complete_schema import ModelTable
from strutwork.machines.model_descriptions import DESCRIPTIONS
from strutwork.units import NUMBER

#: The name under which it lies beside a model file.
FILE_NAME = "strutwork-model.schema.json"
#: First line of a model file: where editors find the schema (Taplo and what builds on it).
DIRECTIVE = f"#:schema ./{FILE_NAME}"
#: Editors read this draft; later ones have other words for lists of fixed length.
DRAFT = "http://json-schema.org/draft-07/schema#"

#: Values that the reader understands before it looks at their type.
_ALSO: dict[tuple[str, str], dict[str, Any]] = {
    ("SupportTable", "fixed"): {"const": "all"},
    ("JointTable", "matrix"): {"type": "array", "maxItems": 0},
}

#: Entries of a catalogue that state where their numbers come from.
_WITH_SOURCE = (
    "AngularContactTable",
    "BallRailTable",
    "CylindricalRollersTable",
    "GivenStiffnessTable",
)


def model_schema() -> dict[str, Any]:
    """The schema, as JSON holds it.

    Returns
    -------
    dict
        Draft 7. It refuses unknown keys and what is neither a number nor a text with a unit; what
        depends on several keys, names and dimensions of units only the reader itself checks.
    """
    tables = described(ModelTable, DESCRIPTIONS)
    for (name, key), value in _ALSO.items():
        _allow(tables[name]["properties"][key], value)
    for name in _WITH_SOURCE:
        # absent, it is refused with words of its own
        tables[name]["required"].append("source")
    rows = tables["MassTable"]["properties"]["inertia"]
    _allow(rows, {"type": "array", "items": _entry(rows), "minItems": 3, "maxItems": 3})
    return finished(
        tables, ModelTable, "Strutwork model file", "Structure of a machine: docs/model-file.md"
    )


def described(
    top: type[BaseModel], descriptions: Mapping[str, Mapping[str, str]]
) -> dict[str, dict[str, Any]]:
    """The schemas of a file's tables by the name of their class, with what each key means.

    Parameters
    ----------
    top : type
        The class of the entire file.
    descriptions : mapping of class to mapping of key to str
        Of tables that are not in it the model file's count.
    """
    found = top.model_json_schema(ref_template="#/definitions/{model}", schema_generator=_Generator)
    tables: dict[str, dict[str, Any]] = {top.__name__: found} | found.pop("$defs", {})
    for name, table in tables.items():
        table.pop("title", None)
        words = descriptions.get(name) or DESCRIPTIONS[name]
        for key, value in table.get("properties", {}).items():
            value.pop("title", None)
            _say(value, words[key])
    return tables


def finished(
    tables: Mapping[str, dict[str, Any]], top: type[BaseModel], title: str, description: str
) -> dict[str, Any]:
    """The schema of a file as JSON holds it, draft 7.

    Parameters
    ----------
    tables : mapping of class to dict
        As `described`.
    top : type
        The class of the entire file.
    title, description : str
    """
    first = tables[top.__name__]
    keys = ("type", "additionalProperties", "required", "properties")
    rest = {name: table for name, table in tables.items() if name != top.__name__}
    whole = {
        "$schema": DRAFT,
        "title": title,
        "description": description,
        **{key: first[key] for key in keys if key in first},
        "definitions": dict(sorted(rest.items())),
    }
    plain: dict[str, Any] = _plain(whole)
    return plain


def schema_text() -> str:
    """The schema as the text of its file."""
    return json.dumps(model_schema(), indent=1, ensure_ascii=False) + "\n"


def put_beside(path: Path) -> Path | None:
    """Write the schema beside a model file, unless a file of its name is there that is no schema.

    Parameters
    ----------
    path : Path
        The model file.

    Returns
    -------
    Path or None
        The file written; None where it was there already, or where another file has its name.

    Raises
    ------
    OutputError
        It cannot be written.
    """
    place = path.parent / FILE_NAME
    text = schema_text()
    if place.exists():
        try:
            there = place.read_text(encoding="utf-8")
            own = json.loads(there).get("title") == "Strutwork model file"
        except (OSError, ValueError, AttributeError):
            return None
        if not own or there == text:
            return None
    write_text(place, text)
    return place


class _Generator(GenerateJsonSchema):
    """Without defaults: the descriptions state those that matter."""

    def default_schema(self, schema: Any) -> Any:
        """Leave the default out."""
        return self.generate_inner(schema["schema"])


def _say(value: dict[str, Any], words: str) -> None:
    """Describe a key by its meaning and, where all it holds is of one dimension, by that."""
    dimensions = sorted({d for d in _descriptions(value) if d != NUMBER.name})
    tail = f": {dimensions[0]}" if len(dimensions) == 1 else ""
    if "$ref" in value:
        # beside a reference draft 7 reads nothing
        value["allOf"] = [{"$ref": value.pop("$ref")}]
    value["description"] = f"{words}{tail}"


def _descriptions(value: object) -> list[str]:
    if isinstance(value, list):
        return [d for one in value for d in _descriptions(one)]
    if not isinstance(value, dict):
        return []
    own = [str(value["description"])] if "description" in value else []
    return own + [d for one in value.values() for d in _descriptions(one)]


def _allow(place: dict[str, Any], value: dict[str, Any]) -> None:
    """Accept this too, where a key stands."""
    words = place.pop("description")
    known = place.pop("anyOf", None) or [dict(place)]
    place.clear()
    place.update({"anyOf": [*known, value], "description": words})


def _entry(rows: dict[str, Any]) -> Any:
    """What one number of a matrix may be."""
    return rows["anyOf"][0]["prefixItems"][0]["prefixItems"][0]


def _plain(value: Any) -> Any:
    """Lists of fixed length and absent values in the words of draft 7."""
    if isinstance(value, list):
        return [_plain(one) for one in value]
    if not isinstance(value, dict):
        return value
    value = {key: _plain(one) for key, one in value.items() if key != "discriminator"}
    entries = value.pop("prefixItems", None)
    if entries is not None:
        value["items"] = entries[0] if all(one == entries[0] for one in entries) else entries
    # TOML has no null: a key that may be absent is of its type
    if "anyOf" in value:
        value["anyOf"] = [one for one in value["anyOf"] if one != {"type": "null"}]
        if len(value["anyOf"]) == 1:
            value = value.pop("anyOf")[0] | value
            if "$ref" in value:
                value["allOf"] = [{"$ref": value.pop("$ref")}]
    # versions of pydantic differ in whether they limit names here
    value.pop("propertyNames", None)
    return value


if __name__ == "__main__":
    root = Path(__file__).resolve().parents[1]
    write_text(root / "docs" / "schema" / FILE_NAME, schema_text())
    sys.stdout.write(f"Written: docs/schema/{FILE_NAME}\n")
