"""What a study of tolerances says in a report: headline, tolerances, the tool."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import NumericalError
from strutwork.overconstraint import Quantity, Tolerance, given_size
from strutwork.reports.alike import grouped
from strutwork.reports.content import Block, Cell, Column, Fact, Facts, Note, Table
from strutwork.reports.data_files import DataFile, json_file
from strutwork.reports.inputs.echo import NONE
from strutwork.reports.numbers import MINUS, significant
from strutwork.studies.tolerance_result import ToleranceStudy

Array = NDArray[Any]

#: A worst case this small beside the largest of its unit is no force.
NOTHING = 1e-9

#: From this size on a tolerance is written in mm, m.
MILLIMETRES = 2e-3

#: Shown unit and factor by a quantity's unit.
UNITS = {"N": ("kN", 1e-3), "N*m": ("N·m", 1.0), "m": ("µm", 1e6), "rad": ("µrad", 1e6)}


def loaded(study: ToleranceStudy) -> list[int]:
    """Quantities of joints that tolerances load at all."""
    found = []
    for unit in ("N", "N*m"):
        some = [i for i, q in enumerate(study.quantities) if q.unit == unit and q.joint]
        most = max((study.largest[i] for i in some), default=0.0)
        found += [i for i in some if study.largest[i] > NOTHING * most]
    return sorted(found)


def governing(study: ToleranceStudy, kind: str | None = None) -> int | None:
    """The quantity nearest to its limit, else the largest force; None where nothing is loaded."""
    some = [
        i
        for i in loaded(study)
        if study.quantities[i].unit == "N" and kind in (None, study.quantities[i].kind)
    ]
    if not some:
        return None
    return max(some, key=lambda i: (study.utilisation[i], study.largest[i]))


def leading(study: ToleranceStudy) -> int:
    """The governing quantity of an assembly that is known to be loaded.

    Raises
    ------
    NumericalError
        Nothing is loaded.
    """
    found = governing(study)
    if found is None:
        raise NumericalError(
            study.title, "no joint is loaded.", "Check the structure and its tolerances."
        )
    return found


def label(quantity: Quantity) -> str:
    """A quantity in the words of the page."""
    return quantity.name


def pose(study: ToleranceStudy, index: int) -> str:
    """Label of a pose with a true minus."""
    return study.poses[index].replace("-", MINUS)


def shown(value: float, unit: str, digits: int = 3) -> str:
    """A number in the unit that the page shows."""
    return significant(UNITS[unit][1] * value, digits)


def main_cause(study: ToleranceStudy, i: int) -> str:
    """The tolerance with the largest share in a quantity, and that share."""
    name = study.contributor(i)
    return (
        ""
        if name is None
        else f"{name} ({100 * float(study.shares[i].max()):.0f}\N{NO-BREAK SPACE}%)"
    )


def tool_blocks(study: ToleranceStudy, key: str) -> list[Block]:
    """Where the locked-in misfit moves the tool, beside the force that it costs."""
    some = [i for i, q in enumerate(study.quantities) if q.joint is None]
    if not some:
        return []
    floor = {
        unit: NOTHING
        * max((study.largest[i] for i in some if study.quantities[i].unit == unit), default=0.0)
        for unit in ("m", "rad")
    }
    rows: list[list[str | Cell]] = []
    for i in some:
        q = study.quantities[i]
        value = float(study.largest[i])
        row: list[str | Cell] = [f"{q.kind} {_way(q)}"]
        if value <= floor[q.unit]:
            rows.append([*row, "0", UNITS[q.unit][0], ""])
            continue
        rows.append([*row, shown(value, q.unit), UNITS[q.unit][0], main_cause(study, i)])
    if study.deviation is not None:
        where = f" at {pose(study, study.farthest)}" if len(study.poses) > 1 else ""
        most = shown(float(study.deviation.largest[study.farthest]), "m")
        rows.append([f"displacement in any direction{where}", most, UNITS["m"][0], ""])
    top = governing(study)
    beside = ""
    if top is not None:
        beside = (
            f"; the largest force that the same tolerances lock in is "
            f"{shown(float(study.largest[top]), 'N')} kN"
        )
    return [
        Table(
            f"{study.title}: worst displacement of the tool that the misfits cause{beside}",
            (
                Column("tool", "", False),
                Column("worst case"),
                Column("unit", "", False),
                Column("largest contributor", "", False),
            ),
            rows,
            f"{key}-forces.csv",
        )
    ]


def _way(quantity: Quantity) -> str:
    way = quantity.directions[0]
    return f"about {way[1:]}" if way.startswith("r") else f"along {way}"


def study_file(study: ToleranceStudy, key: str) -> DataFile:
    """The whole study as JSON."""
    what = f"{study.title}: tolerances, worst cases with their misfits, distribution, SI"
    return json_file(f"{key}.json", what, study.to_dict())


def tolerance_table(tolerances: Sequence[Tolerance], caption: str) -> Table:
    """What may deviate, by how much."""
    named = {
        t.name: [t.kind.replace("_", " "), size_text(t), t.datum or NONE, ", ".join(t.joints)]
        for t in tolerances
    }
    rows = [[group.label, *group.cells] for group in grouped(named, loose=(2, 3))]
    heads = ["tolerance", "kind", "size", "datum", "joints"]
    if all(row[3] == NONE for row in rows):
        del heads[3]
        rows = [[*row[:3], row[4]] for row in rows]
    return Table(caption, [Column(h, "", False) for h in heads], rows)


def size_text(tolerance: Tolerance, factor: float = 1.0) -> str:
    """A tolerance's size as a drawing states it."""
    return size_value(tolerance, factor * given_size(tolerance))


def size_value(tolerance: Tolerance, size: float) -> str:
    """A size of the same kind as the tolerance's."""
    unit = ("µm", 1e6) if size < MILLIMETRES else ("mm", 1e3)
    if tolerance.slope is not None:
        return f"{significant(unit[1] * size)} {unit[0]}/m"
    text = f"{significant(unit[1] * size)} {unit[0]}"
    return "±" + text if tolerance.kind == "length" else text


def headline(study: ToleranceStudy) -> Facts | Note:
    """The governing force and what it means."""
    top = governing(study)
    if top is None:
        return Note(
            "No force is locked in: nothing is constrained twice where these tolerances act."
        )
    q = study.quantities[top]
    facts = [
        Fact(
            "Largest locked-in force",
            shown(float(study.largest[top]), q.unit),
            UNITS[q.unit][0],
            f"{label(q)}, exact worst case",
        )
    ]
    if np.isfinite(study.limit[top]):
        facts.append(
            Fact(
                "Share of its limit",
                f"{100 * float(study.utilisation[top]):.0f}",
                "%",
                f"limit {shown(float(study.limit[top]), q.unit)} {UNITS[q.unit][0]}",
            )
        )
    if study.distribution is not None and 0.99 in study.distribution.shares:
        n = study.distribution.shares.index(0.99)
        value = float(study.distribution.values.quantiles[top, n])
        facts.append(
            Fact("99 % stay below", shown(value, q.unit), UNITS[q.unit][0], "of the assemblies")
        )
    states = int(study.responses.influence.redundant.max(initial=0))
    facts.append(
        Fact("States of self-stress", str(states), "", "directions constrained more than once")
    )
    return Facts(tuple(facts))
