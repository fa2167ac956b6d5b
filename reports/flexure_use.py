"""How far the flexures of a model are moved and stressed by its load cases."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.flexures.flexure import LARGE_COMPRESSION, LARGE_ROTATION, Flexure
from strutwork.machines.model import Model, ModelWarning
from strutwork.msa import StaticSolution
from strutwork.reports.numbers import significant

Array = NDArray[Any]

#: Joints named in a warning.
NAMED = 12


@dataclass(frozen=True)
class FlexureUse:
    """A flexure under a load case.

    Parameters
    ----------
    flexure : Flexure
    motion : (6,)
        Of the second part, elastic, joint axes, m and rad.
    stress : float
        Largest equivalent stress, Pa.
    compression : float
        By the buckling force, no unit.
    """

    flexure: Flexure
    motion: Array
    stress: float
    compression: float

    @property
    def share(self) -> float | None:
        """Stress by the allowable one, no unit; None without one."""
        allowable = self.flexure.allowable_stress
        return None if allowable is None else self.stress / allowable

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers in SI."""
        return {
            "flexure": self.flexure.name,
            "stress": self.stress,
            "share_of_allowable_stress": self.share,
            "displacement": self.motion.tolist(),
            "share_of_buckling_force": self.compression,
        }


def flexure_uses(model: Model, statics: StaticSolution, case: int) -> dict[str, FlexureUse]:
    """Each flexure in a load case, by the name of its joint.

    Parameters
    ----------
    model : Model
    statics : StaticSolution
        Of one pose.
    case : int
    """
    index = model.structure.linkage.joint_index
    found = {}
    for joint, flexure in model.flexures.items():
        # on the second node acts what resists its motion
        wrench = -np.asarray(statics.joint_forces[index[joint], :, case], dtype=float)
        found[joint] = FlexureUse(
            flexure,
            flexure.compliance @ wrench,
            float(flexure.stress(wrench)),
            float(flexure.compression(wrench)),
        )
    return found


def described_flexures(model: Model) -> dict[str, dict[str, Any]]:
    """Shape, stiffness and stroke of each flexure by the name of its joint, SI.

    Parameters
    ----------
    model : Model
    """
    return {
        joint: {
            "flexure": f.name,
            "shape": f.shape,
            "bending": "plate" if f.plate else "beam",
            "stiffness": f.stiffness.tolist(),
            "allowable_stress": f.allowable_stress,
            "stroke": None if f.stroke is None else f.stroke.tolist(),
        }
        for joint, f in model.flexures.items()
    }


def warn_of_flexures(model: Model, statics: StaticSolution) -> None:
    """Flexures stressed beyond what is allowed, or moved beyond what a linear stiffness holds for.

    Parameters
    ----------
    model : Model
    statics : StaticSolution

    Warns
    -----
    ModelWarning
        One for each kind, with the worst load case of each joint.
    """
    cases = {name: flexure_uses(model, statics, m) for m, name in enumerate(statics.cases)}
    _warn(
        cases,
        lambda use: use.share or 0.0,
        1.0,
        lambda use: (
            f"{significant(1e-6 * use.stress)} MPa, {significant(use.share or 0.0)} times "
            "the allowable stress"
        ),
        "flexures are stressed beyond their allowable stress: {}. Reduce the load or the stroke, "
        "or make them longer or thinner.",
    )
    _warn(
        cases,
        lambda use: float(np.abs(use.motion[3:]).max()),
        LARGE_ROTATION,
        lambda use: f"{significant(float(np.degrees(np.abs(use.motion[3:]).max())))}°",
        "flexures rotate farther than a linear stiffness describes: {}. Beyond 6° "
        "their stiffness and the position of their axis change.",
    )
    _warn(
        cases,
        lambda use: use.compression,
        LARGE_COMPRESSION,
        lambda use: f"{significant(100 * use.compression)} %",
        "flexures are compressed by a large share of the force under which they buckle: {}. Their "
        "stiffness in bending is lower by about that share, which is not computed.",
    )


def _warn(
    cases: Mapping[str, Mapping[str, FlexureUse]],
    value: Any,
    limit: float,
    words: Any,
    message: str,
) -> None:
    worst: dict[str, tuple[str, FlexureUse]] = {}
    for case, uses in cases.items():
        for joint, use in uses.items():
            if value(use) > limit and (joint not in worst or value(use) > value(worst[joint][1])):
                worst[joint] = case, use
    if not worst:
        return
    shown = [f'{j} in case "{c}", {words(use)}' for j, (c, use) in list(worst.items())[:NAMED]]
    more = len(worst) - len(shown)
    named = "; ".join(shown) + (f"; and {more} more" if more else "")
    warnings.warn(message.format(named), ModelWarning, stacklevel=4)
