"""Up to which frequency the superelements of a structure hold."""

from __future__ import annotations

import warnings

from strutwork.errors import ValidityWarning
from strutwork.msa.structure import PlacedStructure


def limits(placed: PlacedStructure) -> dict[str, float]:
    """Frequency in Hz below which each superelement's answers hold to 1e-4, by its name.

    As computed when it was made (`Superelement.accurate_to`), else half of the highest frequency
    retained with the interfaces held; zero where neither is known.

    Parameters
    ----------
    placed : PlacedStructure
    """
    found = {}
    for element in placed.structure.elements:
        limit = getattr(element, "accurate_to", None)
        cutoff = getattr(element, "cutoff", None)
        if limit is not None:
            found[element.name] = float(limit)
        elif cutoff is not None:
            found[element.name] = float(cutoff) / 2.0
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
    by_cutoff = {e.name: getattr(e, "cutoff", 0.0) / 2.0 for e in placed.structure.elements}
    text = f"Frequencies up to {highest:.4g} Hz are shown."
    for why, names, remedy in (
        (
            "Above half of a solid's cutoff their accuracy is not guaranteed",
            [n for n in short if short[n] > 0.0 and short[n] == by_cutoff.get(n)],
            "Raise its cutoff or its number of modes.",
        ),
        (
            "Above the computed limit of a solid they may err by more than 1e-4 or be missing",
            [n for n in short if short[n] > 0.0 and short[n] != by_cutoff.get(n)],
            "Raise its number of modes, or refine its mesh.",
        ),
        (
            "No limit is stored with a reduced solid, so that nothing is known of their accuracy",
            [name for name in short if not short[name] > 0.0],
            "Reduce the solid again.",
        ),
    ):
        if names:
            named = ", ".join(f"{name} {short[name]:.4g} Hz" for name in names)
            text += f" {why}: {named}. {remedy}"
    return text


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
