"""Controllers of drives from a file beside the model's."""

from __future__ import annotations

from pathlib import Path

from pydantic import Field

from strutwork.machines.beside_model import tables_beside_model
from strutwork.machines.model import Model
from strutwork.machines.model_fields import Table
from strutwork.machines.model_servo_schema import ServoTable
from strutwork.machines.model_servos import servos_of
from strutwork.machines.servos import Servo


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
    tables = tables_beside_model(path, "servo", ServosTable, "docs/how-to/servo.md")
    joints = {joint.name: joint for joint in model.structure.linkage.joints}
    return servos_of(tables.servos, joints)
