"""The JSON schemas of the files beside a model, by which an editor completes and checks them.

``python -m strutwork.studies.schema_kinds`` writes those of docs/schema.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from strutwork.files import write_text
from strutwork.machines.model_descriptions import DESCRIPTIONS as MODEL
from strutwork.machines.model_process_schema import ProcessTable
from strutwork.machines.schema_file import described, finished
from strutwork.machines.servo_file import ServosTable
from strutwork.studies import (
    calibration_descriptions,
    design_descriptions,
    error_descriptions,
    study_descriptions,
)
from strutwork.studies.calibration_schema import CalibrationTable
from strutwork.studies.design_quantities import OF_JOINTS, QUANTITIES
from strutwork.studies.design_schema import DesignTable
from strutwork.studies.error_schema import ErrorsTable
from strutwork.studies.question import QUESTIONS
from strutwork.studies.study_machines import REDUCTIONS
from strutwork.studies.study_schema import StudyTable
from strutwork.studies.travel_answer import TRAVEL

Tables = dict[str, dict[str, Any]]


@dataclass(frozen=True)
class Kind:
    """A kind of file.

    Parameters
    ----------
    top : type
        The class of the entire file.
    descriptions : mapping of class to mapping of key to str
    description : str
        What the file is, and the page that describes it.
    detail : callable
        Completes the schemas of the tables by what only the package knows.
    """

    top: type[BaseModel]
    descriptions: Mapping[str, Mapping[str, str]]
    description: str
    detail: Callable[[Tables], None] = lambda _: None


def _study(tables: Tables) -> None:
    properties = tables["StudyTable"]["properties"]
    properties["reductions"]["items"] = {"enum": list(REDUCTIONS)}
    # joints are those of the machine
    named = {"type": "string", "pattern": f"^{TRAVEL}:."}
    properties["answers"]["items"] = {"if": named, "else": {"enum": [*QUESTIONS, TRAVEL]}}


def _design(tables: Tables) -> None:
    for table in ("ObjectiveTable", "ConstraintTable"):
        quantity = tables[table]["properties"]["quantity"]
        named = {"type": "string", "pattern": f"^({'|'.join(OF_JOINTS)}):.+:"}
        # a message of the list names what is wrong; one of several schemas does not
        quantity |= {"if": named, "else": {"enum": list(QUANTITIES)}}


def _calibration(tables: Tables) -> None:
    scatter = tables["FrequenciesTable"]["properties"]["scatter"]
    lists = [one for one in scatter["anyOf"] if one.get("type") == "array"]
    scatter["anyOf"] = [*scatter["anyOf"], *(one["items"] for one in lists)]


#: Kinds of files by name.
KINDS: dict[str, Kind] = {
    "study": Kind(
        StudyTable,
        study_descriptions.DESCRIPTIONS,
        "Numbers that are varied: docs/how-to/study.md",
        _study,
    ),
    "design": Kind(
        DesignTable,
        design_descriptions.DESCRIPTIONS,
        "Objectives that are searched for: docs/how-to/design.md",
        _design,
    ),
    "calibration": Kind(
        CalibrationTable,
        calibration_descriptions.DESCRIPTIONS,
        "Measured values that a model is fitted to: docs/how-to/calibrate.md",
        _calibration,
    ),
    "errors": Kind(
        ErrorsTable,
        error_descriptions.DESCRIPTIONS,
        "Causes of displacements of the tool: docs/accuracy.md",
    ),
    "process": Kind(ProcessTable, MODEL, "A milling cut: docs/how-to/lobes.md"),
    "servo": Kind(
        ServosTable,
        {**MODEL, "ServosTable": {"servos": MODEL["ModelTable"]["servos"]}},
        "Controllers of drives: docs/how-to/servo.md",
    ),
}


def file_name(kind: str) -> str:
    """The name under which a schema lies beside its files.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    """
    return f"strutwork-{kind}.schema.json"


def schema_of(kind: str) -> dict[str, Any]:
    """The schema of a kind of files, as JSON holds it.

    Parameters
    ----------
    kind : str
        One of `KINDS`.

    Returns
    -------
    dict
        Draft 7. It refuses unknown keys and wrong types; paths, units and what depends on several
        keys only the reader itself checks, since they depend on the machine.
    """
    found = KINDS[kind]
    tables = described(found.top, found.descriptions)
    found.detail(tables)
    return finished(tables, found.top, f"Strutwork {kind} file", found.description)


def schema_text(kind: str) -> str:
    """The schema of a kind of files as the text of its file.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    """
    return json.dumps(schema_of(kind), indent=1, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    root = Path(__file__).resolve().parents[1]
    for name in KINDS:
        write_text(root / "docs" / "schema" / file_name(name), schema_text(name))
        sys.stdout.write(f"Written: docs/schema/{file_name(name)}\n")
