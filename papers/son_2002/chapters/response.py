"""The tool of the MIT-SS-1 on its granite: receptances, exact least dynamic stiffness."""

from __future__ import annotations

from strutwork.papers.son_2002.modes import TILT
from strutwork.papers.son_2002.whole_study import BAND, WholeStudy
from strutwork.reports.chapters.cover import vibration_answers
from strutwork.reports.chapters.vibration import minima_table, response_figure, response_files
from strutwork.reports.content import Block, Chapter, Note, Text
from strutwork.reports.numbers import significant

#: What the sentences of the cover hold for: the mechanism alone has other bearings and no mounts.
GIVEN = (
    "On its granite and mounts, with damping assumed and bearings calibrated to the thesis's "
    "finite element model"
)


def response_chapter(study: WholeStudy) -> Chapter:
    """The tool's receptance on the granite and its exact least dynamic stiffness."""
    some = study.vibration
    least = min(some.least, key=lambda one: one.value)
    elastic = study.beyond_mounts
    softest = min(elastic.least, key=lambda one: one.value)
    blocks: list[Block] = [
        Note(
            "Damping is assumed: 1 % of critical in every mode; the thesis prints none. It "
            "decides the height of the peaks. The response is that of the tool relative to the "
            "floor, with bearings as in the thesis's finite element model."
        ),
        *([Note(some.validity)] if some.validity else []),
        response_figure(some),
        minima_table([("", some)], f"{some.key}-minima.csv"),
        minima_table([("", elastic)], f"{elastic.key}-minima.csv"),
        Text(
            f"The least of all is {significant(least.value / 1e6)} N/µm at "
            f"{significant(least.frequency)} Hz: the machine on its soft mounts, where tool and "
            "work move together. Beyond the mounts' modes it is "
            f"{significant(softest.value / 1e6)} N/µm along {softest.output.direction} at "
            f"{significant(softest.frequency)} Hz, the strut assembly's. The bands end at "
            f"{BAND[1]:g} Hz, up to which the reduced granite is accurate. The minima are those "
            "of the continuous curve, not of drawn points."
        ),
    ]
    key = "dynamic-stiffness"
    tilt = study.named["numerical"].frequencies[TILT]
    cover = vibration_answers(
        some,
        f"; the lowest of the mechanism is {significant(tilt)} Hz, the housing's tilt.",
        f"; beyond the mounts' modes it is {significant(softest.value / 1e6)} N/µm along "
        f"{softest.output.direction}, at {significant(softest.frequency)} Hz.",
        GIVEN,
        key,
    )
    return Chapter(
        key,
        "Dynamic stiffness at the tool",
        tuple(blocks),
        # the second band's curves are part of the first's
        (*response_files(some), response_files(elastic)[-1]),
        cover=cover,
    )
