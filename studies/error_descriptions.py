"""What each key of an errors file means, in a line: for the schema that editors read.

docs/accuracy.md and docs/how-to/accuracy.md say more on each.
"""

from __future__ import annotations

#: Meaning of each key, by table.
DESCRIPTIONS: dict[str, dict[str, str]] = {
    "ErrorsTable": {
        "model": "which causes of the model file count",
        "tool": "what the displacement of the tool is relative to",
        "expansion": "coefficients of thermal expansion by material",
        "time": "time since the temperatures began to change; their end by default",
        "drift": "times at which the thermal drift is stated",
        "temperatures": "changes of temperature of parts",
        "cutting": "forces of the cut on the tool",
        "drives": "errors of drives",
        "ground": "vibration of the ground",
    },
    "CountedTable": {
        "tolerances": "whether the tolerances of the model file count; true by default",
        "gravity": "whether gravity counts; true by default",
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
        "time_constant": "time constant of the change",
        "expansion": "coefficient of expansion of these parts; that of the material by default",
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
    },
    "GroundTable": {
        "direction": "direction along which all mounts move alike",
        "frequencies": "frequencies of the spectrum, ascending",
        "density": "spectral density of the acceleration at the frequencies",
    },
}
