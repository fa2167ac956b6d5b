"""Linear systems in state space, and their response over frequency."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import matrix_balance, schur

from strutwork.errors import ModelError

if TYPE_CHECKING:
    import control

Array = NDArray[Any]


@dataclass(frozen=True)
class StateSpace:
    """ẋ = A x + B u, y = C x + D u.

    Parameters
    ----------
    a : (n, n)
        1/s and the like.
    b : (n, i)
        Per N or N·m, or the unit of another input.
    c : (o, n)
        Outputs per state, in m, m/s, m/s² and the like of rotations.
    d : (o, i)
        What follows at once, m/N and the like: motions without mass and modes left out.
    inputs, outputs, states : tuple of str
        Their names.
    """

    a: Array
    b: Array
    c: Array
    d: Array
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    states: tuple[str, ...]

    def __repr__(self) -> str:
        return (
            f"<{type(self).__name__}: {len(self.a)} states, {len(self.inputs)} inputs, "
            f"{len(self.outputs)} outputs>"
        )

    @cached_property
    def _triangular(self) -> tuple[Array, Array, Array]:
        """Complex Schur form of A, with B and C in its coordinates."""
        balanced, similar = matrix_balance(self.a)
        form, turn = schur(balanced, output="complex")
        back = turn.conj().T @ np.linalg.solve(similar, self.b)
        return form, back, (self.c @ similar) @ turn

    @property
    def poles(self) -> Array:
        """Eigenvalues of A, (n,), 1/s."""
        return np.diag(self._triangular[0]) if len(self.a) else np.zeros(0, dtype=complex)

    def response(self, frequencies: ArrayLike) -> Array:
        """C (iω − A)⁻¹ B + D, complex, (f, o, i); not finite at a pole.

        Parameters
        ----------
        frequencies : (f,)
            Hz.
        """
        omega = 2.0 * np.pi * np.atleast_1d(np.asarray(frequencies, dtype=float))
        result = np.broadcast_to(self.d, (len(omega), *self.d.shape)).astype(complex)
        if not len(self.a):
            return result
        form, given, seen = self._triangular
        states: Array = np.zeros((len(omega), *given.shape), dtype=complex)
        with np.errstate(divide="ignore", invalid="ignore"):
            for k in range(len(form) - 1, -1, -1):
                pushed = given[k] + form[k, k + 1 :] @ states[:, k + 1 :]
                states[:, k] = pushed / (1j * omega - form[k, k])[:, None]
            return np.asarray(result + seen @ states)

    def static(self) -> Array:
        """D − C A⁻¹ B, (o, i).

        Raises
        ------
        ModelError
            A pole at zero: something drifts.
        """
        try:
            found = self.d - self.c @ np.linalg.solve(self.a, self.b)
        except np.linalg.LinAlgError as error:
            raise ModelError(
                "state space", "has a pole at zero and no static response.", "Hold what drifts."
            ) from error
        return np.asarray(found)

    def to_control(self) -> control.StateSpace:
        """The same for python-control.

        Raises
        ------
        ModelError
            The library is not installed.
        """
        try:
            # it draws in Matplotlib, which only those who ask for it wait for
            import control  # noqa: PLC0415
        except ImportError as error:
            raise ModelError(
                "python-control", "is not installed.", "Install strutwork[servo], or control."
            ) from error
        return control.ss(
            self.a,
            self.b,
            self.c,
            self.d,
            inputs=_plain(self.inputs),
            outputs=_plain(self.outputs),
            states=_plain(self.states),
        )


def _plain(names: tuple[str, ...]) -> list[str]:
    """Names without the dots that python-control keeps for its own."""
    return [name.replace(".", "_") for name in names]
