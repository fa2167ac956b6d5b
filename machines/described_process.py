"""A milling cut as a model file or a file of its own describes it."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING

from strutwork.errors import ModelError

if TYPE_CHECKING:
    from strutwork.machines.model_process_schema import ProcessTable


@dataclass(frozen=True)
class DescribedProcess:
    """A milling cut; `strutwork.cutting` computes with it.

    Parameters
    ----------
    diameter : float
        Of the cutter, m.
    teeth : int
    helix, lead : float
        Angle of the helix, and between edge and the plane across the axis, rad.
    material : str
        Of the library of `strutwork.cutting`; empty where the coefficients are given.
    coefficients : (float, float, float)
        Tangential, radial and axial, Pa; zero where a material is named.
    source : str
        Where the coefficients come from.
    immersion : float
        Radial depth of cut by the diameter, no unit.
    way : str
        "up" or "down".
    feed_per_tooth : float
        m.
    axis, feed : (float, float, float)
        Axis of the tool from its tip to its holder, and direction of the feed, where the tool
        has not turned; both turn with the tool. Global axes, any unit.
    speeds : (float, float)
        Of the spindle, least and largest, rpm.
    points : int
        Speeds between them, both included.
    modal_ratio : float or None
        Damping ratio of every mode, no unit, where the machine states no damping.
    """

    diameter: float
    teeth: int
    helix: float
    lead: float
    material: str
    coefficients: tuple[float, float, float]
    source: str
    immersion: float
    way: str
    feed_per_tooth: float
    axis: tuple[float, float, float]
    feed: tuple[float, float, float]
    speeds: tuple[float, float]
    points: int
    modal_ratio: float | None = None


def process_of(table: ProcessTable | None) -> DescribedProcess | None:
    """The process of a table, or None without one.

    Parameters
    ----------
    table : ProcessTable or None

    Raises
    ------
    ModelError
        Neither a material nor coefficients, or both; coefficients without a source; speeds that
        do not rise.
    """
    if table is None:
        return None
    given = table.tangential is not None
    if given == (table.material is not None):
        raise ModelError(
            "process",
            "has a material and a tangential coefficient."
            if given
            else "has neither a material nor a tangential coefficient.",
            'Give one of them, as in material = "aluminium-7075-t6".',
        )
    if not given and (table.radial or table.axial):
        raise ModelError(
            "process",
            "has coefficients beside a material, which has its own.",
            "Leave the material out and give the tangential coefficient as well.",
        )
    if given and not table.source.strip():
        raise ModelError(
            "process",
            "has coefficients without a source.",
            'Say where they come from, as in source = "our force measurement of 12 May".',
        )
    low, high = (round(30.0 * v / pi, 9) for v in (table.speeds.from_, table.speeds.to))
    if not low < high:
        raise ModelError(
            "process", "has speeds that do not rise.", "Give from below to, as 2000 rpm."
        )
    return DescribedProcess(
        table.diameter,
        table.teeth,
        table.helix,
        table.lead,
        table.material or "",
        (table.tangential or 0.0, table.radial, table.axial),
        table.source,
        table.immersion,
        table.way,
        table.feed_per_tooth,
        table.axis,
        table.feed,
        (low, high),
        table.speeds.points,
        table.modal_ratio,
    )
