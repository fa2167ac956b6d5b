"""Over-constrained loops: rows that are independent at home depend on each other elsewhere."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, axes_frame
from strutwork.kinematics.motion import Motion, Moved
from tests.linkages import chain

#: Newton's method closes all rows to 1e-8 of the machine's size at worst, and far better here.
CLOSED = 1e-9
Z = (0.0, 0.0, 1.0)


def biglide(x: float, y: float) -> Motion:
    """Rails along x and y through the origin, each with a rod of 1 m to the tool, at home."""
    first = (x - np.sqrt(1.0 - y**2), 0.0, 0.0)
    second = (0.0, y - np.sqrt(1.0 - x**2), 0.0)
    tool = (x, y, 0.0)
    nodes = ("g1", "s1", "u1", "v1", "t1", "t2", "v2", "u2", "s2", "g2", "tool")
    bodies = (
        Body(GROUND, ("g1", "g2")),
        Body("slider 1", ("s1", "u1")),
        Body("rod 1", ("v1", "t1", "tool")),
        Body("rod 2", ("t2", "v2")),
        Body("slider 2", ("u2", "s2")),
    )
    joints = (
        Joint("rail 1", "prismatic", ("g1", "s1"), driven=("z",)),
        Joint("foot 1", "revolute", ("u1", "v1")),
        Joint("head", "revolute", ("t1", "t2")),
        Joint("foot 2", "revolute", ("v2", "u2")),
        Joint("rail 2", "prismatic", ("s2", "g2"), driven=("z",)),
    )
    places = [first] * 4 + [tool] * 2 + [second] * 4 + [tool]
    axes = [(1.0, 0.0, 0.0), Z, Z, Z, (0.0, 1.0, 0.0)]
    home = Placement(np.array(places), axes_frame(np.array(axes)), np.zeros(0))
    return Motion(Linkage(nodes, bodies, joints, "tool"), home)


def closes(motion: Motion, moved: Moved) -> None:
    """Every held direction of every joint, whether it was solved for or not."""
    good = moved.reached
    bodies = moved.bodies[good]
    _, _, gaps = motion.joints.place(bodies)
    left = motion.joints.residuals(bodies, gaps)[:, motion.joints.held]
    assert np.abs(left).max() < CLOSED


@pytest.mark.parametrize("home", [(0.0, 0.0), (0.3, 0.2), (0.0, 0.6), (0.6, 0.8)])
def test_biglide_reaches_the_same_from_everywhere(home: tuple[float, float]) -> None:
    motion = biglide(*home)
    x, y = (a.ravel() for a in np.meshgrid(*[np.linspace(-0.8, 0.8, 9)] * 2))
    moved = motion.move(task={"x": x, "y": y})
    assert moved.reached.all()
    closes(motion, moved)
    # closed form: each slider behind the tool on its rail
    start = x - np.sqrt(1.0 - y**2) - (home[0] - np.sqrt(1.0 - home[1] ** 2))
    np.testing.assert_allclose(moved.coordinate("rail 1", "z"), start, atol=CLOSED)


def test_parallelogram_up_to_its_flat_position() -> None:
    turned = np.radians(20.0)
    c, s = np.cos(turned), np.sin(turned)
    points = np.array([[0, 0, 0], [c, s, 0], [2 + c, s, 0], [2, 0, 0]])
    linkage, home = chain(points, [Z] * 4, driven=0)
    motion = Motion(linkage, home)
    angles = np.radians([10.0, 40.0, 91.0, 120.0, 158.0, -18.0, -80.0])
    moved = motion.move(joints={linkage.driven[0]: angles})
    # beyond the flat position the parallelogram may go on crossed: the way ends there, marked
    np.testing.assert_array_equal(moved.reached, [True] * 6 + [False])
    closes(motion, moved)


def test_sarrus() -> None:
    first = [(0.0, 1.0, 0.0), (0.0, 1.6, 0.5), (0.0, 1.0, 1.0)]
    points = [*first, (1.0, 0.0, 1.0), (1.6, 0.0, 0.5), (1.0, 0.0, 0.0)]
    linkage, home = chain(points, [[1, 0, 0]] * 3 + [[0, 1, 0]] * 3, driven=0)
    motion = Motion(linkage, home)
    moved = motion.move(joints={linkage.driven[0]: np.radians([5.0, 35.0, -20.0, -100.0])})
    assert moved.reached.all()
    closes(motion, moved)


def test_bennett() -> None:
    # each axis is normal to the two bars that meet there
    points = np.array([[1.0, 0, 0], [0, 0.7, 0.5], [-1.0, 0, 0], [0, -0.7, 0.5]])
    ahead, back = np.roll(points, -1, axis=0) - points, np.roll(points, 1, axis=0) - points
    linkage, home = chain(points, np.cross(ahead, back), driven=0)
    motion = Motion(linkage, home)
    moved = motion.move(joints={linkage.driven[0]: np.radians([5.0, 30.0, -10.0, -25.0])})
    assert moved.reached.all()
    closes(motion, moved)
