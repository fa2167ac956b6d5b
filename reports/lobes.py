"""Stability of a cut at a machine's pose: lobes from its response, limits from its modes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.cutting import (
    AbsoluteLimits,
    DepthEffects,
    DepthLimits,
    Frame,
    LobeLimits,
    Milling,
    Pocket,
    TipDynamics,
    absolute_limits,
    best_pockets,
    depth_effects,
    depth_limits,
    tip_dynamics,
    turned_matrices,
    zero_order_lobes,
)
from strutwork.cutting.tip_dynamics import tip_ports
from strutwork.errors import ModelError, NumericalError
from strutwork.fea.reduction import reduce_system
from strutwork.fea.validity import warn_beyond
from strutwork.files import write_whole
from strutwork.msa import system_of
from strutwork.reports.covering_band import covering_band
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.vibration import Target
from strutwork.studies.stability_answer import BEYOND, FEEDS, all_round

Array = NDArray[Any]

#: The deepest trial where none is given: at least this many times the absolute limit, and so many
#: times the largest limit of the lobes, but no deeper than the cutter is wide.
DEEPEST, FURTHER = 10.0, 1.2

#: Times as many lines as a coarse response has.
FINER = 4

#: A chatter frequency nearer to an end of the band, as a share, is one that lies beyond it.
EDGE = 1e-6


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
    rose : AbsoluteLimits
        Depths stable at every speed by the direction of the feed.
    effects : DepthEffects
        Of parts and modes on the absolute limit.
    note : str
        Why there are no exact limits, or what else to know.
    residual_share : float or None
        Share of the static compliance for which equivalent modes stand in the exact limits.
    """

    target: Target
    process: Milling
    absolute: tuple[float, float]
    lobes: LobeLimits
    exact: DepthLimits | None
    pockets: tuple[Pocket, ...]
    rose: AbsoluteLimits
    effects: DepthEffects
    note: str
    residual_share: float | None = None

    def __repr__(self) -> str:
        return f"<TargetLobes of {self.target.title}: {1e3 * self.absolute[0]:.4g} mm>"

    def to_dict(self, *, rose: bool = False) -> dict[str, Any]:
        """Plain numbers in SI, speeds in rpm; null where no depth is unstable.

        Parameters
        ----------
        rose : bool
            Whether the depths by direction of the feed are among them.
        """
        exact = self.exact
        return {
            "absolute_depth": self.absolute[0],
            "absolute_frequency": self.absolute[1],
            "limiting_mode": self.effects.limiting_mode,
            "effects": self.effects.to_dict(),
            "speeds_rpm": self.lobes.speeds.tolist(),
            "zero_order_depth": _finite(self.lobes.depth),
            "zero_order_frequency": _finite(self.lobes.frequencies),
            "exact_depth": None if exact is None else _finite(exact.depth),
            "exact_frequency": None if exact is None else _finite(exact.frequencies),
            "exact_residual_share": self.residual_share,
            "kinds": None if exact is None else list(exact.kinds),
            "deepest": None if exact is None else exact.deepest,
            "pockets": [
                {"speed_rpm": p.speed, "depth": p.depth, "removal_rate": p.removal_rate}
                for p in self.pockets
            ],
            **({"rose": self._rose()} if rose else {}),
            **({"note": self.note} if self.note else {}),
        }

    def _rose(self) -> dict[str, Any]:
        found = self.rose
        return {
            "feed": found.feeds.tolist(),
            "absolute_depth": _finite(found.depth),
            "absolute_frequency": _finite(found.frequencies),
        }

    def files(self) -> tuple[DataFile, DataFile, DataFile]:
        """The limits by speed and by feed direction, and the effects of parts, as CSV."""
        exact, lobes, rose = self.exact, self.lobes, self.rose
        columns = ["speed [rpm]", "zero-order depth [m]", "zero-order frequency [Hz]"]
        rows = [list(row) for row in zip(lobes.speeds, lobes.depth, lobes.frequencies, strict=True)]
        if exact is not None:
            columns += ["exact depth [m]", "exact frequency [Hz]", "kind"]
            more = zip(exact.depth, exact.frequencies, exact.kinds, strict=True)
            rows = [[*row, *further] for row, further in zip(rows, more, strict=True)]
        stem = self.target.stem
        turned = zip(rose.feeds, rose.depth, rose.frequencies, strict=True)
        return (
            csv_file(f"{stem}-lobes.csv", "limiting depths by speed", columns, _empty(rows)),
            csv_file(
                f"{stem}-rose.csv",
                "depths stable at every speed, by the direction of the feed",
                ["feed [rad]", "absolute depth [m]", "chatter frequency [Hz]"],
                _empty([list(row) for row in turned]),
            ),
            csv_file(
                f"{stem}-depth-effects.csv",
                "share by which the absolute depth grows per share of stiffness of a part",
                ["part", "effect"],
                [[part, float(e)] for part, e in self.effects.to_dict().items()],
            ),
        )

    def write(self, folder: Path, *, rose: bool = False) -> tuple[Path, ...]:
        """Write the limits by speed as CSV, and those by feed direction where asked for.

        Parameters
        ----------
        folder : Path
        rose : bool
        """
        limits, by_feed, _ = self.files()
        return tuple(
            write_whole(folder / file.name, file.write)
            for file in ((limits, by_feed) if rose else (limits,))
        )


