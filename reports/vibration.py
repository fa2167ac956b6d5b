"""Modes and frequency responses of a model file or a machine, by the names the user gave."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea import (
    Damping,
    FrequencyResponse,
    LossFactor,
    ModalRatio,
    Modes,
    Port,
    frequency_response,
    modes,
)
from strutwork.fea.coupled import AnyDamping
from strutwork.fea.dynamic_stiffness import check_band
from strutwork.fea.idle import IdleMotion, free_motions, idle_line, idle_motions
from strutwork.fea.least_stiffness import LeastStiffness, least_dynamic_stiffness
from strutwork.fea.mode_damping import damping_ratios
from strutwork.fea.modes import searched_modes
from strutwork.fea.ports import tool_port
from strutwork.fea.uff import UniversalFile, mode_file, node_positions, response_records
from strutwork.fea.uff_write import write_universal
from strutwork.files import write_whole
from strutwork.machines import is_machine, named_machine
from strutwork.machines.model import Model
from strutwork.msa import LoadCase, PlacedStructure
from strutwork.names import choices
from strutwork.reports.data_files import csv_file
from strutwork.reports.preload_note import WATCHED, warn_of_preload
from strutwork.studies.model_damping import model_damping

Array = NDArray[Any]

#: Names that stand for the tool where no node bears them.
TOOL_NAMES = ("TCP", "tcp", "tool")

#: Why there is no stiffness between two ports.
APART = (
    "uncoupled: a load at one moves the other only by rounding errors, and the stiffness between "
    "them is infinite."
)


@dataclass(frozen=True)
class Target:
    """A structure that vibrates, at one pose.

    Parameters
    ----------
    title : str
    stem : str
        For names of files.
    placed : PlacedStructure
    nodes : tuple of str
        Those the user knows.
    damping : damping of any kind or None
    cases : tuple of LoadCase
        Loads whose forces might stiffen it; empty where it vibrates under a preload.
    """

    title: str
    stem: str
    placed: PlacedStructure
    nodes: tuple[str, ...]
    damping: AnyDamping | None
    cases: tuple[LoadCase, ...] = ()

    def port(self, text: str) -> Port:
        """Port from `NODE:x` or `NODE-NODE:x`; TCP is the tool where no node is named so.

        Raises
        ------
        ModelError
            Text of another shape, or an unknown node.
        """
        node, colon, direction = text.rpartition(":")
        tool = self.placed.structure.linkage.tool
        known = self.placed.structure.mesh_index
        if node in TOOL_NAMES and node not in known:
            if tool is None:
                raise ModelError(
                    f'port "{text}"',
                    "means the tool, but the model has none.",
                    'Add a table [tool] with tcp = "NODE", or name a node.',
                )
            text = f"{tool}{colon}{direction}"
        port = Port.parse(text, tuple(known))
        for name in (port.node, port.against):
            if name is not None and name not in known:
                remedy = choices("Nodes", name, self.nodes, 8)
                raise ModelError(f'port "{text}"', f'has no node "{name}".', remedy)
        if port.node == tool and port.against is None:
            return tool_port(self.placed.structure.linkage, str(port.direction))
        return port

    def require_damping(self) -> AnyDamping:
        """The damping.

        Raises
        ------
        ModelError
            None is given.
        """
        if self.damping is None:
            raise ModelError(
                "damping",
                "is missing: without it the response is unbounded at a resonance.",
                "Add exactly one to the model file, as in [damping] with modal_ratio = 0.01 "
                "(or loss_factor, or rayleigh), or give --modal-ratio or --loss-factor.",
            )
        return self.damping


def vibration_target(
    name: str,
    modal_ratio: float | None = None,
    loss_factor: float | None = None,
    preload: str | None = None,
    put: Callable[[Model], Model] | None = None,
) -> Target:
    """The structure that a model file or a machine's name stands for.

    Parameters are those of `vibrating_model`, as are the errors.
    """
    return model_target(*vibrating_model(name, modal_ratio, loss_factor, preload, put))


def vibrating_model(
    name: str,
    modal_ratio: float | None = None,
    loss_factor: float | None = None,
    preload: str | None = None,
    put: Callable[[Model], Model] | None = None,
) -> tuple[Model, str, Damping | None]:
    """The model that a model file or a machine's name stands for, its stem and a given damping.

    Parameters
    ----------
    name : str
        Path of a model file, or a machine of the catalogue: `NAME` or `NAME:VARIANT`.
    modal_ratio, loss_factor : float or None
        Damping in place of the file's; joints' dashpots stay.
    preload : str or None
        Load case in place of the file's preload.
    put : callable, optional
        Puts the machine at another pose; it stands at home else.

    Raises
    ------
    ModelError
        No such machine, variant or file, a variant for statics, a wrong model, both kinds of
        damping, an unknown load case.
    """
    from strutwork.machines.load import load, load_heavy

    if modal_ratio is not None and loss_factor is not None:
        raise ModelError(
            "damping", "is given both as a modal ratio and as a loss factor.", "Give one of them."
        )
    given: Damping | None = None
    if modal_ratio is not None:
        given = ModalRatio(modal_ratio)
    elif loss_factor is not None:
        given = LossFactor(loss_factor)
    if is_machine(name):
        if preload is not None:
            raise ModelError(
                name, "has no load cases to preload it.", "Describe it in a model file."
            )
        model = load_heavy(name)
        return model if put is None else put(model), named_machine(name).stem, given
    model = load(name)
    model = model if put is None else put(model)
    if preload is not None:
        model = replace(model, preload=preload)
    return model, Path(name).stem, given


def model_target(model: Model, stem: str, given: Damping | None = None) -> Target:
    """A model under its preload, where it names one, with its damping or `given`."""
    title = model.title or "Model"
    if model.preload is not None:
        title += f"; preload: {model.preload}"
    cases = model.cases if model.preload is None else ()
    damping = model_damping(model, given)
    return Target(title, stem, model.vibrating, model.nodes, damping, cases)


@dataclass(frozen=True)
class TargetModes:
    """Modes of a target.

    Parameters
    ----------
    target : Target
    modes : Modes
        Rigid-body modes first.
    ratios : (m,) or None
        Damping ratios, not a number where one is withheld; None without damping.
    idle : tuple of IdleMotion
        Those of the rigid-body modes that neither strain anything nor move the tool.
    """

    target: Target
    modes: Modes
    ratios: Array | None
    idle: tuple[IdleMotion, ...] = ()

    def __repr__(self) -> str:
        return f"<TargetModes of {self.target.title}: {self.modes!r}>"

    @property
    def elastic(self) -> TargetModes:
        """The same without the rigid-body modes."""
        after = slice(int(self.modes.rigid_body_modes), None)
        ratios = None if self.ratios is None else self.ratios[after]
        return TargetModes(self.target, some_modes(self.modes, after), ratios, self.idle)

    @property
    def rigid_line(self) -> str:
        """What to say of the rigid-body modes, and which of them are idle."""
        rigid = int(self.modes.rigid_body_modes)
        if not rigid:
            return ""
        text = f"{rigid} rigid-body mode{'s' if rigid > 1 else ''} at 0 Hz."
        return f"{text} {idle_line(self.idle)}".rstrip()

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers in SI, shapes at the nodes the user knows."""
        found = self.modes
        idle = [{"parts": list(m.parts), "description": str(m)} for m in self.idle]
        index = found.placed.structure.mesh_index
        return {
            "frequencies": found.frequencies.tolist(),
            "rigid_body_modes": int(found.rigid_body_modes),
            "shapes": [
                {n: shape[index[n]].tolist() for n in self.target.nodes} for shape in found.shapes
            ],
            "effective_mass": found.effective_mass.tolist(),
            "damping_ratios": self._ratios(),
            **({"idle_motions": idle} if idle else {}),
        }

    def write(self, folder: Path) -> tuple[Path, ...]:
        """Write the modes with their mesh as a universal file."""
        content = mode_file(self.modes, self._ratios())
        return (write_universal(folder / f"{self.target.stem}-modes.uff", content),)

    def _ratios(self) -> list[float | None]:
        if self.ratios is None:
            return [None] * len(self.modes.frequencies)
        return [float(r) if np.isfinite(r) else None for r in self.ratios]


