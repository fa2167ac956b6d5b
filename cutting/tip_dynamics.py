"""The tip of a tool at a pose: its receptance at any frequency, and where it resonates."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.cutting.tip_modes import TipModes
from strutwork.cutting.tip_response import Frame, TipResponse
from strutwork.errors import ModelError
from strutwork.fea.coupled import AnyDamping, PartDamping, is_coupled
from strutwork.fea.damping import Damping
from strutwork.fea.eigen import solve_eigen
from strutwork.fea.modal import ModalModel, modal_model_of
from strutwork.fea.pole_residue import PoleModel, pole_model
from strutwork.fea.ports import Port
from strutwork.fea.reduction import Reduced, reduce_system
from strutwork.msa import PlacedStructure, system_of

Array = NDArray[Any]

#: Lines of a response beside those at resonances, and lines at each of these.
LINES, AT_RESONANCE = 200, 25

#: How far these reach to either side, in half-widths of the resonance.
REACH = 10.0

#: Half-width of a resonance at least, as a share of its frequency.
NARROW = 1e-4


@dataclass(frozen=True)
class TipDynamics:
    """Receptance at the tip of a tool at one pose.

    Parameters
    ----------
    natural : (n,)
        Frequencies of the modes, Hz.
    ratios : (n,)
        Their damping ratios, no unit.
    response : callable
        Receptance (f, 3, 3), m/N, of the three translations at frequencies (f,), Hz.
    frame : Frame or None
        Axes of a process in those of the ports; None for the same.
    model : ModalModel or PoleModel
        What it is computed from.
    moving : tuple of int
        Translations that the model has; the others are held.
    pose : int
        In the model.
    """

    natural: Array
    ratios: Array
    response: Callable[[Array], Array]
    model: ModalModel | PoleModel
    moving: tuple[int, ...] = (0, 1, 2)
    pose: int = 0
    frame: Frame | None = None

    def __repr__(self) -> str:
        return f"<TipDynamics: {len(self.natural)} modes>"

    def receptance(self, frequencies: Array) -> Array:
        """Receptance (f, 3, 3), m/N.

        Parameters
        ----------
        frequencies : (f,)
            Hz.
        """
        h = self.response(frequencies)
        return h if self.frame is None else self.frame.matrix @ h @ self.frame.matrix.T

    def in_frame(self, frame: Frame) -> TipDynamics:
        """The same in the axes of a process.

        Parameters
        ----------
        frame : Frame
            In the axes of the ports.
        """
        return replace(self, frame=frame)

    def lines(self, band: tuple[float, float], finer: int = 1) -> Array:
        """Frequencies (f,), Hz, that lie dense at the resonances of a band.

        Parameters
        ----------
        band : (float, float)
            Hz.
        finer : int
            So many times as many lines.

        Raises
        ------
        ModelError
            No mode in the band.
        """
        inside = (self.natural >= band[0]) & (self.natural <= band[1])
        if not np.any(inside):
            nearest = self.natural[np.argmin(np.abs(self.natural - band[1]))]
            raise ModelError(
                "process",
                f"meets no mode between {band[0]:.4g} and {band[1]:.4g} Hz; the nearest is at "
                f"{nearest:.4g} Hz.",
                "Widen the band to the modes of the machine.",
            )
        around = np.tan(np.linspace(-1.0, 1.0, finer * (AT_RESONANCE - 1) + 1) * np.arctan(REACH))
        width = np.maximum(self.ratios[inside], NARROW)
        at = (self.natural[inside, None] * (1.0 + width[:, None] * around)).ravel()
        at = at[(at > band[0]) & (at < band[1])]
        found = np.unique(np.concatenate([np.geomspace(*band, finer * LINES), at]))
        # lines nearer to one another than rounding are one
        return np.asarray(found[np.concatenate([[True], np.diff(found) > 1e-9 * band[1]])])

    def response_at(self, lines: Array) -> TipResponse:
        """Receptance at lines (f,), Hz, as a response.

        Parameters
        ----------
        lines : (f,)
            Hz.
        """
        return TipResponse(lines, self.receptance(lines), "computed")

    def modes(self, highest: float) -> TipModes:
        """Its modes, for exact limits.

        Parameters
        ----------
        highest : float
            Hz; as `TipModes.from_model`.

        Raises
        ------
        ModelError
            As `TipModes.from_model` and `TipModes.from_poles`.
        """
        moving = self.moving
        if isinstance(self.model, PoleModel):
            return TipModes.from_poles(self.model, self.frame, highest, moving)
        return TipModes.from_model(self.model, self.pose, self.frame, highest, moving)


def tip_dynamics(
    placed: PlacedStructure, node: str, damping: AnyDamping, against: str | None = None
) -> list[TipDynamics]:
    """The tip of a tool at each of a batch of poses.

    Parameters
    ----------
    placed : PlacedStructure
        One batch axis (p,), under its preload where it has one.
    node : str
        Where the tool cuts.
    damping : damping of any kind
    against : str or None
        A node of the workpiece, relative to which the tool moves.

    Returns
    -------
    list of p TipDynamics

    Raises
    ------
    ModelError
        No mass, no damping of any part, or a tool that cannot move.
    """
    reduced = reduce_system(system_of(placed))
    ports, moving = tip_ports(reduced, node, against)
    if isinstance(damping, PartDamping):
        if is_coupled(reduced, damping):
            count = len(reduced.basis)
            some = [placed[i : i + 1] for i in range(count)] if placed.batch else [placed]
            return [_by_poles(one, ports, moving, damping) for one in some]
        if damping.background is None:
            raise ModelError(
                "damping", "is named by parts and no part has any.", "Give a part its damping."
            )
        simple: Damping = damping.background
    else:
        simple = damping
    eigen = solve_eigen(reduced)
    model = modal_model_of(reduced, eigen, ports, simple)
    return [_by_modes(model, i, moving) for i in range(len(reduced.basis))]


def tip_ports(
    reduced: Reduced, node: str, against: str | None = None
) -> tuple[tuple[Port, ...], tuple[int, ...]]:
    """Ports of the translations in which the tool moves, and which of x, y and z they are.

    Parameters
    ----------
    reduced : Reduced
    node : str
    against : str or None

    Raises
    ------
    ModelError
        An unknown node, or one that is held in all three.
    """
    # the chip's forces act on the workpiece where the tool stands
    ports = [Port(node, axis, against, carried=against is not None) for axis in "xyz"]
    kept, reason = [], None
    reduced.at_node(node)
    for k, port in enumerate(ports):
        try:
            port.on(reduced)
        except ModelError as error:
            reason = error
            continue
        kept.append(k)
    if not kept and reason is not None:
        raise reason
    return tuple(ports[k] for k in kept), tuple(kept)


def _by_modes(model: ModalModel, pose: int, moving: tuple[int, ...]) -> TipDynamics:
    one = ModalModel(
        model.ports,
        model.residues[pose : pose + 1],
        model.square[pose : pose + 1],
        model.rigid[pose : pose + 1],
        model.damping,
    )
    square = one.square[0]
    heavy = square > 0
    omega = 1.0 / np.sqrt(square[heavy])
    ratios = 0.5 * (one.viscous[0][heavy] * omega + model.damping.structural)
    return TipDynamics(
        omega / (2.0 * np.pi),
        ratios,
        _embedded(lambda f: one.receptance(f)[0], moving),
        one,
        moving,
    )


def _by_poles(
    placed: PlacedStructure, ports: Sequence[Port], moving: tuple[int, ...], damping: AnyDamping
) -> TipDynamics:
    reduced = reduce_system(system_of(placed))
    model = pole_model(reduced, solve_eigen(reduced), ports, damping)
    swings = model.poles[model.poles.imag > 0]
    size = np.abs(swings)
    return TipDynamics(
        size / (2.0 * np.pi),
        -swings.real / size,
        _embedded(model.receptance, moving),
        model,
        moving,
    )


def _embedded(
    response: Callable[[Array], Array], moving: tuple[int, ...]
) -> Callable[[Array], Array]:
    """A response of some translations among all three, zero for those that are held."""
    if len(moving) == 3:
        return response

    def whole(frequencies: Array) -> Array:
        some = response(frequencies)
        found = np.zeros((len(some), 3, 3), dtype=complex)
        found[:, np.array(moving)[:, None], np.array(moving)] = some
        return found

    return whole
