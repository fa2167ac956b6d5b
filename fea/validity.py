"""Up to which frequency the superelements of a structure hold."""

from __future__ import annotations

import warnings

from strutwork.errors import ValidityWarning
from strutwork.msa.structure import PlacedStructure


def limits(placed: PlacedStructure) -> dict[str, float]:
    """Frequency in Hz below which each superelement's answers hold to 1e-4, by its name.

    Half of the highest frequency retained with the interfaces held (`Superelement.cutoff`). A
    Krylov basis has none.

    Parameters
    ----------
    placed : PlacedStructure
    """
    found = {}
    for element in placed.structure.elements:
        cutoff = float(getattr(element, "cutoff", 0.0))
        if cutoff > 0.0:
            found[element.name] = cutoff / 2.0
    return found


def beyond(placed: PlacedStructure, highest: float) -> str:
    """What to say of frequencies above those to which a superelement holds.

    Parameters
    ----------
    placed : PlacedStructure
    highest : float
        Hz.

    Returns
    -------
    str
        Empty where all is well.
    """
    short = {name: limit for name, limit in limits(placed).items() if highest > limit}
    if not short:
        return ""
    named = ", ".join(f"{name} {limit:.4g} Hz" for name, limit in short.items())
    return (
        f"Frequencies up to {highest:.4g} Hz are shown. Above half of a solid's cutoff their "
        f"accuracy is not guaranteed: {named}. Raise its cutoff or its number of modes."
    )


def warn_beyond(placed: PlacedStructure, highest: float) -> None:
    """Warn of what `beyond` says.

    Parameters
    ----------
    placed : PlacedStructure
    highest : float
        Hz.

    Warns
    -----
    ValidityWarning
    """
    text = beyond(placed, highest)
    if text:
        warnings.warn(text, ValidityWarning, stacklevel=3)