def target_modes(target: Target, count: int) -> TargetModes:
    """The `count` lowest elastic modes of a target, and before them all its rigid-body modes.

    With damping ratios where it has damping.
    """
    rigid = free_motions(target.placed)
    found = modes(target.placed, count + rigid)
    warn_of_preload(found, target.cases)
    # a preload gives some free motions a frequency
    rigid = int(found.rigid_body_modes)
    found = some_modes(found, slice(rigid + count))
    exist = len(found.frequencies) - rigid
    if exist < count:
        note = f"{count} modes were requested, but only {exist} exist."
        found = replace(found, note=note)
    ratios = None if target.damping is None else damping_ratios(found, target.damping)
    idle = idle_motions(target.placed)
    return TargetModes(target, found, ratios, idle if len(idle) <= rigid else ())


def some_modes(found: Modes, which: slice) -> Modes:
    """Some of the modes.

    Parameters
    ----------
    found : Modes
    which : slice
    """
    return replace(
        found,
        frequencies=found.frequencies[which],
        shapes=found.shapes[which],
        effective_mass=found.effective_mass[which],
        energy_shares=found.energy_shares[which],
    )


@dataclass(frozen=True)
class TargetResponse:
    """Receptance between two ports of a target, and its least dynamic stiffness.

    Parameters
    ----------
    target : Target
    response : FrequencyResponse
        One output, one input.
    least : LeastStiffness
    """

    target: Target
    response: FrequencyResponse
    least: LeastStiffness

    def __repr__(self) -> str:
        return f"<TargetResponse of {self.target.title}: {self.least!r}>"

    @property
    def is_relative(self) -> bool:
        """Whether a port moves or loads one node against another."""
        return any(p.against is not None for p in (self.least.input, self.least.output))

    @property
    def receptance(self) -> Array:
        """Complex, (f,)."""
        return np.asarray(self.response.receptance[:, 0, 0])

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers in SI; without a least stiffness, and with a reason, where none exists."""
        apart = self.least.uncoupled
        return {
            "frequencies": self.response.frequencies.tolist(),
            "receptance": {
                "real": self.receptance.real.tolist(),
                "imag": self.receptance.imag.tolist(),
            },
            "minimum_dynamic_stiffness": {
                "value": None if apart else self.least.value,
                "frequency": None if apart else self.least.frequency,
                "certified": self.least.certified,
            },
            "static_stiffness": self.least.static,
            **({"reason": f"{self.least.input} and {self.least.output}: {APART}"} if apart else {}),
        }

    def write(self, folder: Path) -> tuple[Path, ...]:
        """Write the response as CSV, and as a universal file (58) unless a port is relative."""
        unit = receptance_unit(self.least.output, self.least.input)
        table = csv_file(
            f"{self.target.stem}-frf.csv",
            "frequency response",
            ["frequency, Hz", f"real part, {unit}", f"imaginary part, {unit}"],
            np.column_stack(
                [self.response.frequencies, self.receptance.real, self.receptance.imag]
            ).tolist(),
        )
        written = write_whole(folder / table.name, table.write)
        if self.is_relative:
            return (written,)
        placed = self.target.placed
        everywhere = node_positions(placed.structure.mesh_nodes, placed.positions)
        ends = {p.node for p in (self.least.input, self.least.output)}
        content = UniversalFile(
            response_records(self.response),
            positions={node: everywhere[node] for node in everywhere if node in ends},
        )
        return (write_universal(folder / f"{self.target.stem}-frf.uff", content), written)


def receptance_unit(output: Port, given: Port) -> str:
    """Unit of the receptance between two ports."""
    turns, twists = (str(p.direction).startswith("r") for p in (output, given))
    return f"{'rad' if turns else 'm'}/{'(N·m)' if twists else 'N'}"


def target_response(
    target: Target, given: Port, output: Port, band: tuple[float, float], lines: int
) -> TargetResponse:
    """Receptance with all modes at evenly spaced lines, and the exact minimum of 1/|H|.

    Raises
    ------
    ModelError
        An empty band, fewer than two lines, no damping, a port that cannot move.
    """
    check_band(*band)
    damping = target.require_damping()
    if lines < 2:
        raise ModelError("lines", f"{lines} requested.", "Request at least two.")
    response = frequency_response(
        target.placed, [given], [output], np.linspace(*band, lines), damping, "all_modes"
    )
    if target.cases:
        # these modes are looked at and not shown
        warn_of_preload(searched_modes(target.placed, WATCHED), target.cases)
    least = least_dynamic_stiffness(target.placed, given, output, damping, band)
    return TargetResponse(target, response, least)
