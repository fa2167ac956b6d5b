"""Which part and which mode limit the depth of a cut, in a sentence."""

from __future__ import annotations

from strutwork.cutting import DepthEffects
from strutwork.reports.numbers import share, significant
from strutwork.reports.part_groups import PartGroup, part_groups

#: A part is made stiffer by this share in the sentence.
STIFFER = 0.1

#: Effects that are nearer to zero than this are none.
NOTHING = 5e-4


def effect_groups(effects: DepthEffects) -> tuple[PartGroup, ...]:
    """Effects of parts alike together, the largest first.

    Parameters
    ----------
    effects : DepthEffects
    """
    return part_groups(effects.to_dict())


def limiting_sentence(effects: DepthEffects) -> str:
    """Which mode limits the depth, and what the part with the largest effect would raise it by.

    Parameters
    ----------
    effects : DepthEffects
    """
    mode = f"The mode at {significant(effects.limiting_mode, 4)} Hz limits the depth."
    groups = effect_groups(effects)
    if not groups or groups[0].share < NOTHING:
        return f"{mode} No part that is made stiffer raises it."
    first = groups[0]
    return (
        f"{mode} Stiffening {first.label} by {100 * STIFFER:.0f} % raises the depth by "
        f"{share(raised(first.share))}."
    )


def raised(effect: float) -> float:
    """By which share the depth grows where a part with this effect is made stiffer.

    Parameters
    ----------
    effect : float
    """
    return float((1.0 + STIFFER) ** effect - 1.0)
