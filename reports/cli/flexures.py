"""Tables of flexures: what a load case does to them, and what they can do."""

from __future__ import annotations

from collections.abc import Mapping

from rich.console import Console

from strutwork.flexures import Flexure
from strutwork.reports.cli.manner import MANNER
from strutwork.reports.cli.output import print_table, table
from strutwork.reports.flexure_use import FlexureUse

#: Rows of a table in the short answer.
SHORT = 10
#: Where there is no allowable stress.
NONE = "–"


def print_flexure_uses(out: Console, uses: Mapping[str, FlexureUse]) -> None:
    """Stress and motion of each flexure in a load case, those most stressed first."""
    if not uses:
        return
    order = sorted(uses, key=lambda joint: -uses[joint].stress)
    kept = order if MANNER.whole else order[:SHORT]
    rows = []
    for joint in kept:
        use = uses[joint]
        share = NONE if use.share is None else 100.0 * use.share
        moved = 1e3 * use.motion
        rows.append((joint, 1e-6 * use.stress, share, moved[1], moved[5]))
    heads = ["joint", "stress, MPa", "of allowable, %", "y, mm", "rz, mrad"]
    print_table(out, "Flexures, joint axes", heads, rows)
    if len(kept) < len(order):
        out.print(
            f"Only the most stressed are shown; --verbose lists {len(order) - len(kept)} more."
        )


def print_flexures(out: Console, flexures: Mapping[str, Flexure]) -> None:
    """Stiffness and stroke of each flexure across its thickness and about its axis."""
    if not flexures:
        return
    rows: list[tuple[object, ...]] = []
    for flexure in {f.name: f for f in flexures.values()}.values():
        stroke = (NONE, NONE) if flexure.stroke is None else 1e3 * flexure.stroke[[1, 5]]
        rows.append(
            (
                flexure.name,
                flexure.shape.replace("_", " "),
                "plate" if flexure.plate else "beam",
                1e-6 / float(flexure.compliance[1, 1]),
                1.0 / float(flexure.compliance[5, 5]),
                *stroke,
            )
        )
    heads = ["flexure", "shape", "bends as", "y, N/µm", "rz, N·m/rad"]
    heads += ["stroke y, mm", "stroke rz, mrad"]
    title = "Stiffness of flexures with the other axes free, and stroke"
    out.print(table(title, heads, rows, names=3))
