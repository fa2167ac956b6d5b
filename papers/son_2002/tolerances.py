"""Tolerances of the MIT-SS-1 and of the reconstructed Table 2, and what its bearings may carry."""

from __future__ import annotations

from strutwork.machines import mit_ss1_parts as parts
from strutwork.machines.mit_ss1 import MitSS1
from strutwork.overconstraint import Tolerance
from strutwork.papers.son_2002.strut_assembly import TILT, block, joint

#: Parallelism of the holes in the spindle housing, rad. Our choice; section 8.6 has them cut
#: by wire EDM in one set-up, "quite good".
HOUSING_TILT = 50e-6

#: Width of the zone in which a rail lies across the granite, m (sections 8.2 and 8.6: 4 µm
#: flatness of the granite, 4 µm parallelism of the rails).
RAIL_HEIGHT = 4e-6

#: Static rating of a bearing, N. Our assumption: the thesis names a tapered roller bearing of
#: 15 mm bore and 35 mm outer diameter by NSK (Table 4) and prints no rating; catalogues give
#: 13 to 15 kN for this size (30202).
STATIC_RATING = 13.2e3

#: Of the axial force in the equivalent static load P₀ = ½ Fr + Y₀ Fa of this size (ISO 76).
AXIAL_FACTOR = 1.0


def table_2_tolerances(tilt: float = TILT, distribution: str = "surface") -> tuple[Tolerance, ...]:
    """The three tilted block axes of Table 2; each moves both joints of its strut's end.

    Parameters
    ----------
    tilt : float
        Half-angle of the tolerance cone, rad.
    distribution : str
        "surface": the thesis places the axis "randomly on the surface of the tolerance cone".
    """
    return tuple(
        Tolerance(
            f"axis of block {i}",
            "parallelism",
            (joint(2 * i - 1), joint(2 * i)),
            slope=tilt,
            datum=block(i),
            distribution=distribution,
        )
        for i in (1, 2, 3)
    )


def pin_tolerances(
    block_tilt: float = TILT, housing_tilt: float = HOUSING_TILT, distribution: str = "uniform"
) -> tuple[Tolerance, ...]:
    """Parallelism of the machine's six pins, each about its near bearing.

    Parameters
    ----------
    block_tilt : float
        Of the pins in the moving blocks, rad (section 6.6: 300 µm/m).
    housing_tilt : float
        Of the pins in the spindle housing, rad.
    distribution : str
    """
    ends = (("block", block_tilt, parts.block), ("housing", housing_tilt, parts.seat))
    return tuple(
        Tolerance(
            f"{end} pin {i}",
            "parallelism",
            tuple(parts.strut(i, end, side) for side in parts.SIDES),
            slope=tilt,
            datum=node(i, "near"),
            distribution=distribution,
        )
        for end, tilt, node in ends
        for i in parts.STRUTS
    )


def rail_tolerances(
    height: float = RAIL_HEIGHT, distribution: str = "uniform"
) -> tuple[Tolerance, ...]:
    """Height of each rail above the granite, along y.

    Parameters
    ----------
    height : float
        Width of the zone, m.
    distribution : str
    """
    return tuple(
        Tolerance(
            f"rail {i}",
            "location",
            (parts.guide(i),),
            size=height,
            datum=parts.rail(i),
            axis=(0.0, 1.0, 0.0),
            distribution=distribution,
        )
        for i in parts.STRUTS
    )


def mit_ss1_tolerances() -> tuple[Tolerance, ...]:
    """The machine's tolerances: pins in the blocks and in the housing, and rails."""
    return (*pin_tolerances(), *rail_tolerances())


def bearing_limits(
    names: tuple[str, ...], rating: float = STATIC_RATING, safety: float = 1.0
) -> dict[tuple[str, str], float]:
    """What a bearing may carry, by joint and kind of force, N.

    Radial and axial force each for itself, in the equivalent static load P₀ = max(Fr,
    ½ Fr + Y₀ Fa) of ISO 76.

    Parameters
    ----------
    names : tuple of str
        Joints that are bearings.
    rating : float
        Static rating, N.
    safety : float
        Static safety factor s₀.
    """
    return {
        (name, kind): rating / (safety * factor)
        for name in names
        for kind, factor in (("radial force", 1.0), ("axial force", AXIAL_FACTOR))
    }


def machine_bearings(machine: MitSS1) -> tuple[str, ...]:
    """Joints of the machine's bearings."""
    return tuple(n for n in parts.bearings() if n in machine.linkage.joint_index)


def table_2_joints() -> tuple[str, ...]:
    """The six joints of Table 2."""
    return tuple(joint(n) for n in range(1, 7))
