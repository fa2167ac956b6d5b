"""Stability of a cut at a machine's pose: lobes from its response, limits from its modes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.cutting import (
    DepthLimits,
    Frame,
    LobeLimits,
    Milling,
    Pocket,
    TipModes,
    best_pockets,
    computed_response,
    depth_limits,
    zero_order_lobes,
)
from strutwork.errors import ModelError, NumericalError
from strutwork.fea import Damping, modal_model
from strutwork.fea.frf import frequency_response
from strutwork.files import write_whole
from strutwork.reports.covering_band import covering_band
from strutwork.reports.data_files import csv_file
from strutwork.reports.vibration import Target

Array = NDArray[Any]

#: Lines of the response.
LINES = 4000

#: The deepest trial where none is given: at least this many times the absolute limit, and so many
#: times the largest limit of the lobes, but no deeper than the cutter is wide.
DEEPEST, BEYOND = 10.0, 1.2


@dataclass(frozen=True)
class TargetLobes:
    """Limits of a cut over spindle speeds.

    Parameters
    ----------
    target : Target
    process : Milling
    absolute : (float, float)
        Depth that is stable at every speed, m, and its chatter frequency, Hz; zero order.
    lobes : LobeLimits
        Zero order.
    exact : DepthLimits or None
    pockets : tuple of Pocket
        Of the exact limits, or of the lobes where there are none.
    note : str
        Why there are no exact limits, or what else to know.
    """

    target: Target
    process: Milling
    absolute: tuple[float, float]
    lobes: LobeLimits
    exact: DepthLimits | None
    pockets: tuple[Pocket, ...]
    note: str

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers in SI, speeds in rpm; null where no depth is unstable."""
        exact = self.exact
        return {
            "absolute_depth": self.absolute[0],
            "absolute_frequency": self.absolute[1],
            "speeds_rpm": self.lobes.speeds.tolist(),
            "zero_order_depth": _finite(self.lobes.depth),
            "zero_order_frequency": _finite(self.lobes.frequencies),
            "exact_depth": None if exact is None else _finite(exact.depth),
            "exact_frequency": None if exact is None else _finite(exact.frequencies),
            "kinds": None if exact is None else list(exact.kinds),
            "deepest": None if exact is None else exact.deepest,
            "pockets": [
                {"speed_rpm": p.speed, "depth": p.depth, "removal_rate": p.removal_rate}
                for p in self.pockets
            ],
            **({"note": self.note} if self.note else {}),
        }

    def write(self, folder: Path) -> Path:
        """Write the limits by speed as CSV."""
        exact, lobes = self.exact, self.lobes
        columns = ["speed [rpm]", "zero-order depth [m]", "zero-order frequency [Hz]"]
        rows = [list(row) for row in zip(lobes.speeds, lobes.depth, lobes.frequencies, strict=True)]
        if exact is not None:
            columns += ["exact depth [m]", "exact frequency [Hz]", "kind"]
            more = zip(exact.depth, exact.frequencies, exact.kinds, strict=True)
            rows = [[*row, *further] for row, further in zip(rows, more, strict=True)]
        file = csv_file(f"{self.target.stem}-lobes.csv", "limits", columns, _empty(rows))
        path = folder / file.name
        write_whole(path, file.write)
        return path


def _finite(values: Array) -> list[float | None]:
    return [float(v) if np.isfinite(v) else None for v in values]


def _empty(rows: list[list[Any]]) -> list[list[Any]]:
    return [
        [None if isinstance(v, float) and not np.isfinite(v) else v for v in row] for row in rows
    ]


def _deepest(limits: LobeLimits, absolute: float, process: Milling) -> float:
    seen = limits.depth[np.isfinite(limits.depth)]
    depth = max(DEEPEST * absolute, BEYOND * float(seen.max(initial=0.0)))
    return min(depth, process.cutter.diameter)


def target_lobes(
    target: Target,
    process: Milling,
    frame: Frame,
    node: str,
    speeds: Array,
    feed: float,
    deepest: float | None,
) -> TargetLobes:
    """Zero-order lobes and exact limits of a target.

    Raises
    ------
    ModelError
        No damping, no mass, a node that cannot move, nothing that limits the depth.
    """
    damping = target.require_damping()
    ports = [target.port(f"{node}:{direction}") for direction in "xyz"]
    band, stop = covering_band(target.placed, ports)
    if band is None:
        raise ModelError(
            "lobes",
            "need a mode in the band, and the structure has no elastic mode.",
            "Give its parts mass and stiffness.",
        )
    highest = max(band[1], 1.05 * float(speeds.max()) * process.teeth / 60.0)
    lines = np.linspace(band[0], highest, LINES)
    response = frequency_response(target.placed, ports, ports, lines, damping)
    pose = (0,) * len(target.placed.batch)
    found = zero_order_lobes(computed_response(response, pose, frame), process)
    absolute = found.absolute
    if not np.isfinite(absolute[0]):
        raise ModelError(
            "lobes",
            f"have no limiting depth between {lines[0]:g} and {lines[-1]:g} Hz.",
            "The directions of the cut do not meet a mode; check --axis and --feed.",
        )
    if found.at_edge:
        raise ModelError(
            "lobes",
            f"have their least depth at the end of the band, {absolute[1]:g} Hz.",
            "Ask for higher speeds, so that the band is wider.",
        )
    limits = found.at(speeds)
    exact, note = None, f"Note: {stop}" if stop else ""
    if isinstance(damping, Damping) and not damping.structural:
        model = modal_model(target.placed, ports, damping)
        modes = TipModes.from_model(model, 0, frame, 0.5 * band[1])
        deep = _deepest(limits, absolute[0], process) if deepest is None else deepest
        try:
            exact = depth_limits(modes, process, speeds, deep, min(0.5 * absolute[0], deep))
        except NumericalError as error:
            note = f"Only zero-order limits are computed. {error}"
    else:
        note = (
            f"Only zero-order limits are computed: the damping ({damping}) is not viscous by "
            "modes. Exact limits need a modal ratio or Rayleigh damping, and joints without "
            "dashpots."
        )
    pockets: tuple[Pocket, ...] = ()
    if len(speeds) >= 3 and (exact is not None or np.all(np.isfinite(limits.depth))):
        pockets = best_pockets(limits if exact is None else exact, process, feed)
    return TargetLobes(target, process, absolute, limits, exact, pockets, note)
