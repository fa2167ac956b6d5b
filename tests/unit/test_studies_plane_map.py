"""Maps over x and a tilt, and the study of the planar stiffness."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.kinematics import rotation_y
from strutwork.machines import GridMachine, HexelHexapod, MitSS1, PoseGrid, Proposed3PPRS
from strutwork.msa import axis_stiffness_free, tool_compliance
from strutwork.papers.son_2002.planar_stiffness import planar_compliance, planar_stiffness_map
from strutwork.studies import on_plane, plane_map, stiffness_falls


def test_map_holds_every_place_with_every_tilt() -> None:
    machine = MitSS1()
    x, b = np.array([-0.05, 0.0, 0.03]), np.radians([-20.0, 10.0])
    grid = PoseGrid(machine.poses(x).position, rotation_y(b), b, "b")
    assert len(grid) == 6
    assert repr(grid) == "<PoseGrid: 3 places, x -50 to 30 mm, 2 tilts b, -20 to 10 deg>"
    found = plane_map(machine, grid, workers=1)
    along, tilts, values = on_plane(found, found["stiffness_free"].sel(direction="x").to_numpy())
    np.testing.assert_array_equal(along, x)
    np.testing.assert_array_equal(tilts, b)
    poses = machine.poses(*np.broadcast_arrays(x[:, None], 0.0, b))
    free = axis_stiffness_free(tool_compliance(machine.structure.at(machine.place(poses))))
    # another stack, the same sums but for their order
    np.testing.assert_allclose(values, free[..., 0], rtol=1e-9)


def test_own_grids() -> None:
    for machine, half in ((MitSS1(), np.radians(30.0)), (HexelHexapod(), np.radians(40.0))):
        assert isinstance(machine, GridMachine)
        grid = machine.pose_grid(2)
        assert len(grid) == 25
        assert grid.tilts[[0, -1]] == pytest.approx([-half, half])
        assert machine.place(machine.poses(grid.x)).reachable.all()
    assert not isinstance(Proposed3PPRS(), GridMachine)


def test_a_machine_without_a_grid_is_refused() -> None:
    with pytest.raises(ModelError, match="no grid of x and tilt"):
        plane_map(Proposed3PPRS())


def test_falls_are_ratios_of_the_map() -> None:
    machine = HexelHexapod()
    found = plane_map(machine, machine.pose_grid(4), workers=1)
    (fall,) = stiffness_falls(found, ("z",))
    x, tilts, values = on_plane(found, found["stiffness_free"].sel(direction="z").to_numpy())
    assert fall.centre == values[4, 4]
    assert fall.whole == values.max() / values.min()
    # half of four steps to either side
    inner = values[2:7, 2:7]
    assert fall.middle == inner.max() / inner.min()
    i, j = np.unravel_index(values.argmin(), values.shape)
    assert fall.least == (x[i], tilts[j])
    with pytest.raises(ModelError, match="in its middle"):
        stiffness_falls(found.assign(stiffness_free=found["stiffness_free"] * np.nan))


def test_planar_stiffness_out_of_reach_is_missing() -> None:
    found = planar_stiffness_map(x=[0.0, 5.0], b=[0.0])
    assert np.isfinite(found["stiffness"].sel(x=0.0)).all()
    assert found["stiffness"].sel(x=5.0).isnull().all()
    assert {v.attrs["units"] for v in found.data_vars.values()} == {"N/m"}


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"strut_stiffness": 0.0}, "not positive"),
        ({"guide_stiffness": -1.0}, "not positive"),
        ({"formula": "other"}, "formula"),
        ({"formula": "thesis", "screw_stiffness": 1e8}, "without a drive stiffness"),
    ],
)
def test_wrong_stiffness(more: dict[str, object], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        planar_compliance(MitSS1(), 0.0, 0.0, **more)  # type: ignore[arg-type]
