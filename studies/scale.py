"""Static stiffness and natural frequencies against the size of a machine (Son 2002, chapter 3)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.modes import modes
from strutwork.kinematics import DIRECTIONS
from strutwork.msa import PlacedStructure, axis_stiffness_free, compliance_budget, tool_compliance
from strutwork.studies.chunks import Arrays
from strutwork.studies.dataset_units import LabelledUnits, unit_attributes, unit_coordinate
from strutwork.studies.description import content_key
from strutwork.studies.removal_rate import ACTUATOR_EXPONENTS, RemovalExponents, removal_exponents
from strutwork.studies.run import Chunk, Run
from strutwork.studies.similarity import ROLLERS, SIMILAR, UNSCALED, JointScaling, scaled

Array = NDArray[Any]

#: Sizes beside the machine's own: a quarter to four times, evenly spaced in the logarithm.
FACTORS: tuple[float, ...] = tuple(float(2.0 ** (k / 2)) for k in range(-4, 5))

#: Laws of the joints that the thesis speaks of.
LAWS = (SIMILAR, ROLLERS, UNSCALED)

_STIFFNESS = LabelledUnits("N/m; N m/rad", ("N/m",) * 3 + ("N m/rad",) * 3)


@dataclass(frozen=True)
class PowerLaw:
    """A power of the size fitted to positive values.

    Parameters
    ----------
    exponent : (...)
        Least squares of the logarithms over all sizes, no unit.
    error : (...)
        Largest distance of a value from the fitted power, as a share of the power.
    local : (f, ...)
        d log(value)/d log(size) at every size, of a cubic spline through the logarithms, no unit.
    """

    exponent: Array
    error: Array
    local: Array


def power_law(factors: ArrayLike, values: ArrayLike) -> PowerLaw:
    """Fit value ~ L^p.

    Parameters
    ----------
    factors : (f,)
        Ascending sizes L, no unit.
    values : (f, ...)
        Positive, any unit.

    Returns
    -------
    PowerLaw

    Raises
    ------
    ModelError
        Fewer than two sizes, or sizes that do not ascend from above zero.
    NumericalError
        A value that is not positive and finite.
    """
    sizes = _ascending(factors)
    some = np.asarray(values, dtype=float)
    if not np.all((some > 0) & (some < np.inf)):
        raise NumericalError(
            "power law", "a value is not positive and finite.", "Remove such values."
        )
    x, y = np.log(sizes), np.log(some)
    across = (x - x.mean()).reshape(-1, *[1] * (some.ndim - 1))
    exponent = (across * y).sum(axis=0) / (across**2).sum()
    rest = y - y.mean(axis=0) - exponent * across
    local = CubicSpline(x, y).derivative()(x)
    return PowerLaw(exponent, np.abs(np.expm1(rest)).max(axis=0), np.asarray(local))


@dataclass(frozen=True)
class ScaleStudy:
    """A machine at several sizes, its joints by several laws.

    Parameters
    ----------
    laws : tuple of JointScaling
        l of them.
    factors : (f,)
        Sizes beside the machine's own, no unit.
    stiffness : (l, f, ..., 6)
        At the tool along each axis with the others free to follow, 1/C_ii, N/m and N·m/rad.
    frequencies : (l, f, ..., m)
        Lowest frequencies that are not of rigid-body modes, ascending, Hz.
    joint_share : (..., 6)
        Share of joints and springs in the tool's deflection along each axis at factor 1.
    """

    laws: tuple[JointScaling, ...]
    factors: Array
    stiffness: Array
    frequencies: Array
    joint_share: Array

    def __repr__(self) -> str:
        return (
            f"<ScaleStudy: {len(self.factors)} sizes from {self.factors[0]:.3g} to "
            f"{self.factors[-1]:.3g}, {len(self.laws)} laws of joints, batch "
            f"{self.joint_share.shape[:-1]}, N/m and Hz>"
        )

    def stiffness_law(self, law: int) -> PowerLaw:
        """Power law of the stiffness; exponent (..., 6).

        Parameters
        ----------
        law : int
            Index into `laws`.
        """
        return power_law(self.factors, self.stiffness[law])

    def frequency_law(self, law: int) -> PowerLaw:
        """Power law of the frequencies; exponent (..., m).

        Parameters
        ----------
        law : int
            Index into `laws`.
        """
        return power_law(self.factors, self.frequencies[law])

    def removal(
        self, law: int, exponents: Sequence[float] = ACTUATOR_EXPONENTS
    ) -> dict[str, tuple[RemovalExponents, ...]]:
        """Exponents at constant removal rate (Son 2002, eq. 23), of a single pose.

        Parameters
        ----------
        law : int
            Index into `laws`.
        exponents : sequence of float
            n of the drives' force, no unit.

        Returns
        -------
        dict of axis to tuple of RemovalExponents
            x, y and z; one for each exponent of the drives' force.

        Raises
        ------
        ModelError
            A study of several poses.
        """
        found = self.stiffness_law(law).exponent
        if found.ndim != 1:
            raise ModelError("scale", "of several poses.", "Study one pose at a time.")
        return {
            axis: tuple(removal_exponents(n, float(found[i])) for n in exponents)
            for i, axis in enumerate(DIRECTIONS[:3])
        }

    def to_dataset(self) -> xr.Dataset:
        """Values and local exponents over law, factor and pose, with units.

        Units of the stiffness are by direction: N/m for x, y, z, N·m/rad for rx, ry, rz.
        """
        poses = self.joint_share.shape[:-1]
        axes = tuple(f"pose_{i}" for i in range(len(poses)))
        head = ("law", "factor", *axes)
        count = range(len(self.laws))
        stiffness = np.array([self.stiffness_law(i).local for i in count])
        frequency = np.array([self.frequency_law(i).local for i in count])
        return xr.Dataset(
            {
                "stiffness": (
                    (*head, "direction"),
                    self.stiffness,
                    unit_attributes(str(_STIFFNESS)) | {"meaning": "1/C_ii at the tool"},
                ),
                "frequency": ((*head, "mode"), self.frequencies, {"units": "Hz"}),
                "stiffness_exponent": ((*head, "direction"), stiffness, {"units": "1"}),
                "frequency_exponent": ((*head, "mode"), frequency, {"units": "1"}),
                "joint_share": ((*axes, "direction"), self.joint_share, {"units": "1"}),
            },
            coords={
                "law": [str(law) for law in self.laws],
                "factor": ("factor", self.factors, {"units": "1"}),
                "direction": list(DIRECTIONS),
                **unit_coordinate("stiffness", "direction", _STIFFNESS),
                "mode": np.arange(1, self.frequencies.shape[-1] + 1),
            },
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, SI."""
        single = self.joint_share.ndim == 1
        laws = []
        for i, law in enumerate(self.laws):
            stiffness, frequency = self.stiffness_law(i), self.frequency_law(i)
            laws.append(
                {
                    "name": str(law),
                    "translational": law.translational,
                    "rotational": float(law.stiffness_exponents[-1]),
                    "stiffness": self.stiffness[i].tolist(),
                    "frequencies": self.frequencies[i].tolist(),
                    "stiffness_exponents": stiffness.exponent.tolist(),
                    "stiffness_exponent_error": stiffness.error.tolist(),
                    "stiffness_local_exponents": stiffness.local.tolist(),
                    "frequency_exponents": frequency.exponent.tolist(),
                    "frequency_exponent_error": frequency.error.tolist(),
                    "frequency_local_exponents": frequency.local.tolist(),
                    "removal_rate": {
                        axis: [vars(found) for found in some]
                        for axis, some in self.removal(i).items()
                    }
                    if single
                    else {},
                }
            )
        return {
            "factors": self.factors.tolist(),
            "directions": list(DIRECTIONS),
            "joint_share": self.joint_share.tolist(),
            "laws": laws,
        }