def _finite(values: Array) -> list[float | None]:
    return [float(v) if np.isfinite(v) else None for v in values]


def _empty(rows: list[list[Any]]) -> list[list[Any]]:
    return [
        [None if isinstance(v, float) and not np.isfinite(v) else v for v in row] for row in rows
    ]


def _deepest(limits: LobeLimits, absolute: float, process: Milling) -> float:
    seen = limits.depth[np.isfinite(limits.depth)]
    depth = max(DEEPEST * absolute, FURTHER * float(seen.max(initial=0.0)))
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

    Parameters
    ----------
    target : Target
    process : Milling
    frame : Frame
        Axes of the process in global axes.
    node : str
        Where it cuts, or NODE-NODE.
    speeds : (s,)
        rpm.
    feed : float
        Per tooth, m.
    deepest : float or None
        Largest depth that is tried, m.

    Raises
    ------
    ModelError
        No damping, no mass, a node that cannot move, nothing that limits the depth.
    """
    damping = target.require_damping()
    port = target.port(f"{node}:x")
    reduced = reduce_system(system_of(target.placed))
    ports, _ = tip_ports(reduced, port.node, port.against)
    band, stop = covering_band(target.placed, ports)
    if band is None:
        raise ModelError(
            "process",
            "needs a mode in the band, and the structure has no elastic mode.",
            "Give its parts mass and stiffness.",
        )
    highest = max(band[1], BEYOND * float(speeds.max()) * process.teeth / 60.0)
    (tip,) = tip_dynamics(target.placed, port.node, damping, port.against)
    every = absolute_limits(
        tip, process, frame, (band[0], highest), np.append(0.0, all_round(FEEDS))
    )
    rose = AbsoluteLimits(every.feeds[1:], every.depth[1:], every.frequencies[1:])
    absolute = float(every.depth[0]), float(every.frequencies[0])
    if not np.isfinite(absolute[0]):
        raise ModelError(
            "lobes",
            f"have no limiting depth between {band[0]:g} and {highest:g} Hz.",
            "The directions of the cut do not meet a mode; check --axis and --feed.",
        )
    if min(absolute[1] / band[0], highest / absolute[1]) < 1.0 + EDGE:
        raise ModelError(
            "lobes",
            f"have their least depth at the end of the band, {absolute[1]:g} Hz.",
            "Ask for higher speeds, so that the band is wider.",
        )
    cutting = tip.in_frame(frame)
    response = cutting.response_at(tip.lines((band[0], highest), FINER))
    limits = zero_order_lobes(response, process).at(speeds)
    exact, share, note = _exact(
        cutting, process, speeds, limits, absolute[0], deepest, 0.5 * band[1]
    )
    matrix = turned_matrices(process, frame, [0.0])[0]
    effects = depth_effects(target.placed, port.node, damping, matrix, absolute[1], port.against)
    pockets: tuple[Pocket, ...] = ()
    if len(speeds) >= 3 and (exact is not None or np.all(np.isfinite(limits.depth))):
        pockets = best_pockets(limits if exact is None else exact, process, feed)
    shown = [absolute[1], *limits.frequencies, *(() if exact is None else exact.frequencies)]
    warn_beyond(target.placed, float(np.max(shown, where=np.isfinite(shown), initial=0.0)))
    said = " ".join(text for text in (f"Note: {stop}" if stop else "", note) if text)
    return TargetLobes(
        target, process, absolute, limits, exact, pockets, rose, effects, said, share
    )


def _exact(
    tip: TipDynamics,
    process: Milling,
    speeds: Array,
    limits: LobeLimits,
    absolute: float,
    deepest: float | None,
    highest: float,
) -> tuple[DepthLimits | None, float | None, str]:
    """Exact limits and the share of compliance by equivalent modes, or why there are none."""
    deep = _deepest(limits, absolute, process) if deepest is None else deepest
    try:
        modes = tip.modes(highest)
    except ModelError as error:
        return None, None, f"Only zero-order limits are computed. {error}"
    try:
        exact = depth_limits(modes, process, speeds, deep, min(0.5 * absolute, deep))
    except NumericalError as error:
        return None, None, f"Only zero-order limits are computed. {error}"
    return exact, modes.residual_share, ""
