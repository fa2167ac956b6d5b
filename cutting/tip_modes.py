"""The tip of a tool as a sum over modes: what exact stability starts from."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.cutting.numbers import positive_list
from strutwork.cutting.tip_residual import MOST_DAMPED, equivalent_modes, equivalent_poles
from strutwork.cutting.tip_response import Frame, TipResponse
from strutwork.errors import ModelError
from strutwork.fea.modal import STATIC_SHARE, ModalModel
from strutwork.fea.pole_residue import PoleModel

Array = NDArray[Any]

#: An imaginary part below this share of a pole is rounding.
STILL = 1e-9

#: Poles that differ from their conjugates by a larger share have none.
PAIRED = 1e-6


@dataclass(frozen=True)
class TipModes:
    """Receptance at the tip by poles and residues, H(iω) = Σ b cᵀ/(iω − s) + conjugate.

    The displacement of the tip is relative to the workpiece, the force that on the tool.

    Parameters
    ----------
    poles : (n,)
        s, rad/s, in the upper half-plane or on the real axis, and left of the imaginary one.
    shapes : (n, 3)
        b, complex, of any unit: how the tip moves in a mode, along x, y, z of the process.
    loads : (n, 3)
        c, complex: how forces along them drive it; b and c together have the unit m/(N·s).
    residual_share : float
        Largest share of the static compliance at a port for which equivalent modes stand, 0 to 1;
        without truncation 0.

    Raises
    ------
    ModelError
        No mode, a mode that does not decay, sizes that differ.
    """

    poles: Array
    shapes: Array
    loads: Array
    residual_share: float = 0.0

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
            if pole.imag < 0 or pole.real >= 0:
                raise ModelError(
                    f"mode {number} of the tip",
                    f"has the pole {pole:.6g} rad/s.",
                    "Give a mode that decays: a damping ratio above 0.",
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
        cls,
        model: ModalModel,
        pose: int,
        frame: Frame | None,
        highest: float,
        moving: tuple[int, ...] = (0, 1, 2),
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
            99 % of the static compliance at every port. Three at most stand for the others, so
            that the static compliance is exact (`strutwork.cutting.tip_residual`).
        moving : tuple of int
            Which of x, y and z the ports are; the tool is held in the others.

        Raises
        ------
        ModelError
            Other ports, structural damping, which has no time response, a mode of a rigid body,
            or no mode up to `highest`.
        """
        _require_ports(len(model.ports), moving)
        if model.damping.structural:
            raise _no_time()
        if model.rigid.shape[-1] and np.any(model.rigid[pose]):
            raise _floats()
        square, residues = model.square[pose], model.residues[pose]
        # motions without mass have no pole: the equivalent modes stand for them
        keep = model.mattering(highest) & (square > 0)
        if not np.any(square[keep] * (2.0 * np.pi * highest) ** 2 >= 1.0):
            raise _none_up_to(highest)
        static = np.sum(residues**2, axis=1)
        rest, slow = equivalent_modes(residues[:, ~keep], square[~keep], static, highest)
        square = np.concatenate([square[keep], slow])
        omega = 1.0 / np.sqrt(square)
        whole = np.concatenate([residues[:, keep], rest], axis=1)
        shapes = _in_frame(whole.T * omega[:, None], frame, moving)
        ratios = 0.5 * model.damping.viscous(square) * omega
        own = len(omega) - len(slow)
        ratios[own:] = np.minimum(ratios[own:], MOST_DAMPED)
        share = np.sum(rest**2, axis=1) / np.where(static > 0, static, 1.0)
        found = cls.from_modes(omega / (2.0 * np.pi), ratios, shapes)
        return replace(found, residual_share=float(share.max()))

    @classmethod
    def from_poles(
        cls,
        model: PoleModel,
        frame: Frame | None,
        highest: float,
        moving: tuple[int, ...] = (0, 1, 2),
    ) -> TipModes:
        """Complex modes of a structure whose damping couples its undamped ones.

        Parameters
        ----------
        model : PoleModel
            As `from_model`'s.
        frame : Frame or None
            Axes of the process in those of the ports; None for the same.
        highest : float
            Hz; poles are kept as `from_model` keeps modes.
        moving : tuple of int
            Which of x, y and z the ports are; the tool is held in the others.

        Raises
        ------
        ModelError
            Other ports, structural damping, which has no time response, a motion of a rigid body,
            or no mode up to `highest`.
        """
        _require_ports(len(model.ports), moving)
        swings = model.poles.imag > STILL * np.abs(model.poles)
        falls = np.abs(model.poles.imag) <= STILL * np.abs(model.poles)
        pairs = np.sort_complex(model.poles[swings])
        others = np.sort_complex(model.poles[~swings & ~falls].conj())
        if len(pairs) != len(others) or not np.allclose(pairs, others, rtol=PAIRED):
            raise _no_time()
        if np.any(model.moving) or np.any(model.poles.real >= 0):
            raise _floats()
        # a pole that only falls is half of itself and of its conjugate
        poles = np.concatenate([model.poles[swings], model.poles[falls].real])
        right = np.concatenate([model.right[:, swings], 0.5 * model.right[:, falls]], axis=1)
        left = np.concatenate([model.left[:, swings], model.left[:, falls]], axis=1)
        slow = np.abs(poles)
        if not np.any((slow <= 2.0 * np.pi * highest) & (poles.imag > 0)):
            raise _none_up_to(highest)
        static = 2.0 * (left * right / -poles).real
        # motions that neither mass nor dashpot delays have no pole
        constant = model.constant.real
        whole = np.abs(static.sum(axis=1) + constant.diagonal())
        keep = slow <= 4.0 * np.pi * highest
        for mode in np.argsort(-np.abs(static).max(axis=0), kind="stable"):
            missing = np.abs(static[:, ~keep].sum(axis=1))
            if np.all(missing <= (1.0 - STATIC_SHARE) * whole):
                break
            keep[mode] = True
        missing = np.abs(static[:, ~keep].sum(axis=1) + constant.diagonal())
        more = equivalent_poles(
            poles[~keep], left[:, ~keep], right[:, ~keep], constant, float(whole.max()), highest
        )
        poles = np.concatenate([poles[keep], more[0]])
        left = np.concatenate([left[:, keep], more[1]], axis=1)
        right = np.concatenate([right[:, keep], more[2]], axis=1)
        return cls(
            poles,
            _in_frame(left.T, frame, moving),
            _in_frame(right.T, frame, moving),
            float((missing / np.where(whole > 0, whole, 1.0)).max()),
        )

    def turned(self, feed: float) -> TipModes:
        """The same tip with the feed turned about the axis of the tool.

        Parameters
        ----------
        feed : float
            From x towards y, rad.
        """
        frame = Frame.feed(feed).matrix
        return replace(self, shapes=self.shapes @ frame.T, loads=self.loads @ frame.T)

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


def _require_ports(count: int, moving: tuple[int, ...]) -> None:
    if count != len(moving):
        raise ModelError("modes of the tip", f"come from {count} ports.", "Name x, y and z.")


def _in_frame(shapes: Array, frame: Frame | None, moving: tuple[int, ...]) -> Array:
    """Shapes (n, 3) along the axes of a process from those of the translations that move."""
    whole = np.zeros((len(shapes), 3), dtype=shapes.dtype)
    whole[:, list(moving)] = shapes
    return whole if frame is None else np.asarray(whole @ frame.matrix.T)


def _no_time() -> ModelError:
    return ModelError(
        "modes of the tip",
        "are damped by a loss factor, which has no response in time.",
        "Give modal damping ratios; the zero-order lobes take any damping.",
    )


def _floats() -> ModelError:
    return ModelError(
        "modes of the tip",
        "contain a rigid-body mode, so that the tool is held by nothing.",
        "Hold the machine, or give the drives their stiffness.",
    )


def _none_up_to(highest: float) -> ModelError:
    return ModelError(
        "modes of the tip",
        f"have none up to {highest:g} Hz.",
        "Ask for a band in which the machine has a mode.",
    )
