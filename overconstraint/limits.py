"""How much a joint may carry."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.overconstraint.responses import Responses

Array = NDArray[Any]

#: By joint (None: the tool) and kind of quantity, N, N·m, m or rad.
Limits = Mapping[tuple[str | None, str], float] | Mapping[tuple[str, str], float]


def limit_vector(responses: Responses, limits: Limits) -> Array:
    """Limit of every quantity, infinite where there is none.

    Parameters
    ----------
    responses : Responses
    limits : mapping of (joint, kind) to float
        N, N·m, m or rad. A limit of the tool holds for each of its axes: (None, "displacement") for
        x, y and z.

    Returns
    -------
    limit : (q,)

    Raises
    ------
    ModelError
        No limit, one that is not positive and finite, or of a quantity that there is not.
    """
    if not limits:
        raise ModelError("limits", "there are none.", "Give a limit for one joint or more.")
    limit = np.full(len(responses.quantities), np.inf)
    for (joint, kind), value in limits.items():
        first = responses.index(joint, kind)
        if not (isfinite(value) and value > 0):
            raise ModelError(
                f"limit of the {responses.quantities[first].name}",
                f"it is {value:g}.",
                "Give a positive, finite limit, or leave it out where there is none.",
            )
        for q, quantity in enumerate(responses.quantities):
            if (quantity.joint, quantity.kind) == (joint, kind):
                limit[q] = value
    return limit


def bearing_limit(static_rating: float, safety_factor: float = 1.0) -> float:
    """Largest radial force that a bearing may carry at rest.

    ISO 76: the static equivalent load P₀ may reach C₀/s₀, with s₀ the static safety factor. A
    radial force alone is its own equivalent load, for tapered rollers too: there P₀ = ½ F_r +
    Y₀ F_a, but no less than F_r. An axial force of more than F_r/(2 Y₀) beside it takes a part
    that this does not count.

    Parameters
    ----------
    static_rating : float
        Basic static radial load rating C₀ of the catalogue, N.
    safety_factor : float
        s₀, no unit.

    Returns
    -------
    limit : float
        N.

    Raises
    ------
    ModelError
        A rating or factor that is not positive.
    """
    for what, value in (("static rating", static_rating), ("static safety factor", safety_factor)):
        if not (isfinite(value) and value > 0):
            raise ModelError("bearing", f"its {what} is {value:g}.", "Give a positive number.")
    return static_rating / safety_factor
