"""One leg as a template: its joints and beams are written once and repeated."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import Body, Joint, angle
from strutwork.kinematics.frames import dot
from strutwork.machines.radial import Radial
from strutwork.msa.beam import Beam

Array = NDArray[Any]

#: Node of the ground at the centre of the circular guide, shared by all legs.
CENTRE = "O"
#: Name by which a leg's template calls its joint centre on the platform.
SEAT = "P"


@dataclass(frozen=True)
class Leg:
    """Topology of one leg, in names that are short within the leg.

    `CENTRE` stands for the ground and `SEAT` for the leg's node on the platform; every other
    node becomes `leg1/node`, `leg2/node`, ….

    Parameters
    ----------
    nodes : tuple of str
        The leg's own nodes.
    bodies : tuple of Body
    joints : tuple of Joint
        From the ground to the platform.
    beams : tuple of Beam
    rigid : tuple of Body
        Rigid groups inside flexible bodies.
    lines : tuple of (str, str)
        What a drawing shows.
    """

    nodes: tuple[str, ...]
    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    beams: tuple[Beam, ...]
    rigid: tuple[Body, ...] = ()
    lines: tuple[tuple[str, str], ...] = ()

    def numbered(self, number: int) -> Leg:
        """The leg with the names it has in the machine.

        Parameters
        ----------
        number : int
            Counted from one.
        """

        def node(name: str) -> str:
            return name if name == CENTRE else seat(number) if name == SEAT else full(number, name)

        def pair(names: tuple[str, str]) -> tuple[str, str]:
            return node(names[0]), node(names[1])

        def body(b: Body) -> Body:
            return Body(full(number, b.name), tuple(node(n) for n in b.nodes))

        return Leg(
            tuple(node(n) for n in self.nodes),
            tuple(body(b) for b in self.bodies),
            tuple(
                replace(j, name=full(number, j.name), between=pair(j.between)) for j in self.joints
            ),
            tuple(replace(b, name=full(number, b.name), nodes=pair(b.nodes)) for b in self.beams),
            tuple(body(b) for b in self.rigid),
            tuple(pair(line) for line in self.lines),
        )


@dataclass(frozen=True)
class LegPlacement:
    """Where the legs stand; every array has the legs as its last batch axis, (..., 3).

    Parameters
    ----------
    positions : mapping of node to (..., 3, 3)
        Of the template's own nodes, m.
    frames : mapping of joint to (..., 3, 3, 3)
        Joint axes as columns; the platform's joint is not needed.
    values : mapping of (joint, direction) to (..., 3)
        Joint coordinates, m or rad.
    link : (..., 3, 3)
        Unit vector of the last link, towards the platform.
    elevation : (..., 3)
        Angle of the last link from the horizontal plane, rad.
    faults : mapping of reason to (..., 3) of bool
        Legs that cannot take the pose; their positions are finite but without meaning.
    """

    positions: Mapping[str, Array]
    frames: Mapping[str, Array]
    values: Mapping[tuple[str, str], Array]
    link: Array
    elevation: Array
    faults: Mapping[str, NDArray[np.bool_]] = field(default_factory=dict)


def full(number: int, name: str) -> str:
    """Name of a leg's part in the machine.

    Parameters
    ----------
    number : int
        Of the leg, counted from one.
    name : str
        Within the leg.
    """
    return f"leg{number}/{name}"


def seat(number: int) -> str:
    """Name of the joint centre of a leg on the platform.

    Parameters
    ----------
    number : int
        Of the leg, counted from one.
    """
    return f"platform/P{number}"


def square_root(square: Array, scale: float) -> tuple[Array, NDArray[np.bool_]]:
    """Root of a square, and where there is none, (...) each; there the root is `scale`.

    Works on complex arguments with a small imaginary part.

    Parameters
    ----------
    square : (...)
        m².
    scale : float
        m.
    """
    missing = np.asarray(square.real <= 0.0)
    return np.sqrt(np.where(missing, scale**2, square)), missing


def hinge_on_column(
    seats: Radial,
    base_radius: float,
    length: float,
    upward: Array | float,
    along: Callable[[Array, Array], Mapping[str, Array]],
) -> LegPlacement:
    """Place legs whose hinge a vertical slide lifts over the guide: joints guide, slide, hinge.

    Parameters
    ----------
    seats : Radial
    base_radius : float
        Of the guide, m; the hinge stands over it.
    length : float
        Of the link from the hinge to the platform, m.
    upward : (3,) or float
        One where a link rises to its joint centre, minus one where it descends; no unit.
    along : callable
        Given height (..., 3) and place (..., 3, 3) of the hinge, m, the nodes below it. The nodes
        `centre`, `root` and `end` are set here.

    Returns
    -------
    LegPlacement
        The height of a hinge is P_z − L sin φ, whatever the sign of φ.
    """
    inward = base_radius - seats.radius
    rise, missing = square_root(length**2 - inward * inward, length)
    rise = rise * upward
    top = seats.height - rise
    hinge = seats.at(base_radius, top)
    link = seats.points - hinge
    link = link / np.sqrt(dot(link, link))[..., None]
    elevation = angle(rise, inward)
    return LegPlacement(
        positions={
            "centre": np.zeros_like(seats.points),
            **along(top, hinge),
            "root": hinge,
            "end": seats.points,
        },
        frames={
            "guide": seats.guide_frame,
            "slide": seats.guide_frame,
            "hinge": seats.hinge_frame,
        },
        values={
            ("guide", "rz"): seats.angle,
            ("slide", "z"): top,
            ("hinge", "rz"): elevation,
        },
        link=link,
        elevation=elevation,
        faults={"its joint centre is farther from the guide than the link is long": missing},
    )
