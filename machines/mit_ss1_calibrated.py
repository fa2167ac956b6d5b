"""Calibrated constants of the MIT-SS-1 whole; `studies.mit_ss1_calibration` finds them again."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Literal

from machines.mit_ss1 import MitSS1
from machines.mit_ss1_frame import GraniteFrame
from machines.mit_ss1_whole import MitSS1Whole

#: Fields of `GraniteFrame`, m.
CALIBRATED_GRANITE: Mapping[str, float] = MappingProxyType({"plate": 0.223, "base": 0.162})

#: Of one mount, N/m: horizontal, vertical.
CALIBRATED_MOUNTS = (7.4e6, 165e6)

#: Fields of `MitSS1`.
CALIBRATED_MOVING: Mapping[str, float] = MappingProxyType(
    {
        "radial_stiffness": 169.7e6,
        "axial_stiffness": 274.5e6,
        "block_radial_stiffness": 1253e6,
        "block_axial_stiffness": 31.5e6,
        "housing_mass": 21.09,
        "strut_mass": 23.86,
    }
)

#: What the measured machine has besides.
CALIBRATED_MEASURED: Mapping[str, float] = MappingProxyType(
    {"preload_factor": 0.3, "drive_stiffness": 200e6}
)


def calibrated_machine(
    which: Literal["numerical", "measured"] = "numerical", folder: Path | None = None
) -> MitSS1Whole:
    """The machine whose bearings, masses, granite and mounts are calibrated.

    Parameters
    ----------
    which : "numerical" or "measured"
        To the thesis's finite element model, or further to its modal test, with softer bearings
        on the preloading side and elastic drives.
    folder : Path, optional
        Of stored superelements.
    """
    fields = dict(CALIBRATED_MOVING)
    if which == "measured":
        fields |= CALIBRATED_MEASURED
    return MitSS1Whole(
        machine=MitSS1(**fields),  # type: ignore[arg-type]
        frame=GraniteFrame(**CALIBRATED_GRANITE),  # type: ignore[arg-type]
        mount_stiffness=CALIBRATED_MOUNTS,
        folder=folder,
    )
