"""Assembly forces against the length of the struts (Son 2002, section 6.6 and Table 2)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.overconstraint import tolerance_responses, worst_case
from strutwork.papers.son_2002.assembly_table import COLUMNS, joint_forces
from strutwork.papers.son_2002.strut_assembly import CASES, TILT, StrutAssembly
from strutwork.papers.son_2002.tolerances import STATIC_RATING, table_2_joints, table_2_tolerances

Array = NDArray[Any]

#: Width over length of the struts in all cases of Table 2.
WIDTH_RATIO = 0.2

#: Lengths of the struts, m.
LENGTHS: tuple[float, ...] = tuple(float(v) for v in np.round(np.linspace(0.1, 3.0, 30), 10))


@dataclass(frozen=True)
class Line:
    """A straight line through the forces of one joint over the length.

    Parameters
    ----------
    slope : float
        N/m.
    intercept : float
        Force at length zero, N; zero where the line is held to the origin.
    error : float
        Largest distance of a force from the line, as a share of the force.
    """

    slope: float
    intercept: float
    error: float


@dataclass(frozen=True)
class AssemblyScale:
    """Worst-case forces of struts of many lengths.

    Parameters
    ----------
    lengths, widths : (n,)
        m.
    forces : (n, 2, 6)
        Radial and axial, joints 1 to 6, N.
    affine, proportional : mapping of (quantity, joint number) to Line
        Fitted over the lengths of Table 2's cases, where the forces are published: least squares
        of the relative errors.
    tilt : float
        Half-angle of the tolerance cone, rad.
    assembly : StrutAssembly
        Whose stiffnesses all lengths share.
    """

    lengths: Array
    widths: Array
    forces: Array
    affine: Mapping[tuple[str, int], Line]
    proportional: Mapping[tuple[str, int], Line]
    tilt: float
    assembly: StrutAssembly

    def __repr__(self) -> str:
        low, high = self.lengths[0], self.lengths[-1]
        return f"<AssemblyScale: {len(self.lengths)} lengths from {low:g} to {high:g} m, N>"

    @property
    def axial_limit(self) -> Array:
        """What the axial force of a joint tends to with length, (4/3) k_y τ l, (n,), N."""
        return np.asarray(4.0 / 3.0 * self.assembly.axial_stiffness * self.tilt * self.lengths)

    def length_at(self, limit: float = STATIC_RATING) -> float:
        """Shortest length at which some joint's radial force reaches a limit, m; inf if none."""
        most = self.forces[:, 0].max(axis=-1)
        above = np.flatnonzero(most >= limit)
        if not above.size:
            return float("inf")
        first = int(above[0])
        if first == 0:
            return float(self.lengths[0])
        pair = slice(first - 1, first + 1)
        return float(np.interp(limit, most[pair], self.lengths[pair]))

    def to_dataset(self) -> xr.Dataset:
        """Forces over length, quantity and joint, with units."""
        return xr.Dataset(
            {
                "force": (("length", "quantity", "joint"), self.forces, {"units": "N"}),
                "width": ("length", self.widths, {"units": "m"}),
                "axial_limit": ("length", self.axial_limit, {"units": "N"}),
            },
            coords={
                "length": ("length", self.lengths, {"units": "m"}),
                "quantity": list(COLUMNS.values()),
                "joint": list(table_2_joints()),
            },
            attrs={"tilt_rad": self.tilt, **vars_of(self.assembly)},
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, SI."""

        def lines(some: Mapping[tuple[str, int], Line]) -> dict[str, Any]:
            return {f"{q} joint {n}": vars(line) for (q, n), line in some.items()}

        return {
            "lengths": self.lengths.tolist(),
            "widths": self.widths.tolist(),
            "radial_force": self.forces[:, 0].tolist(),
            "axial_force": self.forces[:, 1].tolist(),
            "axial_limit": self.axial_limit.tolist(),
            "affine": lines(self.affine),
            "proportional": lines(self.proportional),
            "tilt": self.tilt,
            "assembly": vars_of(self.assembly),
        }


def assembly_scale(
    lengths: Sequence[float] = LENGTHS,
    widths: ArrayLike | float = WIDTH_RATIO,
    *,
    tilt: float = TILT,
    assembly: StrutAssembly | None = None,
) -> AssemblyScale:
    """Worst-case assembly forces of Table 2's structure with struts of other lengths.

    The stiffnesses stay, as the thesis takes them. Its eq. 64 says when they may: a strut whose
    width grows with its length keeps its bending stiffness, see `strutwork.machines.strut_width`.

    Parameters
    ----------
    lengths : sequence of float
        Ascending, m.
    widths : float or (n,)
        A number is the width over the length; an array the widths, m.
    tilt : float
        Half-angle of the tolerance cone, rad.
    assembly : StrutAssembly, optional
        Whose stiffnesses and dimensions but length and width are taken; default the
        reconstruction fitted to all of Table 2.

    Returns
    -------
    AssemblyScale

    Raises
    ------
    ModelError
        Lengths that do not ascend from above zero, or widths that do not match or are not
        positive.
    """
    along = np.asarray(lengths, dtype=float)
    if along.ndim != 1 or len(along) < 1 or not np.all(along > 0) or np.any(np.diff(along) <= 0):
        raise ModelError(
            "lengths of the struts", "do not ascend from above zero.", "Sort them; give metres."
        )
    given = np.asarray(widths, dtype=float)
    across = given * along if given.ndim == 0 else given
    if across.shape != along.shape or not np.all(across > 0):
        raise ModelError(
            "widths of the struts",
            f"are {len(across)} for {len(along)} lengths, or not positive.",
            "Give one positive width per length, or their ratio.",
        )
    base = assembly or StrutAssembly.case("I")
    forces = _forces(base, along, across, tilt)
    cases = np.array(list(CASES.values()))
    at_cases = _forces(base, cases[:, 0], cases[:, 1], tilt)
    keys = [(q, n) for q in COLUMNS.values() for n in range(1, 7)]
    columns = at_cases.reshape(len(cases), -1).T
    return AssemblyScale(
        along,
        across,
        forces,
        {key: _line(cases[:, 0], f, 1) for key, f in zip(keys, columns, strict=True)},
        {key: _line(cases[:, 0], f, 0) for key, f in zip(keys, columns, strict=True)},
        tilt,
        base,
    )


def _forces(base: StrutAssembly, lengths: Array, widths: Array, tilt: float) -> Array:
    """Worst-case forces, (n, 2, 6), N: one topology, a batch of lengths."""
    each = [
        replace(base, length=float(a), width=float(w)).placement()
        for a, w in zip(lengths, widths, strict=True)
    ]
    batch = replace(
        each[0],
        positions=np.stack([p.positions for p in each]),
        frames=np.stack([p.frames for p in each]),
        values=np.stack([p.values for p in each]),
        status=np.zeros(len(each), dtype=np.int8),
    )
    placed = base.structure.at(batch)
    return joint_forces(worst_case(tolerance_responses(placed, table_2_tolerances(tilt))))


def _line(lengths: Array, forces: Array, free: int) -> Line:
    """Least squares of relative errors; `free` 1 fits the intercept too."""
    terms = np.stack([lengths, np.ones_like(lengths)], axis=-1)[:, : 1 + free]
    found, *_ = np.linalg.lstsq(terms / forces[:, None], np.ones_like(forces), rcond=None)
    error = np.abs(terms @ found / forces - 1).max()
    return Line(float(found[0]), float(found[1]) if free else 0.0, float(error))


def vars_of(assembly: StrutAssembly) -> dict[str, float]:
    """Its stiffnesses and dimensions that do not change with the length."""
    names = ("stiffness", "axial_stiffness", "near_factor", "across_factor", "half_span", "drop")
    return {name: float(getattr(assembly, name)) for name in names}
