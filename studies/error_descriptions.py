"""What each key of an errors file means, in a line: for the schema that editors read.

docs/accuracy.md and docs/how-to/accuracy.md say more on each.
"""

from __future__ import annotations

from strutwork.machines.model_descriptions import DESCRIPTIONS as MODEL
from strutwork.studies.calibration_descriptions import DESCRIPTIONS as CALIBRATION

#: Meaning of each key, by table.
DESCRIPTIONS: dict[str, dict[str, str]] = {
    "ErrorsTable": {
        "model": "which causes of the model file count",
        "tool": "what the displacement of the tool is relative to",
        "expansion": "coefficients of thermal expansion by material",
        "conductivity": "thermal conductivities by material, for solids with heated surfaces",
        "time": "time since the temperatures began to change; their end by default",
        "drift": "times at which the thermal drift is stated",
        "temperatures": "changes of temperature of parts",
        "cutting": "forces of the cut on the tool",
        "drives": "errors of drives",
        "ground": "vibration of the ground",
        "source": "where the numbers come from; shown in the report",
        "gravity": "acceleration, for a machine whose model file states none",
        "tolerances": "tolerances beside those of the model file",
        "milling": "milling cut in the process of the model",
        "calibration": "calibration of the geometry, whose remaining errors count",
    },
    "MillingTable": {
        "depth": "depth of cut along the tool",
        "speed": 'speed of the spindle, such as "6000 rpm"',
        "feed_per_tooth": "that of the process by default",
        "harmonics": "harmonics of the tooth frequency; 3 by default",
    },
    "GeometryCalibrationTable": {
        "parameters": "names or kinds of the tolerances that are calibrated; all by default",
        "directions": "displacements of the tool that are measured; x, y and z by default",
        "poses": "number of poses that are chosen from the candidates",
        "at": "poses that are measured in any case",
        "candidates": "poses to choose from; the workspace of the model file by default",
        "uncertainty": "standard deviation of a measured translation",
        "angular_uncertainty": "standard deviation of a measured rotation",
    },
    "PoseTable": CALIBRATION["PoseTable"],
    **{
        table: MODEL[table]
        for table in ("ToleranceTable", "WorkspaceTable", "LengthSpan", "AngleSpan")
    },
    "CountedTable": {
        "tolerances": "whether the tolerances of the model file count; true by default",
        "gravity": "whether gravity counts; true by default",
        "servos": "whether the servos of the model file count; true by default",
    },
    "ToolTable": {"against": "node of the workpiece"},
    "TemperatureTable": {
        "name": "name of the cause",
        "part": "one part; or parts, or a material",
        "parts": "several parts; or part, or a material",
        "material": "all parts of a material; or parts",
        "change": 'change of the temperature at the end, such as "2 K"',
        "spread": "half the width of what is uncertain of the change",
        "gradient_y": "gradient of the temperature along the local y axis of a beam",
        "gradient_z": "gradient of the temperature along the local z axis of a beam",
        "gradient": "gradient of the temperature in a solid, global axes",
        "at": "point at which a solid has the change; its centre of mass by default",
        "profile": "temperature of a solid along an axis, added to the change",
        "surfaces": "heated surfaces of a solid, whose temperature follows by steady conduction",
        "time_constant": "time constant of the change",
        "expansion": "coefficient of expansion of these parts; that of the material by default",
    },
    "ProfileTable": {
        "axis": "axis along which the temperature varies, global axes",
        "places": "distances from the origin along the axis, ascending",
        "changes": "change of the temperature at the places; constant outside them",
    },
    "HeatedSurfaceTable": {
        "node": "interface of the solid; or patch, or box",
        "patch": "patch of the solid's mesh; or node, or box",
        "box": "lowest and highest corner, in the solid's own axes; or node, or patch",
        "normal": "outward normal of the faces in the box",
        "change": "temperature of the surface, as a change",
        "film": "coefficient of heat transfer to the surroundings",
        "surroundings": "temperature of the surroundings, as a change; 0 K by default",
        "flux": "flow of heat per area into the solid",
        "power": "flow of heat into the solid, spread evenly",
    },
    "CuttingTable": {
        "name": "name of the cause",
        "force": "force on the tool, or its amplitude, global axes",
        "moment": "moment on the tool, or its amplitude, global axes",
        "frequency": "frequency of a harmonic force; a constant force by default",
    },
    "DriveTable": {
        "joint": "one joint; or joints",
        "joints": "several joints; or joint",
        "direction": "driven direction",
        "resolution": "step of the measured position of a linear drive",
        "angular_resolution": "step of the measured position of a rotary drive",
        "backlash": "play of a linear drive, from stop to stop",
        "angular_backlash": "play of a rotary drive, from stop to stop",
        "servo_stiffness": "stiffness of a linear drive's control, in series with the drive",
        "angular_servo_stiffness": "stiffness of a rotary drive's control, in series",
        "servo": "whether the drive has the static stiffness of its servo in the model file",
    },
    "GroundTable": {
        "direction": "direction along which all mounts move alike",
        "frequencies": "frequencies of the spectrum, ascending",
        "density": "spectral density of the acceleration at the frequencies",
    },
}
