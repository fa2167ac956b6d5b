"""Calibrated constants of the MIT-SS-1 whole; `studies.mit_ss1_calibration` finds them again."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Literal, get_args

from strutwork.errors import ModelError
from strutwork.machines.mit_ss1 import MitSS1
from strutwork.machines.mit_ss1_frame import GraniteFrame
from strutwork.machines.mit_ss1_whole import MitSS1Whole

#: Fields of `GraniteFrame`, m.
CALIBRATED_GRANITE: Mapping[str, float] = MappingProxyType({"plate": 0.2515, "base": 0.2045})

#: Of one mount, N/m: horizontal, vertical.
CALIBRATED_MOUNTS = (9.35e6, 151e6)

#: Fields of `MitSS1`.
CALIBRATED_MOVING: Mapping[str, float] = MappingProxyType(
    {
        "radial_stiffness": 180.95e6,
        "axial_stiffness": 137.4e6,
        "block_radial_stiffness": 1180e6,
        "block_axial_stiffness": 36.35e6,
        "housing_mass": 20.0,
        "housing_inertia": 0.060,
        "strut_mass": 26.51,
    }
)

#: What the measured machine has besides: softer bearings on the preloading side.
CALIBRATED_MEASURED: Mapping[str, float] = MappingProxyType({"preload_factor": 0.228})

#: What brings the ball screw mode to its measured frequency. Drives so soft take the tilt far
#: below its own, so the two sets are not one machine.
CALIBRATED_SCREW: Mapping[str, float] = MappingProxyType({"drive_stiffness": 96.99e6})

#: The machines that the published frequencies stand beside.
Which = Literal["numerical", "measured", "ball screw"]


def calibrated_machine(which: Which = "numerical", folder: Path | None = None) -> MitSS1Whole:
    """The machine whose bearings, masses, granite and mounts are calibrated.

    Parameters
    ----------
    which : "numerical", "measured" or "ball screw"
        To the thesis's finite element model; further to the measured tilt and strut modes, with
        softer bearings on the preloading side; further to the measured ball screw mode, with
        elastic drives.
    folder : Path, optional
        Of stored superelements.

    Raises
    ------
    ModelError
        Another word for `which`.
    """
    if which not in get_args(Which):
        raise ModelError(
            "calibrated MIT-SS-1",
            f'there is no set "{which}".',
            f"Choose one of: {', '.join(get_args(Which))}.",
        )
    fields = dict(CALIBRATED_MOVING)
    if which != "numerical":
        fields |= CALIBRATED_MEASURED
    if which == "ball screw":
        fields |= CALIBRATED_SCREW
    return MitSS1Whole(
        machine=MitSS1(**fields),  # type: ignore[arg-type]
        frame=GraniteFrame(**CALIBRATED_GRANITE),  # type: ignore[arg-type]
        mount_stiffness=CALIBRATED_MOUNTS,
        folder=folder,
    )
