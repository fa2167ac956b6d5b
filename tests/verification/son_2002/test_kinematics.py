"""Kinematics, singularities and manipulability of the MIT-SS-1.

@phdthesis{son2002,
  author = {Son, Seung-Kil},
  title  = {A Hybrid Type Small 5-Axis {CNC} Milling Machine},
  school = {Massachusetts Institute of Technology},
  year   = {2002}
}

Dimensions from Appendix B with w1 counted to negative x, whose sign the scan has lost in eq. 40.
Where the thesis prints a figure only (Fig. 28), the numbers asserted are worked out from eqs 40 to
45 by hand-written formulas, apart from the machine's joints; where it prints numbers
(section 6.4) they are read from `strutwork.papers.son_2002.published`.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from strutwork.kinematics import drive_values, jacobians, velocity_ellipsoid
from strutwork.machines import MitSS1, WorkTable
from strutwork.machines import mit_ss1_parts as parts
from strutwork.machines.mit_ss1 import NOMINAL_TILT, NOMINAL_X
from strutwork.papers.son_2002.planar_kinematics import planar_kinematics
from strutwork.papers.son_2002.published import DIMENSIONS, MACHINE, MANIPULABILITY

PLANE = [0, 2, 4]
W1, W2, W3, L1, L2, L3, H1, H2, T, R, P = (value.value for value in DIMENSIONS)


def thesis_drives(x: Any, z: Any, b: Any) -> np.ndarray:
    """θ1, θ2, θ3 by eqs 40 to 45 as they are printed, with −w1 in eq. 40."""
    s1x = -W1 - x + R * np.cos(b) - T * np.sin(b)
    s2x = W2 - x - R * np.cos(b) - T * np.sin(b)
    s3x = W3 - x - (T + P) * np.sin(b)
    return np.stack(
        [
            z + R * np.sin(b) + T * np.cos(b) + np.sqrt(L1**2 - s1x**2),
            z - R * np.sin(b) + T * np.cos(b) + np.sqrt(L2**2 - s2x**2),
            z + (T + P) * np.cos(b) + np.sqrt(L3**2 - s3x**2),
        ],
        axis=-1,
    )


def strut_rows(machine: MitSS1, x: Any, b: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """a = (u_x, u_z, u_x q_z − u_z q_x), the struts' directions u, and the lower ends q."""
    placement = machine.place(machine.poses(x, 0.0, b))
    index = machine.linkage.node_index
    tool = placement.positions[..., None, index[parts.TOOL], :]
    upper, lower = (
        placement.positions[..., [index[parts.strut(i, end, "end")] for i in parts.STRUTS], :]
        for end in parts.ENDS
    )
    u = (upper - lower) / np.asarray(machine.strut_lengths)[:, None]
    q = lower - tool
    rows = np.stack([u[..., 0], u[..., 2], u[..., 0] * q[..., 2] - u[..., 2] * q[..., 0]], axis=-1)
    return rows, u, q


@cache
def nominal() -> tuple[np.ndarray, np.ndarray]:
    """The nominal workspace, x in m and b in rad, every 1 mm and 1°."""
    x, b = np.meshgrid(
        np.linspace(*NOMINAL_X, 101), np.linspace(-NOMINAL_TILT, NOMINAL_TILT, 61), indexing="ij"
    )
    return x, b


def test_blocks_at_home() -> None:
    machine = MitSS1()
    found = drive_values(machine, machine.place(machine.home()))
    # eqs 43 to 45 at x = z = b = 0, five digits
    np.testing.assert_allclose(found, [0.49495, 0.48889, 0.69313], rtol=0.0, atol=5e-6)


def test_inverse_kinematics_of_the_thesis() -> None:
    machine = MitSS1()
    x, b = nominal()
    z = 0.3 * np.sin(7.0 * x + b)
    found = drive_values(machine, machine.place(machine.poses(x, z, b)))
    # the same formula in another order: rounding
    np.testing.assert_allclose(found, thesis_drives(x, z, b), rtol=0.0, atol=1e-14)


