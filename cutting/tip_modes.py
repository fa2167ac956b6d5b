"""The tip of a tool as a sum over modes: what exact stability starts from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.cutting.numbers import positive_list
from strutwork.cutting.tip_response import Frame, TipResponse
from strutwork.errors import ModelError
from strutwork.fea.modal import ModalModel

Array = NDArray[Any]


@dataclass(frozen=True)
class TipModes:
    """Receptance at the tip by poles and residues, H(iω) = Σ b cᵀ/(iω − s) + conjugate.

    The displacement of the tip is relative to the workpiece, the force that on the tool.

    Parameters
    ----------
    poles : (n,)
        s, rad/s, in the upper half-plane and left of the imaginary axis.
    shapes : (n, 3)
        b, complex, of any unit: how the tip moves in a mode, along x, y, z of the process.
    loads : (n, 3)
        c, complex: how forces along them drive it; b and c together have the unit m/(N·s).

    Raises
    ------
    ModelError
        No mode, a mode that does not decay or does not swing, sizes that differ.
    """

    poles: Array
    shapes: Array
    loads: Array

    def __post_init__(self) -> None:
        poles = np.atleast_1d(np.asarray(self.poles, dtype=complex))
        shapes = np.atleast_2d(np.asarray(self.shapes, dtype=complex))
        loads = np.atleast_2d(np.asarray(self.loads, dtype=complex))
        n = len(poles)
        if not n:
            raise ModelError("modes of the tip", "are missing.", "Give at least one mode.")
        if shapes.shape != (n, 3) or loads.shape != (n, 3):
            raise ModelError(
                "modes of the tip",
                f"have {n} poles, shapes of {shapes.shape} and loads of {loads.shape}.",
                "Give three numbers per mode.",
            )
        if not all(np.all(np.isfinite(a)) for a in (poles, shapes, loads)):
            raise ModelError("modes of the tip", "hold a number that is not finite.", "Repair it.")
        for number, pole in enumerate(poles, 1):
            if pole.imag <= 0 or pole.real >= 0:
                raise ModelError(
                    f"mode {number} of the tip",
                    f"has the pole {pole:.6g} rad/s.",
                    "Give a mode that swings and decays: a damping ratio above 0 and below 1.",
                )
        object.__setattr__(self, "poles", poles)
        object.__setattr__(self, "shapes", shapes)
        object.__setattr__(self, "loads", loads)

    def __repr__(self) -> str:
        low, high = np.abs(self.poles).min(), np.abs(self.poles).max()
        return (
            f"<TipModes: {len(self.poles)} modes, {low / (2 * np.pi):.4g} to "
            f"{high / (2 * np.pi):.4g} Hz>"
        )

    @classmethod
    def from_modes(cls, frequencies: ArrayLike, ratios: ArrayLike, shapes: ArrayLike) -> TipModes:
        """Modes by undamped frequency, damping ratio and mass-normalised shape.

        Parameters
        ----------
        frequencies : (n,)
            Hz.
        ratios : (n,)
            Viscous ζ, no unit.
        shapes : (n, 3)
            1/√kg; a direction of unit length by the square root of the modal mass.

        Raises
        ------
        ModelError
            As the class.
        """
        omega = 2.0 * np.pi * positive_list("frequencies", frequencies, "Hz")
        zeta = np.broadcast_to(np.asarray(ratios, dtype=float), omega.shape)
        if not np.all((zeta > 0) & (zeta < 1)):
            raise ModelError(
                "modes of the tip",
                "have a damping ratio that is not above 0 and below 1.",
                "Give a mode that swings and decays.",
            )
        damped = omega * np.sqrt(1.0 - zeta**2)
        u = np.asarray(np.atleast_2d(np.asarray(shapes, dtype=float)), dtype=complex)
        if u.shape != (len(omega), 3):
            raise ModelError(
                "modes of the tip",
                f"have {len(omega)} frequencies and shapes of {u.shape}.",
                "Give three numbers per mode.",
            )
        return cls(-zeta * omega + 1j * damped, u, u / (2j * damped[:, None]))

    @classmethod
    def from_model(
        cls, model: ModalModel, pose: int, frame: Frame | None, highest: float
    ) -> TipModes:
        """Modes of a structure at one pose, from its modal model between three ports.

        Parameters
        ----------
        model : ModalModel
            Its ports are three translations of the tool, in the order of the frame's axes.
        pose : int
        frame : Frame or None
            Axes of the process in those of the ports; None for the same.
        highest : float
            Hz. Kept are the modes up to twice this frequency, and further ones until they carry
            99 % of the static compliance at every port.

        Raises
        ------
        ModelError
            Other ports, structural damping, which has no time response, a mode of a rigid body,
            or no mode up to `highest`.
        """
        if len(model.ports) != 3:
            raise ModelError(
                "modes of the tip", f"come from {len(model.ports)} ports.", "Name x, y and z."
            )
        if model.damping.structural:
            raise ModelError(
                "modes of the tip",
                "are damped by a loss factor, which has no response in time.",
                "Give modal damping ratios; the zero-order lobes take any damping.",
            )
        if model.rigid.shape[-1] and np.any(model.rigid[pose]):
            raise ModelError(
                "modes of the tip",
                "contain a rigid-body mode, so that the tool is held by nothing.",
                "Hold the machine, or give the drives their stiffness.",
            )
        kept, _ = model.truncated(highest)
        square, viscous = kept.square[pose], kept.viscous[pose]
        massive = square > 0
        omega = 1.0 / np.sqrt(square[massive])
        if not np.any(omega <= 2.0 * np.pi * highest):
            raise ModelError(
                "modes of the tip",
                f"have none up to {highest:g} Hz.",
                "Ask for a band in which the machine has a mode.",
            )
        shapes = kept.residues[pose][:, massive].T * omega[:, None]
        if frame is not None:
            shapes = shapes @ frame.matrix.T
        ratios = 0.5 * viscous[massive] * omega
        return cls.from_modes(omega / (2.0 * np.pi), ratios, shapes)

    def turned(self, feed: float) -> TipModes:
        """The same tip with the feed turned about the axis of the tool.

        Parameters
        ----------
        feed : float
            From x towards y, rad.
        """
        frame = Frame.feed(feed).matrix
        return TipModes(self.poles, self.shapes @ frame.T, self.loads @ frame.T)

    def receptance(self, frequencies: ArrayLike) -> TipResponse:
        """Receptance at frequencies (f,), Hz, as a response.

        Parameters
        ----------
        frequencies : (f,)
            Hz.
        """
        lines = np.asarray(frequencies, dtype=float)
        s = 2j * np.pi * lines[:, None]
        dyads = self.shapes[:, :, None] * self.loads[:, None, :]
        h = np.tensordot(1.0 / (s - self.poles), dyads, 1)
        h = h + np.tensordot(1.0 / (s - self.poles.conj()), dyads.conj(), 1)
        return TipResponse(lines, h, "modes")
