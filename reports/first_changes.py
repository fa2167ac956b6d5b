"""What to change first: what ten percent more of each dimension brings, by its gradient."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite

import numpy as np
import xarray as xr

from strutwork.reports.alike import pattern
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.numbers import significant

#: The change whose effect is shown, as a share.
CHANGE = 0.1

#: Effects below this share of the quantity are not shown.
SMALL = 5e-5

_OF_EACH = ("gradient", "elasticity")

#: How numbers are shown: SI unit, factor and unit.
SHOWN = {
    "m": (1e3, "mm"),
    "Pa": (1e-9, "GPa"),
    "N/m": (1e-6, "N/µm"),
    "N*m/rad": (1e-3, "kN·m/rad"),
    "m^2": (1e6, "mm²"),
    "m^4": (1e12, "mm⁴"),
}


@dataclass(frozen=True)
class Effect:
    """Dimensions alike, changed together.

    Parameters
    ----------
    names : tuple of str
        Paths.
    value : str
        What they are, with a unit; of several the first and the last.
    shares : tuple of float
        Change of each quantity by ten percent more of them all, by its gradient, as a share.
    """

    names: tuple[str, ...]
    value: str
    shares: tuple[float, ...]

    @property
    def label(self) -> str:
        """Their path, with a star for the numbers in which they differ, and how many they are.

        Examples
        --------
        >>> Effect(("ball1.x", "ball2.x"), "", ()).label, Effect(("a1.z",), "", ()).label
        ('ball*.x (2)', 'a1.z')
        """
        if len(self.names) == 1:
            return self.names[0]
        columns = zip(*(re.split(r"(\d+)", name) for name in self.names), strict=True)
        path = "".join(c[0] if len(set(c)) == 1 else "*" for c in columns)
        return f"{path} ({len(self.names)})"


def effects(found: xr.Dataset, pose: int = 0) -> list[Effect]:
    """Effects on every quantity of a gradient, dimensions alike together, the largest first.

    Parameters
    ----------
    found : xarray.Dataset
        From `strutwork.studies.gradient.gradient`.
    pose : int
    """
    groups: dict[tuple[str, str], list[int]] = {}
    for k, (name, unit) in enumerate(
        zip(found["parameter"].to_numpy(), found["parameter_unit"].to_numpy(), strict=True)
    ):
        groups.setdefault((pattern(str(name)), str(unit)), []).append(k)
    elasticity = found["elasticity"].to_numpy()[:, :, pose]
    names = [str(n) for n in found["parameter"].to_numpy()]
    values = found["parameter_value"].to_numpy()
    rows = []
    for (_, unit), members in groups.items():
        rows.append(
            Effect(
                tuple(names[k] for k in members),
                _value([float(values[k]) for k in members], unit),
                tuple(CHANGE * float(v) for v in elasticity[:, members].sum(axis=1)),
            )
        )
    return sorted(rows, key=lambda row: -largest(row.shares))


def largest(shares: Sequence[float]) -> float:
    """Largest size among changes that are known, no unit, without the digits that rounding decides.

    Equal legs have equal effects: their order is that of the file on every machine.

    Parameters
    ----------
    shares : sequence of float
        As `Effect.shares`.
    """
    size = max((abs(s) for s in shares if isfinite(s)), default=0.0)
    return float(f"{size:.6g}")


def _value(values: Sequence[float], unit: str) -> str:
    factor, shown = SHOWN.get(unit, (1.0, unit if unit != "1" else ""))
    shown = shown.replace("*", "·").replace("^2", "²").replace("^3", "³")
    ends = list(dict.fromkeys(significant(factor * v, 4) for v in (min(values), max(values))))
    return " ".join([" to ".join(ends), shown]).strip()


def what_to_change_file(studies: Sequence[xr.Dataset], name: str) -> DataFile:
    """Every gradient and effect, one line per quantity and dimension.

    Parameters
    ----------
    studies : sequence of xarray.Dataset
        From `strutwork.studies.gradient.gradient`.
    name : str
        Of the file.
    """
    rows: list[list[object]] = []
    for found in studies:
        for q, quantity in enumerate(found["quantity"].to_numpy().tolist()):
            for g, parameter in enumerate(found["parameter"].to_numpy().tolist()):
                slope, power = (float(found[v].to_numpy()[q, g, 0]) for v in _OF_EACH)
                rows.append(
                    [
                        *(quantity, parameter, float(found["parameter_value"].to_numpy()[g])),
                        str(found["parameter_unit"].to_numpy()[g]),
                        float(found["value"].to_numpy()[q, 0]),
                        *([None, None] if not np.isfinite(slope) else [slope, CHANGE * power]),
                        str(found["gradient_unit"].to_numpy()[q, g]),
                    ]
                )
    columns = (
        *("quantity", "parameter", "parameter_value", "parameter_unit", "value"),
        *("gradient", "share_of_ten_percent_more", "gradient_unit"),
    )
    return csv_file(name, "gradients, and the linear effect of ten percent more", columns, rows)
