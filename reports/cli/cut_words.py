"""A cut from the options of a command, over that of a process file or of the model."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.cutting import (
    Cutter,
    Frame,
    Milling,
    described_frame,
    described_milling,
    described_speeds,
    material,
)
from strutwork.errors import ModelError
from strutwork.machines.described_process import DescribedProcess
from strutwork.machines.model import Model
from strutwork.machines.process_file import read_process
from strutwork.units import ANGLE, LENGTH, quantity

Array = NDArray[Any]

#: What --tool takes, and the dimension of each.
TOOL = {"diameter": LENGTH, "helix": ANGLE, "lead": ANGLE}

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}

#: Speeds at most.
MOST = 2000


@dataclass(frozen=True)
class CutWords:
    """What a command says of a cut; None where it says nothing.

    Parameters
    ----------
    process : str or None
        A process file.
    tool, material, speeds, axis, feed, feed_per_tooth, way : str or None
    immersion : float or None
    """

    process: str | None = None
    tool: str | None = None
    material: str | None = None
    speeds: str | None = None
    immersion: float | None = None
    way: str | None = None
    axis: str | None = None
    feed: str | None = None
    feed_per_tooth: str | None = None

    def of(self, model: Model) -> Cut:
        """The cut of a machine where it stands.

        Parameters
        ----------
        model : Model

        Raises
        ------
        ModelError
            An option that is needed, as neither a process file nor the model states it; words
            that cannot be read.
        """
        given = model.process if self.process is None else read_process(self.process)
        speeds = _speeds(self.speeds, given)
        if given is None:
            milling = self._milling()
            frame = Frame.along(
                direction_of(self.axis or "z", "--axis"), direction_of(self.feed or "x", "--feed")
            )
            name, per_tooth, ratio = _needed("--material", self.material), 1e-4, None
        else:
            milling = self._changed(described_milling(given))
            frame = described_frame(given, model.rotation)
            if self.axis or self.feed:
                axis = direction_of(self.axis, "--axis") if self.axis else frame.matrix[2]
                feed = direction_of(self.feed, "--feed") if self.feed else frame.matrix[0]
                frame = Frame.along(axis, feed)
            name = self.material or given.material or given.source
            per_tooth, ratio = given.feed_per_tooth, given.modal_ratio
        if self.feed_per_tooth is not None:
            per_tooth = quantity(self.feed_per_tooth, LENGTH, "--feed-per-tooth")
        return Cut(milling, frame, speeds, per_tooth, name, ratio)

    def _milling(self) -> Milling:
        way: Any = self.way or "down"
        immersion = 1.0 if self.immersion is None else self.immersion
        cutter = cutter_of(_needed("--tool", self.tool))
        file, _, entry = _needed("--material", self.material).rpartition(":")
        return Milling(cutter, material(entry, file or None), immersion, way)

    def _changed(self, milling: Milling) -> Milling:
        new: dict[str, Any] = {}
        if self.tool is not None:
            new["cutter"] = cutter_of(self.tool)
        if self.material is not None:
            file, _, entry = self.material.rpartition(":")
            new["coefficients"] = material(entry, file or None)
        if self.immersion is not None:
            new["immersion"] = self.immersion
        if self.way is not None:
            new["way"] = self.way
        return replace(milling, **new)


@dataclass(frozen=True)
class Cut:
    """A cut that a machine is asked for.

    Parameters
    ----------
    process : Milling
    frame : Frame
        Axes of the process in global axes.
    speeds : (s,)
        rpm.
    feed_per_tooth : float
        m.
    material : str
        In words.
    modal_ratio : float or None
        Damping of a machine that states none, no unit.
    """

    process: Milling
    frame: Frame
    speeds: Array
    feed_per_tooth: float
    material: str
    modal_ratio: float | None


def _needed(option: str, text: str | None) -> str:
    if text is None:
        raise ModelError(
            option,
            "is missing, and neither --process nor the model states a process.",
            "Give --tool, --material and --speeds, or --process FILE.",
        )
    return text


def _speeds(text: str | None, given: DescribedProcess | None) -> Array:
    if text is None and given is not None:
        return described_speeds(given)
    return speeds_of(_needed("--speeds", text))


def cutter_of(text: str) -> Cutter:
    """The cutter of --tool.

    Raises
    ------
    ModelError
        A word of another shape, no diameter, no teeth.
    """
    numbers: dict[str, float] = {}
    for word in text.split(","):
        key, sign, value = (part.strip() for part in word.partition("="))
        if not sign or key not in (*TOOL, "teeth") or key in numbers:
            raise ModelError(
                "--tool",
                f'"{word.strip()}" cannot be read.',
                "Write diameter=20mm,teeth=4 and, if needed, helix=30deg and lead=45deg.",
            )
        if key == "teeth":
            if not (value.isdecimal() and value.isascii() and len(value) < 4):
                raise ModelError("--tool", f'has "{value}" teeth.', "Give a whole number from 1.")
            numbers[key] = int(value)
        else:
            numbers[key] = quantity(value, TOOL[key], f"--tool, {key}")
    for key in ("diameter", "teeth"):
        if key not in numbers:
            raise ModelError("--tool", f"has no {key}.", "Write diameter=20mm,teeth=4.")
    teeth = int(numbers.pop("teeth"))
    return Cutter(numbers.pop("diameter"), teeth, **numbers)


def speeds_of(text: str) -> Array:
    """Speeds (s,) of LOW..HIGH:N, rpm.

    Raises
    ------
    ModelError
        Text of another shape, or numbers out of range.
    """
    span, _, count = text.partition(":")
    low, dots, high = span.partition("..")
    try:
        first, last, number = float(low), float(high if dots else low), int(count or "1")
    except ValueError:
        first, last, number = np.nan, np.nan, 0
    good = 0 < first <= last < np.inf and 1 <= number <= MOST and (number > 1 or first == last)
    if not good:
        raise ModelError(
            "--speeds",
            f'"{text}" cannot be read.',
            f"Write LOW..HIGH:N in rpm with up to {MOST} speeds, as in 2000..12000:51.",
        )
    return np.linspace(first, last, number)


def direction_of(text: str, option: str) -> tuple[float, float, float]:
    """A direction of x, -y, z, or three numbers.

    Raises
    ------
    ModelError
        Text of another shape.
    """
    bare = text.strip().removeprefix("-")
    if bare in AXES:
        sign = -1.0 if text.strip().startswith("-") else 1.0
        x, y, z = AXES[bare]
        return (sign * x, sign * y, sign * z)
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        x = y = z = np.nan
    if not np.all(np.isfinite([x, y, z])):
        raise ModelError(
            option, f'"{text}" is no direction.', "Write x, y, z, -x, -y, -z or three numbers."
        )
    return (x, y, z)
