"""Controllers of drives in state space: from the error of the velocity to the force."""

from __future__ import annotations

from math import factorial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from strutwork.fea.state_space import StateSpace
from strutwork.machines.servos import Servo

Array = NDArray[Any]


def pade_delay(delay: float, order: int) -> tuple[Array, Array, Array, Array]:
    """A, B, C, D of the Padé approximation of a delay, of equal orders: an all-pass.

    Parameters
    ----------
    delay : float
        s, positive.
    order : int
        n, the number of states.

    Returns
    -------
    a, b, c, d : (n, n), (n, 1), (1, n), (1, 1)
        In 1/s; inputs and outputs have one unit.
    """
    n = order
    falling = [
        factorial(2 * n - k) * factorial(n) / (factorial(2 * n) * factorial(k) * factorial(n - k))
        for k in range(n + 1)
    ]
    below = np.array(falling) / falling[n]
    above = below * (-1.0) ** np.arange(n + 1)
    a = np.diag(np.ones(n - 1), 1)
    a[-1] = -below[:n]
    b = np.zeros((n, 1))
    b[-1] = 1.0
    c = (above[:n] - above[n] * below[:n])[None]
    return a / delay, b / delay, c, np.array([[above[n]]])


def controller(servo: Servo) -> tuple[Array, Array, Array, Array]:
    """A, B, C, D from the error of the velocity to the force at the joint.

    States are the force of the integral action, where there is one, and those of the delay.

    Parameters
    ----------
    servo : Servo

    Returns
    -------
    a, b, c, d : (n, n), (n, 1), (1, n), (1, 1)
        In SI units.
    """
    gain, time = servo.velocity_gain, servo.integral_time
    n = 0 if time is None else 1
    a, b = np.zeros((n, n)), np.full((n, 1), 0.0 if time is None else gain / time)
    c, d = np.ones((1, n)), np.array([[gain]])
    if servo.delay == 0.0:
        return a, b, c, d
    late_a, late_b, late_c, late_d = pade_delay(servo.delay, servo.order)
    a = np.block([[a, np.zeros((n, servo.order))], [late_b @ c, late_a]])
    return (
        a,
        np.concatenate([b, late_b @ d]),
        np.concatenate([late_d @ c, late_c], axis=1),
        late_d @ d,
    )


def controllers(servos: tuple[Servo, ...]) -> StateSpace:
    """All controllers side by side.

    Parameters
    ----------
    servos : tuple of Servo
    """
    parts = [controller(servo) for servo in servos]
    a, b, c, d = (block_diag(*(part[k] for part in parts)) for k in range(4))
    names = []
    for servo in servos:
        names += [] if servo.integral_time is None else [f"integral of {servo}"]
        names += [f"delay {k + 1} of {servo}" for k in range(servo.order if servo.delay else 0)]
    states = len(names)
    return StateSpace(
        a.reshape(states, states),
        b.reshape(states, len(servos)),
        c.reshape(len(servos), states),
        d,
        tuple(f"velocity error of {servo}" for servo in servos),
        tuple(f"force of {servo}" for servo in servos),
        tuple(names),
    )
