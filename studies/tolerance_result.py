"""What a study of tolerances gives: worst cases over poses, distribution, limits, allocation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.csv_rows import RowWriter
from strutwork.files import write_whole
from strutwork.overconstraint import (
    Allocation,
    Distribution,
    Limits,
    Quantity,
    Responses,
    Tolerance,
    ToolDeviation,
    WorstCase,
    limit_vector,
)
from strutwork.overconstraint.sensitivity import given_size
from strutwork.studies.dataset_units import unit_attributes

Array = NDArray[Any]


@dataclass(frozen=True)
class ToleranceStudy:
    """Assembly forces of a structure, or of a machine at several poses.

    Parameters
    ----------
    title : str
    poses : tuple of str
        A label for each pose, p of them.
    worst : WorstCase
        (p, q, ...): every quantity at every pose.
    limits : mapping of (joint, kind) to float
        N, N·m; empty where none are known.
    governing : int
        The pose whose distribution, allocation aside, is shown: where the largest share of a
        limit is used, or, without limits, where the largest force is.
    distribution : Distribution or None
        At the governing pose.
    deviation : ToolDeviation or None
        Largest displacement of the tool in any direction, at every pose.
    allocation : Allocation or None
        Keeps the limits at all poses.
    """

    title: str
    poses: tuple[str, ...]
    worst: WorstCase
    limits: Limits
    governing: int
    distribution: Distribution | None
    deviation: ToolDeviation | None
    allocation: Allocation | None

    def __repr__(self) -> str:
        return (
            f"<ToleranceStudy {self.title!r}: {len(self.tolerances)} tolerances, "
            f"{len(self.quantities)} quantities, {len(self.poses)} pose"
            f"{'s' if len(self.poses) > 1 else ''}, SI>"
        )

    @property
    def responses(self) -> Responses:
        """Quantities as functions of the zones' parameters, batch (p)."""
        return self.worst.responses

    @property
    def quantities(self) -> tuple[Quantity, ...]:
        """What is asked of the assembly."""
        return self.responses.quantities

    @property
    def tolerances(self) -> tuple[Tolerance, ...]:
        """What may deviate."""
        return self.responses.sources.tolerances

    @cached_property
    def worst_pose(self) -> NDArray[np.intp]:
        """Pose at which each quantity is largest, (q,)."""
        return np.asarray(self.worst.value.argmax(axis=0))

    @cached_property
    def largest(self) -> Array:
        """Largest value of each quantity over all poses, (q,)."""
        return self._at_worst(self.worst.value)

    @cached_property
    def shares(self) -> Array:
        """Share of each tolerance in it, (q, t)."""
        return self._at_worst(self.worst.shares)

    @cached_property
    def limit(self) -> Array:
        """Limit of each quantity, (q,); infinite where there is none."""
        if not self.limits:
            return np.full(len(self.quantities), np.inf)
        return limit_vector(self.responses, self.limits)

    @cached_property
    def utilisation(self) -> Array:
        """Largest value over limit, (q,); zero where there is no limit."""
        return np.asarray(self.largest / self.limit)

    @property
    def within_limits(self) -> bool:
        """Whether no assembly within tolerance exceeds a limit."""
        return bool(np.all(self.utilisation <= 1.0))

    def contributor(self, quantity: int) -> str | None:
        """The tolerance with the largest share in a quantity; None where nothing acts on it.

        Parameters
        ----------
        quantity : int
            Index into `quantities`.
        """
        share = self.shares[quantity]
        if not share.size or not share.max() > 0:
            return None
        return self.tolerances[int(share.argmax())].name

    def misfits(self, quantity: int) -> dict[str, dict[str, float]]:
        """The worst combination for a quantity: misfits by joint and direction, m and rad.

        Parameters
        ----------
        quantity : int
            Index into `quantities`.
        """
        return self._by_joint(self.worst.misfits(quantity)[self.worst_pose[quantity]])

    def _by_joint(self, misfits: Array) -> dict[str, dict[str, float]]:
        found: dict[str, dict[str, float]] = {}
        for (joint, direction), value in zip(self.responses.sources.columns, misfits, strict=True):
            found.setdefault(joint, {})[direction] = float(value)
        return found

    def _at_worst(self, values: Array) -> Array:
        return np.asarray(values[self.worst_pose, np.arange(len(self.quantities))])

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain values, SI; what does not exist is None."""
        return {
            "title": self.title,
            "poses": list(self.poses),
            "governing_pose": self.poses[self.governing],
            "self_stress_states": int(self.responses.influence.redundant.max(initial=0)),
            "tolerances": {t.name: _tolerance(t) for t in self.tolerances},
            "quantities": [self._quantity(q) for q in range(len(self.quantities))],
            "within_limits": self.within_limits if self.limits else None,
            "distribution": self._sampled(),
            "tool_deviation": self._moved(),
            "allocation": None if self.allocation is None else _allocated(self.allocation),
        }

    def _quantity(self, q: int) -> dict[str, Any]:
        quantity, names = self.quantities[q], [t.name for t in self.tolerances]
        limited = bool(np.isfinite(self.limit[q]))
        found = self.distribution
        return {
            "name": quantity.name,
            "joint": quantity.joint,
            "kind": quantity.kind,
            "directions": list(quantity.directions),
            "unit": quantity.unit,
            "worst": float(self.largest[q]),
            "worst_pose": self.poses[self.worst_pose[q]],
            "limit": float(self.limit[q]) if limited else None,
            "utilisation": float(self.utilisation[q]) if limited else None,
            "quantiles": None if found is None else _quantiles(found, q),
            "shares": None
            if self.contributor(q) is None
            else dict(zip(names, self.shares[q].tolist(), strict=True)),
            "contributor": self.contributor(q),
            "misfits": self.misfits(q),
        }

    def _sampled(self) -> dict[str, Any] | None:
        found = self.distribution
        if found is None:
            return None
        at = found.utilisation
        return {
            "pose": self.poses[self.governing],
            "samples": found.samples,
            "method": found.method,
            "confidence": found.confidence,
            "utilisation": None
            if at is None
            else {f"{s:g}": float(v) for s, v in zip(found.shares, at.quantiles, strict=True)},
        }

    @property
    def farthest(self) -> int:
        """Index of the pose at which the tool can be displaced most; 0 without a tool."""
        return 0 if self.deviation is None else int(np.argmax(self.deviation.largest))

    def _moved(self) -> dict[str, Any] | None:
        found = self.deviation
        if found is None:
            return None
        at = self.farthest
        return {
            "pose": self.poses[at],
            "largest": float(found.largest[at]),
            "bound": float(found.bound[at]),
            "displacement": found.displacement[at].tolist(),
            "misfits": self._by_joint(found.misfits[at]),
        }

    def to_dataset(self) -> xr.Dataset:
        """Largest values at all poses, and the share of each tolerance in them."""
        return xr.Dataset(
            {
                "worst": (
                    ("pose", "quantity"),
                    self.worst.value,
                    unit_attributes("N; N m; m; rad"),
                ),
                "share": (("pose", "quantity", "tolerance"), self.worst.shares, {"units": "1"}),
                "limit": ("quantity", self.limit, unit_attributes("N; N m; m; rad")),
            },
            coords={
                "pose": list(self.poses),
                "quantity": [q.name for q in self.quantities],
                "unit": ("quantity", [q.unit for q in self.quantities]),
                "tolerance": [t.name for t in self.tolerances],
            },
            attrs={"title": self.title, "governing_pose": self.poses[self.governing]},
        )


def write_table(path: Path, study: ToleranceStudy) -> Path:
    """Write the worst of every quantity at every pose as CSV, SI.

    Parameters
    ----------
    path : Path
    study : ToleranceStudy

    Raises
    ------
    ModelError
        The folder cannot be written.
    """
    names = [t.name for t in study.tolerances]
    head = ["pose", "quantity", "unit", "worst", "limit", *(f"share of {n}" for n in names)]

    def write(part: Path) -> None:
        with part.open("w", encoding="utf-8", newline="") as file:
            writer = RowWriter(file)
            writer.writerow(head)
            for p, q in np.ndindex(*study.worst.value.shape):
                quantity, limit = study.quantities[q], float(study.limit[q])
                writer.writerow(
                    [
                        study.poses[p],
                        quantity.name,
                        quantity.unit,
                        repr(float(study.worst.value[p, q])),
                        repr(limit) if np.isfinite(limit) else "",
                        # nothing has no parts
                        *(
                            repr(float(v)) if study.worst.value[p, q] else ""
                            for v in study.worst.shares[p, q]
                        ),
                    ]
                )

    return write_whole(Path(path), write)


def _quantiles(found: Distribution, q: int) -> dict[str, dict[str, float]]:
    spread = found.values
    return {
        f"{share:g}": {
            "value": float(spread.quantiles[q, i]),
            "low": float(spread.low[q, i]),
            "high": float(spread.high[q, i]),
        }
        for i, share in enumerate(found.shares)
    }


def _allocated(found: Allocation) -> dict[str, Any]:
    """An allocation by names; of forces the largest over the poses."""
    names = [t.name for t in found.tolerances]
    quantities = [q.name for q in found.responses.quantities]
    forces = found.forces.reshape(-1, len(quantities)).max(axis=0)
    limited = np.flatnonzero(np.isfinite(found.limit))
    return {
        "sizes": dict(zip(names, found.sizes.tolist(), strict=True)),
        "scales": dict(zip(names, found.scale.tolist(), strict=True)),
        "forces": {quantities[q]: float(forces[q]) for q in limited},
        "utilisation": {quantities[q]: float(forces[q] / found.limit[q]) for q in limited},
        "active": list(found.active),
        "cost": found.cost,
        "gap": found.gap,
        "method": found.method,
        "optimality": found.optimality,
    }


def _tolerance(tolerance: Tolerance) -> dict[str, Any]:
    return {
        "kind": tolerance.kind,
        "joints": list(tolerance.joints),
        "datum": tolerance.datum,
        "size": given_size(tolerance),
        "extent": tolerance.extent,
        "distribution": tolerance.distribution,
    }
