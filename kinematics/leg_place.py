"""Compiled `JointMotion.place`: nodes and joint axes from where the bodies are."""

from __future__ import annotations

import numpy as np

from strutwork.jit import jit


@jit()
def _turned_axis(rotation, frame, k, out):  # type: ignore[no-untyped-def]
    """Axis k of a joint that turns with a body, at home on the ground."""
    for r in range(3):
        out[r, k] = (
            rotation[r, 0] * frame[0, k]
            + rotation[r, 1] * frame[1, k]
            + rotation[r, 2] * frame[2, k]
        )


@jit()
def _two_turns(first, second, locked, out):  # type: ignore[no-untyped-def]
    """Axes of a joint that turns about e of the first body and f of the second."""
    e, f = (locked + 1) % 3, (locked + 2) % 3
    # first holds e; second holds f
    for r in range(3):
        a, b = (r + 1) % 3, (r + 2) % 3
        out[r, locked] = first[a, e] * second[b, f] - first[b, e] * second[a, f]
        out[r, e] = first[r, e]
    size = np.sqrt(out[0, locked] ** 2 + out[1, locked] ** 2 + out[2, locked] ** 2)
    for r in range(3):
        out[r, locked] /= size
    for r in range(3):
        a, b = (r + 1) % 3, (r + 2) % 3
        out[r, f] = out[a, locked] * out[b, e] - out[b, locked] * out[a, e]


@jit()
def place_bodies(position, rotation, nodes, joints, positions, frames):  # type: ignore[no-untyped-def]
    """Node positions and joint frames of p placements of the bodies.

    Parameters
    ----------
    position : (p, b, 3)
        Reference points of the bodies, m.
    rotation : (p, b, 3, 3)
        Of the bodies from home.
    nodes : (n,) of int and (n, 3)
        Body of each node, −1 for the ground, and its arm from the body's reference point at home,
        from the origin on the ground, m.
    joints : (j, 2) of int, (j,) of bool, (j,) of int and (j, 3, 3)
        First and second node, whether it slides, the locked one of two free rotations or −1, and
        the axes at home.
    positions : (p, n, 3)
        Filled, m.
    frames : (p, j, 3, 3)
        Filled: axes of the joints as columns.
    """
    owner, arms = nodes
    ends, slides, locked, home = joints
    fixed, other = np.eye(3), np.empty((3, 3))
    for p in range(position.shape[0]):
        for n in range(owner.shape[0]):
            b = owner[n]
            for r in range(3):
                positions[p, n, r] = arms[n, r]
                if b >= 0:
                    positions[p, n, r] = (
                        position[p, b, r]
                        + rotation[p, b, r, 0] * arms[n, 0]
                        + rotation[p, b, r, 1] * arms[n, 1]
                        + rotation[p, b, r, 2] * arms[n, 2]
                    )
        for j in range(ends.shape[0]):
            b, c = owner[ends[j, 0]], owner[ends[j, 1]]
            first = rotation[p, b] if b >= 0 else fixed
            for k in range(3):
                _turned_axis(first, home[j], k, frames[p, j])
            if locked[j] >= 0:
                second = rotation[p, c] if c >= 0 else fixed
                _turned_axis(second, home[j], (locked[j] + 2) % 3, other)
                _two_turns(frames[p, j], other, locked[j], frames[p, j])
            if slides[j]:
                # the nodes of a joint stand where its second node is
                for r in range(3):
                    positions[p, ends[j, 0], r] = positions[p, ends[j, 1], r]
