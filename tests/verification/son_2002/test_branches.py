"""Working modes of the MIT-SS-1: the signs of the roots in eqs 43 to 45.

@phdthesis{son2002,
  author = {Son, Seung-Kil},
  title  = {A Hybrid Type Small 5-Axis {CNC} Milling Machine},
  school = {Massachusetts Institute of Technology},
  year   = {2002}
}

The thesis takes one sign and counts no others. The modes are held to the machine's own inverse
kinematics and rows (1e-14 m: rounding of lengths of 0.5 m), to the lengths of the struts, and to
the search from many starts that knows no formula; shares of the workspace are a regression of ours.
"""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from strutwork.kinematics.branches import branches
from strutwork.kinematics.motion import Motion
from strutwork.machines import MitSS1
from strutwork.papers.son_2002.planar_kinematics import planar_kinematics
from strutwork.papers.son_2002.working_modes import SIGNS, free_modes, working_modes


@pytest.fixture(scope="module")
def found() -> xr.Dataset:
    return working_modes()


def test_the_first_mode_is_the_machine() -> None:
    ours = planar_kinematics()
    found = working_modes(x=ours["x"], b=ours["b"])
    for name in ("drive", "determinant"):
        np.testing.assert_allclose(found[name][0], ours[name], rtol=0.0, atol=1e-14)


def test_struts_keep_their_lengths_in_every_mode(found: xr.Dataset) -> None:
    machine = MitSS1()
    x, b = np.meshgrid(found["x"], found["b"], indexing="ij")
    pins = machine.poses(x, 0.0, b)
    at = pins.position[..., None, :] + np.einsum("...ij,kj->...ki", pins.rotation, machine.seats)
    rise = found["drive"].to_numpy() - at[..., 2]
    lengths = np.hypot(rise, machine.rails - at[..., 0])
    np.testing.assert_allclose(
        lengths, np.broadcast_to(machine.strut_lengths, lengths.shape), rtol=0.0, atol=1e-14
    )
    assert np.array_equal(np.sign(rise[:, 50, 30]), SIGNS)


def test_the_search_finds_the_same_eight() -> None:
    """Of ideal pins, off home and tilted; 1e-9 m is where the search stops."""
    machine = MitSS1(pins="revolute", struts="rigid")
    home = machine.home()
    motion = Motion(machine.linkage, machine.place(home), home.rotation)
    x, b = 0.02, np.radians(-12.0)
    searched = branches(motion, tool=machine.poses(x, 0.0, b))
    at, _, _ = motion.joints.place(searched.bodies)
    index = [machine.linkage.node_index[f"block{k}/slide"] for k in (1, 2, 3)]
    ours = working_modes(x=[x], b=[b])["drive"].to_numpy()[:, 0, 0]
    theirs = at[:, index, 2]
    apart = np.abs(theirs[:, None] - ours).max(axis=-1)
    # each is one of ours, and every one of ours is found
    assert sorted(apart.argmin(axis=1).tolist()) == list(range(8))
    assert apart.min(axis=1).max() <= 1e-9


def test_where_the_drives_hold_the_housing(found: xr.Dataset) -> None:
    """Three modes keep the sign of their determinant over the nominal workspace, five do not."""
    assert np.isfinite(found["determinant"]).all()
    free = free_modes(found)
    assert [str(m) for m in found["mode"].to_numpy()[free]] == ["+++", "+−+", "−+−"]
    # the least of each, m, three digits, over steps of 1 mm and 1°
    least = np.abs(found["determinant"].to_numpy()).min(axis=(1, 2))[free]
    assert least == pytest.approx([0.0275, 0.0251, 0.0685], abs=5e-5)
    # the larger share of the workspace on one side of the singular line
    positive = (found["determinant"].to_numpy() > 0).mean(axis=(1, 2))[~free]
    larger = np.maximum(positive, 1 - positive)
    assert larger == pytest.approx([0.929, 0.995, 0.682, 0.892, 0.621], abs=5e-4)


def test_out_of_reach_is_out_of_reach_in_every_mode() -> None:
    """At x = 0.6 m no strut reaches; at 0.3 m the first does not and the others do."""
    found = working_modes(x=[0.0, 0.3, 0.6], b=[0.0])
    for name in ("drive", "determinant"):
        missing = np.isnan(found[name].to_numpy()).reshape(8, 3, -1)
        assert np.array_equal(missing.all(axis=(0, 2)), [False, True, True])
        assert np.array_equal(missing.any(axis=(0, 2)), [False, True, True])
