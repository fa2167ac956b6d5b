"""Reading files that name a machine and ask something of it: studies, designs, calibrations."""

from __future__ import annotations

from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from strutwork.errors import ModelError
from strutwork.machines.model_errors import model_error
from strutwork.machines.model_file import file_text, toml_of

Tables = TypeVar("Tables", bound=BaseModel)


def tables_beside_model(path: str | Path, kind: str, schema: type[Tables], page: str) -> Tables:
    """The tables of a file that names a machine.

    Parameters
    ----------
    path : str or Path
        TOML.
    kind : str
        What the file is, for messages, such as "study".
    schema : type
        Of its tables.
    page : str
        Where the file is described.

    Raises
    ------
    ModelError, UnitError
        The file cannot be read, is a model file, or a key is unknown or wrong.
    """
    place = Path(path)
    data = toml_of(file_text(place, f"{kind} file"), str(path), page)
    if "nodes" in data:
        raise ModelError(
            str(path),
            f"is a model file, not a {kind} file.",
            f'A {kind} file names it: machine = "{place.name}". See {page}.',
        )
    try:
        return schema.model_validate(data)
    except ValidationError as error:
        raise model_error(error, data, str(path), schema, page) from None
