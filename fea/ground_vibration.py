"""Vibration of the ground, as a spectral density at the mounts, to the motion of the tool.

All mounts move alike. In the frame of the ground its acceleration a is the load −M r a, so that
the motion of the tool relative to the workpiece has the density Σ |H(f)|² S(f) (Crandall and Mark
1963, Random Vibration in Mechanical Systems).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.coupled import AnyDamping
from strutwork.fea.load_response import load_response
from strutwork.kinematics import DIRECTIONS
from strutwork.msa.assembly import system_of
from strutwork.msa.loads import LoadCase
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]

#: Gauss points of an interval between two breakpoints.
POINTS = 8

#: Breakpoints on either side of a mode, as shares of its frequency: narrow peaks are met.
SHARES = 2.0 ** np.arange(-14, 0)

#: Breakpoints over the band beside those of modes.
BAND = 60


@dataclass(frozen=True)
class GroundSpectrum:
    """Acceleration of the ground along one direction.

    Parameters
    ----------
    direction : "x", "y" or "z"
    frequencies : (f,) tuple
        Hz, ascending.
    density : (f,) tuple
        One-sided power spectral density, (m/s²)²/Hz; straight between the points on logarithmic
        axes, linear next to a zero; zero outside the band.

    Raises
    ------
    ModelError
        Another direction, fewer than two points, frequencies that do not rise, a negative density.
    """

    direction: str
    frequencies: tuple[float, ...]
    density: tuple[float, ...]

    def __post_init__(self) -> None:
        part = f"ground along {self.direction}"
        if self.direction not in DIRECTIONS[:3]:
            raise ModelError(part, "is no direction of a ground.", "Choose x, y or z.")
        if len(self.frequencies) != len(self.density) or len(self.density) < 2:
            raise ModelError(
                part,
                f"has {len(self.frequencies)} frequencies and {len(self.density)} densities.",
                "Give as many of both, two or more.",
            )
        f, s = np.array(self.frequencies), np.array(self.density)
        if not np.all(np.isfinite(f)) or f[0] <= 0 or np.any(np.diff(f) <= 0):
            raise ModelError(
                part, "has frequencies that do not rise from above zero.", "Sort them, in Hz."
            )
        if not np.all(np.isfinite(s)) or np.any(s < 0):
            bad = int(np.flatnonzero(~(s >= 0) | ~np.isfinite(s))[0])
            raise ModelError(
                part,
                f"has the density {s[bad]:g} at {f[bad]:g} Hz: a power is not negative.",
                "Give densities of zero or more, in (m/s^2)^2/Hz.",
            )

    def at(self, lines: Array) -> Array:
        """Density at frequencies, (n,), (m/s²)²/Hz.

        Parameters
        ----------
        lines : (n,)
            Hz.
        """
        f, s = np.array(self.frequencies), np.array(self.density)
        k = np.clip(np.searchsorted(f, lines, side="right") - 1, 0, len(f) - 2)
        linear = s[k] + (s[k + 1] - s[k]) * (lines - f[k]) / (f[k + 1] - f[k])
        positive = (s[k] > 0) & (s[k + 1] > 0)
        first, last = np.where(positive, s[k], 1.0), np.where(positive, s[k + 1], 1.0)
        slope = np.log(last / first) / np.log(f[k + 1] / f[k])
        straight = first * (lines / f[k]) ** slope
        inside = (lines >= f[0]) & (lines <= f[-1])
        return np.where(inside, np.where(positive, straight, linear), 0.0)


@dataclass(frozen=True)
class GroundVibration:
    """Motion of the tool relative to the workpiece while the ground vibrates.

    Parameters
    ----------
    covariance : (s, 6, 6)
        By every spectrum: of displacements and rotations, m², m·rad and rad².
    frequencies : (f,)
        Hz.
    cumulative : (s, f, 6)
        Root of the mean square of what lies below each frequency, m and rad.
    first_mode : float
        Hz.
    highest : float
        Where the last of the spectra ends, Hz.
    """

    covariance: Array
    frequencies: Array
    cumulative: Array
    first_mode: float
    highest: float

    def __repr__(self) -> str:
        rms = np.sqrt(np.einsum("sii->i", self.covariance))[:3]
        return f"<GroundVibration: RMS {', '.join(f'{v:.3g}' for v in rms)} m>"

    @property
    def note(self) -> str:
        """What the spectra leave out; empty where the first mode lies within them."""
        if self.highest > self.first_mode:
            return ""
        return (
            f"The spectrum of the ground ends at {self.highest:.4g} Hz, below the first mode at "
            f"{self.first_mode:.4g} Hz: the vibration of the tool leaves out every resonance."
        )


def ground_vibration(
    placed: PlacedStructure,
    spectra: Sequence[GroundSpectrum],
    damping: AnyDamping,
    against: str | None = None,
) -> GroundVibration:
    """Motion of the tool by the vibration of the ground, at one pose.

    Parameters
    ----------
    placed : PlacedStructure
        At one pose, with a tool.
    spectra : sequence of s GroundSpectrum
        Not correlated with one another.
    damping : damping of any kind
    against : str, optional
        Node of the workpiece; the ground by default.

    Returns
    -------
    GroundVibration
        The integrals are by Gauss points on intervals that narrow towards every mode.

    Raises
    ------
    ModelError
        No spectrum, no mass, or a structure that nothing holds.
    """
    if not spectra:
        raise ModelError("ground", "has no spectrum.", "Give one along x, y or z.")
    system = system_of(placed)
    pushes = [LoadCase(s.direction, gravity=_down(DIRECTIONS.index(s.direction))) for s in spectra]
    found = load_response(placed, system.nodal_loads(pushes)[0], damping, against)
    modes = found.modes
    ends = _breakpoints(spectra, modes)
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    half = np.diff(ends)[:, None] / 2
    lines = ends[:-1, None] + half * (nodes + 1)
    weight = half * weights
    response = found.at(lines.ravel()).reshape(*lines.shape, 6, len(spectra))
    density = np.stack([s.at(lines.ravel()).reshape(lines.shape) for s in spectra])
    power = np.einsum(
        "sip,ip,ipas,ipbs->siab", density, weight, response, response.conj(), optimize=True
    ).real
    running = np.cumsum(np.einsum("siaa->sia", power), axis=1)
    cumulative = np.concatenate([np.zeros((len(spectra), 1, 6)), running], axis=1)
    first = float(modes[0]) if len(modes) else np.inf
    highest = max(s.frequencies[-1] for s in spectra)
    return GroundVibration(
        power.sum(axis=1), ends, np.sqrt(np.maximum(cumulative, 0.0)), first, highest
    )


def _down(axis: int) -> tuple[float, float, float]:
    """The load of a ground that accelerates by one along an axis."""
    pull = [0.0, 0.0, 0.0]
    pull[axis] = -1.0
    return pull[0], pull[1], pull[2]


def _breakpoints(spectra: Sequence[GroundSpectrum], modes: Array) -> Array:
    low = min(s.frequencies[0] for s in spectra)
    high = max(s.frequencies[-1] for s in spectra)
    near = modes[(modes > low / 2) & (modes < 2 * high)]
    around = np.outer(near, np.concatenate([1 - SHARES, [1.0], 1 + SHARES])).ravel()
    points = np.concatenate(
        [np.geomspace(low, high, BAND), around, *(s.frequencies for s in spectra)]
    )
    return np.unique(points[(points >= low) & (points <= high)])
