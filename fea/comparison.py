"""What a comparison of computed and measured vibration gives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from strutwork.fea.frac_scale import FracScale


@dataclass(frozen=True)
class ModePair:
    """A computed mode and the measured one that it is.

    Parameters
    ----------
    computed, measured : int
        Positions in their sets.
    computed_frequency, measured_frequency : float
        Hz.
    difference_percent : float
        (computed − measured) / measured, %.
    computed_damping, measured_damping : float or None
        Viscous ratio ζ, no unit; None where it is not known.
    mac : float
        Of the two shapes, from 0 to 1, no unit; of the two spans where the mode is one of a group.
    group : int
        Number of modes of equal frequency that are compared as a span; one for a single mode.
    """

    computed: int
    measured: int
    computed_frequency: float
    measured_frequency: float
    difference_percent: float
    computed_damping: float | None
    measured_damping: float | None
    mac: float
    group: int


@dataclass(frozen=True)
class FunctionPair:
    """A computed and a measured response between the same directions.

    Parameters
    ----------
    output, input : str
    motion : str
        What is compared: displacement, velocity or acceleration per force.
    found : FracScale
    run : str
        Tells measured responses between the same ends apart; empty where there is one.
    """

    output: str
    input: str
    motion: str
    found: FracScale
    run: str = ""


@dataclass(frozen=True)
class Comparison:
    """What a comparison gives.

    Parameters
    ----------
    modes : tuple of ModePair
        By measured frequency.
    functions : tuple of FunctionPair
    only_computed, only_measured : tuple of float
        Frequencies of modes without a partner, Hz.
    notes : tuple of str
        What of the files was left out, assumed or changed, in words.
    """

    modes: tuple[ModePair, ...] = ()
    functions: tuple[FunctionPair, ...] = ()
    only_computed: tuple[float, ...] = ()
    only_measured: tuple[float, ...] = ()
    notes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return f"<Comparison: {len(self.modes)} paired modes, {len(self.functions)} responses>"

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, lists and words."""
        return {
            "modes": [{**vars(pair)} for pair in self.modes],
            "functions": [
                {
                    "output": f.output,
                    "input": f.input,
                    "run": f.run,
                    "motion": f.motion,
                    **vars(f.found),
                }
                for f in self.functions
            ],
            "only_computed": list(self.only_computed),
            "only_measured": list(self.only_measured),
            "notes": list(self.notes),
        }

    def to_dataframe(self) -> Any:
        """Paired modes as a `pandas.DataFrame`, one row per pair."""
        import pandas as pd  # noqa: PLC0415 - only here

        return pd.DataFrame([vars(pair) for pair in self.modes])
