"""Geometric similarity: the same structure, larger or smaller, its joints by a law of their own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Joint, Placement
from strutwork.msa import Beam, Element, PlacedStructure, PointMass, Section, Spring

Array = NDArray[Any]


@dataclass(frozen=True)
class JointScaling:
    """Scaling of joints and springs with the size L of a machine.

    Parameters
    ----------
    translational : float
        a of k ~ L^a, N/m.
    rotational : float or None
        Exponent of k in N·m/rad; None: a + 2, as when the same law holds at lever arms that grow
        with L.
    damping : float or None
        Of viscous damping, translational, N·s/m; None: a + 1, which keeps the share c ω/k that a
        joint loses where frequencies fall with 1/L. Rotational damping grows faster by as much
        as rotational stiffness does.
    name : str
        For tables.

    Raises
    ------
    ModelError
        An exponent that is not finite.
    """

    translational: float = 1.0
    rotational: float | None = None
    damping: float | None = None
    name: str = ""

    def __post_init__(self) -> None:
        for field in ("translational", "rotational", "damping"):
            value = getattr(self, field)
            if value is not None and not isfinite(value):
                raise ModelError(
                    f"JointScaling.{field}", f"is {value!r}.", "Give the exponent of the size."
                )

    @property
    def stiffness_exponents(self) -> Array:
        """Of k in the six directions, (6,)."""
        a = self.translational
        return np.repeat([a, a + 2.0 if self.rotational is None else self.rotational], 3)

    @property
    def damping_exponents(self) -> Array:
        """Of c in the six directions, (6,)."""
        stiffness = self.stiffness_exponents
        first = self.translational + 1.0 if self.damping is None else self.damping
        return np.asarray(stiffness - self.translational + first)

    @property
    def formula(self) -> str:
        """The law in symbols."""
        first, *_, last = self.stiffness_exponents
        return f"k ~ L^{first:g}, rotational L^{last:g}"

    def __str__(self) -> str:
        return self.name or self.formula


#: Joints that grow with the machine: every length is similar.
SIMILAR = JointScaling(1.0, name="similar joints")

#: Roller bearings of a catalogue, k ~ L^0.8 (Son 2002, section 3.3).
ROLLERS = JointScaling(0.8, name="roller bearings")

#: The same joints whatever the machine's size.
UNSCALED = JointScaling(0.0, 0.0, 0.0, name="unscaled joints")


def scaled(
    placed: PlacedStructure, factor: float, joints: JointScaling = SIMILAR
) -> PlacedStructure:
    """A placed structure of the same materials, `factor` times as large.

    Lengths grow with the factor, areas with its square, second moments with its fourth power,
    masses with its cube, inertias with its fifth power. An element of another kind must offer
    `scaled(factor)`.

    Parameters
    ----------
    placed : PlacedStructure
        At a batch of poses.
    factor : float
        L, dimensionless.
    joints : JointScaling
        Of joints and springs, which are bought or made by other laws than beams and solids.

    Returns
    -------
    PlacedStructure
        At the similar poses: heights and strokes grow with the factor, angles stay.

    Raises
    ------
    ModelError
        A factor that is not positive; an element that cannot be scaled.
    """
    if not (isfinite(factor) and factor > 0):
        raise ModelError("scale", f"the factor is {factor!r}.", "Give a positive number.")
    whole = placed.structure
    linkage = replace(
        whole.linkage, joints=tuple(_joint(j, factor, joints) for j in whole.linkage.joints)
    )
    structure = replace(
        whole,
        linkage=linkage,
        beams=tuple(_beam(b, factor) for b in whole.beams),
        springs=tuple(_spring(s, factor, joints) for s in whole.springs),
        masses=tuple(_mass(m, factor) for m in whole.masses),
        elements=tuple(_element(e, factor) for e in whole.elements),
    )
    return structure.at(_placement(placed.placement, factor))


def _placement(placement: Placement, factor: float) -> Placement:
    lengths = [factor if d in DIRECTIONS[:3] else 1.0 for _, d in placement.names]
    return replace(
        placement,
        positions=factor * placement.positions,
        # a placement may carry values that it does not name
        values=placement.values * np.array(lengths) if lengths else placement.values,
    )


def _section(section: Section, factor: float) -> Section:
    areas = section.shear_areas
    return replace(
        section,
        area=factor**2 * section.area,
        second_moment_y=factor**4 * section.second_moment_y,
        second_moment_z=factor**4 * section.second_moment_z,
        torsion_constant=factor**4 * section.torsion_constant,
        shear_areas=None if areas is None else (factor**2 * areas[0], factor**2 * areas[1]),
        outline=tuple(factor * side for side in section.outline),
    )


def _beam(beam: Beam, factor: float) -> Beam:
    first, second = beam.offsets
    return replace(
        beam,
        section=_section(beam.section, factor),
        offsets=(_vector(first, factor), _vector(second, factor)),
    )


def _vector(vector: Sequence[float], factor: float) -> tuple[float, float, float]:
    x, y, z = vector
    return factor * x, factor * y, factor * z


def _by_direction(values: Mapping[str, float], factor: float, exponents: Array) -> dict[str, float]:
    powers = dict(zip(DIRECTIONS, (factor**exponents).tolist(), strict=True))
    return {d: powers[d] * value for d, value in values.items()}


def _joint(joint: Joint, factor: float, law: JointScaling) -> Joint:
    matrix = joint.matrix
    if matrix is not None:
        # between a translation and a rotation the mean of their exponents
        half = factor ** (law.stiffness_exponents / 2.0)
        rows = np.asarray(matrix, dtype=float) * np.outer(half, half)
        matrix = tuple(tuple(row) for row in rows.tolist())
    return replace(
        joint,
        stiffness=_by_direction(joint.stiffness, factor, law.stiffness_exponents),
        damping=_by_direction(joint.damping, factor, law.damping_exponents),
        limits={
            d: (factor * low, factor * high) if d in DIRECTIONS[:3] else (low, high)
            for d, (low, high) in joint.limits.items()
        },
        matrix=matrix,
    )


def _spring(spring: Spring, factor: float, law: JointScaling) -> Spring:
    grown = _by_direction(spring.stiffness, factor, law.stiffness_exponents)
    return replace(spring, stiffness=grown)


def _mass(mass: PointMass, factor: float) -> PointMass:
    return replace(
        mass,
        mass=factor**3 * mass.mass,
        inertia=tuple(tuple(factor**5 * v for v in row) for row in mass.inertia),
        offset=_vector(mass.offset, factor),
    )


def _element(element: Element, factor: float) -> Element:
    grow = getattr(element, "scaled", None)
    if grow is None:
        raise ModelError(
            f"element {element.name}",
            f"a {type(element).__name__} cannot be scaled.",
            "Give it a method scaled(factor) that returns the element of the similar part.",
        )
    grown: Element = grow(factor)
    return grown
