"""The same machine in Pinocchio and in MuJoCo: Jacobian at the tool and mass matrix to 1e-9."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.machines.robots import Robot, read_robot, robot_of, robot_text
from strutwork.machines.robots.models import model_of
from tests.robots import EXAMPLES, placed, tool_jacobian

Array = NDArray[Any]

#: Relative to the largest entry: rounding of two programs and of poses closed to 1e-12.
NEAR = 1e-9

#: Pinocchio reads a joint that mimics another as a free one.
COUPLED = "examples/10_screws_and_belt.toml"

#: Displacements of the drives from home.
POSES = {
    "arm.urdf": ([0.4, -0.5, 0.3, 0.8, -0.6, 1.2], [-1.0, 0.3, 0.9, -0.7, 1.1, 0.2]),
    "four_bar.sdf": ([0.0], [0.4]),
    "biglide.urdf": ([-0.03, 0.06],),
    COUPLED: ([0.7],),
    "examples/machines/tricept.toml": ([0.01, -0.02, 0.015],),
    "examples/machines/3-rps.toml": ([0.01, -0.02, 0.015],),
    "examples/machines/6-ups.toml": ([0.0] * 6, [0.01, -0.02, 0.015, 0.0, 0.02, -0.01]),
}


def robot(name: str) -> Robot:
    if name.endswith(".toml"):
        return robot_of(load(name))
    return read_robot(EXAMPLES / name)


def cases(*without: str) -> list[Any]:
    return [
        pytest.param(name, values, id=f"{name} {k}")
        for name, poses in POSES.items()
        for k, values in enumerate(poses)
        if name not in without
    ]


def near(got: Array, wanted: Array) -> None:
    np.testing.assert_allclose(got, wanted, rtol=0, atol=NEAR * float(np.abs(wanted).max()))


def null_map(constraint: Array, driven: list[int]) -> Array:
    """Rates of all coordinates per rate of the driven ones, where constraints hold, (n, a)."""
    count = constraint.shape[1]
    asked = np.eye(count)[driven]
    # redundant rows, as of planar loops in space, are consistent
    matrix = np.concatenate([constraint, asked])
    right = np.concatenate([np.zeros((len(constraint), len(driven))), np.eye(len(driven))])
    found, _, rank, _ = np.linalg.lstsq(matrix, right, rcond=1e-10)
    assert rank == count
    return np.asarray(found)


def coordinates(model: Model, found: Any) -> dict[tuple[str, str], float]:
    """Displacements of all joints from home."""
    values = np.ravel(found.placement.values) - model.motion.home_values
    return dict(zip(model.motion.joints.names, values, strict=True))


@pytest.mark.parametrize(("name", "drives"), cases())
def test_mujoco_has_the_same_jacobian_and_mass(
    name: str, drives: list[float], tmp_path: Path
) -> None:
    mujoco = pytest.importorskip("mujoco")
    file = tmp_path / "robot.xml"
    file.write_text(robot_text(robot(name), file), encoding="utf-8")
    own = model_of(read_robot(file))
    m = mujoco.MjModel.from_xml_path(str(file))
    d = mujoco.MjData(m)
    at, found = placed(own, drives)
    known = coordinates(own, found)
    for k in range(m.njnt):
        joint = m.joint(k)
        if m.jnt_type[k] == mujoco.mjtJoint.mjJNT_BALL:
            vector = np.array([known[joint.name, r] for r in ("rx", "ry", "rz")])
            angle = float(np.linalg.norm(vector))
            quat = np.array([1.0, 0.0, 0.0, 0.0])
            if angle:
                mujoco.mju_axisAngle2Quat(quat, vector / angle, angle)
            d.qpos[m.jnt_qposadr[k] : m.jnt_qposadr[k] + 4] = quat
        else:
            d.qpos[m.jnt_qposadr[k]] += _own(known, joint.name, m.jnt_type[k])
    mujoco.mj_forward(m, d)
    rows = np.zeros((0, m.nv))
    if m.neq:
        # active constraints of equality come first
        count = int(d.ne)
        assert np.abs(d.efc_pos[:count]).max() < 1e-10
        rows = _dense(mujoco, m, d)[:count]
    driven = [int(m.jnt_dofadr[m.actuator_trnid[a, 0]]) for a in range(m.nu)]
    order = [
        next(a for a in range(m.nu) if m.joint(m.actuator_trnid[a, 0]).name.split(":")[0] == j)
        for j, _ in own.structure.linkage.driven
    ]
    rates = null_map(rows, [driven[a] for a in order])
    mass = np.zeros((m.nv, m.nv))
    mujoco.mj_fullM(m, d, mass)
    near(at.mass[0], rates.T @ mass @ rates)
    shift, turn = np.zeros((3, m.nv)), np.zeros((3, m.nv))
    site = next(m.site(s).name for s in range(m.nsite))
    mujoco.mj_jacSite(m, d, shift, turn, m.site(site).id)
    near(tool_jacobian(at), np.concatenate([shift, turn]) @ rates)


def _own(known: dict[tuple[str, str], float], name: str, kind: int) -> float:
    """Displacement of a hinge or slide, a piece of a joint or a joint."""
    joint, colon, direction = name.rpartition(":")
    if colon and (joint, direction) in known:
        return known[joint, direction]
    # 2 is a slide
    return known[name, "z" if kind == 2 else "rz"]


def _dense(mujoco: Any, m: Any, d: Any) -> Array:
    if not mujoco.mj_isSparse(m):
        return np.asarray(d.efc_J).reshape(-1, m.nv)
    dense = np.zeros((d.nefc, m.nv))
    for r in range(d.nefc):
        first, count = d.efc_J_rowadr[r], d.efc_J_rownnz[r]
        columns = d.efc_J_colind[first : first + count]
        dense[r, columns] = d.efc_J[first : first + count]
    return dense


@pytest.mark.parametrize(("name", "drives"), cases(COUPLED))
def test_pinocchio_has_the_same_jacobian_and_mass(
    name: str, drives: list[float], tmp_path: Path
) -> None:
    pin = pytest.importorskip("pinocchio")
    # a file that is a tree is read as it is by both, the others as they are written
    file = EXAMPLES / name
    if name != "arm.urdf":
        file = tmp_path / "robot.urdf"
        file.write_text(robot_text(robot(name), file), encoding="utf-8")
    read = read_robot(file)
    own = model_of(read)
    model = pin.buildModelFromUrdf(str(file))
    data = model.createData()
    at, found = placed(own, drives)
    known = coordinates(own, found)
    q = pin.neutral(model)
    for j in range(1, model.njoints):
        joint = model.joints[j]
        value = _piece(known, model.names[j])
        if joint.nq == 2:
            q[joint.idx_q : joint.idx_q + 2] = np.cos(value), np.sin(value)
        else:
            q[joint.idx_q] = value
    rows = _loops(pin, model, data, read, own, q)
    driven = [int(model.joints[model.getJointId(j)].idx_v) for j, _ in own.structure.linkage.driven]
    rates = null_map(rows, driven)
    mass = pin.crba(model, data, q)
    mass = np.triu(mass) + np.triu(mass, 1).T
    near(at.mass[0], rates.T @ mass @ rates)
    frame = model.getFrameId("tool0" if name == "arm.urdf" else _tool(model))
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    near(
        tool_jacobian(at),
        pin.getFrameJacobian(model, data, frame, pin.LOCAL_WORLD_ALIGNED) @ rates,
    )


def _tool(model: Any) -> str:
    return next(f.name for f in model.frames if f.name.lower() == "tcp")


def _piece(known: dict[tuple[str, str], float], name: str) -> float:
    joint, colon, direction = name.rpartition(":")
    if not colon or (joint, direction) not in known:
        return next(v for (j, _), v in known.items() if j == name)
    if (joint, "ry") in known:
        # a ball is three hinges there, a rotation vector here
        turn = Rotation.from_rotvec([known[joint, r] for r in ("rx", "ry", "rz")])
        return float(turn.as_euler("XYZ")[("rx", "ry", "rz").index(direction)])
    return known[joint, direction]


def _loops(pin: Any, model: Any, data: Any, read: Robot, own: Model, q: Array) -> Array:
    """Rows that hold the loops, by Pinocchio's Jacobians of their two sides, (r, n)."""
    closing = [j for j in read.joints if j.name not in set(model.names) and j.kind != "fixed"]
    closing = [j for j in closing if not any(n.startswith(f"{j.name}:") for n in model.names)]
    if not closing:
        return np.zeros((0, model.nv))
    home = pin.neutral(model)
    zero = _from_zero(own)
    for j in range(1, model.njoints):
        joint = model.joints[j]
        value = zero.get(model.names[j], 0.0)
        if joint.nq == 2:
            home[joint.idx_q : joint.idx_q + 2] = np.cos(value), np.sin(value)
        else:
            home[joint.idx_q] = value
    pin.forwardKinematics(model, data, home)
    pairs = []
    for joint in closing:
        places = [joint.place]
        if joint.kind == "revolute":
            places.append(joint.place + joint.axis)
        for place in places:
            at = pin.SE3(np.eye(3), place)
            ends = [_joint_of(model, link) for link in (joint.parent, joint.child)]
            pairs.append([(k, data.oMi[k].actInv(at)) for k in ends])
    pin.computeJointJacobians(model, data, q)
    rows = []
    for pair in pairs:
        places = [data.oMi[k].act(point).translation for k, point in pair]
        # the pose that was solved here closes the loop there
        np.testing.assert_allclose(*places, rtol=0, atol=1e-10)
        first, second = (
            pin.getFrameJacobian(model, data, k, point, pin.LOCAL_WORLD_ALIGNED)[:3]
            for k, point in pair
        )
        rows.append(first - second)
    return np.concatenate(rows)


def _joint_of(model: Any, link: str) -> int:
    return 0 if link == "world" else int(model.frames[model.getFrameId(link)].parentJoint)


def _from_zero(own: Model) -> dict[str, float]:
    """Coordinates of the file at the home of the model, where loops were closed."""
    values = dict(zip(own.motion.joints.names, own.motion.home_values, strict=True))
    return {name: float(value) for (name, _), value in values.items()}
