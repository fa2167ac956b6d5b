"""The singular ring in words and tables: regions, and what the joint ranges leave."""

from __future__ import annotations

from collections.abc import Mapping

from strutwork.papers.azulay_2014.regions import RANGES, SIDES, Barred, Side
from strutwork.papers.tables import numbers, texts
from strutwork.reports.chapters.stiffness import AXES
from strutwork.reports.content import Chapter, Table, Text
from strutwork.reports.numbers import micro, significant
from strutwork.reports.pivot import Entry, pivoted

NONE = "–"

BARRIER = (
    "With six drives no path leads from the pole to a tilt of 90° on this hemisphere: at every "
    "roll one tilt between them is a type 2 singularity, where the platform can move although "
    "all drives are held. The singular poses fill the ring between the two dashed circles, one "
    "distance for each roll. A seventh drive would be needed to cross it."
)


def extent(found: Barred) -> str:
    """Least and largest distance of the ring from the axis, mm."""
    low, high = found.ring.extent
    return f"{1e3 * low:.2f} to {1e3 * high:.2f} mm"


def ring_text(found: Mapping[str, Barred]) -> Text:
    """The sentence that every map carries."""
    where = "; ".join(f"{label}, {extent(one)}" for label, one in found.items())
    return Text(f"{BARRIER} Distance of the ring from the axis: {where}.")


def regions_chapter(found: Mapping[str, Barred], first: str) -> Chapter:
    """Statistics of each connected region, and points kept by the machine's own ranges.

    Parameters
    ----------
    found : mapping of label to Barred
    first : str
        What the labels are: "model" or "machine".
    """
    return Chapter(
        "regions",
        "What is reached with six drives and the joint ranges",
        (
            ring_text(found),
            Text(
                "A machine works on one side of the ring only. Each side is connected over tilts "
                "and rolls; a point belongs to the side of the pose chosen for it."
            ),
            regions_table(found, first, own=True),
            regions_table(found, first, own=False),
            Text(
                "The paper's means are met best with the ranges of the revolute joints alone; "
                "the other ranges of its Tables 1 and 3 take away the points that the next table "
                "counts. Neutral directions of the spherical joints and middles of strokes are not "
                "printed and are assumed."
            ),
            ranges_table(found, first),
        ),
    )


def regions_table(found: Mapping[str, Barred], first: str, own: bool) -> Table:
    """Statistics for each connected region as well as for all points, axes side by side."""
    entries = [
        Entry([label, words, f"{one.kept(own, side)}"], f"K{axis * 2}", cells)
        for label, one in found.items()
        for side, words in SIDES.items()
        for axis, cells in _by_axis(one, side, own).items()
    ]
    return pivoted(
        f"Blocked stiffness by region; joint ranges respected: {RANGES[own]}",
        (*texts(first, "region"), *numbers("points")),
        (
            *numbers("mean", unit="N/µm"),
            *numbers("variance", unit="N²/µm²"),
            *numbers("least to largest", unit="N/µm"),
        ),
        entries,
        "report.json",
    )


def _by_axis(one: Barred, side: Side, own: bool) -> dict[str, list[str]]:
    part = one.parts[own, side]
    if part is None:
        return {axis: [NONE] * 3 for axis in AXES}
    found = {}
    for axis in AXES:
        values = part.axis(axis)
        found[axis] = [
            micro(values.statistics.mean),
            significant(values.statistics.variance / 1e12),
            f"{micro(values.worst.value)} to {micro(values.best.value)}",
        ]
    return found


def ranges_table(found: Mapping[str, Barred], first: str) -> Table:
    """Check points and means without and with the machine's own joint ranges."""
    rows = [
        [
            label,
            RANGES[own],
            *(f"{one.kept(own, side)}" for side in SIDES),
            *(micro(one.mean(axis, own)) if one.kept(own) else NONE for axis in AXES),
        ]
        for label, one in found.items()
        for own in RANGES
    ]
    columns = (
        *texts(first, "joint ranges respected"),
        *numbers("all", "pole's side", "beyond", group="check points kept"),
        *numbers(*(f"K{a * 2}" for a in AXES), unit="N/µm", group="mean"),
    )
    count = next(iter(found.values())).points
    return Table(f"Of {count} check points; stiffness blocked", columns, rows, "report.json")
