"""What a vibration chapter shows of one structure: modes, responses at the tool, exact minima."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.fea import FrequencyResponse, ModalRatio, Modes, frequency_response
from strutwork.fea.frf import response_at
from strutwork.fea.least_stiffness import LeastStiffness, least_dynamic_stiffness
from strutwork.fea.ports import tool_ports
from strutwork.fea.validity import beyond
from strutwork.kinematics import GROUND
from strutwork.machines.catalogue import Machine
from strutwork.machines.model import Model
from strutwork.msa import PlacedStructure
from strutwork.reports.covering_band import covering_band
from strutwork.reports.vibration import Target, TargetModes, model_target, target_modes
from strutwork.studies.dynamic import BAND, GRID_STEP, MODES, ONE_PERCENT, at_home

Array = NDArray[Any]
AXES = ("x", "y", "z")

#: Frequency lines of a drawn response, beside those of its minima.
LINES = 600


@dataclass(frozen=True)
class VibrationStudy:
    """A structure's vibration at one pose.

    Parameters
    ----------
    key : str
        For names of figures and files.
    title : str
    found : TargetModes
    lines : tuple of (str, str)
        Pairs of nodes that rigid parts connect.
    band : (float, float)
        Hz; of the minima.
    response : FrequencyResponse or None
        Receptances at the tool along x, y, z; None without a tool or damping.
    least : tuple of LeastStiffness
        One an axis.
    grid : (3,)
        Least 1/|H_ii| on the multiples of `GRID_STEP`, N/m.
    stop : str
        Empty, or where the band stops though modes beyond it carry static compliance.
    """

    key: str
    title: str
    found: TargetModes
    lines: tuple[tuple[str, str], ...]
    band: tuple[float, float]
    response: FrequencyResponse | None
    least: tuple[LeastStiffness, ...]
    grid: Array
    stop: str = ""

    def __repr__(self) -> str:
        return f"<VibrationStudy of {self.title}: {self.modes!r}>"

    @cached_property
    def elastic(self) -> TargetModes:
        """Lowest modes that strain something, with their damping ratios."""
        return self.found.elastic

    @property
    def modes(self) -> Modes:
        """Lowest elastic modes."""
        return self.elastic.modes

    @property
    def validity(self) -> str:
        """Empty, or which superelement is shown beyond the frequencies to which it holds."""
        return beyond(self.placed, max(self.band[1], *self.modes.frequencies, 0.0))

    @property
    def relative(self) -> str:
        """Words behind the tool where it is relative to a workpiece, else none."""
        return self.placed.structure.linkage.relative_to

    @property
    def placed(self) -> PlacedStructure:
        """The structure."""
        return self.found.target.placed

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers in SI."""
        return {
            **self.found.to_dict(),
            "damping": str(self.found.target.damping),
            "band": list(self.band),
            "minima": {
                axis: {
                    "value": least.value,
                    "frequency": least.frequency,
                    "static": least.static,
                    "certified": least.certified,
                    "grid": float(grid),
                }
                for axis, least, grid in zip(AXES, self.least, self.grid, strict=False)
            },
        }


def study_machine_vibration(
    key: str,
    title: str,
    machine: Machine,
    damping: ModalRatio = ONE_PERCENT,
    band: tuple[float, float] = BAND,
) -> VibrationStudy:
    """A machine at home; the band of its minima in Hz.

    Raises
    ------
    ModelError
        No mass or no tool.
    """
    placed = at_home(machine)
    target = Target(title, key, placed, placed.structure.linkage.nodes, damping)
    beams = {frozenset(b.nodes) for b in placed.structure.beams}
    lines = [(a, b) for a, b in machine.skeleton() if frozenset((a, b)) not in beams]
    return _study(target, lines, band)


def study_model_vibration(model: Model, key: str) -> VibrationStudy:
    """A model file's structure.

    Raises
    ------
    ModelError
        No mass, or all locked.
    """
    target = model_target(model if model.title else replace(model, title=key), key)
    return _study(target, drawn_lines(model), None)


def drawn_lines(model: Model) -> tuple[tuple[str, str], ...]:
    """Pairs of nodes that rigid parts of a model connect, as they are drawn.

    Parameters
    ----------
    model : Model
    """
    known = set(model.placed.structure.mesh_nodes)
    beams = {frozenset(b.nodes) for b in model.structure.beams}
    linkage = model.structure.linkage
    inside = {node for solid in model.solids for node in solid.nodes}
    # a solid is drawn by its own edges
    drawn = [b for b in linkage.bodies if b.name != GROUND and not inside.intersection(b.nodes)]
    return tuple(
        (body.nodes[0], other)
        for body in (*drawn, *(model.structure.rigid if inside else ()))
        for other in body.nodes[1:]
        if {body.nodes[0], other} <= known and frozenset((body.nodes[0], other)) not in beams
    )


def has_mass(model: Model) -> bool:
    """Whether a model's structure has mass to vibrate."""
    structure = model.structure
    heavy = structure.masses or model.solids
    return bool(heavy) or any(b.material.density for b in structure.beams)


def _study(
    target: Target, lines: Sequence[tuple[str, str]], band: tuple[float, float] | None
) -> VibrationStudy:
    found = target_modes(target, MODES)
    linkage = target.placed.structure.linkage
    tool = linkage.tool
    stop = ""
    if band is None and tool is not None and target.damping is not None:
        band, stop = covering_band(target.placed, tool_ports(linkage))
    if tool is None or target.damping is None or band is None:
        span = band or (0.0, 0.0)
        return VibrationStudy(
            target.stem, target.title, found, tuple(lines), span, None, (), np.empty(0)
        )
    ports = tool_ports(linkage)
    least = tuple(least_dynamic_stiffness(target.placed, p, p, target.damping, band) for p in ports)
    drawn = np.unique(
        np.concatenate([np.geomspace(*band, LINES), [one.frequency for one in least]])
    )
    steps = np.arange(np.ceil(band[0] / GRID_STEP), np.floor(band[1] / GRID_STEP) + 1) * GRID_STEP
    response = frequency_response(target.placed, ports, ports, drawn, target.damping, "all_modes")
    coarse = np.full(len(AXES), np.nan)
    if steps.size:
        at = response_at(target.placed, ports, ports, steps, target.damping, "all_modes")
        coarse = (1.0 / np.abs(np.einsum("fii->fi", at.receptance))).min(axis=0)
    return VibrationStudy(
        target.stem, target.title, found, tuple(lines), band, response, least, coarse, stop
    )
