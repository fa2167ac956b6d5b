"""Controlled drives of a machine: what commands and reports say of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import degrees, isfinite
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.files import write_whole
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.vibration import Target
from strutwork.servo import ClosedLoop, LeastStiffness, Margins
from strutwork.studies.servo_loop import LoopQuestion

Array = NDArray[Any]

#: Lines of the curves that are written, beside the resonances.
LINES = 1000


@dataclass(frozen=True)
class TargetLoop:
    """Closed loops of a target, over a band.

    Parameters
    ----------
    target : Target
    question : LoopQuestion
    loop : ClosedLoop
    """

    target: Target
    question: LoopQuestion
    loop: ClosedLoop

    @classmethod
    def of(cls, target: Target, question: LoopQuestion) -> TargetLoop:
        """Close the loops of a target.

        Raises
        ------
        StrutworkError
            As `LoopQuestion.ask`.
        """
        return cls(target, question, question.ask(target.placed))

    def __repr__(self) -> str:
        return f"<TargetLoop of {self.target.title}: {self.loop!r}>"

    @property
    def band(self) -> tuple[float, float]:
        """Hz."""
        return self.question.band

    @cached_property
    def least(self) -> tuple[LeastStiffness, ...] | None:
        """Least dynamic stiffness with the servos in the loop; None of an unstable loop."""
        return self.loop.least(self.band) if self.loop.stable else None

    @cached_property
    def locked(self) -> tuple[LeastStiffness, ...] | None:
        """The same with the drives locked; None of a machine that is rigid then."""
        return self.loop.least_locked(self.band)

    @property
    def kept(self) -> str:
        """Which modes take part, and what their number may change, in words."""
        plant = self.loop.connected.plant
        error = plant.truncation(self.band[1])
        text = f"Modes: {plant.kept}"
        if error:
            text += (
                f"; error of a receptance up to {self.band[1]:.4g} Hz at most {error:.2g} of the "
                "static one"
            )
        return text

    @cached_property
    def lines(self) -> Array:
        """Frequencies of the curves, Hz, (f,)."""
        low, high = self.band
        even = np.geomspace(max(low, 1e-4 * high), high, LINES)
        near = [one.frequency for one in (*(self.least or ()), *(self.locked or ()))]
        near += [pole.frequency for pole in self.loop.poles if low < pole.frequency < high]
        return np.unique(np.concatenate([even, near]))

    @cached_property
    def curves(self) -> tuple[Array | None, Array | None]:
        """|H| at the ports with the servos in the loop, and with the drives locked, (f, o)."""

        def size(response: Array) -> Array:
            return np.asarray(np.abs(np.einsum("fii->fi", response)))

        with_servos = size(self.loop.receptance(self.lines)) if self.loop.stable else None
        locked = None
        if self.loop.locked is not None:
            locked = size(self.loop.locked.response(self.lines))
        return with_servos, locked

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers in SI."""
        loop = self.loop
        return {
            "title": self.target.title,
            "damping": str(self.target.damping),
            "loss_factor_replaced": loop.connected.plant.modes.equivalent,
            "band": list(self.band),
            "modes": loop.connected.plant.kept,
            "truncation": _number(loop.connected.plant.truncation(self.band[1])),
            "stable": loop.stable,
            "drives": [
                {
                    "drive": str(found.servo),
                    "static_stiffness": _number(found.servo.static_stiffness),
                    "following_error_per_speed": found.servo.lag,
                    "velocity_loop": _margins(found.velocity),
                    "position_loop": _margins(found.position),
                }
                for found in loop.margins
            ],
            "poles": [
                {
                    "real": pole.value.real,
                    "imaginary": pole.value.imag,
                    "frequency": pole.frequency,
                    "damping_ratio": pole.damping,
                    "part": pole.part,
                    "share": pole.share,
                    "stable": pole.stable,
                }
                for pole in loop.poles
            ],
            "dynamic_stiffness": [
                {
                    "port": str(port),
                    "with_servos": None if self.least is None else _least(self.least[i]),
                    "drives_locked": None if self.locked is None else _least(self.locked[i]),
                }
                for i, port in enumerate(loop.ports)
            ],
        }

    def files(self) -> tuple[DataFile, ...]:
        """Poles, margins and curves as CSV."""
        stem, loop = self.target.stem, self.loop
        ports = [str(port) for port in loop.ports]
        heads, arrays = ["frequency [Hz]"], [self.lines[:, None]]
        for words, curve in zip(("with servos", "drives locked"), self.curves, strict=True):
            if curve is not None:
                heads += [f"receptance at {port}, {words} [SI]" for port in ports]
                arrays.append(curve)
        return (
            csv_file(
                f"{stem}-servo-poles.csv",
                "poles of the closed loops",
                ["real [1/s]", "imaginary [1/s]", "frequency [Hz]", "damping ratio", "part"],
                [[p.value.real, p.value.imag, p.frequency, p.damping, p.part] for p in loop.poles],
            ),
            csv_file(
                f"{stem}-servo-margins.csv",
                "margins of the opened loops",
                [
                    *("drive", "loop", "gain margin", "at [Hz]", "least gain"),
                    *("phase margin [rad]", "at [Hz]", "crossover [Hz]"),
                ],
                [
                    [str(m.servo), name, *(_number(v) for v in _ordered(one))]
                    for m in loop.margins
                    for name, one in (("velocity", m.velocity), ("position", m.position))
                ],
            ),
            csv_file(
                f"{stem}-servo-response.csv",
                "receptance at the ports",
                heads,
                np.concatenate(arrays, axis=1).tolist(),
            ),
        )

    def write(self, folder: Path) -> tuple[Path, ...]:
        """Write the files."""
        found = []
        for file in self.files():
            path = folder / file.name
            write_whole(path, file.write)
            found.append(path)
        return tuple(found)


def margin_words(found: Margins) -> tuple[str, str, str]:
    """Gain margin, phase margin and bandwidth in words."""
    gain = "unlimited"
    if isfinite(found.gain):
        gain = f"{found.gain:.3g} at {found.gain_frequency:.4g} Hz"
    phase, width = "none", "none"
    if isfinite(found.phase):
        phase = f"{degrees(found.phase):.3g}° at {found.phase_frequency:.4g} Hz"
        width = f"{found.crossover:.4g}"
    return gain, phase, width


def _ordered(found: Margins) -> tuple[float, ...]:
    return (
        *(found.gain, found.gain_frequency, found.reduction),
        *(found.phase, found.phase_frequency, found.crossover),
    )


def _margins(found: Margins) -> dict[str, float | None]:
    names = (
        *("gain_margin", "gain_margin_frequency", "least_gain"),
        *("phase_margin", "phase_margin_frequency", "crossover"),
    )
    return {n: _number(v) for n, v in zip(names, _ordered(found), strict=True)}


def _least(found: LeastStiffness) -> dict[str, Any]:
    return {
        "value": found.value,
        "frequency": found.frequency,
        "static": _number(found.static),
        "certified": found.certified,
    }


def _number(value: float) -> float | None:
    """None for what is unlimited or missing."""
    return float(value) if isfinite(value) else None
