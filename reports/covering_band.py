"""A frequency band wide enough that the modes inside it explain the static compliance, in words."""

from __future__ import annotations

from collections.abc import Sequence

from strutwork.fea import Port
from strutwork.msa import PlacedStructure
from strutwork.reports.numbers import share, significant
from strutwork.studies.covering_band import band_of
from strutwork.studies.dynamic import MODES


def covering_band(
    placed: PlacedStructure, ports: Sequence[Port], count: int = MODES
) -> tuple[tuple[float, float] | None, str]:
    """The band of `strutwork.studies.covering_band`, and what it leaves out.

    Parameters
    ----------
    placed : PlacedStructure
        One pose.
    ports : sequence of Port
    count : int

    Returns
    -------
    band : (float, float) or None
        Hz; None where no mode has a frequency.
    stop : str
        Empty, or how much of which port's compliance the modes inside carry.

    Raises
    ------
    ModelError
        No mass, or a port that cannot move.
    """
    band = band_of(placed, ports, count)
    if band is None:
        return None, ""
    if not band.short:
        return (band.low, band.high), ""
    short = [f"{port} {share(part)}" for port, part in band.short]
    return (band.low, band.high), (
        f"The band ends at {significant(band.high)} Hz. The modes in it carry this share of the "
        f"static compliance: {', '.join(short)}; the rest belongs to higher modes."
    )
