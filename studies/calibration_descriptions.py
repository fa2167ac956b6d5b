"""What each key of a calibration file means, in a line: for the schema that editors read.

docs/how-to/calibrate.md says more on each.
"""

from __future__ import annotations

_LOADED = {
    "node": "node on which the load acts",
    "x": "force along x",
    "y": "force along y",
    "z": "force along z",
    "rx": "moment about x",
    "ry": "moment about y",
    "rz": "moment about z",
}
_POSE = {
    "x": "along x",
    "y": "along y",
    "z": "along z",
    "rx": "about x",
    "ry": "about y",
    "rz": "about z",
}
_NAME = "name in the result"
_WHERE = "pose of the tool; what is not named stays as at home"
_POINTS = 'nodes of measured points, such as "12" = "TCP" or "12:x" = "TCP:z"'
_SHARE = "standard deviation of each value as a share of it"
_LENGTHS = "standard deviation of each displacement"
_ANGLES = "standard deviation of each rotation"

#: Meaning of each key, by table.
DESCRIPTIONS: dict[str, dict[str, str]] = {
    "CalibrationTable": {
        "machine": "model file beside this file, or a name of the catalogue",
        "parameters": "numbers of the machine that are to be found",
        "frequencies": "measured natural frequencies, a table for each pose",
        "frf": "measured frequency responses, a table for each file",
        "deflections": "measured displacements under loads, a table for each load and pose",
        "candidates": "poses of which --poses chooses, and what is measured at each",
        "fit": "how the best values are searched",
    },
    "UnknownTable": {
        "path": "path of a number, or a list of paths; a star stands for any characters",
        "guess": "first guess; what the machine states by default",
        "range": "bounds; a tenth of the guess to ten times the guess by default",
        "prior": "standard deviation of the guess as a share of it, if the guess is knowledge",
        "relative": "whether the parameter is a factor of what the machine states",
        "scale": "whether it is varied by factors or by differences",
        "name": "name in the result; the first path by default",
    },
    "FrequenciesTable": {
        "name": _NAME,
        "pose": _WHERE,
        "values": "frequencies, lowest first; or a file",
        "file": "universal file with mode shapes, which are paired by the MAC; or values",
        "modes": "which elastic modes these are, counted from 1",
        "points": _POINTS,
        "scatter": "standard deviation of all frequencies, or one for each",
        "relative_scatter": _SHARE,
    },
    "FrfTable": {
        "name": _NAME,
        "file": "universal file with frequency responses",
        "pose": _WHERE,
        "points": _POINTS,
        "band": "lowest and highest frequency that count",
        "lines": "lines that are used at most; 200 by default",
        "scatter": "standard deviation as a share of the magnitude",
        "modal_ratio": "viscous damping ratio of every mode; the machine's damping by default",
        "units": "units of labels that the file does not state",
    },
    "DeflectionsTable": {
        "name": _NAME,
        "pose": _WHERE,
        "load": "the load that was put on",
        "displacements": "displacements by node, from before to after the load",
        "scatter": _LENGTHS,
        "angular_scatter": _ANGLES,
    },
    "CandidatesTable": _POSE
    | {
        "frequencies": "frequencies that can be measured at each pose",
        "deflections": "displacements that can be measured at each pose",
        "frf": "frequency responses that can be measured at each pose",
    },
    "CandidateFrequencies": {
        "modes": "number of modes from the lowest",
        "relative_scatter": _SHARE,
    },
    "CandidateDeflections": {
        "load": "the load that is put on",
        "at": 'nodes with directions, such as "TCP:z"',
        "scatter": _LENGTHS,
        "angular_scatter": _ANGLES,
    },
    "CandidateFrf": {
        "input": 'node with the direction of the force, such as "TCP:x"',
        "outputs": "nodes with the directions of the sensors",
        "band": "lowest and highest frequency that count",
        "lines": "number of lines; 50 by default",
        "scatter": "standard deviation as a share of the magnitude",
        "modal_ratio": "viscous damping ratio of every mode; the machine's damping by default",
    },
    "FitTable": {
        "starts": "number of starting points; 6 by default",
        "seed": "seed of the starting points; 0 by default",
    },
    "LoadTable": _LOADED,
    "PoseTable": _POSE,
}
