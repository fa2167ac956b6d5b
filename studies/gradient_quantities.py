"""Quantities whose gradients a study takes, by name."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.coupled import AnyDamping
from strutwork.fea.ports import tool_port
from strutwork.fea.sensitivity import dynamic_sensitivity, frequency_sensitivity
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.model import Model
from strutwork.msa import axis_stiffness_blocked, axis_stiffness_free
from strutwork.msa.mass import total_mass
from strutwork.msa.sensitivity import StaticQuantity, compliance_sensitivity, static_sensitivity
from strutwork.names import visible
from strutwork.studies.tangents import PlacedTangents, Tangents

Array = NDArray[Any]

#: What may be asked, as a person types it.
FORMS = (
    "stiffness_z (others free)",
    "blocked_stiffness_z",
    "frequency_1",
    "least_dynamic_stiffness_z",
    "displacement:NODE:z@CASE",
    "joint_force:JOINT:z@CASE",
    "mass",
)

_TOOL = re.compile(r"(stiffness|blocked_stiffness|least_dynamic_stiffness)_(\w+)")
_MODE = re.compile(r"frequency_([1-9]\d*)")
_STATIC = re.compile(r"(displacement|joint_force):(.+):(\w+)@(.+)")


@dataclass(frozen=True)
class Asked:
    """A quantity.

    Parameters
    ----------
    name : str
        As it was asked for.
    kind : str
        "stiffness", "blocked_stiffness", "least_dynamic_stiffness", "frequency", "displacement",
        "joint_force" or "mass".
    unit : str
        SI.
    meaning : str
    direction : int
        Index into `DIRECTIONS`; of a frequency the mode's index from zero.
    static : StaticQuantity or None
        A displacement or joint force.
    """

    name: str
    kind: str
    unit: str
    meaning: str
    direction: int = 0
    static: StaticQuantity | None = None


@dataclass(frozen=True)
class Vibrating:
    """What the least dynamic stiffness needs beside the structure.

    Parameters
    ----------
    damping : damping of any kind or None
    band : (float, float)
        Hz.
    """

    damping: AnyDamping | None = None
    band: tuple[float, float] = (1.0, 1000.0)


def read_quantity(model: Model, name: str) -> Asked:
    """A quantity by its name.

    Parameters
    ----------
    model : Model
        Whose load cases are named.
    name : str
        As one of `FORMS`.

    Raises
    ------
    ModelError
        Another name (the message lists the forms), an unknown direction or load case.
    """
    if name == "mass":
        return Asked(name, "mass", "kg", "mass of all parts, at home")
    tool, mode, static = (p.fullmatch(name) for p in (_TOOL, _MODE, _STATIC))
    if mode:
        number = int(mode[1])
        return Asked(name, "frequency", "Hz", f"natural frequency {number}", number - 1)
    direction = tool[2] if tool else static[3] if static else ""
    if (tool or static) and direction not in DIRECTIONS:
        raise ModelError(
            visible(name),
            f'has the unknown direction "{visible(direction)}".',
            "Directions are " + ", ".join(DIRECTIONS) + ".",
        )
    turns = direction.startswith("r")
    if tool:
        model.require_tool()
        unit = "N m/rad" if turns else "N/m"
        words = {
            "stiffness": "stiffness of the tool with the other directions free to follow, 1/C_ii",
            "blocked_stiffness": "stiffness of the tool with the other directions blocked",
            "least_dynamic_stiffness": "least driving-point dynamic stiffness at the tool",
        }
        return Asked(name, tool[1], unit, words[tool[1]], DIRECTIONS.index(direction))
    if static:
        asked = StaticQuantity(static[1], static[2], direction, model.case(static[4]))
        if static[1] == "displacement":
            unit, words_ = ("rad" if turns else "m"), f"displacement of node {static[2]}"
        else:
            unit, words_ = ("N m" if turns else "N"), f"force of joint {static[2]}"
        return Asked(name, static[1], unit, words_, DIRECTIONS.index(direction), asked)
    study = ""
    if name.partition(":")[0] in ("travel", "least", "greatest"):
        study = "The travel of joints is an answer of `study` and a quantity of `design`. "
    raise ModelError(
        visible(name),
        "is no quantity that has a gradient.",
        f"{study}Ask for: " + "; ".join(FORMS) + ".",
    )


def sensitivities(
    model: Model, found: PlacedTangents, asked: Sequence[Asked], vibrating: Vibrating
) -> tuple[Array, Array, tuple[str, ...]]:
    """Values (q, p), gradients (q, g, p) and remarks, at most three solutions a pose and kind.

    Parameters
    ----------
    model : Model
    found : PlacedTangents
        At p poses.
    asked : sequence of q Asked
    vibrating : Vibrating

    Raises
    ------
    ModelError
        The least dynamic stiffness of a machine without damping.
    MechanismError, NumericalError
        A pose without an answer.
    """
    g, p = len(found.changes), found.placed.batch[0]
    values = np.full((len(asked), p), np.nan)
    rates = np.full((len(asked), g, p), np.nan)
    remarks: list[str] = []
    kinds = {a.kind for a in asked}
    if kinds & {"stiffness", "blocked_stiffness"}:
        tool = compliance_sensitivity(found.placed, found.changes)
        each = {
            "stiffness": (axis_stiffness_free(tool.compliance), tool.free),
            "blocked_stiffness": (axis_stiffness_blocked(tool.compliance), tool.blocked),
        }
        for k, a in enumerate(asked):
            if a.kind in each:
                of, by = each[a.kind]
                values[k], rates[k] = of[:, a.direction], by[:, :, a.direction]
                if not np.isfinite(values[k]).all():
                    remarks.append(
                        f"{a.name} is infinite where locked joints hold the tool: it has no "
                        "gradient there."
                    )
    if "frequency" in kinds:
        highest = max(a.direction for a in asked if a.kind == "frequency") + 1
        modes = frequency_sensitivity(found.placed, found.changes, highest)
        for k, a in enumerate(asked):
            if a.kind == "frequency":
                values[k] = modes.frequencies[:, a.direction]
                rates[k] = modes.rates[:, :, a.direction]
                if modes.repeated[:, a.direction].any():
                    remarks.append(
                        f"{a.name} occurs several times: its gradients are those of the branches "
                        "into which each parameter splits it, and do not add up."
                    )
    static = [a.static for a in asked if a.static is not None]
    if static:
        solved = static_sensitivity(found.placed, found.changes, static)
        rows = [k for k, a in enumerate(asked) if a.static is not None]
        values[rows], rates[rows] = solved.values.T, np.moveaxis(solved.rates, -1, 0)
    if "mass" in kinds:
        k = next(k for k, a in enumerate(asked) if a.kind == "mass")
        values[k], rates[k] = _mass(found.tangents)
    for k, a in enumerate(asked):
        if a.kind == "least_dynamic_stiffness":
            values[k], rates[k] = _least_dynamic(model, found, a, vibrating)
    if model.preload is not None and kinds & {"frequency", "least_dynamic_stiffness"}:
        remarks.append(
            f'The preload "{model.preload}" is left out of vibration: what a parameter does to '
            "its forces is not differentiated."
        )
    rates = np.where(found.missing, np.nan, rates)
    return values, rates, tuple(remarks)


def _least_dynamic(
    model: Model, found: PlacedTangents, one: Asked, vibrating: Vibrating
) -> tuple[Array, Array]:
    """The least dynamic stiffness (p,) and its rates (g, p)."""
    if vibrating.damping is None:
        raise ModelError("damping", "is missing.", "Add [damping], or give the machine a damping.")
    port = tool_port(model.structure.linkage, DIRECTIONS[one.direction])
    least = dynamic_sensitivity(
        found.placed, found.changes, port, vibrating.damping, vibrating.band
    )
    return least.value, least.rates


def _mass(tangents: Tangents) -> tuple[float, Array]:
    """The mass at home, kg, and its rates (g, 1): beams may be as long as a slider is out."""
    mass, *sides = (
        float(np.ravel(total_mass(m.placed))[0])
        for m in (tangents.model, *tangents.above, *tangents.below)
    )
    above, below = np.array(sides).reshape(2, -1)
    widths = np.array([c.width for c in tangents.changes])
    return mass, ((above - below) / widths)[:, None]
