"""What was assumed about a machine, and where each value comes from."""

from __future__ import annotations

from math import degrees

from strutwork.machines import Alizade3PRPS, Eclipse3PPRS, Glozman3PRRS, Proposed3PPRS, ThreeLegs
from strutwork.papers.tables import texts
from strutwork.reports.content import Cell, Column, Table
from strutwork.reports.numbers import significant
from strutwork.studies import Filters

PAPER, OURS, CALIBRATED = "paper", "assumed", "calibrated"

Line = tuple[str, str, str, str]


def assumptions_table(machine: ThreeLegs, apparent: ThreeLegs, title: str) -> Table:
    """Dimensions and properties of a machine with their sources.

    Parameters
    ----------
    machine, apparent : ThreeLegs
        With true spherical joints, and as the paper's numbers suggest.
    title : str
    """
    lines = [*_common(machine), *_own(machine), _pole(machine, apparent)]
    return _table(f"{title}: dimensions and properties", lines)


def method_table(filters: Filters) -> Table:
    """How the numbers were made, the same for every machine."""
    kinds = "all" if filters.joint_kinds is None else ", ".join(filters.joint_kinds)
    limit = "none" if filters.condition_limit is None else significant(filters.condition_limit)
    return _table(
        "Method",
        [
            (
                "Hemisphere of the check points",
                "radius 4 mm, 317 points",
                PAPER,
                (
                    "section 3; the points are not printed: assumed is the lattice i² + j² ≤ "
                    "100, projected up"
                ),
            ),
            (
                "Roll γ about the normal",
                "24 steps over 120°",
                OURS,
                "the best of them is taken at each point by the largest Kxx (section 3.3.1)",
            ),
            (
                "Joint ranges respected",
                kinds,
                OURS,
                "with the other ranges of Table 3 the published means are out of reach",
            ),
            (
                "Near-singular poses dropped",
                f"condition number ≥ {limit}",
                OURS,
                "the paper drops them by condition number but gives no limit",
            ),
            (
                "Stiffness along an axis",
                "(C⁻¹)_ii, other directions blocked",
                OURS,
                "this meaning agrees with the paper's tables",
            ),
            (
                "Deformation of the links",
                "bending, torsion, axial",
                PAPER,
                "Euler-Bernoulli beams; section 3.3.1 lists bending and axial deformation only",
            ),
            (
                "Passive joints, platform, carriages",
                "rigid",
                OURS,
                "free directions free, the others without compliance",
            ),
            ("Guide", "rigid", OURS, "only the drives are compliant along it"),
        ],
    )


def models_table() -> Table:
    """The two joint models side by side."""
    return Table(
        "The two joint models",
        (
            *texts(
                "", "true spherical joints (default)", "as the paper's numbers suggest (comparison)"
            ),
        ),
        (
            (
                "last link at the platform",
                "spherical joint, free to rotate",
                "clamped: it cannot rotate against the platform",
            ),
            (
                "carriage on the guide",
                "follows the guide and rotates as it slides",
                "slides along the tangent and does not rotate",
            ),
            (
                "purpose",
                "the machine as it is drawn and described",
                "comes closest to the paper's tables; not a prediction",
            ),
        ),
    )


def _common(machine: ThreeLegs) -> list[Line]:
    low, high = (degrees(v) for v in machine.hinge_range)
    material = machine.material
    return [
        ("Base radius R_b", _mm(machine.base_radius), PAPER, "Table 3"),
        ("Platform radius R_p", _mm(machine.platform_radius), PAPER, "Table 3"),
        ("Links", f"{machine.section.name} mm", PAPER, "section 3.3.1"),
        (
            "Material",
            f"{material.name}, E {material.youngs_modulus / 1e9:.0f} GPa",
            PAPER,
            "section 3.3.1 names the steel; the modulus is a handbook's",
        ),
        (
            "Stiffness of a drive",
            "3 N/µm on both drives of a leg",
            PAPER,
            "section 3.3.1 gives the value; it is assumed for both drives",
        ),
        ("Range of the passive revolute joint", f"{low:.0f}° to {high:.0f}°", PAPER, "Table 3"),
        ("Tool centre point", "centre of the spherical joints", OURS, "not printed"),
    ]


def _own(machine: ThreeLegs) -> list[Line]:
    if isinstance(machine, Proposed3PPRS):
        return [
            ("Link length L", _mm(machine.link_length), PAPER, "Table 1"),
            (
                "First link",
                "cantilever from the guide to the slider, |d − R_b| long",
                OURS,
                "its length changes with the pose; the paper does not say how it is modelled",
            ),
            (
                "Inverse kinematics",
                "d = √(Px² + Py²) + √(L² − Pz²)",
                PAPER,
                "eq. 4 read so that it agrees with eq. 6",
            ),
        ]
    if isinstance(machine, Eclipse3PPRS):
        return [
            ("Link length L", _mm(machine.link_length), PAPER, "Table 3"),
            (
                "Free length of the column",
                _mm(machine.column_length),
                CALIBRATED,
                "not printed; meets Table 4 best",
            ),
        ]
    if isinstance(machine, Alizade3PRPS):
        return [
            (
                "Hinge to joint centre, middle of the stroke",
                _mm(machine.middle_length),
                PAPER,
                "Table 3, section 4",
            ),
            (
                "Length of the flexible strut",
                _mm(machine.strut_length),
                CALIBRATED,
                "not printed; meets Table 4 best",
            ),
        ]
    if isinstance(machine, Glozman3PRRS):
        return [
            ("Length of each of the two links", _mm(machine.link_length), PAPER, "section 4"),
            (
                "Second drive",
                "a spring along the radius at the shoulder",
                CALIBRATED,
                "how 3 N/µm act on a rotary drive is not printed; this meets Table 4 best",
            ),
        ]
    return []


def _pole(machine: ThreeLegs, apparent: ThreeLegs) -> Line:
    height = _mm(machine.pole_height)
    if apparent.pole_height != machine.pole_height:
        height += f"; {_mm(apparent.pole_height)} as the paper's numbers suggest"
    if isinstance(machine, Eclipse3PPRS):
        return (
            "Pole of the hemisphere above the guide",
            height,
            OURS,
            "changes no stiffness of this machine",
        )
    return (
        "Pole of the hemisphere above the guide",
        height,
        CALIBRATED,
        "not printed; fitted to Table 4",
    )


def _mm(length: float) -> str:
    return f"{significant(1e3 * length, 4)} mm" if 1e3 * length % 1 else f"{1e3 * length:.0f} mm"


def _table(title: str, lines: list[Line]) -> Table:
    rows = [
        (what, value, Cell(kind, "fair" if kind == CALIBRATED else "plain"), source)
        for what, value, kind, source in lines
    ]
    heads = ("assumption", "value", "from", "source")
    return Table(title, [Column(h, "", False) for h in heads], rows)
