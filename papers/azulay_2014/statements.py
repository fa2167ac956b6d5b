"""Every result that Azulay et al. 2014 print, beside ours."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import degrees, nan, sqrt

from strutwork.papers.azulay_2014.comparison import DIRECTIONS, machines, variant
from strutwork.papers.azulay_2014.dynamic import azulay_table_5
from strutwork.papers.azulay_2014.machine_study import MODEL_NAMES, Comparison
from strutwork.papers.azulay_2014.published import TABLE_2, TABLE_3, TABLE_4
from strutwork.papers.azulay_2014.tilts import tilts
from strutwork.papers.statements import Statement, stated

TESTS = "tests/verification/azulay_2014"

#: Check points of a machine (section 3.3.1).
POINTS = 317
#: Of a two-tailed test at 99 %.
CRITICAL = 2.576


def significance(axis: str, other: str) -> float:
    """The test statistic of section 4.1 from the printed means and variances.

    Parameters
    ----------
    axis : "x", "y" or "z"
    other : str
        A machine that the proposed one is compared with.

    Returns
    -------
    float
        Difference of the means over its standard deviation; positive where the proposed machine
        is the stiffer one. Points of a grid are no independent samples: it is the paper's test.
    """
    quantity = f"K{axis * 2}"
    first, second = machines()[0], other
    apart = TABLE_4.value(first, f"{quantity} mean") - TABLE_4.value(second, f"{quantity} mean")
    variances = [TABLE_4.value(m, f"{quantity} variance") for m in (first, second)]
    return apart / sqrt(sum(variances) / POINTS)


def statements(study: Comparison) -> tuple[Statement, ...]:
    """All of them, in the order of the document."""
    return (
        *_tilts(),
        *_ring(study),
        *_table(study, TABLE_2.key, "Table 2", "test_apparent_model_meets_table_2"),
        *_table(study, TABLE_4.key, "Table 4", "test_apparent_model_meets_table_4"),
        *_significance(),
        *stated(
            azulay_table_5().table(),
            "Table 5",
            f"{TESTS}/test_dynamic.py::test_rows_say_what_they_are_worth",
        ),
        *_without_numbers(),
    )


def _table(study: Comparison, key: str, place: str, test: str) -> tuple[Statement, ...]:
    found: list[Statement] = []
    for model, words in MODEL_NAMES.items():
        rows = [replace(r, row=f"{r.row}, {words}") for r in study.azulay.rows[key, model]]
        for row in rows:
            held = "test_no_row_is_called_a_prediction"
            if row.quantity.endswith("mean"):
                held = test if model == "apparent" else "test_machines_rank_as_in_table_4"
            found += stated([row], place, f"{TESTS}/test_static.py::{held}")
    return tuple(found)


def _tilts() -> tuple[Statement, ...]:
    found: list[Statement] = []
    for name in machines():
        ours = tilts(variant(name, "spherical"))
        found.append(
            Statement(
                "section 3.1, Table 3",
                f"{name}: largest tilt from the pole",
                "deg",
                TABLE_3.value(name, "platform tilt angle"),
                degrees(ours.connected),
                "not reproducible",
                "on the 4 mm hemisphere, by poses within the machine's own joint ranges; neutral "
                "directions of the spherical joints, poles, middles of strokes and the "
                "shapes that touch are not printed",
                f"{TESTS}/test_statements.py::test_tilts_are_nested",
            )
        )
        found.append(
            Statement(
                "section 3.1, Table 3",
                f"{name}: with gaps on the way; before the singular ring",
                "deg",
                "not distinguished",
                f"{degrees(ours.reached):.1f}; {degrees(ours.before_the_ring):.1f}",
                "not reproducible",
                "the paper asks of each point alone whether it is reached, and names neither; the "
                "first counts any roll however the machine came there, the second is what six "
                "drives do",
                f"{TESTS}/test_statements.py::test_tilts_are_nested",
            )
        )
    return tuple(found)


def _ring(study: Comparison) -> tuple[Statement, ...]:
    found: list[Statement] = []
    for name in study.names:
        low, high = study.barred[name, "spherical"].ring.extent
        first = name == study.names[0]
        found.append(
            Statement(
                "Fig. 4",
                f"{name}: type 2 singular poses on the 4 mm hemisphere",
                "mm",
                "about 2" if first else "not shown",
                f"{1e3 * low:.2f} to {1e3 * high:.2f}",
                "calibrated",
                "the height of the pole was chosen by Table 4",
                f"{TESTS}/test_barrier.py::test_ring",
            )
        )
    return tuple(found)


def _significance() -> tuple[Statement, ...]:
    names: Mapping[str, str] = {n: n for n in machines()[1:]}
    found: list[Statement] = []
    for axis in DIRECTIONS:
        for name in names:
            z = significance(axis, name)
            found.append(
                Statement(
                    "section 4.1",
                    f"K{axis * 2}: proposed stiffer than {name} beyond 99 %",
                    "",
                    "yes",
                    f"{'yes' if z > CRITICAL else 'no'}, statistic {z:.1f} from the printed table",
                    "predicted" if z > CRITICAL else "not reproducible",
                    "computed from the printed means and variances with 317 points each; points of "
                    "a grid are no independent samples, so the level means little"
                    if z > CRITICAL
                    else "by Table 4 itself the proposed machine is not the stiffer one along z",
                    f"{TESTS}/test_statements.py::test_significance",
                )
            )
    return tuple(found)


def _without_numbers() -> tuple[Statement, ...]:
    """Results that are drawn only."""
    test = f"{TESTS}/test_statements.py::test_every_result_is_there"
    drawn = "curves without numbers in the text; data and dimensions behind them are not printed"
    return tuple(
        Statement(place, what, "", "a figure", nan, "not reproducible", drawn, test)
        for place, what in (
            ("Fig. 3", "tilt by link length and radius of the sphere"),
            ("Fig. 8", "frequency responses by link length"),
            ("Fig. 10", "frequency responses of the four machines"),
            ("Fig. 12", "the prototype: measured and computed frequency responses"),
        )
    )
