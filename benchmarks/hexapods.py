"""Hexapods of 6-UPS legs from rods, springs and beams, at many poses."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, axes_frame
from strutwork.msa import Beam, Material, PlacedStructure, Structure, rod

Array = NDArray[Any]

STEEL = Material.isotropic(205e9, 0.29, 7870.0, name="steel")
LEGS = range(6)

#: Along a leg, N/m: its drive; across and along a joint, N/m: its bearings.
DRIVE, BEARING = 3e7, MappingProxyType({"x": 8e7, "y": 8e7, "z": 2e8})


def hexapod(
    poses: int, lower: str = "universal", *, beams: bool, bearings: bool
) -> PlacedStructure:
    """A hexapod at poses around home.

    Parameters
    ----------
    poses : int
    lower : str
        "universal", or "spherical": then every strut spins freely about its line.
    beams : bool
        Whether cylinders and rods bend; rigid otherwise, with the drive as the only spring.
    bearings : bool
        Whether the balls are elastic; locked otherwise.
    """
    at, frames, joints, bodies, inner = _parts(poses, lower, bearings)
    nodes = tuple(at)
    links = tuple(
        Beam(f"{part} {i}", pair, STEEL, rod(0.03))
        for i in LEGS
        for part, pair in (
            ("cylinder", (f"foot{i}", f"slide{i}")),
            ("rod", (f"rod{i}", f"head{i}")),
        )
    )
    linkage = Linkage(nodes, (*bodies, *inner), joints, tool="tool")
    structure = Structure(linkage, beams=links if beams else ())
    positions = np.stack([np.broadcast_to(at[n], (poses, 3)) for n in nodes], axis=1)
    turned = np.stack([np.broadcast_to(f, (poses, 3, 3)) for f in frames], axis=1)
    return structure.at(Placement(positions, turned, np.zeros((poses, 0))))


def _parts(
    poses: int, lower: str, bearings: bool
) -> tuple[dict[str, Array], list[Array], tuple[Joint, ...], list[Body], list[Body]]:
    random = np.random.default_rng(6)
    turn = Rotation.from_rotvec(random.uniform(-0.3, 0.3, (poses, 3)))
    tool = np.array([0.0, 0.0, 0.6]) + random.uniform(-0.1, 0.1, (poses, 3))
    at: dict[str, Array] = {"tool": tool}
    frames: list[Array] = []
    joints: list[Joint] = []
    base = np.radians([-10, 10, 110, 130, 230, 250])
    plate = np.radians([-50, 50, 70, 170, 190, 290])
    soft = dict(BEARING) if bearings else {}
    for i in LEGS:
        foot = 0.4 * np.array([np.cos(base[i]), np.sin(base[i]), 0.0])
        head = tool + turn.apply(0.2 * np.array([np.cos(plate[i]), np.sin(plate[i]), 0.1]))
        along = head - foot
        across = np.cross(along, (0.3, 1.0, 0.2))
        at |= {f"base{i}": foot, f"foot{i}": foot, f"head{i}": head, f"plate{i}": head}
        at |= {f"slide{i}": (foot + head) / 2, f"rod{i}": (foot + head) / 2}
        joints += [
            Joint(f"lower{i}", lower, (f"base{i}", f"foot{i}")),
            Joint(
                f"drive{i}",
                "prismatic",
                (f"slide{i}", f"rod{i}"),
                driven=("z",),
                stiffness={"z": DRIVE},
            ),
            Joint(f"ball{i}", "spherical", (f"head{i}", f"plate{i}"), stiffness=soft),
        ]
        frames += [
            axes_frame(across, np.cross(across, along)),
            axes_frame(along),
            axes_frame(along) if bearings else np.eye(3),
        ]
    bodies = [
        Body(GROUND, tuple(f"base{i}" for i in LEGS)),
        Body("platform", ("tool", *(f"plate{i}" for i in LEGS))),
    ]
    inner = [
        Body(f"{name}{i}", pair)
        for i in LEGS
        for name, pair in (
            ("cylinder", (f"foot{i}", f"slide{i}")),
            ("piston", (f"rod{i}", f"head{i}")),
        )
    ]
    return at, frames, tuple(joints), bodies, inner


#: Every kind by its words, made at a number of poses.
HEXAPODS: Mapping[str, Callable[[int], PlacedStructure]] = MappingProxyType(
    {
        "6-UPS, rods": lambda n: hexapod(n, beams=False, bearings=False),
        "6-SPS, rods that spin": lambda n: hexapod(n, "spherical", beams=False, bearings=False),
        "6-UPS, rods and springs in the balls": lambda n: hexapod(n, beams=False, bearings=True),
        "6-UPS, beams": lambda n: hexapod(n, beams=True, bearings=False),
        "6-UPS, beams and springs in the balls": lambda n: hexapod(n, beams=True, bearings=True),
    }
)
