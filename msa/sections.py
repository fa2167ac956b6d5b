"""Cross-sections of beams."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import isfinite, pi, tanh

from strutwork.errors import ModelError

#: Shear coefficients κ_y, κ_z as functions of Poisson's ratio.
ShearCoefficients = Callable[[float], tuple[float, float]]


@dataclass(frozen=True)
class Section:
    """Properties of a cross-section in its local y and z axes.

    Parameters
    ----------
    area : float
        A, m².
    second_moment_y, second_moment_z : float
        Iy for bending in the local x-z plane, Iz for bending in the local x-y plane, m⁴.
    torsion_constant : float
        J, m⁴; the polar moment only where the section is circular.
    shear_coefficients : callable or None
        κ_y, κ_z, no unit, from Poisson's ratio (Cowper 1966); None where shear areas are given.
    shear_areas : (float, float) or None
        Shear areas along y and z, m²; None with no coefficients means no shear deformation.
    name : str
        For messages.
    outline : tuple of float
        Outer sizes along y and z, m, for drawings; empty where unknown.
    shape : str
        As a model file names it; "properties" where the numbers come from a table.
    dimensions : tuple of (str, float)
        What the shape was given by, each with its size, m; empty for properties.

    Raises
    ------
    ModelError
        A property that is not positive and finite.
    """

    area: float
    second_moment_y: float
    second_moment_z: float
    torsion_constant: float
    shear_coefficients: ShearCoefficients | None = None
    shear_areas: tuple[float, float] | None = None
    name: str = "section"
    outline: tuple[float, ...] = ()
    shape: str = "properties"
    dimensions: tuple[tuple[str, float], ...] = ()

    def __post_init__(self) -> None:
        values = {
            "area": self.area,
            "Iy": self.second_moment_y,
            "Iz": self.second_moment_z,
            "J": self.torsion_constant,
        }
        if self.shear_areas is not None:
            values |= {"shear_area_y": self.shear_areas[0], "shear_area_z": self.shear_areas[1]}
        for field, value in values.items():
            _positive(self.name, field, value)

    def shear_area(self, poissons_ratio: float) -> tuple[float, float] | None:
        """Effective shear areas along y and z, m²; None where shear does not deform.

        Parameters
        ----------
        poissons_ratio : float
            ν, no unit.
        """
        if self.shear_areas is not None:
            return self.shear_areas
        if self.shear_coefficients is None:
            return None
        ky, kz = self.shear_coefficients(poissons_ratio)
        return ky * self.area, kz * self.area


def rod(diameter: float, name: str = "rod") -> Section:
    """Solid circular section; κ = 6 (1 + ν) / (7 + 6 ν) (Cowper 1966).

    Parameters
    ----------
    diameter : float
        m.
    name : str
        For messages.
    """
    _positive(name, "diameter", diameter)
    inertia = pi * diameter**4 / 64.0

    return Section(
        pi * diameter**2 / 4.0,
        inertia,
        inertia,
        2.0 * inertia,
        partial(_of_tube, 0.0),
        name=name,
        outline=(diameter, diameter),
        shape="rod",
        dimensions=(("diameter", diameter),),
    )


def tube(outer_diameter: float, inner_diameter: float, name: str = "tube") -> Section:
    """Hollow circular section (Cowper 1966).

    With m the ratio of inner to outer diameter,
    κ = 6 (1 + ν) (1 + m²)² / ((7 + 6 ν) (1 + m²)² + (20 + 12 ν) m²).

    Parameters
    ----------
    outer_diameter, inner_diameter : float
        m; the inner one below the outer.
    name : str
        For messages.

    Raises
    ------
    ModelError
        A diameter that is not positive, or an inner one not below the outer.
    """
    _positive(name, "outer_diameter", outer_diameter)
    _positive(name, "inner_diameter", inner_diameter)
    if inner_diameter >= outer_diameter:
        raise ModelError(
            f"section {name}",
            f"inner_diameter {inner_diameter:g} m is not below outer_diameter "
            f"{outer_diameter:g} m.",
            "Swap them, or use a rod.",
        )
    inertia = pi * (outer_diameter**4 - inner_diameter**4) / 64.0
    m2 = (inner_diameter / outer_diameter) ** 2

    return Section(
        pi * (outer_diameter**2 - inner_diameter**2) / 4.0,
        inertia,
        inertia,
        2.0 * inertia,
        partial(_of_tube, m2),
        name=name,
        outline=(outer_diameter, outer_diameter),
        shape="tube",
        dimensions=(("outer diameter", outer_diameter), ("inner diameter", inner_diameter)),
    )


def rectangle(width_y: float, height_z: float, name: str = "rectangle") -> Section:
    """Solid rectangle; κ = 10 (1 + ν) / (12 + 11 ν) (Cowper 1966), Saint-Venant's J.

    Parameters
    ----------
    width_y, height_z : float
        Sizes along the local y and z axes, m.
    name : str
        For messages.
    """
    _positive(name, "width_y", width_y)
    _positive(name, "height_z", height_z)

    return Section(
        width_y * height_z,
        width_y * height_z**3 / 12.0,
        height_z * width_y**3 / 12.0,
        rectangle_torsion_constant(width_y, height_z),
        _of_rectangle,
        name=name,
        outline=(width_y, height_z),
        shape="rectangle",
        dimensions=(("width along y", width_y), ("height along z", height_z)),
    )


def rectangle_torsion_constant(side: float, other: float) -> float:
    """Saint-Venant's torsion constant of a rectangle, m⁴ (Timoshenko and Goodier, §109).

    J = a b³ (1/3 − (64/π⁵)(b/a) Σ tanh(n π a / 2b) / n⁵) over odd n, a ≥ b.

    Parameters
    ----------
    side, other : float
        m, in either order.
    """
    a, b = max(side, other), min(side, other)
    series = sum(tanh(n * pi * a / (2.0 * b)) / n**5 for n in range(1, 60, 2))
    return a * b**3 * (1.0 / 3.0 - 64.0 / pi**5 * (b / a) * series)


def box(width_y: float, height_z: float, thickness: float, name: str = "box") -> Section:
    """Rectangular hollow section of one wall thickness, thin or thick.

    Torsion constant by Saint-Venant's theory and shear coefficients by Cowper's (1966), solved for
    the section as it is (`strutwork.msa.hollow_rectangle`): Bredt's formula loses 38 % of the
    torsion constant of a square with walls of 0.4 of its width.

    Parameters
    ----------
    width_y, height_z : float
        Outer sizes along the local y and z axes, m.
    thickness : float
        Of all four walls, m; less than half of either size.
    name : str
        For messages.

    Raises
    ------
    ModelError
        A size that is not positive, or walls that meet.
    """
    for field, value in (("width_y", width_y), ("height_z", height_z), ("thickness", thickness)):
        _positive(name, field, value)
    if 2.0 * thickness >= min(width_y, height_z):
        raise ModelError(
            f"section {name}",
            f"thickness {thickness:g} m leaves no hollow in {width_y:g} x {height_z:g} m.",
            "Use a rectangle, or a thinner wall.",
        )
    # it solves by SciPy, which other sections do not wait for
    from strutwork.msa.hollow_rectangle import hollow_rectangle  # noqa: PLC0415

    inner_y, inner_z = width_y - 2 * thickness, height_z - 2 * thickness
    exact = hollow_rectangle(width_y, height_z, thickness)
    return Section(
        width_y * height_z - inner_y * inner_z,
        (width_y * height_z**3 - inner_y * inner_z**3) / 12.0,
        (height_z * width_y**3 - inner_z * inner_y**3) / 12.0,
        exact.torsion_constant,
        exact.coefficients,
        name=name,
        outline=(width_y, height_z),
        shape="box",
        dimensions=(
            ("width along y", width_y),
            ("height along z", height_z),
            ("wall", thickness),
        ),
    )


# no closures: a section is sent to other processes
def _of_tube(m2: float, nu: float) -> tuple[float, float]:
    square = (1.0 + m2) ** 2
    k = 6.0 * (1.0 + nu) * square / ((7.0 + 6.0 * nu) * square + (20.0 + 12.0 * nu) * m2)
    return k, k


def _of_rectangle(nu: float) -> tuple[float, float]:
    k = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu)
    return k, k


def _positive(name: str, field: str, value: float) -> None:
    if not (isfinite(value) and value > 0):
        raise ModelError(f"section {name}", f"{field} is {value!r}.", "Give a positive number.")
