"""The JSON schema of study files, by which an editor completes and checks them.

``python -m strutwork.studies.study_schema_file`` writes docs/schema/strutwork-study.schema.json.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from strutwork.files import write_text
from strutwork.machines.schema_file import described, finished
from strutwork.studies.question import QUESTIONS
from strutwork.studies.study_descriptions import DESCRIPTIONS
from strutwork.studies.study_machines import REDUCTIONS
from strutwork.studies.study_schema import StudyTable

#: The name under which it lies beside a study file.
FILE_NAME = "strutwork-study.schema.json"


def study_schema() -> dict[str, Any]:
    """The schema, as JSON holds it.

    Returns
    -------
    dict
        Draft 7. It refuses unknown keys and wrong types; paths, units and what depends on several
        keys only the reader itself checks, since they depend on the machine.
    """
    tables = described(StudyTable, DESCRIPTIONS)
    for key, names in (("answers", QUESTIONS), ("reductions", REDUCTIONS)):
        tables["StudyTable"]["properties"][key]["items"] = {"enum": list(names)}
    return finished(
        tables, StudyTable, "Strutwork study file", "Numbers that are varied: docs/how-to/study.md"
    )


def schema_text() -> str:
    """The schema as the text of its file."""
    return json.dumps(study_schema(), indent=1, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    root = Path(__file__).resolve().parents[1]
    write_text(root / "docs" / "schema" / FILE_NAME, schema_text())
    sys.stdout.write(f"Written: docs/schema/{FILE_NAME}\n")
