"""A margin asked chunk by chunk, where studies are computed or kept elsewhere."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.margins import Margins, joined
from strutwork.studies.chunks import Arrays
from strutwork.studies.description import content_key
from strutwork.studies.progress import Progress
from strutwork.studies.run import Chunk, Run
from strutwork.studies.workspace_margin import MachineMargin

Array = NDArray[Any]

#: Poses of a chunk.
CHUNK = 1024


@dataclass
class Spread:
    """A margin whose poses do not depend on one another, by the executor of `computed_on`.

    Parameters
    ----------
    margin : MachineMargin
        Of poses that are not followed from one another.
    progress : callable or None
        Called while the grid is asked, the first time; edges are halved in silence.
    """

    margin: MachineMargin
    progress: Progress | None = None

    def __call__(self, points: Array) -> Margins:
        """Margins of points, (p,) of (p, d)."""
        margin = self.margin

        def evaluate(chunk: Chunk) -> Arrays:
            found = margin(points[chunk.items])
            return {
                "value": found.value,
                "reason": found.reason,
                "reasons": np.array(found.reasons, dtype=np.str_),
            }

        told, self.progress = self.progress, None
        parts = Run(progress=told).chunks(evaluate, len(points), CHUNK, lambda: self._key(points))
        return joined(
            [
                Margins(part["value"], part["reason"], tuple(part["reasons"].tolist()))
                for _, part in parts
            ]
        )

    def _key(self, points: Array) -> str:
        model, place = self.margin.model, self.margin.model.placement
        own = {
            f.name: getattr(self.margin, f.name)
            for f in fields(self.margin)
            if f.name not in {"model", "told"}
        }
        at = {"positions": place.positions, "frames": place.frames, "values": place.values}
        return content_key(
            "workspace", model.structure, at, model.rotation, model.limits, own, points, CHUNK
        )
