"""Joint ranges: which poses a machine cannot take although its legs could reach them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import degrees

import numpy as np

from strutwork.errors import ModelError
from strutwork.kinematics.joint import Joint
from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.placement import Placement

#: A coordinate may pass its limit by this much, m or rad: the rounding of a pose at the limit.
SLACK = 1e-9


@dataclass(frozen=True)
class Limit:
    """Range of one joint coordinate.

    Parameters
    ----------
    joint : str
    coordinate : str
        As in `Placement.names`.
    low, high : float
        m or rad.
    kind : str
        Type of the joint: a study may look at the ranges of one kind only.
    """

    joint: str
    coordinate: str
    low: float
    high: float
    kind: str

    def __str__(self) -> str:
        return f"{self.joint}: {self.words}"

    @property
    def words(self) -> str:
        """The range without the joint's name, as in `z of the prismatic joint, 0 to 90 mm`."""
        if self.coordinate in ("x", "y", "z"):
            span = f"{self.low * 1e3:.4g} to {self.high * 1e3:.4g} mm"
        else:
            span = f"{degrees(self.low):.4g} to {degrees(self.high):.4g} deg"
        return f"{self.coordinate} of the {self.kind} joint, {span}"


def joint_limits(linkage: Linkage) -> tuple[Limit, ...]:
    """The ranges that the joints of a linkage define.

    Parameters
    ----------
    linkage : Linkage
        Whose joints have `limits`, or none.
    """
    return joint_limits_of(linkage.joints)


def joint_limits_of(joints: Iterable[Joint]) -> tuple[Limit, ...]:
    """The ranges that joints state themselves.

    Parameters
    ----------
    joints : iterable of Joint
        In the order of the result.
    """
    return tuple(
        Limit(j.name, d, low, high, j.type) for j in joints for d, (low, high) in j.limits.items()
    )


def check_limits(limits: Iterable[Limit], placement: Placement) -> Placement:
    """The placement with poses outside joint ranges marked.

    The inverse kinematics says which poses the legs can reach at all; this adds the ranges. A
    pose that is already marked keeps its reason. Positions, frames and values are untouched, so
    that the placement before the check can still be analysed.

    Parameters
    ----------
    limits : iterable of Limit
        A machine's `limits`, or some of them.
    placement : Placement

    Returns
    -------
    Placement
        `status` and `reasons` extended; a reason is the limit in words.

    Raises
    ------
    ModelError
        A limit on a coordinate that the placement does not give.
    """
    column = {name: i for i, name in enumerate(placement.names)}
    status = np.array(placement.status, dtype=np.int16)
    reasons = list(placement.reasons)
    for limit in limits:
        if (limit.joint, limit.coordinate) not in column:
            raise ModelError(
                f"joint {limit.joint}",
                f'has a range in "{limit.coordinate}", which the placement does not give.',
                "Add the coordinate to the values of the inverse kinematics.",
            )
        value = placement.values[..., column[limit.joint, limit.coordinate]].real
        reasons.append(f"{limit} is exceeded")
        outside = (value < limit.low - SLACK) | (value > limit.high + SLACK)
        status = np.where(outside & (status == 0), np.int16(len(reasons)), status)
    return replace(placement, status=status, reasons=tuple(reasons))