def scale_study(
    placed: PlacedStructure,
    factors: Sequence[float] = FACTORS,
    laws: Sequence[JointScaling] = LAWS,
    count: int = 4,
) -> ScaleStudy:
    """Stiffness at the tool and lowest frequencies of a machine at several sizes.

    Beams, solids and masses are geometrically similar; joints and springs follow each law. Where
    these are similar as well, stiffness grows with L and frequencies with 1/L (Son 2002, eqs 14,
    15 and 24). Else the slope of log K at factor 1 is 1 − s (1 − a), s the joints' share in the
    deflection and a the exponent of their stiffness.

    Parameters
    ----------
    placed : PlacedStructure
        With a tool and masses, at a batch of poses. Every size is another structure, solved at
        all poses at once.
    factors : sequence of float
        Ascending sizes L beside the machine's own, no unit.
    laws : sequence of JointScaling
    count : int
        Frequencies, without rigid-body modes.

    Returns
    -------
    ScaleStudy

    Raises
    ------
    ModelError
        Sizes that do not ascend from above zero, no law, an element that cannot be scaled, fewer
        modes than asked.
    StrutworkError
        As `tool_compliance` and `strutwork.fea.modes`.
    """
    sizes = _ascending(factors)
    if not laws:
        raise ModelError("scale", "no law of the joints.", "Give at least one JointScaling.")
    first = modes(placed, count)
    rigid = int(np.max(first.rigid_body_modes, initial=0))
    if np.any(first.rigid_body_modes != rigid):
        raise ModelError(
            "scale",
            f"some poses have {rigid} rigid-body modes and some have fewer.",
            "Study them one by one.",
        )

    def evaluate(chunk: Chunk) -> Arrays:
        law, size = divmod(chunk.start, len(sizes))
        some = scaled(placed, float(sizes[size]), laws[law])
        return {
            "stiffness": axis_stiffness_free(tool_compliance(some))[None],
            "frequency": modes(some, count + rigid).frequencies[None, ..., rigid:],
        }

    # one at a time here: of a large solid two sizes at once would take twice the memory
    run = Run(workers=1, inputs=lambda c: f"size {sizes[c.start % len(sizes)]:.6g}")
    parts = [
        part
        for _, part in run.chunks(
            evaluate, len(laws) * len(sizes), 1, lambda: _key(placed, sizes, laws, count)
        )
    ]
    shape = (len(laws), len(sizes))
    stiffness, frequencies = (
        np.concatenate([part[name] for part in parts], dtype=float).reshape(
            *shape, *parts[0][name].shape[1:]
        )
        for name in ("stiffness", "frequency")
    )
    if frequencies.shape[-1] < count or not np.all(np.isfinite(frequencies)):
        raise ModelError("scale", f"has fewer than {count} modes.", "Request fewer frequencies.")
    return ScaleStudy(tuple(laws), sizes, stiffness, frequencies, joint_share(placed))


