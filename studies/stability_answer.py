"""How deep a machine may cut, pose by pose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.cutting import Frame, Milling, best_pockets, zero_order_lobes
from strutwork.cutting.absolute import absolute_limits, limiting_mode, turned_matrices
from strutwork.cutting.described import described_frame, described_milling, described_speeds
from strutwork.cutting.tip_dynamics import TipDynamics, tip_dynamics, tip_ports
from strutwork.errors import ModelError
from strutwork.fea import ModalRatio
from strutwork.fea.coupled import AnyDamping
from strutwork.fea.preload import preloaded
from strutwork.fea.reduction import reduce_system
from strutwork.kinematics.tool_turns import ToolTurns
from strutwork.machines.described_process import DescribedProcess
from strutwork.machines.model import Model
from strutwork.msa import LoadCase, PlacedStructure, system_of
from strutwork.outcome import Outcome, solve_poses
from strutwork.studies.answers import Column
from strutwork.studies.covering_band import band_of
from strutwork.studies.model_damping import model_damping

Array = NDArray[Any]

#: Poses whose modes are found at once.
STACK = 16

#: Directions of the feed in a turn.
FEEDS = 36

#: Times as many lines as a coarse response has: depths by speed are then certain to about 1e-4.
FINER = 2

#: The band reaches this much beyond the highest tooth frequency.
BEYOND = 1.05


def all_round(count: int) -> Array:
    """Angles (k,) of a turn, rad, from zero.

    Parameters
    ----------
    count : int
    """
    return np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)


@dataclass(frozen=True)
class Stability:
    """Limiting depths of a milling cut, by the zero-order method.

    Parameters
    ----------
    tool : str
        Node that cuts.
    process : Milling
    axes : (3, 3)
        Axes of the process as rows, unit vectors, global, where the machine stood; they turn with
        the tool.
    turns : ToolTurns
    damping : damping of any kind
    band : (float, float)
        Hz; holds the highest tooth frequency.
    speeds : (s,)
        Of the spindle, rising, rpm.
    feed_per_tooth : float
        m.
    feeds : (k,)
        Angles of the feed from the process's own, rad.
    preload : LoadCase or None
        Under which it vibrates; its forces are those at each pose.
    against : str or None
        A node of the workpiece, relative to which the tool moves.
    """

    tool: str
    process: Milling
    axes: Array
    turns: ToolTurns
    damping: AnyDamping
    band: tuple[float, float]
    speeds: Array
    feed_per_tooth: float = 1e-4
    feeds: Array = field(default_factory=lambda: all_round(FEEDS))
    preload: LoadCase | None = None
    against: str | None = None

    @classmethod
    def of(cls, model: Model, described: DescribedProcess | None = None) -> Stability:
        """As a model, or a process beside it, states.

        Parameters
        ----------
        model : Model
        described : DescribedProcess, optional
            In place of the model's own.

        Raises
        ------
        ModelError
            No process, no tool, no damping, no elastic mode.
        """
        given = described or model.process
        if given is None:
            raise ModelError(
                "process", "is missing.", "Add a table [process], or give one with --process."
            )
        damping = model_damping(model)
        if damping is None and given.modal_ratio is not None:
            damping = ModalRatio(given.modal_ratio)
        frame = described_frame(given, model.rotation)
        speeds = described_speeds(given)
        return cls.at(model, described_milling(given), frame, speeds, damping, given.feed_per_tooth)

    @classmethod
    def at(
        cls,
        model: Model,
        process: Milling,
        frame: Frame,
        speeds: ArrayLike,
        damping: AnyDamping | None,
        feed_per_tooth: float = 1e-4,
    ) -> Stability:
        """With a process and its axes where the machine stands.

        Parameters
        ----------
        model : Model
        process : Milling
        frame : Frame
            Axes of the process in global axes.
        speeds : (s,)
            rpm.
        damping : damping of any kind or None
        feed_per_tooth : float
            m.

        Raises
        ------
        ModelError
            No tool, no damping, no elastic mode.
        """
        tool = model.require_tool()
        if damping is None:
            raise ModelError(
                "damping",
                "is missing: without it no cut is stable.",
                "Add [damping] to the model, or modal_ratio to the process.",
            )
        rpm = np.asarray(speeds, dtype=float)
        vibrating = model.vibrating
        against = model.structure.linkage.against
        ports, _ = tip_ports(reduce_system(system_of(vibrating)), tool, against)
        band = band_of(vibrating, ports)
        if band is None:
            raise ModelError(
                "process",
                "needs a mode of the machine, and the structure has no elastic mode.",
                "Give its parts mass and stiffness.",
            )
        highest = max(band.high, BEYOND * float(rpm.max()) * process.teeth / 60.0)
        return cls(
            tool,
            process,
            frame.matrix,
            ToolTurns.of(model.structure.linkage, model.placement),
            damping,
            (band.low, highest),
            rpm,
            feed_per_tooth,
            preload=None if model.preload is None else model.case(model.preload),
            against=against,
        )

    @property
    def columns(self) -> tuple[Column, ...]:
        """Depths, what limits them, and the best pocket."""
        return (
            Column("limiting_depth", "m", "depth stable at every spindle speed", (), "least"),
            Column("chatter_frequency", "Hz", "frequency of chatter at the limiting depth"),
            Column("limiting_mode", "Hz", "natural frequency of the mode that limits the depth"),
            Column("least_depth", "m", "least limiting depth of all feed directions", (), "least"),
            Column("worst_feed", "rad", "angle of the feed with the least limiting depth"),
            Column(
                "depth_by_feed", "m", "limiting depth by the angle of the feed", ("feed",), "least"
            ),
            Column("pocket_speed", "Hz", "spindle speed that removes most, turns per second"),
            Column("pocket_depth", "m", "limiting depth at that speed"),
            Column(
                "removal_rate",
                "m^3/s",
                "material removed per time at that speed and depth",
                (),
                "least",
            ),
        )

    @property
    def coordinates(self) -> Mapping[str, tuple[Any, ...]]:
        """Angles of the feed, rad."""
        return {"feed": tuple(float(a) for a in self.feeds)}

    def over_feeds(self, feeds: ArrayLike) -> Stability:
        """The same with other directions of the feed.

        Parameters
        ----------
        feeds : (k,)
            rad.
        """
        return replace(self, feeds=np.asarray(feeds, dtype=float))

    def frames(self, placed: PlacedStructure) -> list[Frame]:
        """Axes of the process in global axes at each of p poses.

        Parameters
        ----------
        placed : PlacedStructure
            One batch axis (p,).
        """
        turned = self.axes @ np.swapaxes(self.turns.at(placed.placement), -1, -2)
        return [Frame(matrix) for matrix in turned]

    def tips(self, placed: PlacedStructure) -> list[TipDynamics]:
        """The tip of the tool at each of p poses.

        Parameters
        ----------
        placed : PlacedStructure
            One batch axis (p,).

        Raises
        ------
        StrutworkError
            As `strutwork.cutting.tip_dynamics.tip_dynamics`.
        """
        loaded = placed if self.preload is None else preloaded(placed, self.preload)
        return tip_dynamics(loaded, self.tool, self.damping, self.against)

    def __call__(self, placed: PlacedStructure) -> tuple[dict[str, Array], Outcome]:
        """Of a flat batch."""
        poses = placed.batch[0]
        found = {
            c.name: np.full((poses, *(len(self.feeds) for _ in c.dims)), np.nan)
            for c in self.columns
        }

        def some(index: NDArray[np.intp]) -> None:
            for part in np.array_split(index, max(1, -(-len(index) // STACK))):
                batch = placed[part]
                for k, tip, frame in zip(part, self.tips(batch), self.frames(batch), strict=True):
                    for name, value in self._one(tip, frame).items():
                        found[name][k] = value

        return found, solve_poses(some, poses)

    def _one(self, tip: TipDynamics, frame: Frame) -> dict[str, Any]:
        """The columns at one pose."""
        process = self.process
        every = np.append(0.0, self.feeds)
        limits = absolute_limits(tip, process, frame, self.band, every)
        own, rose = float(limits.depth[0]), limits.depth[1:]
        matrix = turned_matrices(process, frame, [0.0])[0]
        at = float(limits.frequencies[0])
        mode = limiting_mode(tip, matrix, at) if np.isfinite(own) else np.nan
        response = tip.in_frame(frame).response_at(tip.lines(self.band, FINER))
        lobes = zero_order_lobes(response, process).at(self.speeds)
        # a cut deeper than the cutter is wide is none
        lobes = replace(lobes, depth=np.minimum(lobes.depth, process.cutter.diameter))
        best = best_pockets(lobes, process, self.feed_per_tooth, 1)[0]
        return {
            "limiting_depth": own,
            "chatter_frequency": at,
            "limiting_mode": mode,
            "least_depth": float(rose.min()),
            "worst_feed": float(self.feeds[int(rose.argmin())]),
            "depth_by_feed": rose,
            "pocket_speed": best.speed / 60.0,
            "pocket_depth": best.depth,
            "removal_rate": best.removal_rate,
        }
