"""Receptance at the tip of a tool in the axes of a process, from a computation or a test."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.fea.frf import FrequencyResponse
from strutwork.fea.uff import FrfRecord

Array = NDArray[Any]


@dataclass(frozen=True)
class Frame:
    """Axes of a process: along the feed, across it, and along the tool from tip to holder.

    Parameters
    ----------
    matrix : (3, 3)
        Rows are the axes in the directions of a machine or a measurement, a rotation matrix.

    Raises
    ------
    ModelError
        No rotation matrix.
    """

    matrix: Array

    def __post_init__(self) -> None:
        m = np.asarray(self.matrix, dtype=float)
        proper = m.shape == (3, 3) and np.allclose(m @ m.T, np.eye(3), atol=1e-9)
        if not proper or np.linalg.det(m) < 0:
            raise ModelError(
                "axes of the process",
                "are no right-handed set of unit vectors.",
                "Give feed, normal and tool axis, each across the others.",
            )
        object.__setattr__(self, "matrix", m)

    @classmethod
    def feed(cls, angle: float) -> Frame:
        """Axes whose feed is turned from x towards y.

        Parameters
        ----------
        angle : float
            rad.
        """
        c, s = np.cos(angle), np.sin(angle)
        return cls(np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]))

    @classmethod
    def along(cls, axis: ArrayLike, feed: ArrayLike) -> Frame:
        """Axes by the tool's axis and a feed direction, whose part along the axis is left out.

        Parameters
        ----------
        axis : (3,)
            From the tip to the holder, any unit.
        feed : (3,)
            Of any length, any unit.

        Raises
        ------
        ModelError
            A direction of length zero, or a feed along the axis.
        """
        z, x = np.asarray(axis, dtype=float), np.asarray(feed, dtype=float)
        size = float(np.linalg.norm(z))
        z = z / size if size > 0 else z
        x = x - z * (z @ x)
        length = float(np.linalg.norm(x))
        if not size > 0 or not length > 1e-9 * float(np.linalg.norm(feed)):
            raise ModelError(
                "axes of the process",
                "have no direction, or a feed along the tool's axis.",
                "Give an axis and a feed across it.",
            )
        x = x / length
        return cls(np.stack([x, np.cross(z, x), z]))


@dataclass(frozen=True)
class TipResponse:
    """Receptance between the three translations of a tool's tip.

    Parameters
    ----------
    frequencies : (f,)
        Hz, ascending.
    receptance : (f, 3, 3)
        Complex, m/N, tool relative to workpiece: motion by force.
    source : str
        Where it comes from, in words.

    Raises
    ------
    ModelError
        Frequencies that do not rise, another shape, a number that is not finite.
    """

    frequencies: Array
    receptance: Array
    source: str = ""

    def __post_init__(self) -> None:
        lines = np.asarray(self.frequencies, dtype=float)
        h = np.asarray(self.receptance, dtype=complex)
        if lines.ndim != 1 or len(lines) < 2 or h.shape != (len(lines), 3, 3):
            raise ModelError(
                "receptance at the tip",
                f"has {lines.shape} frequencies and values of {h.shape}.",
                "Give two lines or more and a 3 x 3 matrix per line.",
            )
        if not (np.all(np.isfinite(lines)) and np.all(np.isfinite(h))):
            raise ModelError(
                "receptance at the tip",
                "holds a number that is not finite.",
                "Leave out the lines that have no value.",
            )
        if lines[0] < 0 or np.any(np.diff(lines) <= 0):
            raise ModelError(
                "receptance at the tip", "has frequencies that do not rise.", "Sort its lines."
            )
        object.__setattr__(self, "frequencies", lines)
        object.__setattr__(self, "receptance", h)

    def __repr__(self) -> str:
        f = self.frequencies
        return f"<TipResponse: {len(f)} lines, {f[0]:g} to {f[-1]:g} Hz, {self.source}>"

    def turned(self, feed: float) -> TipResponse:
        """The same response with the feed turned about the axis of the tool.

        Parameters
        ----------
        feed : float
            From x towards y, rad.
        """
        return oriented(self, Frame.feed(feed))


def oriented(response: TipResponse, frame: Frame) -> TipResponse:
    """A response in the axes of a process.

    Parameters
    ----------
    response : TipResponse
    frame : Frame
        Axes of the process in those of the response.
    """
    m = frame.matrix
    return TipResponse(response.frequencies, m @ response.receptance @ m.T, response.source)


def computed_response(
    response: FrequencyResponse, pose: tuple[int, ...] = (), frame: Frame | None = None
) -> TipResponse:
    """Receptance at the tip from a frequency response at a pose.

    Parameters
    ----------
    response : FrequencyResponse
        Three outputs and the same three inputs: translations of the tool.
    pose : tuple of int
        Index into the batch of poses.
    frame : Frame or None
        Axes of the process in those of the ports; None for the same.

    Raises
    ------
    ModelError
        Other ports, or an index that is none of a pose.
    """
    if len(response.outputs) != 3 or response.outputs != response.inputs:
        raise ModelError(
            "frequency response",
            f"has {len(response.outputs)} outputs and {len(response.inputs)} inputs.",
            "Give x, y and z of the tool as both.",
        )
    values = response.receptance[pose]
    if values.ndim != 3:
        raise ModelError("frequency response", "has several poses.", "Name one by its index.")
    found = TipResponse(response.frequencies, values, f"computed, {response.method}")
    return found if frame is None else oriented(found, frame)


def measured_response(
    records: Sequence[FrfRecord], node: str, frame: Frame | None = None
) -> TipResponse:
    """Receptance at the tip from measured functions, as `strutwork.fea.uff_read` reads them.

    A pair that was measured one way stands for the other (reciprocity). A direction without its
    direct function is taken as rigid, and a cross function that is missing as zero: `source`
    names both.

    Parameters
    ----------
    records : sequence of FrfRecord
    node : str
        The tool's node.
    frame : Frame or None
        Axes of the process in those of the measurement; None for the same.

    Raises
    ------
    ModelError
        No direct function at the node, two functions between the same ends, or frequencies that
        differ.
    """
    found: dict[tuple[int, int], FrfRecord] = {}
    for record in records:
        ends = (record.output, record.input)
        if any(end[0] != node or end[1] not in ("x", "y", "z") for end in ends):
            continue
        key = ("xyz".index(record.output[1]), "xyz".index(record.input[1]))
        if key in found:
            raise ModelError(
                f"function {record.name}", "is there twice.", "Leave one of the runs out."
            )
        found[key] = record
    direct = [i for i in range(3) if (i, i) in found]
    if not direct:
        nodes = ", ".join(sorted({r.output[0] for r in records})) or "none"
        raise ModelError(
            f'node "{node}"',
            "has no function of a direction by a force in the same direction.",
            f"Name the tool's node; functions are at: {nodes}.",
        )
    lines = found[direct[0], direct[0]].frequencies
    for record in found.values():
        if not np.array_equal(record.frequencies, lines):
            raise ModelError(
                f"function {record.name}",
                "has other frequencies than the direct function.",
                "Export all functions with the same lines.",
            )
    keep = lines > 0
    h = np.zeros((int(keep.sum()), 3, 3), dtype=complex)
    missing = []
    for i in range(3):
        for j in range(3):
            one = found.get((i, j)) or found.get((j, i))
            if one is not None:
                # zero frequency tells nothing of a displacement that was measured otherwise
                whole = FrfRecord(
                    one.output, one.input, lines[keep], one.values[keep], one.motion, one.run
                )
                h[:, i, j] = whole.as_motion("displacement")
            elif i <= j:
                missing.append(f"{'xyz'[i]}{'xyz'[j]}")
    said = "measured" + (f", without {', '.join(missing)}" if missing else "")
    measured = TipResponse(lines[keep], h, said)
    return measured if frame is None else oriented(measured, frame)