def test_workpiece_coordinates() -> None:
    """Eqs 39, 46 and 47 with h1 = h2 = 0.1 m, written out; (x, 0, z) in the plane of the tool."""
    random = np.random.default_rng(5)
    work, a = random.uniform(-0.1, 0.1, (50, 3)), random.uniform(-1.2, 1.2, 50)
    xw, yw, zw = work.T
    theta4 = -yw * np.cos(a) - zw * np.sin(a) - H2 * np.sin(a)
    table = WorkTable(axis_height=H1, table_height=H2)
    found = table.drive_values(work, a)
    np.testing.assert_allclose(found, np.stack([theta4, -a], axis=-1), atol=1e-16)
    tool = table.tool_position(work, a)
    np.testing.assert_array_equal(tool[:, 0], xw)
    # eq. 39, second row: θ4 brings the point into the plane
    np.testing.assert_allclose(
        yw * np.cos(a) + zw * np.sin(a) + H2 * np.sin(a) + found[:, 0], 0.0, atol=1e-16
    )
    np.testing.assert_allclose(
        tool[:, 2], -yw * np.sin(a) + zw * np.cos(a) + H1 + H2 * np.cos(a), atol=1e-16
    )


def test_inverse_jacobian_by_the_struts_directions() -> None:
    """Appendix B in vectors: row i of J⁻¹ is a_i / u_iz; nothing out of the plane moves a drive."""
    machine = MitSS1()
    x, b = (grid[::10, ::10] for grid in nominal())
    rows, u, _ = strut_rows(machine, x, b)
    inverse = jacobians(machine.linkage, machine.place(machine.poses(x, 0.0, b))).inverse
    # rates are of order one: rounding of a null space of 42 columns
    np.testing.assert_allclose(inverse[..., PLANE], rows / u[..., 2:], atol=1e-12)
    np.testing.assert_allclose(inverse[..., [1, 3, 5]], 0.0, atol=1e-12)


def test_inverse_jacobian_of_the_sliding_units() -> None:
    """Appendix B: J_tr⁻¹ row i is a_i / u_ix, from w_i as the drive; by central differences."""
    machine = MitSS1()
    x, b = 0.013, 0.21
    rows, u, _ = strut_rows(machine, x, b)
    step = 1e-6

    def rails(dx: float, dz: float, db: float) -> np.ndarray:
        """Where the rails would have to stand for the blocks to keep their heights."""
        poses = machine.poses(x + dx, dz, b + db)
        points = poses.position + np.einsum("ij,kj->ki", poses.rotation, machine.seats)
        height = drive_values(machine, machine.place(machine.poses(x, 0.0, b)))
        side = np.sign(u[:, 0])
        length = np.asarray(machine.strut_lengths)
        return np.asarray(points[:, 0] + side * np.sqrt(length**2 - (height - points[:, 2]) ** 2))

    numeric = np.stack(
        [(rails(*step * e) - rails(*-step * e)) / (2 * step) for e in np.eye(3)], axis=-1
    )
    np.testing.assert_allclose(rails(0.0, 0.0, 0.0), machine.rails, atol=1e-15)
    # central differences: step² and rounding over the step; w1 itself counts the other way
    np.testing.assert_allclose(numeric, rows / u[:, :1], atol=1e-8)


def determinant(b: float, x: float) -> float:
    return float(np.linalg.det(strut_rows(MitSS1(), x, b)[0]))


