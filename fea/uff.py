"""What a universal file (UFF) holds: measured or computed functions, modes and the nodes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.fea.frf import FrequencyResponse
from strutwork.fea.modes import Modes
from strutwork.fea.ports import Port
from strutwork.kinematics import DIRECTIONS

Array = NDArray[Any]

Motion = Literal["displacement", "velocity", "acceleration"]

#: Motions by rising power of iω.
MOTIONS: tuple[Motion, ...] = ("displacement", "velocity", "acceleration")

#: ISO 7626 names of motion per force.
FUNCTION_NAMES: Mapping[Motion, str] = MappingProxyType(
    {"displacement": "receptance", "velocity": "mobility", "acceleration": "accelerance"}
)


@dataclass(frozen=True)
class FrfRecord:
    """One frequency response function.

    Parameters
    ----------
    output, input : (str, str)
        Node and direction of the motion and of the force.
    frequencies : (f,)
        Hz, ascending.
    values : (f,)
        Complex motion per force, m/N, m/(N·s), m/(N·s²) and the like of rotations.
    motion : "displacement", "velocity" or "acceleration"
    run : str
        Tells functions between the same ends apart, as in `#2`.

    Raises
    ------
    ModelError
        An unknown direction or motion, lengths that differ, frequencies that do not rise, a
        number that is not finite.
    """

    output: tuple[str, str]
    input: tuple[str, str]
    frequencies: Array
    values: Array
    motion: Motion = "displacement"
    run: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "frequencies", np.asarray(self.frequencies, dtype=float))
        object.__setattr__(self, "values", np.asarray(self.values, dtype=complex))
        problem = remedy = ""
        if self.frequencies.ndim != 1 or self.frequencies.shape != self.values.shape:
            problem = f"has {self.frequencies.size} frequencies and {self.values.size} values."
            remedy = "Give one value per frequency."
        elif len(self.frequencies) < 2:
            problem, remedy = "has fewer than two lines.", "Give a frequency axis."
        elif not (np.all(np.isfinite(self.frequencies)) and np.all(np.isfinite(self.values))):
            problem = "contains a number that is not finite."
            remedy = "Repair or remove the lines that have no value."
        elif self.frequencies[0] < 0 or np.any(np.diff(self.frequencies) <= 0):
            problem, remedy = "has frequencies that do not ascend.", "Sort its lines."
        elif self.motion not in MOTIONS:
            problem, remedy = f'has the motion "{self.motion}".', ", ".join(MOTIONS) + "."
        elif not {self.output[1], self.input[1]} <= set(DIRECTIONS):
            problem = f'has the directions "{self.output[1]}" and "{self.input[1]}".'
            remedy = "Directions are " + ", ".join(DIRECTIONS) + "."
        if problem:
            raise ModelError(f"function {self.name}", problem, remedy)

    def __repr__(self) -> str:
        return (
            f"<FrfRecord {self.name}: {FUNCTION_NAMES[self.motion]}, {len(self.frequencies)} lines>"
        )

    @property
    def name(self) -> str:
        """Output and input, as in `TCP:x / TCP:x`, and the run where there are several."""
        return f"{':'.join(self.output)} / {':'.join(self.input)} {self.run}".rstrip()

    def as_motion(self, motion: Motion) -> Array:
        """Values brought to another motion, (f,).

        Parameters
        ----------
        motion : "displacement", "velocity" or "acceleration"

        Raises
        ------
        ModelError
            A line at zero frequency that would have to be divided by zero, or a number that
            grows beyond all numbers.
        """
        power = MOTIONS.index(motion) - MOTIONS.index(self.motion)
        if power < 0 and self.frequencies[0] == 0:
            raise ModelError(
                f"function {self.name}",
                f"has a line at 0 Hz, where {self.motion} gives no information on {motion}.",
                "Omit that line.",
            )
        if not power:
            return np.asarray(self.values)
        with np.errstate(all="ignore"):
            found = np.asarray(self.values * (2j * np.pi * self.frequencies) ** power)
        if not np.all(np.isfinite(found)):
            raise ModelError(
                f"function {self.name}",
                f"is out of range as {motion}.",
                "Check its unit and its frequencies.",
            )
        return found


@dataclass(frozen=True)
class ModeRecord:
    """One mode at some nodes.

    Parameters
    ----------
    frequency : float
        Hz.
    damping_ratio : float or None
        Viscous ζ, no unit; None where the source has none.
    nodes : tuple of str
    shape : (n, 6)
        Real or complex, of any unit; directions that the source does not have are zero.

    Raises
    ------
    ModelError
        A shape of another size, or a number that is not finite.
    """

    frequency: float
    damping_ratio: float | None
    nodes: tuple[str, ...]
    shape: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "shape", np.asarray(self.shape))
        numbers = [self.frequency, *([] if self.damping_ratio is None else [self.damping_ratio])]
        if self.shape.shape != (len(self.nodes), 6):
            raise ModelError(
                f"mode at {self.frequency:g} Hz",
                f"has {len(self.nodes)} nodes and a shape of {self.shape.shape}.",
                "Give six numbers per node.",
            )
        if not (np.all(np.isfinite(numbers)) and np.all(np.isfinite(self.shape))):
            raise ModelError(
                f"mode at {self.frequency:g} Hz",
                "contains a number that is not finite.",
                "Repair the source or omit the mode.",
            )

    def __repr__(self) -> str:
        return f"<ModeRecord: {self.frequency:.4g} Hz, {len(self.nodes)} nodes>"


@dataclass(frozen=True)
class UniversalFile:
    """Content of a universal file.

    Parameters
    ----------
    functions : tuple of FrfRecord
        Data sets 58 and 58b; their names differ.
    modes : tuple of ModeRecord
        Data sets 55 and 2414.
    positions : mapping of node to (3,)
        Data sets 2411 and 15, m.
    lines : tuple of (str, str)
        Data sets 2412 and 82 as lines for drawing.
    ignored : tuple of str
        What was there and is not used, in words, once for each time.
    notes : tuple of str
        What was assumed or changed in reading, in words.
    """

    functions: tuple[FrfRecord, ...] = ()
    modes: tuple[ModeRecord, ...] = ()
    positions: Mapping[str, Array] = field(default_factory=lambda: MappingProxyType({}))
    lines: tuple[tuple[str, str], ...] = ()
    ignored: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return (
            f"<UniversalFile: {len(self.functions)} functions, {len(self.modes)} modes, "
            f"{len(self.positions)} nodes>"
        )

    @property
    def nodes(self) -> tuple[str, ...]:
        """Every node that is named, each once."""
        named: list[str] = [*self.positions]
        named += [node for line in self.lines for node in line]
        named += [node for f in self.functions for node, _ in (f.output, f.input)]
        named += [node for mode in self.modes for node in mode.nodes]
        return tuple(dict.fromkeys(named))


def response_records(response: FrequencyResponse) -> tuple[FrfRecord, ...]:
    """Receptances of a computed response of one pose, one record per pair of ports.

    Parameters
    ----------
    response : FrequencyResponse
        At one pose.

    Raises
    ------
    ModelError
        Several poses, or a port that is no single direction of one node.
    """
    if response.receptance.ndim != 3:
        raise ModelError("frequency response", "is of several poses.", "Choose one.")
    return tuple(
        FrfRecord(
            _degree(output), _degree(given), response.frequencies, response.receptance[:, o, i]
        )
        for o, output in enumerate(response.outputs)
        for i, given in enumerate(response.inputs)
    )


def _degree(port: Port) -> tuple[str, str]:
    if port.against is not None or not isinstance(port.direction, str):
        raise ModelError(
            f"port {port}",
            (
                "is not a single direction of one node, the only kind that a universal file can "
                "contain."
            ),
            "Write it as CSV.",
        )
    return port.node, port.direction


def mode_file(modes: Modes, damping_ratios: Sequence[float | None] | None = None) -> UniversalFile:
    """Content of a universal file from computed modes of one pose, with the mesh for drawing.

    Parameters
    ----------
    modes : Modes
        At one pose, m of them.
    damping_ratios : sequence of m float or None, optional
        ζ, no unit; None where it is not known.

    Raises
    ------
    ModelError
        Several poses.
    """
    if modes.placed.batch != ():
        raise ModelError("modes", "are of several poses.", "Choose one.")
    structure = modes.placed.structure
    names = structure.mesh_nodes
    ratios = damping_ratios or [None] * len(modes.frequencies)
    return UniversalFile(
        modes=tuple(
            ModeRecord(float(f), ratio, names, shape)
            for f, ratio, shape in zip(modes.frequencies, ratios, modes.shapes, strict=True)
        ),
        positions=node_positions(names, modes.placed.positions),
        lines=tuple((names[a], names[b]) for _, a, b in structure.segments),
    )


def node_positions(names: Iterable[str], positions: ArrayLike) -> Mapping[str, Array]:
    """Positions by node name, (3,) each, m.

    Parameters
    ----------
    names : iterable of n str
    positions : (n, 3)
        m.
    """
    return dict(zip(names, np.asarray(positions, dtype=float).reshape(-1, 3), strict=True))
