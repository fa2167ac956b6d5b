"""What each key of a study file means, in a line: for the schema that editors read.

docs/how-to/study.md says more on each.
"""

from __future__ import annotations

#: Meaning of each key, by table.
DESCRIPTIONS: dict[str, dict[str, str]] = {
    "StudyTable": {
        "machine": "model file beside this file, or a name of the catalogue",
        "parameters": "numbers of the machine that are varied",
        "sample": "how the values are combined",
        "answers": "what each machine is asked; stiffness by default",
        "reductions": "what is stored of the poses; worst, mean and home by default",
        "workspace": "poses at which each machine is asked; the machine's own by default",
        "vibration": "what is asked of vibration",
    },
    "ParameterTable": {
        "path": "path of a number, or a list of paths; a star stands for any characters",
        "values": "values, each a number in SI or a text with a unit",
        "range": "lowest and highest value; of a distribution the ends of its values",
        "points": "number of points of a grid over the range; 5 by default",
        "relative": "whether the values are factors of what the machine states",
        "log": "whether the range is divided by ratios",
        "name": "name in the result; the first path by default",
        "distribution": "how the values scatter about the mean",
        "mean": "mean of the distribution; what the machine states by default",
        "scatter": 'standard deviation, of "uniform" half the width; "10 %" is a share of the mean',
        "independent": "whether each match of the first star varies by itself, as each joint",
    },
    "SampleTable": {
        "kind": "grid, list, or points over the ranges; saltelli gives Sobol indices",
        "count": "number of points, of saltelli the number of blocks",
        "seed": "seed of the points; the same seed gives the same points; 0 by default",
        "second_order": "whether saltelli gives indices of second order as well",
    },
    "VibrationTable": {
        "band": "lowest and highest frequency of the least dynamic stiffness",
        "count": "number of natural frequencies; 6 by default",
    },
}
