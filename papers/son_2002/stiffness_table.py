"""Table 6 of Son 2002, the measured stiffness, beside computed values, a fit and the null model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from strutwork.errors import NumericalError
from strutwork.machines import MitSS1
from strutwork.msa import axis_stiffness_free, tool_compliance
from strutwork.papers.published_rows import PublishedRow
from strutwork.papers.son_2002.calibrated import CALIBRATED_MOVING
from strutwork.papers.son_2002.planar_stiffness import Formula, planar_compliance
from strutwork.papers.son_2002.published import TABLE_6, table_6_row

Array = NDArray[Any]

Reading = Literal["as printed", "last two rows swapped"]

#: Places of Table 6: x in mm, tilt in degrees, in the table's order.
PLACES = ((0, 0), (50, 30), (50, -30), (-50, 30), (-50, -30))
QUANTITIES = ("Kx", "Ky", "Kz")

#: For each reading the order in which the rows' numbers are read.
READINGS: Mapping[Reading, tuple[int, ...]] = MappingProxyType(
    {"as printed": (0, 1, 2, 3, 4), "last two rows swapped": (0, 1, 2, 4, 3)}
)

#: Columns that lie in the machine's plane.
IN_PLANE = (0, 2)

#: Starts and bounds of a fit, N/m: softer than a rubber mount or stiffer than the granite says
#: that the data do not determine the number.
STARTS = ((1e8, 3e7), (3e8, 1e8), (1e9, 1e9))
BOUNDS = (1e6, 1e11)

MEASURED = (
    "measured at the spindle housing, at a place that is not published, after a dead zone; "
    "computed is "
    "1/C_ii at the tool tip"
)


@dataclass(frozen=True)
class ColumnFit:
    """How near a model comes to a column of Table 6.

    Parameters
    ----------
    reading : str
        A key of `READINGS`.
    model : str
    rms : (3,) of float or None
        Root mean square of ln(ours / published) in x, y and z; None where the model has none.
    parameters : mapping of name to float
        What was fitted, N/m.
    """

    reading: Reading
    model: str
    rms: tuple[float | None, ...]
    parameters: Mapping[str, float]

    def to_dict(self) -> dict[str, Any]:
        """Fields as plain values, SI."""
        return {**vars(self), "rms": list(self.rms), "parameters": dict(self.parameters)}


def published_stiffness(reading: Reading = "as printed") -> Array:
    """Table 6 in N/m, (5 places, 3 directions)."""
    found = np.array([[TABLE_6.value(table_6_row(*p), q) for q in QUANTITIES] for p in PLACES])
    return 1e6 * found[list(READINGS[reading])]


def calibrated_alone() -> MitSS1:
    """The machine on rigid ground, calibrated to the thesis's numerical frequencies."""
    return replace(MitSS1(), **CALIBRATED_MOVING)  # type: ignore[arg-type]


def computed_stiffness(machine: MitSS1 | None = None) -> Array:
    """1/C_ii at the tool tip of the structure at the places of Table 6, N/m, (5, 3).

    Default: the machine calibrated to the thesis's numerical frequencies and to its K_y at home.
    """
    machine = machine or calibrated_alone()
    placed = machine.structure.at(machine.place(machine.poses(*_places())))
    return axis_stiffness_free(tool_compliance(placed))[:, :3]


def table_6_rows(machine: MitSS1 | None = None) -> tuple[PublishedRow, ...]:
    """Table 6 beside the structure's stiffness at the tool tip, in both readings.

    None of it is reproduced: in x and z together neither reading is met better than by one
    constant a column, see `table_6_fits`. Only the trend of section 9.2.1 is: the two corners
    x = −50 mm, b = −30° and x = 50 mm, b = 30° are much softer than home.
    """
    ours = computed_stiffness(machine)
    rows = []
    for reading in READINGS:
        published = published_stiffness(reading)
        for i, place in enumerate(PLACES):
            source = READINGS[reading][i]
            moved = "" if source == i else f"; numbers of the row {table_6_row(*PLACES[source])}"
            rows += [
                PublishedRow(
                    f"{table_6_row(*place)}, {reading}",
                    quantity,
                    "N/um",
                    float(published[i, k] / 1e6),
                    float(ours[i, k] / 1e6),
                    "not reproducible",
                    MEASURED + moved,
                )
                for k, quantity in enumerate(QUANTITIES)
            ]
    return tuple(rows)


def table_6_fits(machine: MitSS1 | None = None) -> tuple[ColumnFit, ...]:
    """Residuals of every model in both readings.

    The null model is one constant a column, the geometric mean: three numbers fitted that know
    nothing of the machine. Ours has nothing fitted to Table 6. The fits have two numbers, k_i
    and k_tr (eq. 51), to x and z together, by each of the formulas of `planar_compliance`.
    """
    machine = machine or calibrated_alone()
    ours = computed_stiffness(machine)
    found = []
    for reading in READINGS:
        published = published_stiffness(reading)
        constant = np.exp(np.log(published).mean(axis=0))
        found += [
            ColumnFit(
                reading,
                "one constant a column",
                _rms(np.log(constant / published)),
                dict(zip(QUANTITIES, constant.tolist(), strict=True)),
            ),
            ColumnFit(
                reading, "computed, calibrated elsewhere", _rms(np.log(ours / published)), {}
            ),
            *(_fitted(machine, reading, published, f) for f in ("corrected", "thesis")),
        ]
    return tuple(found)


def _fitted(machine: MitSS1, reading: Reading, published: Array, formula: Formula) -> ColumnFit:
    """Least squares of the logarithms over ln k_i and ln k_tr."""
    wanted = np.log(published[:, IN_PLANE])
    places = _places()

    def residuals(logs: Array) -> Array:
        k, guide = np.exp(logs)
        c = planar_compliance(machine, places[0], places[2], k, guide, formula=formula)
        found = 1.0 / np.diagonal(c, axis1=-2, axis2=-1)[:, :2]
        return np.asarray((np.log(found) - wanted).ravel())

    fits = [least_squares(residuals, np.log(s), bounds=np.log(BOUNDS)) for s in STARTS]
    best = min(fits, key=lambda fit: float(fit.cost))
    if not best.success:
        raise NumericalError(
            "fit to Table 6", f"did not converge: {best.message}.", "Widen its bounds."
        )
    x, z = _rms(best.fun.reshape(wanted.shape))
    k, guide = np.exp(best.x)
    return ColumnFit(
        reading,
        f"k_i and k_tr fitted, {formula} formula",
        (x, None, z),
        {"strut_stiffness": float(k), "guide_stiffness": float(guide)},
    )


def _places() -> tuple[Array, float, Array]:
    """x, z, b of Table 6, m and rad."""
    x, b = np.array(PLACES, dtype=float).T
    return 1e-3 * x, 0.0, np.radians(b)


def _rms(logs: Array) -> tuple[float, ...]:
    return tuple(float(v) for v in np.sqrt((logs**2).mean(axis=0)))
