"""A force that rigid joints share among themselves is named, not handed out in silence."""

import warnings

import numpy as np
import pytest

from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement
from strutwork.msa import PlacedStructure, Structure
from strutwork.overconstraint import influence
from strutwork.overconstraint.influence import UndeterminedWarning

PLACES = ([0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.6, 0.0, 0.5])


def door(**hinge: float) -> PlacedStructure:
    """A door on two hinges along z and a third, elastic mount."""
    ground, leaf = ("g1", "g2", "g3"), ("d1", "d2", "d3")
    joints = (
        Joint("top", "revolute", ("g1", "d1"), stiffness=hinge),
        Joint("bottom", "revolute", ("g2", "d2"), stiffness=hinge),
        Joint("stop", "bushing", ("g3", "d3"), stiffness={"x": 1e6, "y": 1e6, "z": 1e6}),
    )
    linkage = Linkage((*ground, *leaf), (Body(GROUND, ground), Body("door", leaf)), joints, "d3")
    frames = np.broadcast_to(np.eye(3), (3, 3, 3))
    return Structure(linkage).at(Placement(np.array(PLACES * 2), frames, np.zeros(0)))


def test_rigid_hinges_share_an_unknown_way() -> None:
    with pytest.warns(
        UndeterminedWarning, match=r"top in x.*bottom in x.*only their sum is certain"
    ):
        found = influence(door(), [("stop", "x")])
    # the sum is sure: the two hinges balance the mount
    np.testing.assert_allclose(found.forces[:, 0].sum(axis=0), 0.0, atol=1e-3)
    assert abs(found.forces[2, 0, 0]) > 1e5


def test_elastic_hinges_share_by_their_stiffness() -> None:
    elastic = dict.fromkeys(("x", "y", "z", "rx", "ry"), 1e8)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = influence(door(**elastic), [("stop", "x")])
    assert abs(found.forces[0, 0, 0]) > 1e3
