"""Reading an errors file: temperatures, cutting forces, drives and the ground of a machine."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from pydantic import ValidationError

from strutwork.errors import ModelError
from strutwork.fea.ground_vibration import GroundSpectrum
from strutwork.machines.model import Model
from strutwork.machines.model_errors import model_error
from strutwork.machines.model_file import file_text, toml_of
from strutwork.machines.model_motion_tables import grid_of_table
from strutwork.machines.model_tolerances import tolerance_of
from strutwork.names import choices
from strutwork.overconstraint.tolerance import Tolerance
from strutwork.studies.calibration_file import task_of
from strutwork.studies.error_calibration import CalibrationPlan
from strutwork.studies.error_inputs import CuttingForce, DriveError, ErrorInputs, Temperature
from strutwork.studies.error_milling import MillingCut
from strutwork.studies.error_schema import (
    DriveTable,
    ErrorsTable,
    GeometryCalibrationTable,
    TemperatureTable,
)
from strutwork.studies.error_servos import with_loop
from strutwork.studies.error_solid_heat import HeatFlow, SolidField
from strutwork.studies.error_temperatures import parts_of, temperature_of

#: Where the file is described.
PAGE = "docs/accuracy.md"


def read_errors(path: str | Path, model: Model) -> ErrorInputs:
    """Read an errors file.

    Parameters
    ----------
    path : str or Path
        TOML; its tables are those of docs/accuracy.md.
    model : Model
        Whose parts, drives and nodes it names.

    Raises
    ------
    ModelError, UnitError
        The file cannot be read, a key is unknown or wrong, it names what the machine has not, or
        a part whose temperature changes has no coefficient of expansion.
    """
    return parse_errors(file_text(Path(path), "errors file"), str(path), model)


def parse_errors(text: str, source: str, model: Model) -> ErrorInputs:
    """Read the text of an errors file.

    Parameters
    ----------
    text : str
    source : str
        Named in messages.
    model : Model

    Raises
    ------
    ModelError, UnitError
        As `read_errors`.
    """
    data = toml_of(text, source, PAGE)
    if "nodes" in data:
        raise ModelError(
            source,
            "is a model file, not an errors file.",
            f"Give it as the machine; an errors file is described in {PAGE}.",
        )
    try:
        tables = ErrorsTable.model_validate(data)
    except ValidationError as error:
        raise model_error(error, data, source, ErrorsTable, PAGE) from None
    linkage = model.structure.linkage
    against = linkage.against if tables.tool is None else tables.tool.against
    if against is not None and against not in linkage.node_index:
        raise ModelError(
            "tool.against",
            f'names the unknown node "{against}".',
            choices("Nodes", against, model.nodes),
        )
    return ErrorInputs(
        tuple(_temperature(i, t, tables, model) for i, t in enumerate(tables.temperatures)),
        tuple(CuttingForce(t.name, (*t.force, *t.moment), t.frequency) for t in tables.cutting),
        tuple(d for i, t in enumerate(tables.drives) for d in _drives(i, t, model)),
        tuple(GroundSpectrum(t.direction, t.frequencies, t.density) for t in tables.ground),
        against,
        tables.model.tolerances,
        tables.model.gravity,
        tables.time,
        tables.drift,
        _tolerances(tables, model),
        tables.gravity,
        _milling(tables, model),
        None if tables.calibration is None else _plan(tables.calibration),
        source=tables.source,
        servos=tables.model.servos,
    )


def _tolerances(tables: ErrorsTable, model: Model) -> tuple[Tolerance, ...]:
    linkage = model.structure.linkage
    known = {joint.name: joint for joint in linkage.joints}
    names = {t.name for t in model.tolerances if tables.model.tolerances}
    found = []
    for table in tables.tolerances:
        if table.name in names:
            raise ModelError(
                f"tolerance {table.name}", "is defined twice.", "Give every tolerance its own name."
            )
        names.add(table.name)
        found.append(tolerance_of(table, known, linkage.node_index))
    return tuple(found)


def _milling(tables: ErrorsTable, model: Model) -> MillingCut | None:
    table = tables.milling
    if table is None:
        return None
    if model.process is None:
        raise ModelError(
            "milling",
            "has no process.",
            "Add a table [process] to the model file, with cutter and material.",
        )
    return MillingCut(table.depth, table.speed, table.feed_per_tooth, table.harmonics)


def _plan(table: GeometryCalibrationTable) -> CalibrationPlan:
    grid = None if table.candidates is None else grid_of_table(table.candidates).task()
    return CalibrationPlan(
        table.parameters or (),
        table.directions,
        table.poses,
        tuple(task_of(pose) for pose in table.at),
        grid,
        table.uncertainty,
        table.angular_uncertainty,
    )


def _temperature(
    number: int, table: TemperatureTable, tables: ErrorsTable, model: Model
) -> Temperature:
    given = [k for k in ("part", "parts", "material") if getattr(table, k) is not None]
    if len(given) != 1:
        raise ModelError(
            f"temperatures[{number}]",
            f"has {' and '.join(given) or 'neither part, parts nor material'}.",
            "Name one part, several as parts = [...], or a material.",
        )
    if table.material is not None:
        parts = parts_of(model, table.material)
    else:
        parts = table.parts or () if table.part is None else (table.part,)
    name = table.name or table.material or ", ".join(parts)
    return temperature_of(
        model,
        parts,
        table.expansion,
        tables.expansion,
        _field(table, tables),
        name=name,
        change=table.change,
        spread=table.spread,
        gradient=(table.gradient_y, table.gradient_z),
        time_constant=table.time_constant,
    )


def _field(table: TemperatureTable, tables: ErrorsTable) -> SolidField | None:
    """Of solids; None where the temperature is one number."""
    profile = table.profile
    if not (any(table.gradient) or table.at or profile or table.surfaces):
        return None
    field = SolidField(
        table.change,
        table.gradient,
        table.at,
        flows=tuple(HeatFlow(**dict(surface)) for surface in table.surfaces),
        conductivities=tables.conductivity,
    )
    if profile is None:
        return field
    return replace(field, axis=profile.axis, places=profile.places, changes=profile.changes)


def _drives(number: int, table: DriveTable, model: Model) -> list[DriveError]:
    part = f"drives[{number}]"
    if (table.joint is None) == (table.joints is None):
        found = "neither joint nor joints" if table.joint is None else "both joint and joints"
        raise ModelError(part, f"has {found}.", "Name one joint, or several as a list.")
    turns = table.direction.startswith("r")
    values = {}
    for key in ("resolution", "backlash", "servo_stiffness"):
        right, wrong = (f"angular_{key}", key) if turns else (key, f"angular_{key}")
        if getattr(table, wrong) is not None:
            raise ModelError(
                f"{part}.{wrong}",
                f"does not suit the direction {table.direction}.",
                f"Write {right}.",
            )
        values[key] = getattr(table, right)
    if table.servo is None and all(v is None for v in values.values()):
        raise ModelError(
            part, "states no error.", "Give resolution, backlash, servo_stiffness or servo."
        )
    if table.servo is not None and values["servo_stiffness"] is not None:
        raise ModelError(part, "gives servo_stiffness and servo.", "Give one of the two.")
    drives = model.structure.linkage.driven
    joints = (table.joint,) if table.joint is not None else table.joints or ()
    for joint in joints:
        if (joint, table.direction) not in drives:
            name = f"{joint}:{table.direction}"
            raise ModelError(
                part,
                f'names the unknown drive "{name}".',
                choices("Drives", name, [f"{j}:{d}" for j, d in drives]),
            )
    errors = [
        DriveError(joint, table.direction, **values, servo=table.servo is not False)
        for joint in joints
    ]
    return [_with_servo(d, model, part) for d in errors] if table.servo else errors


def _with_servo(drive: DriveError, model: Model, part: str) -> DriveError:
    """With the servo that the model has for it, which is asked for by name."""
    for servo in model.servos:
        if (servo.joint, servo.direction) == (drive.joint, drive.direction):
            return with_loop(drive, servo)
    raise ModelError(
        f"{part}.servo",
        f"asks for the servo of {drive.joint}:{drive.direction}, which the model does not have.",
        "Add it to [[servos]] of the model file, or give servo_stiffness.",
    )