@pytest.mark.parametrize(
    ("x", "degrees"), [(-0.06, -42.5), (-0.03, -51.0), (0.0, -58.5), (0.04, -67.1)]
)
def test_the_three_struts_meet_at_an_actuator_singularity(x: float, degrees: float) -> None:
    """Fig. 28-(b): on the solid curve "the three extension lines of the struts meet at one point".

    The angles are to a tenth of a degree. Where the determinant has its root the lines meet to
    1e-13 m: rounding of coordinates below one metre and of the root.
    """
    machine = MitSS1()
    # at x = −60 mm strut 2 lies level half a degree further
    low, high = np.radians([degrees - 0.2, degrees + 0.2])
    root = brentq(determinant, low, high, args=(x,), xtol=1e-15, rtol=1e-15)
    assert np.degrees(root) == pytest.approx(degrees, abs=0.06)
    _, u, q = strut_rows(machine, x, root)
    u, q = u[:, [0, 2]], q[:, [0, 2]]
    normal = np.stack([-u[:, 1], u[:, 0]], axis=-1)
    level = (normal * q).sum(-1)
    meeting = np.linalg.solve(normal[:2], level[:2])
    assert abs(normal[2] @ meeting - level[2]) < 1e-13
    # and the joints' own rows lose a rank there
    inverse = jacobians(machine.linkage, machine.place(machine.poses(x, 0.0, root))).inverse
    assert np.linalg.cond(inverse[:, PLANE]) > 1e10


def test_no_actuator_singularity_in_the_nominal_workspace() -> None:
    """Section 6.1: "the workspace does not include a singularity".

    The range of det [a1 a2 a3], m, over x from −60 to 40 mm and b within 30°: −0.089 to −0.0275,
    both read to their last digit.
    """
    machine = MitSS1()
    found = np.linalg.det(strut_rows(machine, *nominal())[0])
    assert found.min() == pytest.approx(-0.089, abs=5e-4)
    assert found.max() == pytest.approx(-0.0275, abs=1e-4)


def test_position_condition_number() -> None:
    """Section 6.4: "The condition number varies between 1.74 - 2.71"; nothing is tuned.

    The tool's x, y and z with a and b held, the four sliding drives; the table's slide along y
    has the ratio one, and the tilt of the table changes nothing (a property test). Published to
    0.01; the range on a grid of 1 mm and 1° is within 0.002 of 1.743 and 2.706.
    """
    machine = MitSS1()
    rows, u, _ = strut_rows(machine, *nominal())
    blocks = (rows / u[..., 2:])[..., :2]
    rates = np.zeros((*blocks.shape[:-2], 4, 3))
    rates[..., :3, [0, 2]] = blocks
    rates[..., 3, 1] = -1.0
    found = velocity_ellipsoid(rates).condition
    published = [
        MANIPULABILITY.value(MACHINE, f"position condition number, {end}")
        for end in ("least", "most")
    ]
    assert [found.min(), found.max()] == pytest.approx([1.743, 2.706], abs=2e-3)
    assert [found.min(), found.max()] == pytest.approx(published, abs=5e-3)
    # the thesis names this corner as one where the condition number increases sharply
    x, b = nominal()
    assert (x.flat[found.argmax()], np.degrees(b.flat[found.argmax()])) == pytest.approx(
        (-0.06, -30.0)
    )


def test_the_ellipsoid_shrinks_at_the_two_corners() -> None:
    """Section 6.4, Fig. 34 (b) and (c): smallest axis and volume fall towards two corners.

    "as the end-effector gets close to x = -0.06, b = -30° or x = 0.04, b = 30°, [...] the volume of
    the velocity ellipsoid and the minimum eigenvalue goes down rapidly": least of all there.
    """
    found = planar_kinematics()
    smallest, volume, condition = (
        found[name].to_numpy() for name in ("smallest", "volume", "condition")
    )
    middle = tuple(n // 2 for n in volume.shape)
    soft, others = ((0, 0), (-1, -1)), ((0, -1), (-1, 0))
    assert int(volume.argmin()) == int(smallest.argmin()) == 0
    for corner in soft:
        assert volume[corner] < 0.7 * volume[middle]
        assert smallest[corner] < smallest[middle]
        assert all(volume[corner] < 0.8 * volume[other] for other in others)
    # the text has the condition number rise sharply at both: it does at the first alone
    assert condition[0, 0] > 1.3 * condition[middle]
    assert condition[-1, -1] < condition[middle]
