"""Measured frequency response functions, compared by the logarithm of their size.

The residual is ln|H computed| − ln|H measured|. A complex difference relative to the measured value
grows without bound where a computed resonance stands beside the measured one, so that a search from
a distant guess is led astray, and it charges phase errors of sensors and filters to the stiffness.
The logarithm grows slowly there, weighs resonances and antiresonances alike, and its scatter is the
relative scatter of the magnitude.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea import ModalRatio, Port, frequency_response, modes
from strutwork.fea.coupled import AnyDamping
from strutwork.fea.receptance_sensitivity import receptance_sensitivity
from strutwork.msa.assembly import system_of
from strutwork.studies.measurement import Standing, require_node
from strutwork.studies.model_damping import model_damping

Array = NDArray[Any]

#: A mode within the band, or so far outside of it as a share, shows in the response.
BESIDE = 0.3

#: Modes that are looked through for one in the band.
SOUGHT = 30


@dataclass(frozen=True)
class MeasuredFrf:
    """Responses at a pose on common lines.

    Parameters
    ----------
    name : str
    task : mapping of direction to float
        Pose of the tool, m and rad; empty: home.
    pairs : tuple of q (Port, Port)
        Output and input.
    frequencies : (f,)
        Hz.
    values : (q f,)
        Logarithms of the receptances' magnitudes in m/N and the like, no unit; line after line of
        the first pair, then the next.
    scatter : (q f,)
        Relative standard deviations of the magnitudes, no unit.
    modal_ratio : float or None
        Damping in place of the machine's, no unit.
    said : tuple of str
        What was left out in reading.
    """

    name: str
    task: Mapping[str, float]
    pairs: tuple[tuple[Port, Port], ...]
    frequencies: Array
    values: Array
    scatter: Array
    modal_ratio: float | None = None
    said: tuple[str, ...] = ()
    kind: str = field(default="frf", init=False)
    unit: str = field(default="ln(m/N)", init=False)

    @property
    def labels(self) -> tuple[str, ...]:
        """What each value is."""
        return tuple(f"{o}/{i} at {f:.6g} Hz" for o, i in self.pairs for f in self.frequencies)

    def damping(self, at: Standing) -> AnyDamping:
        """Of the machine, or the one that the measurement states.

        Parameters
        ----------
        at : Standing

        Raises
        ------
        ModelError
            There is none.
        """
        given: Any = None if self.modal_ratio is None else ModalRatio(self.modal_ratio)
        found = model_damping(at.model, given)
        if found is None:
            raise ModelError(
                self.name,
                "needs damping, and the machine has none.",
                "Add [damping] to the machine, or modal_ratio = 0.02 to this table.",
            )
        return found

    def magnitudes(self, at: Standing) -> Array:
        """Computed receptances, (q, f), m/N and the like, complex.

        Parameters
        ----------
        at : Standing

        Raises
        ------
        ModelError
            No damping, or a port that does not move.
        """
        outputs = list(dict.fromkeys(pair[0] for pair in self.pairs))
        inputs = list(dict.fromkeys(pair[1] for pair in self.pairs))
        found = frequency_response(
            at.vibrating, inputs, outputs, self.frequencies, self.damping(at), "all_modes"
        ).receptance[0]
        return np.stack([found[:, outputs.index(o), inputs.index(i)] for o, i in self.pairs])

    def computed(self, at: Standing) -> Array:
        """Logarithms of the magnitudes, (q f,), no unit.

        Parameters
        ----------
        at : Standing

        Raises
        ------
        ModelError
            No damping, or ports that do not answer one another.
        """
        size = np.abs(self.magnitudes(at))
        if np.any(size == 0):
            output, given = self.pairs[int(np.argmax(np.any(size == 0, axis=1)))]
            raise ModelError(
                self.name,
                f"contains {output} over {given}, which do not move one another in the model.",
                "Leave this function out, or check its directions.",
            )
        return np.log(size).ravel()

    def rates(self, at: Standing) -> Array | None:
        """Derivatives of the logarithms, (g, q f), per unit of each parameter; None: none exist.

        Parameters
        ----------
        at : Standing
        """
        tied = system_of(at.placed).locked_rows.tied is not None
        if at.model.preload is not None or tied or any(c.geometry is not None for c in at.changes):
            return None
        value, rate = receptance_sensitivity(
            at.placed, at.changes, self.pairs, self.frequencies, self.damping(at)
        )
        return np.asarray((rate / value).real.reshape(len(at.changes), -1))

    def blind(self, path: str) -> bool:
        """Whether a number of this path needs differences: damping of all modes does.

        Parameters
        ----------
        path : str
        """
        return path.startswith("damping")

    def check(self, at: Standing) -> tuple[str, ...]:
        """Refuse unknown nodes and a band in which the machine has no mode.

        Parameters
        ----------
        at : Standing

        Raises
        ------
        ModelError
            As said, or no damping.
        """
        for pair in self.pairs:
            for port in pair:
                require_node(self.name, at.model, port.node)
        self.computed(at)
        low, high = float(self.frequencies[0]), float(self.frequencies[-1])
        found = modes(at.vibrating, SOUGHT).frequencies[0]
        elastic = found[np.isfinite(found) & (found > 0)]
        if not np.any((elastic > low * (1 - BESIDE)) & (elastic < high * (1 + BESIDE))):
            near = ", ".join(
                f"{f:.4g}"
                for f in sorted(elastic, key=lambda f: min(abs(f - low), abs(f - high)))[:2]
            )
            raise ModelError(
                self.name,
                f"has the band {low:g} to {high:g} Hz, in which the machine has no mode at its "
                f"first guess (the nearest: {near} Hz).",
                "Give a band with a resonance, or correct the guess.",
            )
        return self.said

    def notes(self, at: Standing) -> tuple[str, ...]:  # noqa: ARG002 - as others take it
        """Nothing.

        Parameters
        ----------
        at : Standing
        """
        return ()
