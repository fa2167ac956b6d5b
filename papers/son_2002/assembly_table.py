"""Table 2 of Son 2002 beside the reconstructed assembly, and the fit of its two stiffnesses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from strutwork.errors import ModelError, NumericalError
from strutwork.overconstraint import WorstCase, tolerance_responses, worst_case
from strutwork.papers.published_rows import PublishedRow, Status
from strutwork.papers.son_2002.published import TABLE_2, table_2_row
from strutwork.papers.son_2002.strut_assembly import CALIBRATED_ON_CASE_I, CASES, StrutAssembly
from strutwork.papers.son_2002.tolerances import table_2_joints, table_2_tolerances

Array = NDArray[Any]

Set = Literal["all cases", "case I"]

#: Columns of Table 2 and the quantities they are.
COLUMNS: Mapping[str, str] = MappingProxyType({"Fr": "radial force", "Fa": "axial force"})

#: The two fits of the stiffnesses, in words.
SETS: Mapping[Set, str] = MappingProxyType(
    {
        "all cases": "stiffnesses fitted to all 36 forces",
        "case I": "stiffnesses fitted to the 12 forces of Case I alone",
    }
)

#: Stored stiffnesses of each fit; the first are the defaults of `StrutAssembly`.
STIFFNESSES: Mapping[Set, Mapping[str, float]] = MappingProxyType(
    {"all cases": MappingProxyType({}), "case I": CALIBRATED_ON_CASE_I}
)


@dataclass(frozen=True)
class AssemblyCalibration:
    """Stiffnesses that meet some cases of Table 2 best.

    Parameters
    ----------
    cases : tuple of str
        Those fitted to.
    stiffness, axial_stiffness : float
        N/m, as in `StrutAssembly`.
    largest, rms : float
        Relative errors that are left in these cases.
    """

    cases: tuple[str, ...]
    stiffness: float
    axial_stiffness: float
    largest: float
    rms: float

    def to_dict(self) -> dict[str, Any]:
        """Fields as plain numbers, SI."""
        return {**vars(self), "cases": list(self.cases)}


def table_2_worst_case(case: str, **fields: float) -> WorstCase:
    """Worst-case forces of one case of Table 2.

    Parameters
    ----------
    case : str
        I, II or III.
    **fields : float
        Fields of `StrutAssembly`.

    Raises
    ------
    ModelError
        An unknown case or a stiffness that is not positive.
    """
    assembly = StrutAssembly.case(case, **fields)
    placed = assembly.structure.at(assembly.placement())
    return worst_case(tolerance_responses(placed, table_2_tolerances()))


def joint_forces(worst: WorstCase) -> Array:
    """Radial and axial worst-case forces of the six joints, (..., 2, 6), N."""
    found = worst.responses
    return np.stack(
        [
            worst.value[..., [found.index(name, kind) for name in table_2_joints()]]
            for kind in COLUMNS.values()
        ],
        axis=-2,
    )


def published_forces(case: str) -> Array:
    """Radial and axial forces of a case of Table 2 as printed, (2, 6), N."""
    return np.array(
        [[1e3 * TABLE_2.value(table_2_row(case, n), q) for n in range(1, 7)] for q in COLUMNS]
    )


def calibrate_assembly(cases: Sequence[str] = tuple(CASES)) -> AssemblyCalibration:
    """Fit the two stiffnesses of the reconstruction to cases of Table 2.

    Least squares of the relative errors of radial and axial forces over the logarithms of the
    two stiffnesses.

    Parameters
    ----------
    cases : sequence of str

    Returns
    -------
    AssemblyCalibration

    Raises
    ------
    ModelError
        No case, or an unknown one.
    NumericalError
        The fit did not converge.
    """
    if not cases:
        raise ModelError("Table 2", "no case to fit to.", "Cases: " + ", ".join(CASES) + ".")

    def errors(unknowns: Array) -> Array:
        k, axial = np.exp(unknowns)
        return np.concatenate(
            [
                np.ravel(
                    joint_forces(table_2_worst_case(c, stiffness=k, axial_stiffness=axial))
                    / published_forces(c)
                    - 1.0
                )
                for c in cases
            ]
        )

    found = least_squares(errors, np.log([100e6, 10e6]), xtol=1e-12, ftol=1e-12, gtol=1e-12)
    if not found.success:
        raise NumericalError(
            "fit to Table 2", f"did not converge: {found.message}", "Fit to other cases."
        )
    k, axial = np.exp(found.x)
    left = np.abs(found.fun)
    return AssemblyCalibration(
        tuple(cases),
        float(k),
        float(axial),
        float(left.max()),
        float(np.sqrt(np.mean(left**2))),
    )


def table_2_rows(which: Set = "all cases") -> tuple[PublishedRow, ...]:
    """The 36 entries of Table 2 beside the computed values, kN.

    Parameters
    ----------
    which : "all cases" or "case I"
        What the stiffnesses were fitted to.

    Returns
    -------
    tuple of PublishedRow
    """
    ours = {
        case: 1e-3 * joint_forces(table_2_worst_case(case, **STIFFNESSES[which])) for case in CASES
    }
    quantities = tuple(COLUMNS)
    rows = []
    for entry in TABLE_2:
        _, case, _, number = entry.row.split()
        computed = float(ours[case][quantities.index(entry.quantity), int(number) - 1])
        status, note = _worth(case, which)
        rows.append(
            PublishedRow(entry.row, entry.quantity, entry.unit, entry.value, computed, status, note)
        )
    return tuple(rows)


def _worth(case: str, which: Set) -> tuple[Status, str]:
    """Status of a number and what a reader should know about it.

    Calibrated throughout: layout and stiffness ratios were chosen with all cases in view.
    """
    note = (
        f"reconstructed structure, figures 40 and 42 of the thesis are not available; {SETS[which]}"
    )
    if which == "case I" and case != "I":
        note += "; layout and stiffness ratios were chosen to match this case too"
    return "calibrated", note
