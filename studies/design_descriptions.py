"""What each key of a design file means, in a line: for the schema that editors read.

docs/how-to/design.md says more on each.
"""

from __future__ import annotations

from strutwork.studies.study_descriptions import DESCRIPTIONS as STUDY

#: Meaning of each key, by table.
DESCRIPTIONS: dict[str, dict[str, str]] = {
    "DesignTable": {
        "machine": "model file beside this file, or a name of the catalogue",
        "parameters": "numbers of the machine that are searched for",
        "objectives": "quantities to make as small or as large as possible",
        "constraints": "limits of quantities",
        "search": "how, and how long, is searched",
        "cost": "what a machine costs, for the quantity cost",
        "workspace": "poses at which each machine is asked; the machine's own by default",
        "poses": "poses one by one, instead of a grid",
        "hemisphere": "check points of a hemisphere about home, instead of a grid",
        "vibration": "what is asked of vibration",
    },
    "ObjectiveTable": {
        "quantity": "a quantity that docs/how-to/design.md lists",
        "goal": "the quantity's own by default: stiffness is maximised, mass minimised",
    },
    "ConstraintTable": {
        "quantity": "a quantity that docs/how-to/design.md lists",
        "at_least": "lowest value, a number in SI or a text with a unit; stated: as described",
        "at_most": "highest value, a number in SI or a text with a unit; stated: as described",
    },
    "SearchTable": {
        "method": "evolution (NSGA-II, the default), gradient (SLSQP), or both one after the other",
        "starts": "points at which a search along gradients begins; 3 by default",
        "population": "machines of a generation; 48 by default",
        "generations": "number of generations; 40 by default",
        "seed": "seed of the search; the same seed gives the same machines; 0 by default",
    },
    "CostTable": {
        "fixed": "cost of any machine; 0 by default",
        "per_kg": "cost of a kilogram of the machine's mass; 0 by default",
        "currency": "shown behind costs",
        "parameters": "what parameters cost",
    },
    "CostPartTable": {
        "name": "name of a parameter",
        "amount": "what it costs for each step of its value",
        "per": "the step, a number in SI or a text with a unit; 1 by default",
    },
    "PoseTable": {
        "x": "place of the tool along x",
        "y": "place of the tool along y",
        "z": "place of the tool along z",
        "rx": "rotation of the tool about x, component of its rotation vector from home",
        "ry": "rotation of the tool about y, component of its rotation vector from home",
        "rz": "rotation of the tool about z, component of its rotation vector from home",
    },
    "HemisphereTable": {
        "radius": "radius of the hemisphere, whose pole is home; 4 mm by default",
        "lattice": "fineness of the check points; 10 (317 points) by default",
        "rolls": "angles of roll that are tried at each point; 24 by default",
        "joint_ranges": "types of joints whose ranges are kept, as revolute; all by default",
        "condition_limit": "poses of a larger condition number do not count; 100 by default",
    },
    "ParameterTable": STUDY["ParameterTable"],
    "VibrationTable": STUDY["VibrationTable"],
}
