"""Three struts on one body, each on a far and a near elastic bearing, for tests of tolerances."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, axes_frame
from strutwork.msa import PlacedStructure, Structure
from strutwork.overconstraint import Quantity, Responses, Tolerance, tolerance_responses

TILT = 300e-6

RADIAL = {(f"joint{n}", "radial force"): 6e3 for n in range(1, 7)}
AXIAL = {(f"joint{n}", "axial force"): 1.5e3 for n in range(1, 7)}
LIMITS = RADIAL | AXIAL


def three_struts(length: float = 0.5, width: float = 0.1) -> PlacedStructure:
    """Struts of a length along z, z and −x, whose bearings are `width` apart along y."""
    points = [(-0.095, 0.0), (0.095, 0.0), (0.0, -0.150)]
    along = [(0, 1), (0, 1), (-1, 0)]
    nodes: list[str] = []
    positions: list[list[float]] = []
    ground: list[str] = []
    body: list[str] = []
    joints: list[Joint] = []
    frames = []
    for i, ((x, z), (ax, az)) in enumerate(zip(points, along, strict=True)):
        nodes.append(f"block{i + 1}")
        positions.append([x - length * ax, 0, z - length * az])
        ground.append(nodes[-1])
        for far in (True, False):
            n = 2 * i + (1 if far else 2)
            for side, owner in (("a", ground), ("b", body)):
                nodes.append(f"{side}{n}")
                positions.append([x, width if far else 0.0, z])
                owner.append(nodes[-1])
            k = 141.1e6 * (1 if far else 2)
            joints.append(
                Joint(
                    f"joint{n}",
                    "bushing",
                    (f"a{n}", f"b{n}"),
                    stiffness={"x": k, "y": 2 * k, "z": 9.549e6},
                )
            )
            frames.append(axes_frame(np.array([0, 1.0, 0]), np.array([ax, 0, az])))
    nodes.append("tool")
    positions.append([0, 0, 0])
    body.append("tool")
    linkage = Linkage(
        tuple(nodes),
        (Body(GROUND, tuple(ground)), Body("plate", tuple(body))),
        tuple(joints),
        "tool",
    )
    placement = Placement(np.array(positions, dtype=float), np.array(frames), np.zeros(0))
    return Structure(linkage).at(placement)


def tilted_axes(distribution: str = "surface") -> list[Tolerance]:
    """One axis per strut, tilted in a cone."""
    return [
        Tolerance(
            f"axis{i}",
            "parallelism",
            (f"joint{2 * i - 1}", f"joint{2 * i}"),
            slope=TILT,
            datum=f"block{i}",
            distribution=distribution,
        )
        for i in range(1, 4)
    ]


def one_of_each(distribution: str = "uniform") -> list[Tolerance]:
    """Zones of every shape, among them a length whose middle is not zero."""
    options: dict[str, Any] = {"distribution": distribution}
    return [
        tilted_axes(distribution)[0],
        Tolerance("place", "position", ("joint3", "joint4"), size=40e-6, datum="block2", **options),
        Tolerance("point", "point_position", ("joint4",), size=30e-6, **options),
        Tolerance(
            "face",
            "location",
            ("joint5", "joint6"),
            size=50e-6,
            datum="block3",
            length=0.2,
            width=0.3,
            **options,
        ),
        Tolerance(
            "spacer", "length", ("joint2",), limits=(-10e-6, 30e-6), axis=(0, 0, 1), **options
        ),
        Tolerance("seats", "flatness", ("joint1", "joint2"), size=20e-6, axis=(1, 0, 0), **options),
    ]


def case(
    tolerances: Sequence[Tolerance] | None = None, quantities: Sequence[Quantity] | None = None
) -> Responses:
    """Responses of the struts, to tilted axes by default."""
    return tolerance_responses(
        three_struts(), tilted_axes() if tolerances is None else tolerances, quantities
    )
