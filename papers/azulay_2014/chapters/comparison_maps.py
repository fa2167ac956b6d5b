"""Maps of the four machines of Azulay et al. 2014 side by side."""

from __future__ import annotations

import numpy as np

from strutwork.papers.azulay_2014.chapters.barrier import ring_text
from strutwork.papers.azulay_2014.chapters.comparison import SHORT
from strutwork.papers.azulay_2014.machine_study import MODEL_NAMES, Comparison
from strutwork.reports.chapters.stiffness import AXES, axis_values, map_figure, map_files
from strutwork.reports.content import Block, Chapter, Row, Text
from strutwork.reports.data_files import DataFile


def maps_chapter(study: Comparison) -> Chapter:
    """Small discs, one for each machine and axis, with one scale an axis."""
    blocks: list[Block] = [
        Text(
            "The maps are for true spherical joints and seen from above; the middle of a disc is "
            "the pole and its rim the equator of the hemisphere. The four machines of a row "
            "share one scale. ▽ marks the worst point, ▲ the best, × points without a valid pose."
        ),
        ring_text({SHORT[name]: study.barred[name, "spherical"] for name in study.names}),
    ]
    files: list[DataFile] = []
    for axis in AXES:
        values = [axis_values(study.azulay.maps[n, "spherical"], axis) for n in study.names]
        limits = (
            min(float(np.nanmin(v)) for v in values),
            max(float(np.nanmax(v)) for v in values),
        )
        figures = tuple(
            map_figure(
                study.azulay.maps[name, "spherical"],
                axis,
                f"map-{name}-{axis}",
                SHORT[name],
                f"stiffness-map-{name}-spherical.csv",
                limits,
                small=True,
                ring=study.barred[name, "spherical"].ring.extent,
            )
            for name in study.names
        )
        blocks.append(Row(figures, 200))
    for name in study.names:
        for model, label in MODEL_NAMES.items():
            files += map_files(
                study.azulay.maps[name, model],
                f"stiffness-map-{name}-{model}",
                f"stiffness map of the {SHORT[name]} machine, {label}",
            )
    return Chapter("maps", "Stiffness over the hemisphere", tuple(blocks), tuple(files))
