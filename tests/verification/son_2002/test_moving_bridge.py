"""The planar machine under a moving bridge, chapter 10.

@phdthesis{son2002,
  author = {Son, Seung-Kil},
  title  = {A Hybrid Type Small 5-Axis {CNC} Milling Machine},
  school = {Massachusetts Institute of Technology},
  year   = {2002}
}

The chapter prints no number. What is asserted is that the fourth axis changes nothing else, to
rounding, and places that follow from Appendix B.
"""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.kinematics import Poses, mobility, rotation_y
from strutwork.machines import MitSS1, MovingBridge
from strutwork.machines.load import load
from strutwork.msa import tool_compliance
from strutwork.papers.son_2002.serial import bridge_reversals, flat_rows


def poses(y: float) -> Poses:
    tilt = np.radians([-20.0, 0.0, 25.0])
    place = np.array([[-0.04, y, 0.02], [0.0, y, 0.0], [0.03, y, -0.05]])
    return Poses(place, rotation_y(tilt))


def test_it_has_four_axes() -> None:
    """x, z and b of the planar machine and y of the bridge; over-constrained as that one is."""
    machine, planar = MovingBridge(), MitSS1()
    found = mobility(machine.linkage, machine.place(machine.home()))
    other = mobility(planar.linkage, planar.place(planar.home()))
    assert (found.mobility, found.mobility_locked) == (4, 0)
    assert found.redundant == other.redundant


def test_the_bridge_takes_y_and_the_planar_machine_the_rest() -> None:
    machine, planar = MovingBridge(), MitSS1()
    moved, still = machine.place(poses(0.7)), planar.place(poses(0.0))
    assert moved.reachable.all()
    values = dict(zip(moved.names, moved.values.T, strict=True))
    assert values["bridge/guide", "z"] == pytest.approx([0.7] * 3, abs=1e-15)
    np.testing.assert_array_equal(moved.values[:, 1:], still.values)
    shifted = still.positions + np.array([0.0, 0.7, 0.0])
    np.testing.assert_allclose(moved.positions[:, 2:], shifted, atol=1e-15)


def test_the_joints_alone_agree() -> None:
    """1e-9 m, to which joints are closed: all nodes, along y too, 2 m away."""
    model = load("moving-bridge")
    assert model.closed_form is not None
    x, y, b = [-0.03, 0.02], [-2.0, 2.0], np.radians([15.0, -10.0])
    moved = model.motion.move(task={"x": x, "y": y, "z": [0.05, -0.05], "ry": b})
    assert moved.reached.all()
    assert moved.tool is not None
    own = model.closed_form(moved.tool)
    np.testing.assert_allclose(moved.placement.positions, own.positions, atol=1e-9)


def test_statics_are_those_of_the_planar_machine() -> None:
    """A rigid bridge on a rigid way gives nothing; a drive of 50 N/µm gives along y alone."""
    machine, planar = MovingBridge(), MitSS1()
    wanted = tool_compliance(planar.structure.at(planar.place(poses(0.0))))
    found = tool_compliance(machine.structure.at(machine.place(poses(0.7))))
    size = np.abs(wanted).max()
    np.testing.assert_allclose(found, wanted, atol=1e-9 * size)
    soft = MovingBridge(bridge_stiffness=50e6)
    found = tool_compliance(soft.structure.at(soft.place(poses(0.7))))
    wanted[:, 1, 1] += 1.0 / 50e6
    np.testing.assert_allclose(found, wanted, atol=1e-9 * size)


def test_lines_on_which_a_block_turns_back() -> None:
    """Over x and y all struts reach, only block 3 stands still, on x = w₃ = 157.5 mm."""
    found = bridge_reversals(MovingBridge()).singular
    lines = [line for drive in found for line in drive.lines]
    assert all(not drive.points for drive in found)
    (line,) = lines
    assert line[:, 0] == pytest.approx(np.full(len(line), 0.1575), abs=1e-9)


def test_machines_beside_each_other_over_a_flat_surface() -> None:
    """Fig. 15 and section 6.5: serial none, hexapod six; −202.5, 212.5, 157.5 and 305.01 mm.

    The last by geometry: feet less seats of Appendix A, here to the hundredth of a millimetre.
    """
    rows = {row.machine: row for row in flat_rows()}
    assert rows["serial, A–C"].found == rows["serial, A–B"].found == "none"
    planar = rows["MIT-SS-1, with a slide along y"]
    assert planar.places == pytest.approx((-202.5, 212.5, 157.5), abs=1e-9)
    hexapod = rows["Hexel hexapod"]
    assert hexapod.found == "6, all strong"
    assert hexapod.places == pytest.approx([305.01] * 6, abs=5e-3)


def test_bad_numbers_are_named() -> None:
    with pytest.raises(ModelError, match="bridge_mass"):
        MovingBridge(bridge_mass=0.0)
    with pytest.raises(ModelError, match="bridge_stiffness"):
        MovingBridge(bridge_stiffness=-1.0)