def _key(placed: PlacedStructure, sizes: Array, laws: Sequence[JointScaling], count: int) -> str:
    place = placed.placement
    return content_key(
        "scale",
        placed.structure,
        {"positions": place.positions, "frames": place.frames, "values": place.values},
        {"sizes": sizes, "laws": list(laws), "count": count},
    )


def joint_share(placed: PlacedStructure) -> Array:
    """Share of joints, drives and springs in the tool's deflection along each axis, (..., 6).

    Parameters
    ----------
    placed : PlacedStructure
        With a tool.
    """
    shares = []
    for wrench in np.eye(6):
        budget = compliance_budget(placed, wrench)
        mine = [part.startswith(("joint ", "drive ", "spring ")) for part in budget.parts]
        shares.append(budget.shares[..., mine].sum(axis=-1))
    return np.stack(shares, axis=-1)


def _ascending(factors: ArrayLike) -> Array:
    sizes = np.asarray(factors, dtype=float)
    good = sizes.ndim == 1 and len(sizes) >= 2 and np.all(np.isfinite(sizes)) and sizes[0] > 0
    if not (good and np.all(np.diff(sizes) > 0)):
        raise ModelError(
            "sizes of the machine",
            "are fewer than two, or do not ascend from above zero.",
            "Give ascending factors, such as 0.5, 1 and 2.",
        )
    return sizes
