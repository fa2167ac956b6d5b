"""Load cases."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from strutwork.errors import ModelError

Vector = tuple[float, float, float]
Wrench = tuple[float, float, float, float, float, float]


@dataclass(frozen=True)
class LineLoad:
    """A load per length in global axes, over an entire beam, N/m.

    Parameters
    ----------
    beam : str
    first, second : (3,)
        Values at the beam's first and second end, N/m; they vary linearly between.
    """

    beam: str
    first: Vector
    second: Vector


@dataclass(frozen=True)
class LoadCase:
    """Loads that act together.

    Parameters
    ----------
    name : str
    wrenches : tuple of (node, (6,))
        Force and moment at nodes, global axes, N and N·m.
    line_loads : tuple of LineLoad
    gravity : (3,) or None
        Acceleration, m/s²; acts on beams and masses.
    gaps : mapping of (joint name, direction) to float
        Misfits of joints and settlements of supports: the displacement of the second side
        relative to the first, in joint axes, that closes the joint, m or rad.

    Raises
    ------
    ModelError
        A value that is not finite.
    """

    name: str
    wrenches: tuple[tuple[str, Wrench], ...] = ()
    line_loads: tuple[LineLoad, ...] = ()
    gravity: Vector | None = None
    gaps: Mapping[tuple[str, str], float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        parts = [
            *((f"load at node {node}", wrench) for node, wrench in self.wrenches),
            *((f"line load on beam {q.beam}", (*q.first, *q.second)) for q in self.line_loads),
            *((f"misfit of joint {j} in {d}", (gap,)) for (j, d), gap in self.gaps.items()),
            ("gravity", self.gravity or (0.0,)),
        ]
        for part, values in parts:
            if not np.all(np.isfinite(values)):
                raise ModelError(
                    f"load case {self.name}",
                    f"{part} is {', '.join(f'{v:g}' for v in values)}.",
                    "Give finite numbers.",
                )
