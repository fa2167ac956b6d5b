"""Controllers of drives from a file beside the model's."""

from __future__ import annotations

from pathlib import Path

from pydantic import Field, ValidationError

from strutwork.errors import ModelError
from strutwork.machines.model import Model
from strutwork.machines.model_errors import model_error
from strutwork.machines.model_fields import Table
from strutwork.machines.model_file import file_text, toml_of
from strutwork.machines.model_servo_schema import ServoTable
from strutwork.machines.model_servos import servos_of
from strutwork.machines.servos import Servo

#: Where such files are described.
PAGE = "docs/how-to/servo.md"


class ServosTable(Table):
    """A file of controllers."""

    servos: tuple[ServoTable, ...] = Field(min_length=1)


def read_servos(path: str | Path, model: Model) -> tuple[Servo, ...]:
    """Read controllers from a file of its own, whose tables are those of a model file.

    Parameters
    ----------
    path : str or Path
        A TOML file with tables [[servos]].
    model : Model
        Whose drives they control.

    Raises
    ------
    ModelError, UnitError
        The file cannot be read, or as `strutwork.machines.model_servos.servos_of`.
    """
    data = toml_of(file_text(Path(path), "servo file"), str(path), PAGE)
    if "nodes" in data:
        raise ModelError(
            str(path),
            "is a model file, not a file of controllers.",
            f"Give a file that has tables [[servos]] alone. See {PAGE}.",
        )
    try:
        tables = ServosTable.model_validate(data)
    except ValidationError as error:
        raise model_error(error, data, str(path), ServosTable, PAGE) from None
    joints = {joint.name: joint for joint in model.structure.linkage.joints}
    return servos_of(tables.servos, joints)
